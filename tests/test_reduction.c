/* Guyan and IRS condensation and their derivatives: dense formulas, static and modal invariants, central differences. */
#include "dense.h"
#include "paper_rotor.h"

#include <cblas.h>

#include "linalg/linalg.h"
#include "model/model.h"
#include "support.h"

static const int kinds[2] = {ROTID_GUYAN, ROTID_IRS};

static rotid_matrix like(struct pool *pool, const rotid_matrix *a)
{
    rotid_matrix b;
    assert_status(matrix_new(pool, a->n, a->kd, a->nfar, a->far, &b), ROTID_OK);
    return b;
}

/* K, M and their derivatives of the paper's rotor. */
struct reduced_rotor {
    struct rotor_model client;
    rotid_matrix k, m, dk, dm;
};

static void open_rotor(struct pool *pool, enum bundle_model bundle, int self_equilibrated, int nparameter,
                       const struct parameter *parameter, const double *x, struct reduced_rotor *r)
{
    int failed;
    const struct rotor *rotor = paper_rotor(bundle, self_equilibrated);
    assert_status(model_open(pool, NULL, rotor, nparameter, parameter, 1, &r->client, &failed), ROTID_OK);
    const rotid_model *model = &r->client.equations;
    rotid_matrix *all[4] = {&r->k, &r->m, &r->dk, &r->dm};
    for (int i = 0; i < 4; i++)
        assert_status(matrix_new(pool, model->n, model->kd, model->nfar, model->far, all[i]), ROTID_OK);
    assert_int_equal(model->matrices(model->user, x, &r->k, &r->m), 0);
}

/* T, K~, M~ of both kinds against their dense formulas, the difference relative to the largest element. */
static void check_against_dense(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int nc, const int *master,
                                double tolerance)
{
    int n = k->n;
    size_t square = (size_t)nc * (size_t)nc, tall = (size_t)n * (size_t)nc;
    const double *full_k = dense_of(pool, k), *full_m = dense_of(pool, m);
    for (int kind = 0; kind < 2; kind++) {
        struct reduction r;
        assert_status(reduction_new(pool, kinds[kind], k, nc, master, &r), ROTID_OK);
        assert_status(reduction_compute(&r, k, m), ROTID_OK);
        const double *t = kind ? dense_irs(pool, n, full_k, full_m, nc, master) : dense_guyan(pool, n, full_k, nc, master);
        assert_close(relative_difference(tall, r.t, t), 0, 0, tolerance);
        assert_close(relative_difference(square, r.kc, dense_congruence(pool, n, nc, full_k, t)), 0, 0, tolerance);
        assert_close(relative_difference(square, r.mc, dense_congruence(pool, n, nc, full_m, t)), 0, 0, tolerance);
    }
}

POOL_TEST(condensed_matrices_are_those_of_the_dense_formulas)
{
    struct random_stream stream = {41};
    const int far[6] = {0, 1, 11, 12, 24, 25}, all[30] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14,
                                                          15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29};
    const int masters[5][8] = {
        {0}, {3, 24}, {0, 4, 8, 12, 16, 20, 24, 28}, {1, 2, 3, 4, 5, 6, 7, 8}, {22, 23, 24, 25, 26, 27, 28, 29}};
    const int counts[5] = {1, 2, 8, 8, 8};
    for (int nfar = 0; nfar <= 6; nfar += 3)
        for (int c = 0; c < 7; c++) {
            rotid_matrix k, m;
            random_positive(*state, &stream, 30, 3, nfar, far, 1, &k);
            random_positive(*state, &stream, 30, 3, nfar, far, 1, &m);
            /* the last two: all but the first degree of freedom, and no slave at all */
            check_against_dense(*state, &k, &m, c < 5 ? counts[c] : c + 24, c < 5 ? masters[c] : all + (c == 5), 1e-11);
        }
}

POOL_TEST(condensed_matrices_of_the_papers_rotor_are_those_of_the_dense_formulas)
{
    for (int bundle = BUNDLE_RODS; bundle <= BUNDLE_TUBE; bundle++) {
        struct reduced_rotor r;
        open_rotor(*state, (enum bundle_model)bundle, 1, 2, paper_parameters, paper_start, &r);
        assert_int_equal(r.client.equations.nmaster, PAPER_SENSORS);
        check_against_dense(*state, &r.k, &r.m, PAPER_SENSORS, r.client.equations.master, 1e-9);
    }
}

/* Loads on the masters alone deflect them as in the full model: K~^-1 is the part of K^-1 at the masters. */
POOL_TEST(guyan_keeps_the_static_flexibility_of_the_masters)
{
    enum { n = 40, nc = 6 };
    struct random_stream stream = {42};
    const int far[4] = {2, 3, 30, 31}, master[nc] = {0, 3, 11, 19, 31, 38};
    rotid_matrix k, m;
    struct reduction r;
    random_positive(*state, &stream, n, 3, 4, far, 1, &k);
    random_positive(*state, &stream, n, 3, 4, far, 1, &m);
    assert_status(reduction_new(*state, ROTID_GUYAN, &k, nc, master, &r), ROTID_OK);
    assert_status(reduction_compute(&r, &k, &m), ROTID_OK);
    double *loads = numbers(*state, n * nc), *unit = numbers(*state, nc * nc);
    for (int c = 0; c < nc; c++)
        loads[master[c] + c * n] = unit[c + c * nc] = 1;
    const double *full = dense_solution(*state, n, nc, dense_of(*state, &k), loads);
    const double *small = dense_solution(*state, nc, nc, r.kc, unit);
    for (int c = 0; c < nc; c++)
        for (int b = 0; b < nc; b++)
            assert_close(small[b + c * nc], full[master[b] + c * n], 1e-11, 1e-12);
}

/* Frequencies of modes 1-6 in Hz: condensed, or full with kind ROTID_REDUCTION_NONE. */
static void bending_frequencies(struct pool *pool, const struct reduced_rotor *r, int kind, double *hz)
{
    int count = r->client.equations.nrigid + PAPER_MODES, nc = r->client.equations.nmaster;
    double *lambda = numbers(pool, count), *phi = numbers(pool, (ptrdiff_t)r->k.n * count);
    if (kind == ROTID_REDUCTION_NONE) {
        struct eigen_band e;
        assert_status(eigen_band_new(pool, &r->k, count, &e), ROTID_OK);
        assert_status(eigen_band_solve(&e, &r->k, &r->m, lambda, phi), ROTID_OK);
    } else {
        struct reduction reduction;
        struct eigen_dense e;
        assert_status(reduction_new(pool, kind, &r->k, nc, r->client.equations.master, &reduction), ROTID_OK);
        assert_status(reduction_compute(&reduction, &r->k, &r->m), ROTID_OK);
        assert_status(eigen_dense_new(pool, nc, count, &e), ROTID_OK);
        assert_status(eigen_dense_solve(&e, reduction.kc, reduction.mc, lambda, phi), ROTID_OK);
    }
    for (int j = 0; j < PAPER_MODES; j++)
        hz[j] = sqrt(lambda[r->client.equations.nrigid + j]) / 6.28318530717958647692;
}

/* Per cent by which Guyan with 68 masters raises the frequencies; from SciPy, dense. IRS on the same masters is nearer. */
POOL_TEST(condensation_errors_of_the_papers_rotor_are_those_of_scipy)
{
    const double expected[PAPER_MODES] = {0.043357, 0.076664, 0.214545, 0.709566, 3.296078, 1.287215};
    const double x[2] = {1.157e11, 0.316e11};
    struct reduced_rotor r;
    double full[PAPER_MODES], guyan[PAPER_MODES], irs[PAPER_MODES];
    open_rotor(*state, BUNDLE_TUBE, 0, 2, paper_parameters, x, &r);
    bending_frequencies(*state, &r, ROTID_REDUCTION_NONE, full);
    bending_frequencies(*state, &r, ROTID_GUYAN, guyan);
    bending_frequencies(*state, &r, ROTID_IRS, irs);
    for (int j = 0; j < PAPER_MODES; j++) {
        assert_close(100 * (guyan[j] / full[j] - 1), expected[j], 0, 1e-4);
        assert_true(irs[j] >= full[j] * (1 - 1e-9)); /* Rayleigh-Ritz bounds from above, whatever the basis */
        assert_true(irs[j] - full[j] < guyan[j] - full[j]);
    }
}

/* ---- derivatives */

static const struct parameter six[6] = {{PARAMETER_E, 1, 0, 0, NULL},       {PARAMETER_G, 1, 0, 0, NULL},
                                        {PARAMETER_NU, 1, 0, 0, NULL},      {PARAMETER_RHO, 1, 0, 0, NULL},
                                        {PARAMETER_TENSION, 0, 0, 0, NULL}, {PARAMETER_TIEROD_E, 0, 0, 0, NULL}};
/* steps of the differences in relative terms: as large as the curvature allows, since K~ hardly feels some of these */
static const double values[6] = {0.6e11, 0.3e11, 0.28, 7380.66, 150e3, 2.1e11}, steps[6] = {2e-3, 2e-3, 1e-2, 2e-3, 0.5, 1e-2};

/* T, K~ and M~ one after the other, at x with x_p changed by `by` relative. */
static void condensed_at(struct reduced_rotor *r, struct reduction *reduction, int p, double by, double *all)
{
    double x[6];
    memcpy(x, values, sizeof x);
    x[p] *= 1 + by;
    matrix_zero(&r->k);
    matrix_zero(&r->m);
    assert_int_equal(r->client.equations.matrices(r->client.equations.user, x, &r->k, &r->m), 0);
    assert_status(reduction_compute(reduction, &r->k, &r->m), ROTID_OK);
    size_t square = (size_t)reduction->nc * (size_t)reduction->nc, tall = (size_t)reduction->n * (size_t)reduction->nc;
    memcpy(all, reduction->t, tall * sizeof *all);
    memcpy(all + tall, reduction->kc, square * sizeof *all);
    memcpy(all + tall + square, reduction->mc, square * sizeof *all);
}

/* Central difference of fourth order; leaves the reduction computed at `values`. */
static double *difference(struct pool *pool, struct reduced_rotor *r, struct reduction *reduction, int p)
{
    const double weight[4] = {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12}, at[4] = {-2, -1, 1, 2};
    ptrdiff_t length = (ptrdiff_t)reduction->n * reduction->nc + 2 * (ptrdiff_t)reduction->nc * reduction->nc;
    double *all = numbers(pool, length), *sum = numbers(pool, length);
    for (int i = 0; i < 4; i++) {
        condensed_at(r, reduction, p, at[i] * steps[p], all);
        cblas_daxpy((int)length, weight[i] / (steps[p] * values[p]), all, 1, sum, 1);
    }
    condensed_at(r, reduction, p, 0, all);
    return sum;
}

static double largest(size_t count, const double *x)
{
    return fabs(x[cblas_idamax((int)count, x, 1)]);
}

/* dT, dK~ and dM~ column by column. */
POOL_TEST(derivatives_match_central_differences)
{
    for (int kind = 0; kind < 2; kind++) {
        struct reduced_rotor r;
        struct reduction reduction;
        open_rotor(*state, BUNDLE_RODS, 0, 6, six, values, &r);
        const rotid_model *model = &r.client.equations;
        int n = model->n, nc = model->nmaster;
        size_t square = (size_t)nc * (size_t)nc, tall = (size_t)n * (size_t)nc;
        assert_status(reduction_new(*state, kinds[kind], &r.k, nc, model->master, &reduction), ROTID_OK);
        double *dt = numbers(*state, (ptrdiff_t)tall), *dkc = numbers(*state, nc * nc), *dmc = numbers(*state, nc * nc);
        double *column = numbers(*state, nc), *work = numbers(*state, 3 * n + nc);
        for (int p = 0; p < 6; p++) {
            const double *expected = difference(*state, &r, &reduction, p);
            matrix_zero(&r.dk);
            matrix_zero(&r.dm);
            assert_int_equal(model->derivatives(model->user, values, p, &r.dk, &r.dm), 0);
            for (int c = 0; c < nc; c++) {
                memset(column, 0, (size_t)nc * sizeof *column);
                column[c] = 1;
                reduction_derivative_multiply(&reduction, &r.dk, &r.dm, column, dkc + c * nc, dmc + c * nc, work);
                reduction_derivative_expand(&reduction, &r.dk, &r.dm, column, dt + (ptrdiff_t)c * n);
            }
            const double *parts[3] = {dt, dkc, dmc}, *of[3] = {reduction.t, reduction.kc, reduction.mc};
            for (int part = 0; part < 3; part++) { /* Guyan's T and K~ do not feel rho */
                const double *reference = expected + (part > 0) * tall + (part > 1) * square;
                size_t length = part ? square : tall;
                if (six[p].kind == PARAMETER_RHO && kinds[kind] == ROTID_GUYAN && part < 2) {
                    assert_close(largest(length, parts[part]), 0, 0, 0);
                    continue;
                }
                /* it has to act, or rounding is all that the difference shows */
                assert_true(largest(length, reference) * values[p] > 1e-7 * largest(length, of[part]));
                assert_close(relative_difference(length, parts[part], reference), 0, 0, 1e-8);
            }
            for (int j = 0; j < nc; j++)
                for (int i = 0; i < j; i++) {
                    assert_close(dkc[i + j * nc], dkc[j + i * nc], 0, 1e-9 * largest(square, dkc));
                    assert_close(dmc[i + j * nc], dmc[j + i * nc], 0, 1e-9 * largest(square, dmc));
                }
        }
    }
}

POOL_TEST(expansion_and_projection_are_adjoint)
{
    enum { n = 40 };
    struct random_stream stream = {43};
    const int far[4] = {2, 3, 30, 31};
    int master[n];
    for (int nc = 1; nc <= n; nc += nc < 3 ? 1 : 9)
        for (int kind = 0; kind < 2; kind++) {
            struct reduction r;
            rotid_matrix k, m, dk, dm;
            for (int c = 0; c < nc; c++)
                master[c] = n - 1 - (nc - 1 - c) * (n / nc);
            random_positive(*state, &stream, n, 3, 4, far, 1, &k);
            random_positive(*state, &stream, n, 3, 4, far, 1, &m);
            random_positive(*state, &stream, n, 3, 4, far, 1, &dk);
            random_positive(*state, &stream, n, 3, 4, far, 1, &dm);
            assert_status(reduction_new(*state, kinds[kind], &k, nc, master, &r), ROTID_OK);
            assert_status(reduction_compute(&r, &k, &m), ROTID_OK);
            const double *x = random_numbers(*state, &stream, nc), *u = random_numbers(*state, &stream, n);
            double *tx = numbers(*state, n), *tu = numbers(*state, nc), *kx = numbers(*state, nc), *mx = numbers(*state, nc);
            reduction_expand(&r, x, tx);
            reduction_project(&r, u, tu);
            assert_close(relative_difference(n, tx, dense_product(*state, n, nc, 1, r.t, x)), 0, 0, 1e-14);
            double size = cblas_dnrm2(n, tx, 1) * cblas_dnrm2(n, u, 1);
            assert_close(cblas_ddot(nc, x, 1, tu, 1), cblas_ddot(n, tx, 1, u, 1), 0, 1e-13 * size);
            reduction_derivative_expand(&r, &dk, &dm, x, tx);
            reduction_derivative_project(&r, &dk, &dm, u, tu);
            size = cblas_dnrm2(n, tx, 1) * cblas_dnrm2(n, u, 1);
            assert_close(cblas_ddot(nc, x, 1, tu, 1), cblas_ddot(n, tx, 1, u, 1), 0, 1e-11 * size);
            /* (K~ + h dK~) x by a difference on random matrices, where no structure of a beam can hide an error */
            double h = 1e-5, *work = numbers(*state, 3 * n + nc), *low = numbers(*state, 2 * nc), *high = numbers(*state, 2 * nc);
            reduction_derivative_multiply(&r, &dk, &dm, x, kx, mx, work);
            rotid_matrix at_k = like(*state, &k), at_m = like(*state, &m);
            for (int side = -1; side <= 1; side += 2) {
                double *y = side < 0 ? low : high;
                matrix_combine(1, &k, side * h, &dk, &at_k);
                matrix_combine(1, &m, side * h, &dm, &at_m);
                assert_status(reduction_compute(&r, &at_k, &at_m), ROTID_OK);
                memcpy(y, dense_product(*state, nc, nc, 1, r.kc, x), (size_t)nc * sizeof *y);
                memcpy(y + nc, dense_product(*state, nc, nc, 1, r.mc, x), (size_t)nc * sizeof *y);
            }
            for (int i = 0; i < 2 * nc; i++)
                high[i] = (high[i] - low[i]) / (2 * h);
            assert_close(relative_difference((size_t)nc, kx, high), 0, 0, 1e-6);
            assert_close(relative_difference((size_t)nc, mx, high + nc), 0, 0, 1e-6);
        }
}

/* ---- refusals */

POOL_TEST(slaves_that_nothing_holds_are_an_error)
{
    struct random_stream stream = {44};
    const int master[3] = {0, 8, 19};
    for (int kind = 0; kind < 2; kind++) {
        struct reduction r;
        rotid_matrix k, m;
        random_positive(*state, &stream, 20, 3, 0, NULL, 1, &k);
        random_positive(*state, &stream, 20, 3, 0, NULL, 1, &m);
        assert_status(reduction_new(*state, kinds[kind], &k, 3, master, &r), ROTID_OK);
        assert_status(reduction_compute(&r, &k, &m), ROTID_OK);
        for (int d = 0; d < 4; d++) { /* degree of freedom 12 has no stiffness */
            k.band[d + 4 * 12] = 0;
            k.band[d + 4 * (12 - d)] = 0;
        }
        assert_status(reduction_compute(&r, &k, &m), ROTID_ERROR_SLAVE);
        k.band[4 * 12] = -1;
        assert_status(reduction_compute(&r, &k, &m), ROTID_ERROR_SLAVE);
    }
}

/* A free beam with its only master at one end can still turn about it: singular up to rounding. */
POOL_TEST(slaves_that_can_move_rigidly_are_an_error)
{
    for (int elements = 2; elements <= 200; elements *= 3) {
        int n = 2 * elements + 2, master[1] = {0};
        double l = 2.0 / elements, ek[16], em[16];
        struct reduction r;
        rotid_matrix k, m;
        rotid_element_stiffness(1.03e6, 5e8, l, ek);
        rotid_element_mass(61.7, 0.0385, 12 * 1.03e6 / (5e8 * l * l), l, em);
        assert_status(matrix_new(*state, n, 3, 0, NULL, &k), ROTID_OK);
        assert_status(matrix_new(*state, n, 3, 0, NULL, &m), ROTID_OK);
        for (int e = 0; e < elements; e++) {
            const int dof[4] = {2 * e, 2 * e + 1, 2 * e + 2, 2 * e + 3};
            matrix_add_element(&k, 4, dof, ek);
            matrix_add_element(&m, 4, dof, em);
        }
        assert_status(reduction_new(*state, ROTID_GUYAN, &k, 1, master, &r), ROTID_OK);
        assert_status(reduction_compute(&r, &k, &m), ROTID_ERROR_SLAVE);
    }
}

POOL_TEST(a_guyan_mass_that_is_not_positive_definite_stops_irs)
{
    struct random_stream stream = {45};
    const int master[3] = {0, 8, 19};
    struct reduction r;
    rotid_matrix k, m;
    random_positive(*state, &stream, 20, 3, 0, NULL, 1, &k);
    random_positive(*state, &stream, 20, 3, 0, NULL, 1, &m);
    m.band[4 * 8] = -1000;
    assert_status(reduction_new(*state, ROTID_IRS, &k, 3, master, &r), ROTID_OK);
    assert_status(reduction_compute(&r, &k, &m), ROTID_ERROR_MASS);
}
