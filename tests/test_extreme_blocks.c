/* Building blocks on valid but extreme input: sizes of 1e-300 to 1e300, columns that depend on each other, fewer residuals than
 * unknowns, callbacks that give NaN or infinity or fail at any call. Every array has exactly its stated length, so the address
 * sanitizer sees what is read or written beyond. */
#include <limits.h>

#include "dense.h"
#include "host_beam.h"
#include "support.h"

enum fault { NONE, NOT_A_NUMBER, INFINITE, HUGE_ONE, FAILS, FAULTS };

static double *exact(int count) /* of its own, for the red zones around it */
{
    double *a = calloc((size_t)count, sizeof *a);
    assert_non_null(a);
    return a;
}

/* ---- least squares */

enum rank { FULL, COPIES, ZERO_COLUMN, RANKS };

struct problem {
    int m, n, calls, at, for_ever;
    enum fault fault;
    double size, unit; /* r = size (A (unit x) - b + sin(unit x_0) / 10) */
    double *a, *b;
};

static int strikes(int call, int at, int for_ever)
{
    return at && (for_ever ? call >= at : call == at);
}

/* Returns 1 where the callback is to fail. */
static int spoil(enum fault fault, double most, double *value)
{
    const double put[] = {[NOT_A_NUMBER] = NAN, [INFINITE] = -INFINITY, [HUGE_ONE] = most};
    if (fault != FAILS)
        *value = put[fault];
    return fault == FAILS;
}

static int residual(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    struct problem *p = user;
    double shift = 0.1 * sin(p->unit * x[0]), slope = 0.1 * cos(p->unit * x[0]);
    for (int i = 0; i < m && r; i++) {
        double sum = shift - p->b[i];
        for (int j = 0; j < n; j++)
            sum += p->a[i + j * m] * (p->unit * x[j]);
        r[i] = p->size * sum;
    }
    for (int j = 0; j < n && jacobian; j++)
        for (int i = 0; i < m; i++)
            jacobian[i + j * m] = p->size * ((p->a[i + j * m] + (j ? 0 : slope)) * p->unit);
    int spoilt = strikes(++p->calls, p->at, p->for_ever);
    return spoilt ? spoil(p->fault, p->size < 1e160 ? 1e140 * p->size : 1e308, r ? &r[m - 1] : &jacobian[m * n - 1]) : 0;
}

static void open_problem(int m, int n, enum rank rank, double size, double unit, struct problem *p)
{
    struct random_stream stream = {(uint64_t)(m + 100 * n)};
    *p = (struct problem){.m = m, .n = n, .size = size, .unit = unit, .a = exact(m * n), .b = exact(m)};
    for (int i = 0; i < m * n; i++)
        p->a[i] = random_normal(&stream);
    for (int i = 0; i < m; i++)
        p->b[i] = random_normal(&stream);
    if (rank != FULL)
        for (int i = 0; i < m; i++)
            p->a[i + (n - 1) * m] = rank == COPIES ? p->a[i + (n > 2 ? m : 0)] : 0;
}

static double norm(int m, const double *r, double size)
{
    double sum = 0;
    for (int i = 0; i < m; i++)
        sum += r[i] / size * (r[i] / size);
    return sqrt(sum);
}

static void minimise(struct problem *p)
{
    int m = p->m, n = p->n;
    double *x = exact(n), *r = exact(m), *again = exact(m), *jacobian = exact(m * n),
           *work = exact((int)rotid_lm_workspace(m, n));
    const rotid_lm_options options = {.size = sizeof options, .max_iterations = 60};
    rotid_lm_result result;
    char failure[ROTID_FAILURE_LENGTH];
    for (int j = 0; j < n; j++)
        x[j] = 0.3 / p->unit;
    p->calls = 0;
    int status = rotid_lm(m, n, residual, p, &options, failure, x, r, jacobian, work, &result);
    assert_true(status >= 0 || status == ROTID_ERROR_CALLBACK || status == ROTID_ERROR_FINITE || status == ROTID_ERROR_RANK);
    if (status < 0) /* of the start alone, which is the first residual and the first Jacobian */
        assert_true(p->fault && p->at <= 2);
    if (status >= 0 && p->fault != HUGE_ONE) { /* that is a residual like any other */
        int at = p->at;
        p->at = 0;
        assert_int_equal(residual(p, m, n, x, again, NULL), 0);
        assert_memory_equal(again, r, (size_t)m * sizeof *r);
        for (int i = 0; i < m * n; i++)
            assert_true(isfinite(jacobian[i]));
        double *start = exact(n);
        for (int j = 0; j < n; j++)
            start[j] = 0.3 / p->unit;
        double end = norm(m, r, p->size);
        assert_int_equal(residual(p, m, n, start, again, NULL), 0);
        assert_true(end <= norm(m, again, p->size));
        if (p->fault == NONE && m <= n - 1) /* as many unknowns as there are residuals, one of them to spare */
            assert_true(end < 1e-6);
        p->at = at;
        free(start);
    }
    free(x);
    free(r);
    free(again);
    free(jacobian);
    free(work);
}

static void check(struct problem *p)
{
    int m = p->m, n = p->n;
    double *x = exact(n), *scale = exact(n), *error = exact(n), *doubt = exact(n),
           *work = exact((int)rotid_check_jacobian_workspace(m, n));
    for (int j = 0; j < n; j++)
        x[j] = scale[j] = 0.3 / p->unit;
    p->calls = 0;
    int status = rotid_check_jacobian(m, n, residual, p, x, scale, NULL, error, doubt, work);
    assert_true(status == ROTID_OK || status == ROTID_ERROR_CALLBACK || status == ROTID_ERROR_FINITE);
    for (int j = 0; j < n && !p->fault; j++)
        assert_true(error[j] <= fmax(1e-6, doubt[j]));
    free(x);
    free(scale);
    free(error);
    free(doubt);
    free(work);
}

static const double sizes[] = {1e-300, 1e-150, 1, 1e150, 1e300};

POOL_TEST(fits_of_any_size_end_where_they_say)
{
    static const int shape[][2] = {{1, 1}, {1, 5}, {3, 7}, {7, 3}, {40, 10}};
    for (size_t s = 0; s < sizeof shape / sizeof *shape; s++)
        for (int rank = 0; rank < RANKS; rank++)
            for (size_t z = 0; z < sizeof sizes / sizeof *sizes; z++) {
                struct problem p;
                open_problem(shape[s][0], shape[s][1], shape[s][1] > 1 ? (enum rank)rank : FULL, sizes[z], 1, &p);
                for (int f = 0; f < FAULTS; f++)
                    for (p.at = f ? 1 : 0, p.fault = (enum fault)f; p.at <= (f ? 14 : 0); p.at++)
                        for (p.for_ever = 0; p.for_ever < (f ? 2 : 1); p.for_ever++) {
                            minimise(&p);
                            check(&p);
                        }
                free(p.a);
                free(p.b);
            }
}

POOL_TEST(unknowns_of_any_unit_give_the_same_fit)
{
    static const double units[] = {1e-200, 1e-100, 1e100, 1e200};
    for (size_t u = 0; u < sizeof units / sizeof *units; u++) {
        struct problem p;
        open_problem(7, 3, FULL, 1, units[u], &p);
        minimise(&p);
        free(p.a);
        free(p.b);
    }
}

/* ---- condensation */

/* K of a chain of n masses of which the first is held, scaled. */
static void condense(int n, int kd, int nmaster, int kind, double stiff, double heavy)
{
    double *kb = exact(n * (kd + 1)), *mb = exact(n * (kd + 1)), *kc = exact(nmaster * nmaster), *mc = exact(nmaster * nmaster),
           *t = exact(n * nmaster);
    int *master = calloc((size_t)nmaster, sizeof *master);
    assert_non_null(master);
    const rotid_matrix k = {.n = n, .kd = kd, .band = kb}, m = {.n = n, .kd = kd, .band = mb};
    for (int i = 0; i < n; i++) {
        kb[i * (kd + 1)] = (i < n - 1 ? 2 : 1) * stiff;
        mb[i * (kd + 1)] = heavy;
        if (kd && i < n - 1)
            kb[1 + i * (kd + 1)] = -stiff;
    }
    for (int c = 0; c < nmaster; c++)
        master[c] = (c + 1) * n / nmaster - 1;
    int status = rotid_condense(&k, &m, nmaster, master, kind, NULL, NULL, kc, mc, t);
    assert_true(status == ROTID_OK || status == ROTID_ERROR_FINITE || status == ROTID_ERROR_MASS || status == ROTID_ERROR_SLAVE);
    if (kind == ROTID_GUYAN && stiff > 1e-290 && stiff < 1e290 && heavy > 1e-290 && heavy < 1e290)
        assert_int_equal(status, ROTID_OK);
    for (int c = 0; c < nmaster && status == ROTID_OK && kind == ROTID_GUYAN && kd; c++) { /* springs in series */
        int below = c ? master[c] - master[c - 1] : master[0] + 1, above = c < nmaster - 1 ? master[c + 1] - master[c] : 0;
        assert_close(kc[c + c * nmaster], stiff * (1.0 / below + (above ? 1.0 / above : 0)), 1e-9, 0);
    }
    free(kb);
    free(mb);
    free(kc);
    free(mc);
    free(t);
    free(master);
}

POOL_TEST(condensations_of_any_size_are_springs_in_series)
{
    static const int size[][3] = {{1, 0, 1}, {5, 1, 1}, {5, 4, 5}, {50, 12, 7}, {50, 49, 3}, {120, 13, 40}};
    for (size_t s = 0; s < sizeof size / sizeof *size; s++)
        for (size_t a = 0; a < sizeof sizes / sizeof *sizes; a++)
            for (size_t b = 0; b < sizeof sizes / sizeof *sizes; b++)
                for (int kind = ROTID_GUYAN; kind <= ROTID_IRS; kind++)
                    condense(size[s][0], size[s][1], size[s][2], kind, sizes[a], sizes[b]);
}

POOL_TEST(half_bands_beyond_the_matrix_are_refused)
{
    static const int wrong[][2] = {{3, INT_MAX}, {3, 1 << 30}, {3, -1}, {INT_MAX, INT_MAX}, {-1, 0}, {0, 0}};
    double *one = exact(1), kc[9], mc[9];
    const int master[] = {0, 1};
    for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++) {
        const rotid_matrix a = {.n = wrong[w][0], .kd = wrong[w][1], .band = one};
        assert_true(rotid_condense(&a, &a, 2, master, ROTID_GUYAN, NULL, NULL, kc, mc, NULL) < 0);
        assert_true(rotid_eigenpairs(&a, &a, 1, NULL, NULL, kc, mc) < 0);
    }
    free(one);
}

/* ---- fits of a model */

struct hostile {
    struct beam_host host;
    int calls, at, for_ever, where;
    enum fault fault;
    double stiff, heavy;
};

static int hostile_matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    struct hostile *h = user;
    int failed = beam_matrices(&h->host, x, k, m);
    for (int i = 0; i < k->n * (k->kd + 1); i++) {
        k->band[i] *= h->stiff;
        m->band[i] *= h->heavy;
    }
    if (!failed && strikes(++h->calls, h->at, h->for_ever))
        failed = spoil(h->fault, 1e300, h->where % 2 ? &m->band[0] : &k->band[(k->n - 1) * (k->kd + 1)]);
    return failed;
}

static int hostile_derivatives(void *user, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm)
{
    struct hostile *h = user;
    int failed = beam_derivatives(&h->host, x, p, dk, dm);
    for (int i = 0; i < dk->n * (dk->kd + 1); i++) {
        dk->band[i] *= h->stiff;
        dm->band[i] *= h->heavy;
    }
    if (!failed && strikes(++h->calls, h->at, h->for_ever))
        failed = spoil(h->fault, 1e300, &dk->band[0]);
    return failed;
}

POOL_TEST(models_that_fail_anyhow_end_the_fit)
{
    static const int reduction[] = {ROTID_REDUCTION_NONE, ROTID_GUYAN, ROTID_IRS};
    static const double scale[][2] = {{1, 1}, {1e-200, 1e-200}, {1e200, 1e200}, {1e-300, 1}, {1, 1e300}, {1e290, 1e-290}};
    for (size_t s = 0; s < sizeof scale / sizeof *scale; s++)
        for (size_t d = 0; d < sizeof reduction / sizeof *reduction; d++)
            for (int f = 0; f < FAULTS; f++)
                for (int at = f ? 1 : 0; at <= (f && !s ? 18 : f ? 2 : 0); at++)
                    for (int way = 0; way < (f ? 8 : 1); way++) {
                        struct hostile h = {.fault = (enum fault)f,
                                            .at = at,
                                            .for_ever = way & 1,
                                            .where = way >> 1,
                                            .stiff = scale[s][0],
                                            .heavy = scale[s][1]};
                        struct beam_data data;
                        struct pool pool;
                        pool_open(&pool, NULL);
                        beam_host_open(&h.host, 8, 0, 1, 1);
                        beam_host_measure(&pool, &h.host, reduction[d], &data);
                        h.host.model.matrices = hostile_matrices;
                        h.host.model.derivatives = way & 4 ? NULL : hostile_derivatives;
                        h.host.model.user = &h;
                        const rotid_fit_options options = {
                            .size = sizeof options, .reduction = reduction[d], .max_iterations = 20};
                        char failure[ROTID_FAILURE_LENGTH] = "";
                        rotid_fit_result *result;
                        int status = rotid_fit(&h.host.model, beam_parameters, &data.measured, &options, NULL, failure, &result);
                        assert_true((status < 0) == !result);
                        assert_true(status >= 0 || *failure);
                        if (!f && !s)
                            assert_true(result->converged);
                        for (int p = 0; result && p < result->n; p++)
                            assert_true(isfinite(result->x[p]));
                        rotid_fit_free(result);
                        pool_close(&pool);
                    }
    (void)state;
}
