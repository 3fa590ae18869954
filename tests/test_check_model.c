/* rotid_check_model: the derivatives of a right model pass, wrong ones are found at their parameter and matrix, and a model that
 * the fit would refuse is refused. */
#include "dense.h"
#include "host_beam.h"
#include "linalg/linalg.h"
#include "support.h"

enum { N = 3 };

/* A beam with a tie, and what is wrong with it. */
struct wrong {
    struct beam_host host;
    double factor;          /* of the derivative of parameter p */
    int p, entry, of_block; /* entry: of the band (or the block) that it concerns, -1: all */
    double mass, claimed;   /* dM/dx_0 over M: in truth, and as the host says */
    double moved;           /* from the block of dK to its band, where the band reaches */
    double lowest, highest; /* of the x that were asked for, over the parameters */
    double poison;          /* put onto the mass of the first degree of freedom */
    double skew;            /* added to one triangle of the block of dK only */
    double unit;            /* of the rotations */
    int fail;
};

static void scale_mass(rotid_matrix *a, double factor)
{
    for (int i = 0; i < a->n * (a->kd + 1); i++)
        a->band[i] *= factor;
}

static void change_units(rotid_matrix *a, double unit)
{
    for (int j = 0; j < a->n; j++)
        for (int i = j; i < a->n && i <= j + a->kd; i++)
            a->band[i - j + j * (a->kd + 1)] *= (i % 2 ? unit : 1) * (j % 2 ? unit : 1);
}

static int matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    struct wrong *wrong = user;
    for (int p = 0; p < N; p++) {
        wrong->lowest = fmin(wrong->lowest, x[p]);
        wrong->highest = fmax(wrong->highest, x[p]);
    }
    int status = beam_matrices(&wrong->host, x, k, m);
    scale_mass(m, 1 + wrong->mass * x[0] * x[0]);
    m->band[0] += wrong->poison;
    change_units(k, wrong->unit);
    change_units(m, wrong->unit);
    return status || wrong->fail;
}

static int derivatives(void *user, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm)
{
    struct wrong *wrong = user;
    double none[N] = {0};
    int status = beam_derivatives(&wrong->host, x, p, dk, dm);
    if (p == 0 && wrong->claimed != 0) {
        rotid_matrix zero = *dk;
        zero.band = test_calloc((size_t)(dk->n * (dk->kd + 1)), sizeof *zero.band);
        zero.block = test_calloc((size_t)(dk->nfar * dk->nfar + 1), sizeof *zero.block);
        status = status || beam_matrices(&wrong->host, none, &zero, dm);
        test_free(zero.band);
        test_free(zero.block);
        scale_mass(dm, 2 * wrong->claimed * x[0]);
    }
    change_units(dk, wrong->unit);
    change_units(dm, wrong->unit);
    int entries = wrong->of_block ? dk->nfar * dk->nfar : dk->n * (dk->kd + 1);
    double *a = wrong->of_block ? dk->block : dk->band;
    for (int i = 0; p == wrong->p && i < entries; i++)
        if (wrong->entry < 0 || wrong->entry == i)
            a[i] *= wrong->factor;
    if (dk->nfar > 1)
        dk->block[1] += wrong->skew;
    for (int f = 0; f < dk->nfar && wrong->moved != 0; f++) { /* a diagonal entry has a place in both */
        dk->block[f + f * dk->nfar] -= wrong->moved;
        dk->band[dk->far[f] * (dk->kd + 1)] += wrong->moved;
    }
    return status;
}

static double error[2 * N], doubt[2 * N];

static int check(struct wrong *wrong, const double *x)
{
    wrong->lowest = INFINITY;
    wrong->highest = -INFINITY;
    return rotid_check_model(&wrong->host.model, beam_parameters, x, NULL, NULL, error, doubt);
}

static int is_wrong(int k)
{
    return !(error[k] <= 1e-6 || error[k] <= doubt[k]);
}

/* kd 0: a band with a far block; 41: dense */
static void open_wrong(int kd, struct wrong *wrong)
{
    *wrong = (struct wrong){.factor = 1, .entry = -1, .unit = 1};
    beam_host_open(&wrong->host, 20, kd, 1, 1);
    wrong->host.model.matrices = matrices;
    wrong->host.model.derivatives = derivatives;
    wrong->host.model.user = wrong;
}

POOL_TEST(right_derivatives_pass)
{
    static const double near_a_bound[N] = {0.0101, 9.99, 0.4};
    for (int kd = 0; kd < 42; kd += 41)
        for (int own = 0; own < 2; own++)
            for (int at = 0; at < 2; at++) {
                struct wrong wrong;
                open_wrong(kd, &wrong);
                wrong.mass = wrong.claimed = 0.1;
                if (!own)
                    wrong.host.model.derivatives = NULL; /* then those that the fit would take are looked at */
                assert_status(check(&wrong, at ? near_a_bound : NULL), ROTID_OK);
                for (int k = 0; k < 2 * N; k++) {
                    assert_true(!is_wrong(k));
                    assert_true(error[k] <= (own ? 1e-8 : 1e-7) && doubt[k] <= 1e-8);
                }
                assert_true(error[N + 1] == 0 && doubt[N + 1] == 0); /* M does not depend on the others */
                if (own) {
                    assert_true(wrong.lowest > beam_parameters[0].lower && wrong.highest < beam_parameters[0].upper);
                }
            }
}

/* Of all entries; of one on the diagonal, of bending and of rotation, and one beside it; of the block of the tie. */
POOL_TEST(a_derivative_that_is_a_fifth_too_large_is_found)
{
    static const struct {
        int p, of_block, entry;
        double least; /* that it is found to be wrong by */
    } cases[] = {{0, 0, -1, 0.16}, {1, 0, -1, 0.16}, {2, 1, -1, 0.1}, {0, 0, 8, 1e-3}, {0, 0, 12, 1e-3}, {0, 0, 5, 1e-3}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct wrong wrong;
        open_wrong(0, &wrong);
        wrong.factor = 1.2;
        wrong.p = cases[k].p;
        wrong.entry = cases[k].entry;
        wrong.of_block = cases[k].of_block;
        assert_status(check(&wrong, NULL), ROTID_OK);
        for (int q = 0; q < 2 * N; q++)
            assert_int_equal(is_wrong(q), q == cases[k].p);
        assert_true(error[cases[k].p] >= cases[k].least && error[cases[k].p] < 0.17);
        if (cases[k].entry < 0 && !cases[k].of_block) /* of the tie the diagonal stands in the band */
            assert_close(error[cases[k].p], 0.2 / 1.2, 1e-6, 0);
    }
}

/* dK u and dM u, too large by a fifth for parameter p */
static int products(void *user, const double *x, int p, int count, const double *u, double *dk_u, double *dm_u)
{
    struct wrong *wrong = user;
    const rotid_model *model = &wrong->host.model;
    rotid_matrix d[2];
    double factor = wrong->factor;
    wrong->factor = 1;
    for (int i = 0; i < 2; i++)
        assert_status(matrix_new(&test_pool, model->n, model->kd, model->nfar, model->far, &d[i]), ROTID_OK);
    int status = derivatives(user, x, p, &d[0], &d[1]);
    wrong->factor = factor;
    matrix_multiply(&d[0], count, u, dk_u);
    matrix_multiply(&d[1], count, u, dm_u);
    for (int i = 0; i < model->n * count; i++)
        dk_u[i] *= p == wrong->p ? factor : 1;
    return status;
}

POOL_TEST(a_product_that_is_a_fifth_too_large_is_found)
{
    for (int p = 0; p < N; p++) {
        struct wrong wrong;
        open_wrong(0, &wrong);
        wrong.host.model.derivative_products = products;
        wrong.mass = wrong.claimed = 0.1;
        assert_status(check(&wrong, NULL), ROTID_OK);
        for (int q = 0; q < 2 * N; q++)
            assert_true(!is_wrong(q));
        wrong.p = p;
        wrong.entry = 0; /* of the matrix, hardly any */
        wrong.of_block = 1;
        wrong.factor = 1.2;
        wrong.host.model.derivatives = NULL; /* differences, which are right */
        assert_status(check(&wrong, NULL), ROTID_OK);
        for (int q = 0; q < 2 * N; q++)
            assert_int_equal(is_wrong(q), q == p);
        assert_close(error[p], 0.2 / 1.2, 1e-6, 0);
    }
}

POOL_TEST(a_wrong_derivative_of_the_mass_is_found)
{
    static const double masses[][3] = {/* true, claimed, error */ {0.1, 0, 1}, {0, 0.1, 1}, {0.1, -0.1, 2}, {0.1, 0.2, 0.5}};
    for (size_t k = 0; k < sizeof masses / sizeof *masses; k++) {
        struct wrong wrong;
        open_wrong(41, &wrong);
        wrong.mass = masses[k][0];
        wrong.claimed = masses[k][1];
        assert_status(check(&wrong, NULL), ROTID_OK);
        for (int q = 0; q < 2 * N; q++)
            assert_int_equal(is_wrong(q), q == N);
        assert_close(error[N], masses[k][2], 1e-6, 0);
    }
}

POOL_TEST(storage_tells_no_difference_but_a_missing_triangle_does)
{
    struct wrong wrong;
    open_wrong(0, &wrong);
    wrong.moved = 1e5;
    assert_status(check(&wrong, NULL), ROTID_OK);
    for (int q = 0; q < 2 * N; q++)
        assert_true(!is_wrong(q));
    wrong.skew = 1e9; /* no symmetric block: refused, as by the fit */
    assert_status(check(&wrong, NULL), ROTID_ERROR_ARGUMENT);
}

POOL_TEST(units_make_no_difference)
{
    double first[2 * N] = {0};
    for (int k = 0; k < 2; k++) {
        struct wrong wrong;
        open_wrong(0, &wrong);
        wrong.factor = 1.2;
        wrong.entry = 8;
        wrong.unit = k ? 1024 : 1;
        assert_status(check(&wrong, NULL), ROTID_OK);
        if (!k)
            memcpy(first, error, sizeof first);
    }
    for (int q = 0; q < 2 * N; q++)
        assert_close(error[q], first[q], 1e-9, 1e-12);
}

/* Where a fit ended pressed against a bound there is no room for differences, and nothing is said of that parameter. */
POOL_TEST(a_parameter_at_its_bound_is_not_judged)
{
    struct wrong wrong;
    const double x[N] = {1, 10 - 1e-14, 0.4};
    open_wrong(0, &wrong);
    wrong.mass = wrong.claimed = 0.1;
    assert_status(check(&wrong, x), ROTID_OK);
    for (int k = 0; k < 2 * N; k++) {
        assert_int_equal(isnan(error[k]) && isnan(doubt[k]), k % N == 1);
        assert_true(k % N == 1 || !is_wrong(k));
    }
}

POOL_TEST(what_the_fit_refuses_is_refused)
{
    struct wrong wrong;
    double x[N] = {1, 1, 1};
    open_wrong(0, &wrong);
    wrong.poison = -1e3;
    assert_status(check(&wrong, NULL), ROTID_ERROR_MASS);
    wrong.poison = NAN;
    assert_status(check(&wrong, NULL), ROTID_ERROR_FINITE);
    wrong.poison = 0;
    wrong.fail = 1;
    assert_status(check(&wrong, NULL), ROTID_ERROR_CALLBACK);
    wrong.fail = 0;
    wrong.factor = NAN;
    assert_status(check(&wrong, NULL), ROTID_ERROR_FINITE);
    wrong.factor = 1;
    x[1] = 10; /* at its bound */
    assert_status(check(&wrong, x), ROTID_ERROR_ARGUMENT);
    x[1] = NAN;
    assert_status(check(&wrong, x), ROTID_ERROR_ARGUMENT);
    x[1] = 1;
    const rotid_model *model = &wrong.host.model;
    assert_status(rotid_check_model(NULL, beam_parameters, x, NULL, NULL, error, doubt), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_check_model(model, NULL, x, NULL, NULL, error, doubt), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_check_model(model, beam_parameters, x, NULL, NULL, NULL, doubt), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_check_model(model, beam_parameters, x, NULL, NULL, error, NULL), ROTID_ERROR_ARGUMENT);
    wrong.host.model.nparam = 0;
    assert_status(check(&wrong, x), ROTID_ERROR_ARGUMENT);
    wrong.host.model.nparam = N;
    const int n = model->n;
    struct failing_allocator none;
    failing_allocator_open(&none, 1);
    const rotid_environment environment = {.size = sizeof environment, .allocator = &none.allocator};
    wrong.host.model.n = 50000; /* 2.5e9 entries, which no int counts: refused before any of the 20 GB is asked for */
    wrong.host.model.kd = 49999;
    assert_status(rotid_check_model(model, beam_parameters, x, &environment, NULL, error, doubt), ROTID_ERROR_ARGUMENT);
    wrong.host.model.n = n;
    wrong.host.model.kd = 42;
    assert_status(check(&wrong, x), ROTID_ERROR_ARGUMENT);
}

POOL_TEST(memory_that_fails_is_said_and_given_back)
{
    struct wrong wrong;
    open_wrong(0, &wrong);
    int status = ROTID_ERROR_MEMORY;
    for (long n = 1; status == ROTID_ERROR_MEMORY; n++) {
        struct failing_allocator failing;
        failing_allocator_open(&failing, n);
        rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
        status = rotid_check_model(&wrong.host.model, beam_parameters, NULL, &environment, NULL, error, doubt);
        assert_int_equal(failing.in_use, 0);
    }
    assert_status(status, ROTID_OK);
}

/* What it is for: the fit converges all the same, and its interval is too narrow by as much. */
POOL_TEST(a_fit_does_not_notice_and_is_too_sure)
{
    struct wrong wrong;
    struct beam_data data;
    rotid_fit_options options = {.size = sizeof options, .functional = ROTID_LIKELIHOOD};
    double std[2];
    open_wrong(0, &wrong);
    beam_host_measure(*state, &wrong.host, ROTID_REDUCTION_NONE, &data);
    for (int k = 0; k < 2; k++) {
        rotid_fit_result *result;
        open_wrong(0, &wrong);
        wrong.p = 1;
        wrong.factor = k ? 1.2 : 1;
        assert_status(rotid_fit(&wrong.host.model, beam_parameters, &data.measured, &options, NULL, NULL, &result), ROTID_OK);
        assert_true(result->converged);
        std[k] = result->std[1];
        rotid_fit_free(result);
    }
    assert_close(std[1], std[0] / 1.2, 0.01, 0);
    assert_status(check(&wrong, NULL), ROTID_OK);
    assert_true(is_wrong(1));
}
