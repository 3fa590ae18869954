/* The contract of rotid_lm: what it returns, counts, refuses and leaves behind. Its minima are in test_lm_problems.c. */
#include "support.h"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#define M 12

static double work[2000], jacobian[200];

/* A residual that counts, remembers, and misbehaves on demand. */
struct watch {
    rotid_residual residual;
    int residuals, jacobians, refused, misplaced; /* misplaced: Jacobians not asked for at the last residual's point */
    int fail_residual, fail_jacobian;             /* the call that fails, counted from 1; 0 never */
    double last[4];
};

static int watched(void *user, int m, int n, const double *x, double *r, double *j)
{
    struct watch *watch = user;
    if (r) {
        memcpy(watch->last, x, (size_t)n * sizeof *x);
        if (++watch->residuals == watch->fail_residual)
            return 7;
    } else {
        watch->misplaced += memcmp(watch->last, x, (size_t)n * sizeof *x) != 0;
        if (++watch->jacobians == watch->fail_jacobian)
            return 7;
    }
    int status = watch->residual(NULL, m, n, x, r, j);
    watch->refused += status != 0;
    return status;
}

/* x1 exp(-x2 t) against 2 exp(-0.7 t) and a wave that no x can follow, so that the residual stays large */
static int decay(void *user, int m, int n, const double *x, double *r, double *j)
{
    (void)user, (void)n;
    for (int i = 0; i < m; i++) {
        double t = 0.25 * i, e = exp(-x[1] * t);
        if (r) {
            r[i] = x[0] * e - 2 * exp(-0.7 * t) + 0.1 * sin(7.0 * i);
        } else {
            j[i] = e;
            j[i + m] = -t * x[0] * e;
        }
    }
    return 0;
}

/* ln x - ln 0.01: the first step from 10 leads far below zero, where there is no logarithm */
static int logarithm(void *user, int m, int n, const double *x, double *r, double *j)
{
    (void)m, (void)n;
    if (j) {
        j[0] = 1 / x[0];
        return 0;
    }
    r[0] = x[0] > 0 ? log(x[0]) - log(0.01) : NAN;
    return user ? 0 : x[0] <= 0; /* with a user, only the NaN tells */
}

static int row(void *user, int m, int n, const double *x, double *r, double *j)
{
    const double *a = user; /* [m * n] and the right-hand side [m] */
    for (int i = 0; r && i < m; i++) {
        r[i] = -a[m * n + i];
        for (int k = 0; k < n; k++)
            r[i] += a[i + k * m] * x[k];
    }
    if (j)
        memcpy(j, a, (size_t)(m * n) * sizeof *a);
    return 0;
}

UNIT_TEST(test_linear_problem_satisfies_the_normal_equations)
{
    double a[15 + 5] = {1, 2, 0, 1, -1, 3, 0, 1, 1, 2, -1, 1, 4, 0, 1, 2, -3, 1, 5, 0.5}, x[3] = {10, -20, 30}, r[5];
    rotid_lm_result result;
    assert_true(rotid_lm(5, 3, row, a, NULL, NULL, x, r, jacobian, work, &result) > 0);
    for (int k = 0; k < 3; k++) {
        double sum = 0;
        for (int i = 0; i < 5; i++)
            sum += a[i + 5 * k] * r[i];
        assert_close(sum, 0, 0, 1e-7); /* of |r| about 3 and columns of 4 */
    }
    assert_true(result.iterations <= 10);
}

/* Two equations, three unknowns, from zero: of all solutions the one of least |D x|, D the norms of the columns,
 * x = D^-2 A' (A D^-2 A')^-1 b. */
UNIT_TEST(test_fewer_residuals_than_parameters_give_the_step_of_least_norm)
{
    double a[8] = {1, 0, 2, 1, -1, 4, 3, 5}, x[3] = {0}, r[2], w[3], g[4] = {0};
    rotid_lm_result result;
    assert_true(rotid_lm(2, 3, row, a, NULL, NULL, x, r, jacobian, work, &result) > 0);
    for (int k = 0; k < 3; k++) {
        w[k] = 1 / (a[2 * k] * a[2 * k] + a[2 * k + 1] * a[2 * k + 1]);
        for (int i = 0; i < 4; i++)
            g[i] += w[k] * a[2 * k + i % 2] * a[2 * k + i / 2];
    }
    double det = g[0] * g[3] - g[1] * g[2], u = (g[3] * a[6] - g[1] * a[7]) / det, v = (g[0] * a[7] - g[2] * a[6]) / det;
    for (int k = 0; k < 3; k++)
        assert_close(x[k], w[k] * (a[2 * k] * u + a[2 * k + 1] * v), 1e-7, 1e-7);
    assert_close(result.objective, 0, 0, 1e-18);
}

UNIT_TEST(test_parameter_without_influence_stays_where_it_is)
{
    double a[12] = {1, 2, 3, 0, 0, 0, 1, -1, 1, 3, 1, 4}, x[3] = {1, 0.125, 1}, r[3];
    rotid_lm_result result;
    assert_true(rotid_lm(3, 3, row, a, NULL, NULL, x, r, jacobian, work, &result) > 0);
    assert_true(x[1] == 0.125);
    assert_true(result.cosine < 1e-9);
}

/* x1 and x2 enter as their sum: from equal starts they stay equal, without a drift along what is not determined. */
UNIT_TEST(test_equal_columns_share_the_step)
{
    double a[12] = {1, 2, 3, 1, 2, 3, 1, -1, 1, 3, 1, 4}, x[3] = {5, 5, 5}, r[3];
    rotid_lm_result result;
    assert_true(rotid_lm(3, 3, row, a, NULL, NULL, x, r, jacobian, work, &result) > 0);
    assert_close(x[0], x[1], 1e-3, 0);
    /* least squares of [1 1; 2 -1; 3 1] (s, x3) = (3, 1, 4) by Cramer's rule: [14 2; 2 3] (s, x3) = (17, 6) */
    assert_close(x[0] + x[1], 39.0 / 38, 1e-9, 0);
    assert_close(x[2], 50.0 / 38, 1e-9, 0);
}

UNIT_TEST(test_refused_points_are_stepped_back_from)
{
    struct watch watch = {.residual = logarithm};
    double x = 10, r;
    rotid_lm_result result;
    assert_true(rotid_lm(1, 1, watched, &watch, NULL, NULL, &x, &r, jacobian, work, &result) > 0);
    assert_close(x, 0.01, 1e-9, 0);
    assert_true(watch.refused > 0);
    int nan_tells = 1;
    x = 10;
    assert_true(rotid_lm(1, 1, logarithm, &nan_tells, NULL, NULL, &x, &r, jacobian, work, &result) > 0);
    assert_close(x, 0.01, 1e-9, 0);
}

static int given(void *user, int m, int n, const double *x, double *r, double *j)
{
    const double *value = user; /* residual, Jacobian */
    (void)m, (void)n, (void)x;
    *(r ? r : j) = value[r ? 0 : 1];
    return 0;
}

/* 1e10 + 1e-300 x: the step of Gauss and Newton has no double */
static int far_away(void *user, int m, int n, const double *x, double *r, double *j)
{
    int *beyond = user;
    (void)m, (void)n;
    *beyond += !isfinite(x[0]);
    *(r ? r : j) = r ? 1e10 + 1e-300 * x[0] : 1e-300;
    return 0;
}

UNIT_TEST(test_no_point_beyond_the_doubles_is_asked_for)
{
    int beyond = 0;
    double x = 0, r;
    rotid_lm_result result;
    (void)rotid_lm(1, 1, far_away, &beyond, NULL, NULL, &x, &r, jacobian, work, &result);
    assert_int_equal(beyond, 0);
    assert_true(isfinite(x) && r == 1e10 + 1e-300 * x && result.evaluations > 1);
}

UNIT_TEST(test_start_without_a_finite_residual_is_an_error)
{
    static const double values[][2] = {{NAN, 1}, {INFINITY, 1}, {1, NAN}, {1, INFINITY}};
    for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
        double value[2] = {values[k][0], values[k][1]}, x = 1, r;
        rotid_lm_result result;
        assert_status(rotid_lm(1, 1, given, value, NULL, NULL, &x, &r, jacobian, work, &result), ROTID_ERROR_FINITE);
        assert_true(x == 1);
    }
}

UNIT_TEST(test_callback_that_fails_at_the_start_ends_the_call)
{
    for (int which = 0; which < 2; which++) {
        struct watch watch = {.residual = decay, .fail_residual = !which, .fail_jacobian = which};
        double x[2] = {1, 0.3}, r[M];
        rotid_lm_result result;
        assert_status(rotid_lm(M, 2, watched, &watch, NULL, NULL, x, r, jacobian, work, &result), ROTID_ERROR_CALLBACK);
        assert_int_equal(result.status, ROTID_ERROR_CALLBACK);
        assert_true(x[0] == 1 && x[1] == 0.3);
    }
}

/* 1 + max(x - 1, 0): nothing to go by at 0; from 3 the first step lands where the gradient has vanished, which is a minimum */
static int ramp(void *user, int m, int n, const double *x, double *r, double *j)
{
    (void)user, (void)m, (void)n;
    *(r ? r : j) = r ? 1 + fmax(x[0] - 1, 0) : x[0] > 1;
    return 0;
}

UNIT_TEST(test_jacobian_without_a_column_is_an_error_at_the_start_and_a_minimum_later)
{
    double x = 0, r;
    rotid_lm_result result;
    assert_status(rotid_lm(1, 1, ramp, NULL, NULL, NULL, &x, &r, jacobian, work, &result), ROTID_ERROR_RANK);
    x = 3;
    assert_status(rotid_lm(1, 1, ramp, NULL, NULL, NULL, &x, &r, jacobian, work, &result), ROTID_STOP_GRADIENT);
    assert_true(x <= 1 && result.objective == 0.5 && result.iterations == 1);
}

UNIT_TEST(test_arguments_out_of_range_are_refused_before_anything_is_called)
{
    struct watch watch = {.residual = decay};
    double x[2] = {1, 0.3}, bad[2] = {1, NAN}, far[2] = {INFINITY, 1}, r[M];
    rotid_lm_result result;
    assert_status(rotid_lm(0, 2, watched, &watch, NULL, NULL, x, r, jacobian, work, &result), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_lm(M, 0, watched, &watch, NULL, NULL, x, r, jacobian, work, &result), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_lm(M, -1, watched, &watch, NULL, NULL, x, r, jacobian, work, &result), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_lm(M, 2, NULL, &watch, NULL, NULL, x, r, jacobian, work, &result), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_lm(M, 2, watched, &watch, NULL, NULL, NULL, r, jacobian, work, &result), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_lm(M, 2, watched, &watch, NULL, NULL, x, NULL, jacobian, work, &result), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_lm(M, 2, watched, &watch, NULL, NULL, x, r, NULL, work, &result), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_lm(M, 2, watched, &watch, NULL, NULL, x, r, jacobian, NULL, &result), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_lm(M, 2, watched, &watch, NULL, NULL, x, r, jacobian, work, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_lm(M, 2, watched, &watch, NULL, NULL, bad, r, jacobian, work, &result), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_lm(M, 2, watched, &watch, NULL, NULL, far, r, jacobian, work, &result), ROTID_ERROR_ARGUMENT);
    assert_int_equal(watch.residuals + watch.jacobians, 0);
}

struct diary {
    int calls, stop_at;
    double objective, x[2], cosine;
};

static int write_down(void *user, const rotid_lm_iteration *now)
{
    struct diary *diary = user;
    assert_int_equal(now->iteration, diary->calls);
    if (diary->calls) /* past the first point there was a step, and it may not have raised f by more than rounding */
        assert_true(now->objective <= diary->objective * (1 + 1e-12) && !isnan(now->gain_ratio));
    else
        assert_true(isnan(now->gain_ratio));
    diary->objective = now->objective;
    diary->cosine = now->cosine;
    memcpy(diary->x, now->x, sizeof diary->x);
    return ++diary->calls == diary->stop_at;
}

UNIT_TEST(test_cancelling_leaves_the_last_accepted_point)
{
    for (int k = 1; k <= 5; k++) {
        struct diary diary = {.stop_at = k};
        rotid_lm_options options = {.size = sizeof options, .trace = write_down, .trace_user = &diary};
        double x[2] = {1, 0.3}, r[M], again[M], sum = 0;
        rotid_lm_result result;
        assert_status(rotid_lm(M, 2, decay, NULL, &options, NULL, x, r, jacobian, work, &result), ROTID_STOP_CANCELLED);
        assert_int_equal(diary.calls, k);
        assert_int_equal(result.iterations, k - 1);
        assert_memory_equal(x, diary.x, sizeof x);
        (void)decay(NULL, M, 2, x, again, NULL);
        assert_memory_equal(r, again, sizeof r);
        for (int i = 0; i < M; i++)
            sum += again[i] * again[i] / 2;
        assert_close(result.objective, sum, 1e-15, 0);
    }
}

UNIT_TEST(test_trace_sees_every_accepted_point_and_the_last_one_is_the_result)
{
    struct diary diary = {0};
    rotid_lm_options options = {.size = sizeof options, .trace = write_down, .trace_user = &diary};
    double x[2] = {1, 0.3}, r[M];
    rotid_lm_result result;
    assert_true(rotid_lm(M, 2, decay, NULL, &options, NULL, x, r, jacobian, work, &result) > 0);
    assert_int_equal(diary.calls, result.iterations + 1);
    assert_memory_equal(x, diary.x, sizeof x);
    assert_true(diary.objective == result.objective && diary.cosine == result.cosine);
}

UNIT_TEST(test_iteration_limit_is_kept)
{
    rotid_lm_options options = {.size = sizeof options, .max_iterations = 3};
    double x[2] = {1, 0.3}, r[M];
    rotid_lm_result result;
    assert_status(rotid_lm(M, 2, decay, NULL, &options, NULL, x, r, jacobian, work, &result), ROTID_STOP_ITERATIONS);
    assert_int_equal(result.iterations, 3);
}

/* 1 and exp(-x): every step adds about 1 to x, and there is no minimum */
static int falls_for_ever(void *user, int m, int n, const double *x, double *r, double *j)
{
    (void)user, (void)m, (void)n;
    if (r) {
        r[0] = 1;
        r[1] = exp(-x[0]);
    } else {
        j[0] = 0;
        j[1] = -exp(-x[0]);
    }
    return 0;
}

UNIT_TEST(test_a_creep_ends_where_five_steps_gain_less_than_is_asked_for)
{
    static const double tolerance[] = {0, 1e-2, 1e-4, 1e-6};
    int iterations[4];
    for (int i = 0; i < 4; i++) {
        double x = 0, r[2], above;
        rotid_lm_result result;
        const rotid_lm_options options = {
            .size = sizeof options, .gradient_tolerance = 1e-30, .decrease_tolerance = tolerance[i]};
        int status = rotid_lm(2, 1, falls_for_ever, NULL, &options, NULL, &x, r, jacobian, work, &result);
        above = r[1] * r[1] / 2; /* the objective less its limit, of which five steps take nearly all */
        assert_int_equal(status, ROTID_STOP_OBJECTIVE);
        iterations[i] = result.iterations;
        assert_true(i == 0 || (above < 1e-3 * tolerance[i] && above > 1e-7 * tolerance[i]));
    }
    assert_true(iterations[1] < iterations[2] && iterations[2] < iterations[3] && iterations[3] < iterations[0]);
    for (int i = 1; i < 4; i++) { /* of an objective near 1/2, twice as much of it as of itself */
        double x = 0, r[2];
        rotid_lm_result result;
        const rotid_lm_options options = {
            .size = sizeof options, .gradient_tolerance = 1e-30, .decrease_least = tolerance[i] / 2};
        assert_int_equal(rotid_lm(2, 1, falls_for_ever, NULL, &options, NULL, &x, r, jacobian, work, &result),
                         ROTID_STOP_OBJECTIVE);
        assert_int_equal(result.iterations, iterations[i]);
    }
}

UNIT_TEST(test_evaluations_are_counted_as_they_are_made)
{
    struct {
        rotid_residual residual;
        int m, n;
        double x[2];
    } runs[] = {{decay, M, 2, {1, 0.3}}, {decay, M, 2, {-3, 2}}, {logarithm, 1, 1, {10, 0}}};
    for (size_t k = 0; k < sizeof runs / sizeof *runs; k++) {
        struct watch watch = {.residual = runs[k].residual};
        double r[M];
        rotid_lm_result result;
        assert_true(rotid_lm(runs[k].m, runs[k].n, watched, &watch, NULL, NULL, runs[k].x, r, jacobian, work, &result) > 0);
        assert_int_equal(result.evaluations, watch.residuals);
        assert_int_equal(result.jacobians, watch.jacobians);
        assert_int_equal(watch.misplaced, 0);
    }
}

static int uphill(void *user, int m, int n, const double *x, double *r, double *j)
{
    (void)decay(user, m, n, x, r, j);
    for (int i = 0; j && i < m * n; i++)
        j[i] = -j[i];
    return 0;
}

/* A residual computed to five digits alone, another rounding at every x. */
static int rounded_decay(void *user, int m, int n, const double *x, double *r, double *j)
{
    (void)decay(user, m, n, x, r, j);
    for (int i = 0; r && i < m; i++)
        r[i] += 1e-5 * sin(1e13 * x[0] + 3e13 * x[1] + i);
    return 0;
}

/* The minimum is where that of the exact residual is, as far as its rounding tells; a wrong Jacobian is told none the less. */
UNIT_TEST(test_minimum_of_a_rounded_residual_is_one)
{
    for (int i = 0; i < 40; i++) {
        double x[2] = {1 + 0.02 * i, 0.3}, exact[2] = {1, 0.3}, r[M];
        rotid_lm_result result;
        assert_true(rotid_status_converged(rotid_lm(M, 2, decay, NULL, NULL, NULL, exact, r, jacobian, work, &result)));
        assert_true(rotid_status_converged(rotid_lm(M, 2, rounded_decay, NULL, NULL, NULL, x, r, jacobian, work, &result)));
        assert_close(x[0], exact[0], 0, 1e-2);
        assert_close(x[1], exact[1], 0, 1e-2);
        assert_true(result.evaluations < 100);
    }
}

UNIT_TEST(test_jacobian_of_the_wrong_sign_ends_soon_and_changes_nothing)
{
    struct watch watch = {.residual = uphill};
    double x[2] = {1, 0.3}, r[M];
    rotid_lm_result result;
    assert_status(rotid_lm(M, 2, watched, &watch, NULL, NULL, x, r, jacobian, work, &result), ROTID_STOP_STALLED);
    assert_true(x[0] == 1 && x[1] == 0.3 && watch.residuals < 30);
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)

static size_t in_use_inside;

static int weighed(void *user, int m, int n, const double *x, double *r, double *j)
{
    in_use_inside = mallinfo2().uordblks;
    return decay(user, m, n, x, r, j);
}

/* glibc counts a freed small block as in use while it is cached, so that even what is given back at once shows. */
UNIT_TEST(test_iteration_allocates_nothing)
{
    double x[2] = {1, 0.3}, r[M];
    rotid_lm_result result;
    int status =
        rotid_lm(M, 2, weighed, NULL, NULL, NULL, x, r, jacobian, work, &result); /* what a BLAS such as BLIS takes once */
    x[0] = 1;
    x[1] = 0.3;
    size_t before = mallinfo2().uordblks;
    status = rotid_lm(M, 2, weighed, NULL, NULL, NULL, x, r, jacobian, work, &result);
    size_t after = mallinfo2().uordblks;
    assert_true(status > 0);
    assert_int_equal(in_use_inside, before);
    assert_int_equal(after, before);
    void *block = test_malloc(100); /* the scale is alive: under valgrind it is not */
    if (mallinfo2().uordblks == before) {
        test_free(block);
        skip();
    }
    test_free(block);
}

#endif
