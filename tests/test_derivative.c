/* Derivatives of eigenvalues and eigenvectors against central differences of fourth order. */
#include "dense.h"
#include "paper_rotor.h"

#include <math.h>
#include <string.h>

#include "linalg/matrix.h"
#include "modal/prediction.h"
#include "run/client.h"

/* ---- the paper's rotor with seven parameters; its left spring is stiff enough to be felt by the bending modes */

enum { nparam = 7 };
static const struct parameter seven[nparam] = {{PARAMETER_E, 1},       {PARAMETER_G, 1},        {PARAMETER_NU, 1},
                                               {PARAMETER_RHO, 1},     {PARAMETER_TENSION, 0}, {PARAMETER_TIEROD_E, 0},
                                               {PARAMETER_SPRING_K, 0}};
static const double rotor_values[nparam] = {0.6e11, 0.3e11, 0.28, 7380.66, 150e3, 2.1e11, 1e8};
/* relative: as large as the curvature allows, since the bending modes hardly feel some of these */
static const double rotor_steps[nparam] = {2e-3, 2e-3, 1e-2, 2e-3, 0.5, 2e-2, 2e-2};

static const rotid_model *open_rotor(struct pool *pool, enum bundle_model bundle, struct client *client)
{
    int failed;
    struct rotor *rotor = paper_rotor(bundle, 0);
    rotor->spring[0].lateral = rotor_values[6];
    assert_status(client_open(pool, rotor, nparam, seven, 1, client, &failed), ROTID_OK);
    return &client->model;
}

/* ---- a host's own model: K(x) = K0 + x1 K1 + x1 x2 K2, M(x) = M0 + x2^2 M1, all of them dense */

enum { host_n = 14 };
struct host {
    double k0[host_n * host_n], k1[host_n * host_n], k2[host_n * host_n], m0[host_n * host_n], m1[host_n * host_n];
    int fail_matrices, fail_derivatives; /* the callback reports a failure */
    double poison_matrices, poison_derivatives; /* added to one element */
    rotid_model model;
};
static const double host_values[2] = {1.5, 0.8};

static void host_put(rotid_matrix *a, double factor, const double *full)
{
    for (int j = 0; j < a->n; j++)
        for (int i = j; i < a->n; i++)
            a->band[(i - j) + j * (a->kd + 1)] += factor * full[i + j * a->n];
}

static int host_matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    const struct host *host = user;
    host_put(stiffness, 1, host->k0);
    host_put(stiffness, x[0], host->k1);
    host_put(stiffness, x[0] * x[1], host->k2);
    host_put(mass, 1, host->m0);
    host_put(mass, x[1] * x[1], host->m1);
    mass->band[3] += host->poison_matrices;
    return host->fail_matrices;
}

static int host_derivatives(void *user, const double *x, int p, rotid_matrix *stiffness, rotid_matrix *mass)
{
    const struct host *host = user;
    if (p == 0)
        host_put(stiffness, 1, host->k1);
    host_put(stiffness, p == 0 ? x[1] : x[0], host->k2);
    if (p == 1)
        host_put(mass, 2 * x[1], host->m1);
    stiffness->band[3] += host->poison_derivatives;
    return host->fail_derivatives;
}

static const rotid_model *open_host(struct pool *pool, struct host *host)
{
    static const int master[6] = {0, 2, 5, 8, 9, 13};
    struct random_stream stream = {51};
    double *parts[5] = {host->k0, host->k1, host->k2, host->m0, host->m1};
    for (int p = 0; p < 5; p++) {
        rotid_matrix a;
        random_positive(pool, &stream, host_n, host_n - 1, 0, NULL, 1, &a);
        memcpy(parts[p], dense_of(pool, &a), host_n * host_n * sizeof(double));
    }
    host->fail_matrices = host->fail_derivatives = 0;
    host->poison_matrices = host->poison_derivatives = 0;
    host->model = (rotid_model){.n = host_n, .kd = host_n - 1, .nparam = 2, .nmaster = 6, .master = master,
                                .matrices = host_matrices, .derivatives = host_derivatives, .user = host};
    return &host->model;
}

/* ---- what is compared */

static double largest(int n, const double *x)
{
    double most = 0;
    for (int i = 0; i < n; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

/* Of all modes with respect to x_q: dlambda [count] and dphi [size * count]. Vectors are turned to the sign of those that p
 * holds, at x; their scale is that of phi' M phi = 1 everywhere. `away` computes at the points beside x: p stays there. */
static void differentiate_numerically(struct pool *pool, const struct prediction *p, struct prediction *away, const double *x,
                                      int q, double step, double *dlambda, double *dphi)
{
    const double weight[4] = {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12}, at[4] = {-2, -1, 1, 2};
    int n = p->size, nx = p->model->nparam;
    double *moved = numbers(pool, nx);
    memset(dphi, 0, (size_t)n * (size_t)p->count * sizeof *dphi);
    memset(dlambda, 0, (size_t)p->count * sizeof *dlambda);
    for (int i = 0; i < 4; i++) {
        memcpy(moved, x, (size_t)nx * sizeof *x);
        moved[q] *= 1 + at[i] * step;
        assert_status(prediction_compute(away, moved), ROTID_OK);
        for (int k = 0; k < p->count; k++) {
            const double *phi = away->phi + (ptrdiff_t)k * n, *at_x = p->phi + (ptrdiff_t)k * n;
            double dot = 0, factor = weight[i] / (step * x[q]);
            for (int j = 0; j < n; j++)
                dot += phi[j] * at_x[j];
            dlambda[k] += factor * away->lambda[k];
            for (int j = 0; j < n; j++)
                dphi[j + (ptrdiff_t)k * n] += (dot < 0 ? -factor : factor) * phi[j];
        }
    }
}

/* Every derivative of the modes from `first` on against differences, relative to the largest component. */
static void check_derivatives(struct pool *pool, const rotid_model *model, int reduction, int derivative, int first, int count,
                              const double *x, const double *steps, double tolerance)
{
    struct prediction p, away, scalar;
    assert_status(prediction_new(pool, model, reduction, derivative, count, 1, &p), ROTID_OK);
    assert_status(prediction_new(pool, model, reduction, derivative, count, 1, &away), ROTID_OK);
    assert_status(prediction_new(pool, model, reduction, derivative, p.count, 0, &scalar), ROTID_OK);
    int n = p.size, *wanted = POOL_ARRAY(pool, int, p.count);
    double *dphi = numbers(pool, (ptrdiff_t)n * p.count), *dlambda = numbers(pool, p.count), *difference = numbers(pool, n);
    for (int k = first; k < count; k++)
        wanted[k] = 1;
    assert_status(prediction_compute(&scalar, x), ROTID_OK);
    assert_status(prediction_differentiate(&scalar, x, wanted, 0), ROTID_OK);
    assert_status(prediction_compute(&p, x), ROTID_OK);
    assert_status(prediction_differentiate(&p, x, wanted, 1), ROTID_OK);
    for (int q = 0; q < model->nparam; q++) {
        differentiate_numerically(pool, &p, &away, x, q, steps[q], dlambda, dphi);
        for (int k = first; k < count; k++) {
            const double *expected = dphi + (ptrdiff_t)k * n, *analytic = p.dphi + ((ptrdiff_t)q * p.count + k) * n;
            assert_true(fabs(dlambda[k] * x[q]) > 1e-7 * p.lambda[k]); /* the parameter acts, or the test shows nothing */
            assert_close(p.dlambda[k + q * p.count], dlambda[k], tolerance, 0);
            assert_close(scalar.dlambda[k + q * p.count], dlambda[k], tolerance, 0);
            for (int i = 0; i < n; i++)
                difference[i] = analytic[i] - expected[i];
            assert_close(largest(n, difference), 0, 0, tolerance * largest(n, expected));
        }
    }
}

static void derivatives_of_the_papers_rotor_match_differences(void **state)
{
    for (int bundle = BUNDLE_RODS; bundle <= BUNDLE_TUBE; bundle++) {
        struct client client;
        const rotid_model *model = open_rotor(*state, (enum bundle_model)bundle, &client);
        int first = model->nrigid, count = first + 4;
        check_derivatives(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, first, count, rotor_values, rotor_steps, 1e-6);
        check_derivatives(*state, model, ROTID_GUYAN, ROTID_NELSON, first, count, rotor_values, rotor_steps, 1e-6);
        check_derivatives(*state, model, ROTID_IRS, ROTID_NELSON, first, count, rotor_values, rotor_steps, 1e-6);
    }
}

static void derivatives_of_a_hosts_dense_model_match_differences(void **state)
{
    const double steps[2] = {1e-3, 1e-3};
    struct host host;
    const rotid_model *model = open_host(*state, &host);
    check_derivatives(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, 0, 6, host_values, steps, 1e-7);
    for (int kind = ROTID_GUYAN; kind <= ROTID_IRS; kind++) {
        check_derivatives(*state, model, kind, ROTID_NELSON, 0, 6, host_values, steps, 1e-7);
        check_derivatives(*state, model, kind, ROTID_MODAL, 0, 6, host_values, steps, 1e-7);
    }
}

/* All of them with both methods at once. */
static void nelson_and_modal_superposition_agree(void **state)
{
    for (int kind = ROTID_GUYAN; kind <= ROTID_IRS; kind++) {
        struct client client;
        const rotid_model *model = open_rotor(*state, BUNDLE_TUBE, &client);
        struct prediction nelson, modal;
        int count = model->nrigid + 6, wanted[PAPER_SENSORS] = {0};
        for (int k = model->nrigid; k < count; k++)
            wanted[k] = 1;
        assert_status(prediction_new(*state, model, kind, ROTID_NELSON, count, 1, &nelson), ROTID_OK);
        assert_status(prediction_new(*state, model, kind, ROTID_MODAL, count, 1, &modal), ROTID_OK);
        assert_int_equal(modal.count, PAPER_SENSORS); /* the superposition needs them all */
        assert_status(prediction_compute(&nelson, rotor_values), ROTID_OK);
        assert_status(prediction_compute(&modal, rotor_values), ROTID_OK);
        assert_status(prediction_differentiate(&nelson, rotor_values, wanted, 1), ROTID_OK);
        assert_status(prediction_differentiate(&modal, rotor_values, wanted, 1), ROTID_OK);
        for (int k = model->nrigid; k < count; k++)
            for (int q = 0; q < nparam; q++) {
                double a[PAPER_SENSORS], b[PAPER_SENSORS], dot = 0;
                for (int s = 0; s < PAPER_SENSORS; s++) {
                    dot += prediction_at_sensor(&nelson, k, s) * prediction_at_sensor(&modal, k, s);
                    a[s] = prediction_derivative_at_sensor(&nelson, k, q, s);
                    b[s] = prediction_derivative_at_sensor(&modal, k, q, s);
                }
                for (int s = 0; s < PAPER_SENSORS && dot < 0; s++)
                    b[s] = -b[s];
                assert_close(relative_difference(PAPER_SENSORS, a, b), 0, 0, 1e-8);
            }
    }
}

/* phi' M phi = 1 at every x: 2 phi' M dphi = -phi' dM phi; rho is what moves M. */
static void derivatives_keep_the_normalisation(void **state)
{
    struct client client;
    const rotid_model *model = open_rotor(*state, BUNDLE_RODS, &client);
    struct prediction p;
    int n = model->n, count = model->nrigid + 6, wanted[16] = {0};
    double *work = numbers(*state, n);
    for (int k = model->nrigid; k < count; k++)
        wanted[k] = 1;
    assert_status(prediction_new(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 1, &p), ROTID_OK);
    assert_status(prediction_compute(&p, rotor_values), ROTID_OK);
    assert_status(prediction_differentiate(&p, rotor_values, wanted, 1), ROTID_OK);
    for (int q = 0; q < nparam; q++) {
        matrix_zero(&p.dk);
        matrix_zero(&p.dm);
        assert_int_equal(model->derivatives(model->user, rotor_values, q, &p.dk, &p.dm), 0);
        for (int k = model->nrigid; k < count; k++) {
            const double *phi = p.phi + (ptrdiff_t)k * n, *dphi = p.dphi + ((ptrdiff_t)q * p.count + k) * n;
            double change = matrix_product(&p.dm, phi, phi, work), size = sqrt(matrix_product(&p.m, dphi, dphi, work));
            assert_close(matrix_product(&p.m, phi, dphi, work), -0.5 * change, 0, 1e-10 * size);
            if (seven[q].kind == PARAMETER_RHO)
                assert_true(change * rotor_values[q] > 0.1);
        }
    }
}

/* Without derivatives of its own a model gets differences of its matrices. */
static void a_model_without_derivatives_gets_the_same(void **state)
{
    for (int kind = ROTID_REDUCTION_NONE; kind <= ROTID_IRS; kind++) {
        struct client client;
        rotid_model bare = *open_rotor(*state, BUNDLE_TUBE, &client), *models[2] = {&client.model, &bare};
        struct prediction p[2];
        int count = bare.nrigid + 4, wanted[16] = {0};
        bare.derivatives = NULL;
        for (int k = bare.nrigid; k < count; k++)
            wanted[k] = 1;
        for (int i = 0; i < 2; i++) {
            assert_status(prediction_new(*state, models[i], kind, ROTID_NELSON, count, 1, &p[i]), ROTID_OK);
            assert_status(prediction_compute(&p[i], rotor_values), ROTID_OK);
            assert_status(prediction_differentiate(&p[i], rotor_values, wanted, 1), ROTID_OK);
        }
        for (int k = bare.nrigid; k < count; k++)
            for (int q = 0; q < nparam; q++) {
                ptrdiff_t place = ((ptrdiff_t)q * p[0].count + k) * p[0].size;
                assert_close(p[1].dlambda[k + q * p[0].count], p[0].dlambda[k + q * p[0].count], 1e-6, 0);
                assert_close(relative_difference((size_t)p[0].size, p[1].dphi + place, p[0].dphi + place), 0, 0, 1e-6);
            }
    }
}

/* ---- refusals */

static void a_callback_that_fails_or_gives_nan_is_named(void **state)
{
    const int wanted[7] = {1, 1, 1, 1, 1, 1, 0};
    for (int kind = ROTID_REDUCTION_NONE; kind <= ROTID_IRS; kind++)
        for (int vectors = 0; vectors < 2; vectors++) {
            struct host host;
            struct prediction p;
            const rotid_model *model = open_host(*state, &host);
            assert_status(prediction_new(*state, model, kind, ROTID_NELSON, 6, vectors, &p), ROTID_OK);
            host.fail_matrices = 17;
            assert_status(prediction_compute(&p, host_values), ROTID_ERROR_CALLBACK);
            host.fail_matrices = 0;
            host.poison_matrices = NAN;
            assert_status(prediction_compute(&p, host_values), ROTID_ERROR_FINITE);
            host.poison_matrices = -INFINITY;
            assert_status(prediction_compute(&p, host_values), ROTID_ERROR_FINITE);
            host.poison_matrices = 0;
            assert_status(prediction_compute(&p, host_values), ROTID_OK);
            host.fail_derivatives = -1;
            assert_status(prediction_differentiate(&p, host_values, wanted, vectors), ROTID_ERROR_CALLBACK);
            host.fail_derivatives = 0;
            host.poison_derivatives = NAN;
            assert_status(prediction_differentiate(&p, host_values, wanted, vectors), ROTID_ERROR_FINITE);
            host.poison_derivatives = 0;
            assert_status(prediction_differentiate(&p, host_values, wanted, vectors), ROTID_OK);
            host.model.derivatives = NULL; /* the differences call `matrices` */
            host.fail_matrices = 1;
            assert_status(prediction_differentiate(&p, host_values, wanted, vectors), ROTID_ERROR_CALLBACK);
            host.fail_matrices = 0;
            host.poison_matrices = NAN;
            assert_status(prediction_differentiate(&p, host_values, wanted, vectors), ROTID_ERROR_FINITE);
        }
}

static void requests_out_of_range_are_refused(void **state)
{
    struct host host;
    struct prediction p;
    const rotid_model *model = open_host(*state, &host);
    assert_status(prediction_new(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, 0, 0, &p), ROTID_ERROR_ARGUMENT);
    assert_status(prediction_new(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, host_n + 1, 0, &p), ROTID_ERROR_ARGUMENT);
    assert_status(prediction_new(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, host_n, 0, &p), ROTID_OK);
    assert_status(prediction_new(*state, model, ROTID_REDUCTION_NONE, ROTID_MODAL, 3, 1, &p), ROTID_ERROR_ARGUMENT);
    assert_status(prediction_new(*state, model, ROTID_GUYAN, ROTID_NELSON, 7, 1, &p), ROTID_ERROR_ARGUMENT);
    assert_status(prediction_new(*state, model, ROTID_IRS, ROTID_MODAL, 6, 1, &p), ROTID_OK);
}

/* Two copies of the same chain of three masses and springs x1, the second x2 times as stiff; masses at the ends are masters. */
static int twin_matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    (void)user;
    for (int c = 0; c < 2; c++)
        for (int i = 0; i < 3; i++) {
            double spring = c ? x[0] * x[1] : x[0];
            matrix_add(mass, 3 * c + i, 3 * c + i, 1);
            matrix_add(stiffness, 3 * c + i, 3 * c + i, i ? 2 * spring : spring + 1);
            if (i < 2)
                matrix_add(stiffness, 3 * c + i, 3 * c + i + 1, -spring);
        }
    return 0;
}

static void vectors_of_repeated_eigenvalues_are_not_differentiated(void **state)
{
    static const int master[5] = {0, 1, 2, 3, 5};
    rotid_model model = {.n = 6, .kd = 1, .nparam = 2, .nmaster = 5, .master = master, .matrices = twin_matrices};
    const double equal[2] = {2, 1}, near[2] = {2, 1 + 1e-9}, apart[2] = {2, 1.5};
    for (int count = 1; count <= 6; count++) /* also where the partner lies just beyond the request */
        for (int k = 0; k < count; k++) {
            struct prediction p;
            int wanted[7] = {0};
            wanted[k] = 1;
            assert_status(prediction_new(*state, &model, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 1, &p), ROTID_OK);
            assert_status(prediction_compute(&p, equal), ROTID_OK);
            assert_status(prediction_differentiate(&p, equal, wanted, 1), ROTID_ERROR_CLOSE);
            assert_status(prediction_compute(&p, near), ROTID_OK);
            assert_status(prediction_differentiate(&p, near, wanted, 1), ROTID_ERROR_CLOSE);
            assert_status(prediction_compute(&p, apart), ROTID_OK);
            assert_status(prediction_differentiate(&p, apart, wanted, 1), ROTID_OK);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_POOL(derivatives_of_the_papers_rotor_match_differences),
        WITH_POOL(derivatives_of_a_hosts_dense_model_match_differences),
        WITH_POOL(nelson_and_modal_superposition_agree),
        WITH_POOL(derivatives_keep_the_normalisation),
        WITH_POOL(a_model_without_derivatives_gets_the_same),
        WITH_POOL(a_callback_that_fails_or_gives_nan_is_named),
        WITH_POOL(requests_out_of_range_are_refused),
        WITH_POOL(vectors_of_repeated_eigenvalues_are_not_differentiated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
