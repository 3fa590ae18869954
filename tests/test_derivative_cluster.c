/* Derivatives where eigenvalues are close: two spans with a weak coupling, whose pairs of modes are as near as is asked for. The
 * sum of phi phi' over a pair is a smooth function whatever the gap is, and differences of it are the witness. */
#include "dense.h"

#include "linalg/linalg.h"
#include "modal/modal.h"
#include "support.h"

enum { each = 3, most = 9, most_spans = 11 }; /* masses of a span; of three spans; more than a cluster has members */

struct spans {
    int count;
    double coupling; /* spring between the ends of neighbours */
    rotid_model model;
};

/* x1: springs of the first span, x2: mass at the end of the second; alike at (2, 1) */
static int span_matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    const struct spans *spans = user;
    for (int c = 0; c < spans->count; c++) {
        double spring = c ? 2 : x[0];
        int end = c * each + each - 1;
        for (int i = 0; i < each; i++) {
            matrix_add(mass, c * each + i, c * each + i, c == 1 && i == each - 1 ? x[1] : 1);
            matrix_add(stiffness, c * each + i, c * each + i, i ? 2 * spring : spring + 1);
            if (i)
                matrix_add(stiffness, c * each + i, c * each + i - 1, -spring);
        }
        matrix_add(stiffness, end, end, spans->coupling * (c > 0) + spans->coupling * (c + 1 < spans->count));
        if (c)
            matrix_add(stiffness, end, end - each, -spans->coupling);
    }
    return 0;
}

static const rotid_model *open_spans(struct spans *spans, int count, double coupling)
{
    static int master[2 * most_spans];
    for (int i = 0; i < 2 * count; i++)
        master[i] = i / 2 * each + i % 2 * 2;
    *spans = (struct spans){.count = count, .coupling = coupling};
    spans->model = (rotid_model){.n = count * each,
                                 .kd = each,
                                 .nparam = 2,
                                 .nmaster = 2 * count,
                                 .master = master,
                                 .matrices = span_matrices,
                                 .user = spans};
    return &spans->model;
}

static const double alike[2] = {2, 1};

/* sum of phi phi' over pairs k ... k + members - 1, in square [size * size] */
static void add_projector(const struct prediction *p, int k, int members, double factor, double *square)
{
    for (int m = k; m < k + members; m++)
        for (int j = 0; j < p->size; j++)
            for (int i = 0; i < p->size; i++)
                square[i + j * p->size] += factor * p->phi[i + m * p->size] * p->phi[j + m * p->size];
}

/* Error of its derivative by the vectors' against differences of fourth order, the worst over the clusters and parameters. */
static double projector_error(struct pool *pool, const rotid_model *model, int reduction, int derivative, int members)
{
    static const double at[4] = {-2, -1, 1, 2}, weight[4] = {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12};
    const double h = 1e-3;
    struct prediction p, other;
    int count = reduction == ROTID_REDUCTION_NONE ? model->n : model->nmaster, wanted[most] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    double worst = 0;
    assert_status(prediction_new(pool, model, reduction, derivative, count, 1, &p), ROTID_OK);
    assert_status(prediction_new(pool, model, reduction, derivative, count, 0, &other), ROTID_OK);
    assert_status(prediction_compute(&p, alike), ROTID_OK);
    assert_status(prediction_differentiate(&p, alike, wanted, 1), ROTID_OK);
    for (int k = 0; k < count; k += members)
        for (int q = 0; q < 2; q++) {
            double slope[most * most] = {0}, difference[most * most] = {0};
            for (int m = k; m < k + members; m++)
                for (int j = 0; j < p.size; j++)
                    for (int i = 0; i < p.size; i++) {
                        const double *phi = p.phi + m * p.size, *dphi = p.dphi + prediction_place(&p, m, q);
                        slope[i + j * p.size] += dphi[i] * phi[j] + phi[i] * dphi[j];
                    }
            for (int s = 0; s < 4; s++) {
                double x[2] = {alike[0], alike[1]};
                x[q] += at[s] * h;
                assert_status(prediction_compute(&other, x), ROTID_OK);
                add_projector(&other, k, members, weight[s] / h, difference);
            }
            worst = fmax(worst, relative_difference((size_t)(p.size * p.size), slope, difference));
        }
    return worst;
}

/* Above the limit of a cluster the vectors turn by 1/gap, and the error is rounding beside that; in the cluster it is rounding
 * alone, but for the dense solution without refinement, in which the cluster counts as one eigenvalue. */
POOL_TEST(subspace_of_close_pairs_is_differentiated_at_any_gap)
{
    for (int tenth = 2; tenth <= 16; tenth++) {
        struct spans spans;
        double coupling = tenth == 16 ? 0 : pow(10, -tenth);
        const rotid_model *model = open_spans(&spans, 2, coupling);
        double full = projector_error(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, 2),
               nelson = projector_error(*state, model, ROTID_GUYAN, ROTID_NELSON, 2),
               modal = projector_error(*state, model, ROTID_GUYAN, ROTID_MODAL, 2);
        print_message("coupling %.0e: full %.1e, condensed by Nelson %.1e, by superposition %.1e\n", coupling, full, nelson,
                      modal);
        double turning = coupling > 1e-6 ? 1e-8 / coupling : 0;
        assert_close(full, 0, 0, 1e-9 + turning);
        assert_close(nelson, 0, 0, 1e-9 + turning + 0.2 * coupling);
        assert_close(modal, 0, 0, 1e-9);
    }
}

POOL_TEST(three_alike_are_one_cluster)
{
    struct spans spans;
    const rotid_model *model = open_spans(&spans, 3, 0);
    assert_close(projector_error(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, 3), 0, 0, 1e-8);
    assert_close(projector_error(*state, model, ROTID_GUYAN, ROTID_NELSON, 3), 0, 0, 1e-8);
}

/* Above the limit the vectors turn as they do; a step has to stay well inside the gap. */
POOL_TEST(vectors_turn_where_they_are_apart)
{
    for (int tenth = 1; tenth <= 4; tenth++) {
        struct spans spans;
        struct prediction p, low, high;
        const int wanted[6] = {1, 1, 1, 1, 1, 1};
        const rotid_model *model = open_spans(&spans, 2, pow(10, -tenth));
        double h = 1e-3 * spans.coupling, worst = 0;
        struct prediction *all[] = {&p, &low, &high};
        for (int i = 0; i < 3; i++) {
            const double x[2] = {i == 0 ? alike[0] : i == 1 ? alike[0] - h : alike[0] + h, alike[1]};
            assert_status(prediction_new(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, 6, 1, all[i]), ROTID_OK);
            assert_status(prediction_compute(all[i], x), ROTID_OK);
        }
        assert_status(prediction_differentiate(&p, alike, wanted, 1), ROTID_OK);
        for (int k = 0; k < 6; k++) {
            double difference[6];
            for (int i = 0; i < 6; i++) {
                double sign[2] = {0, 0};
                for (int j = 0; j < 6; j++) {
                    sign[0] += p.phi[j + k * 6] * low.phi[j + k * 6];
                    sign[1] += p.phi[j + k * 6] * high.phi[j + k * 6];
                }
                difference[i] =
                    (copysign(1, sign[1]) * high.phi[i + k * 6] - copysign(1, sign[0]) * low.phi[i + k * 6]) / (2 * h);
            }
            worst = fmax(worst, relative_difference(6, p.dphi + prediction_place(&p, k, 0), difference));
        }
        print_message("coupling %.0e: vectors within %.1e of differences\n", spans.coupling, worst);
        assert_close(worst, 0, 0, 2e-5);
    }
}

/* phi_j' M dphi_k of all pairs j, those far from pair k by (phi_j' P)/(lambda_j - lambda_k): *worst, relative to the largest of
 * them; those near it: the largest, *turning. */
static void compare_with_all_pairs(struct pool *pool, const struct prediction *all, const struct prediction *p, int k, int q,
                                   double *worst, double *turning)
{
    int n = all->size;
    rotid_matrix m = p->m;
    double *m_dphi = numbers(pool, n), largest = 0, error = 0;
    const double *dphi = p->dphi + prediction_place(p, k, q), *right = p->right + prediction_place(p, k, q);
    m.n = n;
    if (p->reduction == ROTID_REDUCTION_NONE)
        matrix_multiply(&m, 1, dphi, m_dphi);
    else
        m_dphi = dense_product(pool, n, n, 1, p->condensed.mc, dphi);
    for (int j = 0; j < n; j++) {
        double distance = all->lambda[j] - p->lambda[k], part = 0, expected = 0;
        for (int i = 0; i < n; i++) {
            part += all->phi[i + j * n] * m_dphi[i];
            expected += all->phi[i + j * n] * right[i];
        }
        if (fabs(distance) < 1e-5 * p->lambda[k]) {
            *turning = fmax(*turning, fabs(part));
        } else {
            error = fmax(error, fabs(part - expected / distance));
            largest = fmax(largest, fabs(expected / distance));
        }
    }
    if (largest > 0)
        *worst = fmax(*worst, error / largest);
}

/* Where further ones of the kind lie behind the pairs that are known, or beyond those that are counted to a cluster, the
 * derivative is that of the subspace still: the vectors do not turn by 1/rounding. */
POOL_TEST(more_alike_than_are_known_turn_nothing)
{
    static const int reductions[3][2] = {
        {ROTID_REDUCTION_NONE, ROTID_NELSON}, {ROTID_GUYAN, ROTID_NELSON}, {ROTID_GUYAN, ROTID_MODAL}};
    double worst = 0, turning = 0;
    for (int spans_in_all = 3; spans_in_all <= most_spans; spans_in_all += most_spans - 3)
        for (int r = 0; r < 3; r++) {
            struct spans spans;
            struct prediction all;
            const rotid_model *model = open_spans(&spans, spans_in_all, 0);
            int size = r ? model->nmaster : model->n;
            assert_status(prediction_new(*state, model, reductions[r][0], reductions[r][1], size, 1, &all), ROTID_OK);
            assert_status(prediction_compute(&all, alike), ROTID_OK);
            /* of one matrix block iteration finds no more equal ones than it has guards: nearly all pairs, by the dense solver */
            for (int count = r || spans_in_all == 3 ? 1 : size - 3; count <= size; count++) {
                struct prediction p;
                int wanted[2 * most_spans * each] = {0};
                for (int k = 0; k < count; k++)
                    wanted[k] = 1;
                assert_status(prediction_new(*state, model, reductions[r][0], reductions[r][1], count, 1, &p), ROTID_OK);
                assert_status(prediction_compute(&p, alike), ROTID_OK);
                assert_status(prediction_differentiate(&p, alike, wanted, 1), ROTID_OK);
                for (int k = 0; k < count; k++)
                    for (int q = 0; q < 2; q++)
                        compare_with_all_pairs(*state, &all, &p, k, q, &worst, &turning);
            }
        }
    print_message("pairs apart within %.1e, pairs alike turn by %.1e\n", worst, turning);
    assert_close(worst, 0, 0, 1e-6);
    assert_close(turning, 0, 0, 10);
}

/* R* is the eigenvalue whatever was measured; so is its derivative, and over a cluster they add up to that of the trace. */
POOL_TEST(hybrid_quotients_of_a_cluster_change_as_its_eigenvalues)
{
    static const int number[2] = {1, 2};
    static const double frequency[2] = {0.1, 0.1}, shape[8] = {1, 0.4, 0.2, 0.1, -0.3, 0.2, 1, 0.7};
    for (int tenth = 5; tenth <= 15; tenth += 2) {
        struct spans spans;
        struct functional f;
        const rotid_model *model = open_spans(&spans, 2, pow(10, -tenth));
        const rotid_measured measured = {.nmode = 2, .number = number, .frequency_hz = frequency, .shape = shape};
        double r[2], jacobian[4], difference[2] = {0};
        assert_status(functional_new(*state, ROTID_HYBRID, ROTID_GUYAN, ROTID_NELSON, model, &measured, &f), ROTID_OK);
        for (int i = -1; i < 2; i += 2)
            for (int q = 0; q < 2; q++) {
                double x[2] = {alike[0], alike[1]};
                x[q] += i * 1e-4;
                assert_status(functional_residual(&f, x, r), ROTID_OK);
                difference[q] += i * (r[0] + r[1]) / 2e-4;
            }
        assert_status(functional_residual(&f, alike, r), ROTID_OK);
        assert_status(functional_jacobian(&f, alike, jacobian), ROTID_OK);
        for (int q = 0; q < 2; q++)
            assert_close(jacobian[2 * q] + jacobian[2 * q + 1], difference[q], 1e-5, 0);
    }
}
