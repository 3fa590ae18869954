/* A host's own model behind rotid_model: derivatives of its modes, and what is refused. */
#include "dense.h"
#include "derivative_check.h"

#include "linalg/linalg.h"
#include "modal/modal.h"
#include "support.h"

/* ---- K(x) = K0 + x1 K1 + x1 x2 K2, M(x) = M0 + x2^2 M1, all of them dense */

enum { host_n = 14 };
struct host {
    double k0[host_n * host_n], k1[host_n * host_n], k2[host_n * host_n], m0[host_n * host_n], m1[host_n * host_n];
    int fail_matrices, fail_derivatives;                         /* the callback reports a failure */
    double least, most;                                          /* of x[0]: beyond them there are no matrices */
    double poison_matrices, poison_derivatives, poison_products; /* added to one element */
    int refuse_products;
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
    return host->fail_matrices || x[0] < host->least || x[0] > host->most;
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
    host->poison_matrices = host->poison_derivatives = host->poison_products = 0;
    host->refuse_products = 0;
    host->least = -INFINITY;
    host->most = INFINITY;
    host->model = (rotid_model){.size = sizeof(rotid_model),
                                .n = host_n,
                                .kd = host_n - 1,
                                .nparam = 2,
                                .nmaster = 6,
                                .master = master,
                                .matrices = host_matrices,
                                .derivatives = host_derivatives,
                                .user = host};
    return &host->model;
}

POOL_TEST(derivatives_of_a_hosts_dense_model_match_differences)
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

/* dK u and dM u; where they are refused the matrices are asked for */
static int host_products(void *user, const double *x, int p, int count, const double *u, double *dk_u, double *dm_u)
{
    const struct host *host = user;
    const double of[3] = {p == 0 ? 1 : 0, p == 0 ? x[1] : x[0], p == 0 ? 0 : 2 * x[1]};
    const double *const parts[3] = {host->k1, host->k2, host->m1};
    memset(dk_u, 0, (size_t)(count * host_n) * sizeof *dk_u);
    memset(dm_u, 0, (size_t)(count * host_n) * sizeof *dm_u);
    for (int c = 0; c < count; c++)
        for (int part = 0; part < 3; part++)
            for (int i = 0; i < host_n * host_n; i++)
                (part < 2 ? dk_u : dm_u)[i % host_n + c * host_n] += of[part] * parts[part][i] * u[i / host_n + c * host_n];
    dk_u[3] += host->poison_products;
    return host->refuse_products;
}

POOL_TEST(products_give_the_derivatives_that_the_matrices_give)
{
    const int wanted[7] = {0, 1, 0, 1, 1, 0, 0};
    for (int vectors = 0; vectors < 2; vectors++) {
        struct host host;
        struct prediction by[2];
        char failure[ROTID_FAILURE_LENGTH];
        const rotid_model *model = open_host(*state, &host);
        for (int products = 0; products < 2; products++) {
            struct prediction *p = &by[products];
            host.model.derivative_products = products ? host_products : NULL;
            host.fail_derivatives = products; /* which nobody asks for then */
            assert_status(prediction_new(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, 6, vectors, p), ROTID_OK);
            assert_status(prediction_compute(p, host_values), ROTID_OK);
            assert_status(prediction_differentiate(p, host_values, wanted, vectors), ROTID_OK);
        }
        for (int k = 0; k < 6; k++)
            for (int q = 0; q < 2 && wanted[k]; q++) {
                assert_close(by[1].dlambda[k + q * by[1].count], by[0].dlambda[k + q * by[0].count], 1e-11, 0);
                assert_true(!vectors || relative_difference(host_n, by[1].dphi + prediction_place(&by[1], k, q),
                                                            by[0].dphi + prediction_place(&by[0], k, q)) < 1e-10);
            }
        host.refuse_products = 1;
        assert_status(prediction_differentiate(&by[1], host_values, wanted, vectors), ROTID_ERROR_CALLBACK);
        host.refuse_products = 0;
        host.poison_products = NAN;
        by[1].failure = failure;
        assert_status(prediction_differentiate(&by[1], host_values, wanted, vectors), ROTID_ERROR_FINITE);
        assert_string_equal(failure, "model->derivative_products for p = 0: row 3 is nan, expected a number");
    }
}

/* ---- the same model in unknowns q, u = V q, which are no motions of sensors */

struct turned {
    struct host host;
    double v[host_n * host_n], work[host_n * host_n];
    rotid_model model;
};

static void turn(const struct turned *t, const rotid_matrix *from, rotid_matrix *to)
{
    host_put(to, 1, dense_congruence(&test_pool, host_n, host_n, dense_of(&test_pool, from), t->v));
}

static int turned_matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    struct turned *t = user;
    rotid_matrix k, m;
    assert_status(matrix_new(&test_pool, host_n, host_n - 1, 0, NULL, &k), ROTID_OK);
    assert_status(matrix_new(&test_pool, host_n, host_n - 1, 0, NULL, &m), ROTID_OK);
    int failed = host_matrices(&t->host, x, &k, &m);
    turn(t, &k, stiffness);
    turn(t, &m, mass);
    return failed;
}

POOL_TEST(a_model_in_other_unknowns_with_rows_for_its_sensors_fits_the_same)
{
    static const double std[6] = {1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3};
    static const int number[6] = {1, 2, 3, 4, 5, 6};
    static const rotid_parameter parameter[2] = {{"a", "1", 0.5, 3, 1.2}, {"b", "1", 0.3, 2, 1}};
    struct turned t;
    struct prediction p;
    struct random_stream stream = {77};
    double hz[6], shape[36], shape_std[36], sensor[6 * host_n];
    const rotid_model *model = open_host(*state, &t.host);
    t.host.model.derivatives = NULL; /* those of the turned one come from differences too */
    for (int i = 0; i < host_n * host_n; i++)
        t.v[i] = random_normal(&stream);
    for (int s = 0; s < 6; s++)
        for (int j = 0; j < host_n; j++)
            sensor[j + s * host_n] = t.v[model->master[s] + j * host_n];
    t.model = *model;
    t.model.master = NULL;
    t.model.sensor = sensor;
    t.model.matrices = turned_matrices;
    t.model.user = &t;
    assert_status(prediction_new(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, 6, 0, &p), ROTID_OK);
    assert_status(prediction_compute(&p, host_values), ROTID_OK);
    for (int k = 0; k < 6; k++) {
        hz[k] = prediction_hz(&p, k) * (1 + 1e-3 * random_normal(&stream));
        for (int s = 0; s < 6; s++) {
            shape[s + 6 * k] = prediction_at_sensor(&p, k, s) + 0.01 * random_normal(&stream);
            shape_std[s + 6 * k] = 0.05;
        }
    }
    const rotid_measured measured = {.size = sizeof measured,
                                     .nmode = 6,
                                     .number = number,
                                     .frequency_hz = hz,
                                     .frequency_std = std,
                                     .shape = shape,
                                     .shape_std = shape_std};
    rotid_fit_result *fit[2];
    for (int turned = 0; turned < 2; turned++)
        assert_status(rotid_fit(turned ? &t.model : model, parameter, &measured, NULL, NULL, NULL, &fit[turned]), ROTID_OK);
    assert_true(fit[0]->converged && fit[1]->converged);
    for (int q = 0; q < 2; q++) {
        assert_close(fit[1]->x[q], fit[0]->x[q], 1e-7, 0);
        assert_close(fit[1]->std[q], fit[0]->std[q], 1e-5, 0);
    }
    for (int k = 0; k < 6; k++)
        assert_close(fit[1]->mac[k], fit[0]->mac[k], 1e-8, 0);
    rotid_fit_free(fit[0]);
    rotid_fit_free(fit[1]);
}

/* ---- refusals */

/* By differences, of points on both sides or on the one where there is a model. */
POOL_TEST(without_derivatives_they_come_from_differences_on_either_side)
{
    struct host host;
    const rotid_model *model = open_host(*state, &host);
    struct prediction exact, differences;
    for (int side = -1; side <= 1; side++) {
        host.model.derivatives = host_derivatives;
        assert_int_equal(prediction_new(*state, model, ROTID_GUYAN, ROTID_NELSON, 4, 0, &exact), 0);
        assert_int_equal(prediction_compute(&exact, host_values), 0);
        assert_int_equal(prediction_matrix_derivatives(&exact, host_values, 0), 0);
        host.model.derivatives = NULL;
        host.least = side > 0 ? host_values[0] : -INFINITY;
        host.most = side < 0 ? host_values[0] : INFINITY;
        assert_int_equal(prediction_new(*state, model, ROTID_GUYAN, ROTID_NELSON, 4, 0, &differences), 0);
        assert_int_equal(prediction_compute(&differences, host_values), 0);
        assert_int_equal(prediction_matrix_derivatives(&differences, host_values, 0), 0);
        size_t count = (size_t)host_n * host_n; /* the band holds them all, and zeros */
        assert_true(relative_difference(count, differences.dk.band, exact.dk.band) < 1e-10);
    }
}

POOL_TEST(a_callback_that_fails_or_gives_nan_is_named)
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

POOL_TEST(requests_out_of_range_are_refused)
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

/* ---- models whose structure makes it hard */

/* Two copies of the same chain of three masses, springs x1 (2 - x2) and x1 x2: equal where x2 = 1. */
static int twin_matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    (void)user;
    for (int c = 0; c < 2; c++)
        for (int i = 0; i < 3; i++) {
            double spring = c ? x[0] * x[1] : x[0] * (2 - x[1]);
            matrix_add(mass, 3 * c + i, 3 * c + i, 1);
            matrix_add(stiffness, 3 * c + i, 3 * c + i, i ? 2 * spring : spring + 1);
            if (i < 2)
                matrix_add(stiffness, 3 * c + i, 3 * c + i + 1, -spring);
        }
    return 0;
}

static const int twin_master[5] = {0, 1, 2, 3, 5};
static const rotid_model twins = {
    .size = sizeof twins, .n = 6, .kd = 1, .nparam = 2, .nmaster = 5, .master = twin_master, .matrices = twin_matrices};

/* Half of each vector is zero: Nelson's method has to leave out a component that is not. */
POOL_TEST(vectors_with_zeros_are_differentiated)
{
    const double apart[2] = {2, 1.4}, steps[2] = {1e-3, 1e-3};
    check_derivatives(*state, &twins, ROTID_REDUCTION_NONE, ROTID_NELSON, 0, 6, apart, steps, 1e-7);
    check_derivatives(*state, &twins, ROTID_GUYAN, ROTID_NELSON, 0, 5, apart, steps, 1e-7);
    check_derivatives(*state, &twins, ROTID_GUYAN, ROTID_MODAL, 0, 5, apart, steps, 1e-7);
}

/* A string of 59 springs x1 with a coil between its thirds; the masses of its right half grow with x2. */
static int string_matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    (void)user;
    for (int i = 0; i < 59; i++) {
        matrix_add(stiffness, i, i, 2 * x[0] + (i == 19 || i == 39 ? 0.3 : 0));
        if (i < 58)
            matrix_add(stiffness, i, i + 1, -x[0]);
        matrix_add(mass, i, i, i > 30 ? 0.9 + 0.1 * x[1] : 1);
    }
    matrix_add(stiffness, 19, 39, -0.3);
    return 0;
}

/* Mode 3 has its nodes at the far degrees of freedom, so its frequency is that of the thirds with those clamped, and the inner
 * part of the bordered factors is singular there. The same string as a dense matrix has no border. */
POOL_TEST(a_far_block_at_the_nodes_of_a_mode_costs_no_digits)
{
    static const int far[2] = {19, 39}, master[3] = {5, 20, 50};
    const double x[2] = {1, 1};
    const rotid_model bordered = {.size = sizeof bordered,
                                  .n = 59,
                                  .kd = 1,
                                  .nfar = 2,
                                  .far = far,
                                  .nparam = 2,
                                  .nmaster = 3,
                                  .master = master,
                                  .matrices = string_matrices};
    const rotid_model full = {
        .size = sizeof full, .n = 59, .kd = 58, .nparam = 2, .nmaster = 3, .master = master, .matrices = string_matrices};
    const int wanted[7] = {1, 1, 1, 1, 1, 1, 0};
    struct prediction a, b;
    assert_status(prediction_new(*state, &bordered, ROTID_REDUCTION_NONE, ROTID_NELSON, 6, 1, &a), ROTID_OK);
    assert_status(prediction_new(*state, &full, ROTID_REDUCTION_NONE, ROTID_NELSON, 6, 1, &b), ROTID_OK);
    assert_status(prediction_compute(&a, x), ROTID_OK);
    assert_status(prediction_compute(&b, x), ROTID_OK);
    assert_close(a.phi[19 + 2 * 59], 0, 0, 1e-10);
    assert_close(a.phi[39 + 2 * 59], 0, 0, 1e-10);
    assert_status(prediction_differentiate(&a, x, wanted, 1), ROTID_OK);
    assert_status(prediction_differentiate(&b, x, wanted, 1), ROTID_OK);
    for (int k = 0; k < 6; k++) { /* with respect to x2: x1 scales K but for the coil, and some shapes do not feel it */
        double sign = 0, difference = 0, size = 0;
        for (int i = 0; i < 59; i++)
            sign += a.phi[i + k * 59] * b.phi[i + k * 59];
        for (int i = 0; i < 59; i++) {
            double of_a = a.dphi[i + prediction_place(&a, k, 1)],
                   of_b = b.dphi[i + prediction_place(&b, k, 1)] * (sign < 0 ? -1 : 1);
            difference = fmax(difference, fabs(of_a - of_b));
            size = fmax(size, fabs(of_b));
        }
        assert_close(difference, 0, 0, 1e-8 * size);
    }
}
