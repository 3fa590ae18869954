/* Levenberg-Marquardt on the least-squares problems of More, Garbow and Hillstrom: what is found is judged by the printed minima
 * and by objective and gradient recomputed at the point that came back, not by the status. */
#include "more_garbow_hillstrom.h"
#include "support.h"

static double work[40000];

struct outcome {
    double x[MGH_MOST_PARAMETERS], r[MGH_MOST_RESIDUALS], jacobian[MGH_MOST_RESIDUALS * MGH_MOST_PARAMETERS];
    double objective, cosine; /* recomputed: half the sum of squares, largest cosine between r and a column of J */
    rotid_lm_result result;
};

static void recompute(const struct mgh_problem *problem, const double *x, double *objective, double *cosine)
{
    double r[MGH_MOST_RESIDUALS], jacobian[MGH_MOST_RESIDUALS * MGH_MOST_PARAMETERS], square = 0;
    assert_int_equal(problem->residual(NULL, problem->m, problem->n, x, r, NULL), 0);
    assert_int_equal(problem->residual(NULL, problem->m, problem->n, x, NULL, jacobian), 0);
    for (int i = 0; i < problem->m; i++)
        square += r[i] * r[i];
    *objective = square / 2;
    *cosine = 0;
    for (int j = 0; j < problem->n; j++) {
        double product = 0, norm = 0;
        for (int i = 0; i < problem->m; i++) {
            product += jacobian[i + j * problem->m] * r[i];
            norm += jacobian[i + j * problem->m] * jacobian[i + j * problem->m];
        }
        if (norm > 0 && square > 0)
            *cosine = fmax(*cosine, fabs(product) / sqrt(norm * square));
    }
}

static int solve(const struct mgh_problem *problem, double factor, struct outcome *out)
{
    rotid_lm_options options = {.size = sizeof options, .max_iterations = 2000};
    assert_true(rotid_lm_workspace(problem->m, problem->n) <= sizeof work / sizeof *work);
    mgh_start(problem, factor, out->x);
    int m = problem->m, n = problem->n;
    int status = rotid_lm(m, n, problem->residual, NULL, &options, NULL, out->x, out->r, out->jacobian, work, &out->result);
    recompute(problem, out->x, &out->objective, &out->cosine);
    return status;
}

UNIT_TEST(test_problems_have_the_jacobians_of_their_residuals)
{
    for (int k = 0; k < mgh_count; k++) {
        const struct mgh_problem *problem = &mgh_problems[k];
        double x[MGH_MOST_PARAMETERS], above[MGH_MOST_RESIDUALS], below[MGH_MOST_RESIDUALS];
        double jacobian[MGH_MOST_RESIDUALS * MGH_MOST_PARAMETERS];
        mgh_start(problem, 1, x);
        for (int j = 0; j < problem->n; j++) /* off the start, where some terms vanish */
            x[j] = 1.1 * x[j] + 0.01;
        assert_int_equal(problem->residual(NULL, problem->m, problem->n, x, NULL, jacobian), 0);
        for (int j = 0; j < problem->n; j++) {
            double kept = x[j], h = 6e-6 * fabs(kept), largest = 0;
            x[j] = kept + h;
            assert_int_equal(problem->residual(NULL, problem->m, problem->n, x, above, NULL), 0);
            x[j] = kept - h;
            assert_int_equal(problem->residual(NULL, problem->m, problem->n, x, below, NULL), 0);
            x[j] = kept;
            for (int i = 0; i < problem->m; i++)
                largest = fmax(largest, fabs(jacobian[i + j * problem->m]));
            for (int i = 0; i < problem->m; i++)
                assert_close(jacobian[i + j * problem->m], (above[i] - below[i]) / (2 * h), 0, 1e-6 * largest);
        }
    }
}

/* Every start from which MINPACK's lmder reaches a minimum, in not many more evaluations; elsewhere no worse an end than its. One
 * line a run, so that a change of the evaluations is seen. */
UNIT_TEST(test_minima_are_reached_from_near_and_far)
{
    int failures = 0;
    for (int k = 0; k < mgh_count; k++)
        for (int f = 0; f < 3; f++) {
            const struct mgh_problem *problem = &mgh_problems[k];
            struct outcome out;
            int status = solve(problem, mgh_factors[f], &out), lmder = problem->lmder[f];
            double sum = 2 * out.objective;
            int reached = mgh_reached(problem, sum) >= 0,
                bad = lmder ? !reached || out.result.evaluations > 4 * lmder + 40 : sum > problem->ends[f] * (1 + 1e-5);
            failures += bad;
            print_message("%-18s x%-4g %-21s sum of squares %-11.6g %-11s cosine %.1e evaluations %4d (%d) jacobians %4d%s\n",
                          problem->name, mgh_factors[f], rotid_status_name(status), sum, reached ? "reached" : "not reached",
                          out.cosine, out.result.evaluations, lmder, out.result.jacobians, bad ? " FAILED" : "");
        }
    assert_int_equal(failures, 0);
}

UNIT_TEST(test_what_comes_back_belongs_to_the_point_that_comes_back)
{
    for (int k = 0; k < mgh_count; k++) {
        const struct mgh_problem *problem = &mgh_problems[k];
        struct outcome out;
        double r[MGH_MOST_RESIDUALS], jacobian[MGH_MOST_RESIDUALS * MGH_MOST_PARAMETERS];
        (void)solve(problem, 1, &out);
        assert_int_equal(problem->residual(NULL, problem->m, problem->n, out.x, r, NULL), 0);
        assert_int_equal(problem->residual(NULL, problem->m, problem->n, out.x, NULL, jacobian), 0);
        assert_close(out.result.objective, out.objective, 1e-15, 0);
        assert_memory_equal(out.r, r, (size_t)problem->m * sizeof *r);
        assert_memory_equal(out.jacobian, jacobian, (size_t)(problem->m * problem->n) * sizeof *jacobian);
    }
}

/* Gauss-Newton steps of a large residual overshoot, and the objective is flat to rounding where x is still off by 1e-4: a stop
 * there is a stop too early. Zero residuals have no cosine worth the name. */
UNIT_TEST(test_gradient_vanishes_at_the_minimum_of_a_large_residual)
{
    for (int k = 0; k < mgh_count; k++)
        for (int f = 0; f < 3; f++) {
            struct outcome out;
            if (!mgh_problems[k].lmder[f])
                continue;
            (void)solve(&mgh_problems[k], mgh_factors[f], &out);
            /* some of the second minima lie at infinity, where nothing vanishes */
            if (mgh_problems[k].minimum[0] == 0 || mgh_reached(&mgh_problems[k], 2 * out.objective) > 0)
                continue;
            assert_close(out.cosine, 0, 0, 1e-7);
        }
}

/* Rosenbrock (1, 1), helical valley (1, 0, 0), Powell (0, 0, 0, 0); Box also vanishes at (10, 1, -1) and where x1 = x2, x3 = 0 */
UNIT_TEST(test_zero_residuals_are_found_where_they_are)
{
    static const struct {
        const char *name;
        double x[4], digits; /* Powell's Jacobian is singular there: x is the square root of the residual */
    } known[] = {{"Rosenbrock", {1, 1}, 1e-10},
                 {"helical valley", {1, 0, 0}, 1e-10},
                 {"Box 3D", {1, 10, 1}, 1e-10},
                 {"Powell singular", {0}, 1e-5}};
    for (int k = 0; k < mgh_count; k++)
        for (size_t z = 0; z < sizeof known / sizeof *known; z++) {
            struct outcome out;
            if (strcmp(mgh_problems[k].name, known[z].name) != 0)
                continue;
            int status = solve(&mgh_problems[k], 1, &out); /* rounding does not hide the decrease of an objective of zero */
            assert_true(status == ROTID_STOP_STEP || status == ROTID_STOP_GRADIENT);
            for (int j = 0; j < mgh_problems[k].n; j++)
                assert_close(out.x[j], known[z].x[j], known[z].digits, known[z].digits);
        }
}

/* A run that only its iteration limit ends tells the user nothing. Powell's columns shrink with x and so must the damping. */
UNIT_TEST(test_every_run_ends_by_itself)
{
    for (int k = 0; k < mgh_count; k++)
        for (int f = 0; f < 3; f++) {
            struct outcome out;
            if (!mgh_problems[k].lmder[f])
                continue;
            int status = solve(&mgh_problems[k], mgh_factors[f], &out);
            if (status == ROTID_STOP_ITERATIONS || status < 0)
                print_error("%s from %g times its start: %s\n", mgh_problems[k].name, mgh_factors[f], rotid_status_name(status));
            assert_true(status > 0 && status != ROTID_STOP_ITERATIONS);
        }
}

/* D makes the path the same in any unit; powers of two, so that rounding is the same as well. */
static int unit_of(int j)
{
    return 10 * (j % 12) - 13;
}

static int rescaled(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    const struct mgh_problem *problem = user;
    double own[MGH_MOST_PARAMETERS] = {0};
    for (int j = 0; j < n; j++)
        own[j] = ldexp(x[j], unit_of(j));
    int status = problem->residual(NULL, m, n, own, r, jacobian);
    for (int j = 0; jacobian && j < n; j++)
        for (int i = 0; i < m; i++)
            jacobian[i + j * m] = ldexp(jacobian[i + j * m], unit_of(j));
    return status;
}

UNIT_TEST(test_path_does_not_depend_on_the_units_of_x)
{
    for (int k = 0; k < mgh_count; k++) {
        struct mgh_problem problem = mgh_problems[k];
        struct outcome plain, other;
        rotid_lm_options options = {.size = sizeof options, .max_iterations = 8};
        mgh_start(&problem, 1, plain.x);
        for (int j = 0; j < problem.n; j++)
            other.x[j] = ldexp(plain.x[j], -unit_of(j));
        (void)rotid_lm(problem.m, problem.n, problem.residual, NULL, &options, NULL, plain.x, plain.r, plain.jacobian, work,
                       &plain.result);
        (void)rotid_lm(problem.m, problem.n, rescaled, &problem, &options, NULL, other.x, other.r, other.jacobian, work,
                       &other.result);
        assert_int_equal(plain.result.evaluations, other.result.evaluations);
        for (int j = 0; j < problem.n; j++)
            assert_close(ldexp(other.x[j], unit_of(j)), plain.x[j], 1e-9, 1e-12);
    }
}

/* sum exp(x t) against exp(t) (1 + 0.01 sin): J shrinks by exp(19 t) on the way from 20 to 1. What vanishes must be the gradient
 * where x stands, not beside the Jacobian of the start. The minimum is the root of J'r, found by bisection. */
static int growth(void *user, int m, int n, const double *x, double *r, double *j)
{
    (void)user, (void)n;
    for (int i = 0; i < m; i++) {
        double t = (i + 1.0) / m;
        *((r ? r : j) + i) = r ? exp(x[0] * t) - exp(t) * (1 + 0.01 * sin(5.0 * i)) : t * exp(x[0] * t);
    }
    return 0;
}

UNIT_TEST(test_gradient_is_judged_by_the_jacobian_where_x_stands)
{
    double low = 0.5, high = 2, r[10], j[10];
    while (high - low > 1e-15) {
        double middle = (low + high) / 2, slope = 0;
        (void)growth(NULL, 10, 1, &middle, r, NULL);
        (void)growth(NULL, 10, 1, &middle, NULL, j);
        for (int i = 0; i < 10; i++)
            slope += j[i] * r[i];
        *(slope > 0 ? &high : &low) = middle;
    }
    static const double starts[] = {3, 10, 20, 25};
    for (size_t k = 0; k < sizeof starts / sizeof *starts; k++) {
        double x = starts[k];
        rotid_lm_result result;
        assert_true(rotid_lm(10, 1, growth, NULL, NULL, NULL, &x, r, j, work, &result) > 0);
        assert_close(x, low, 1e-8, 0);
    }
}

/* One more residual, which no x can change. */
static int beside_a_constant(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    const struct mgh_problem *problem = user;
    double inner[MGH_MOST_RESIDUALS * MGH_MOST_PARAMETERS];
    int status = problem->residual(NULL, m - 1, n, x, r, r ? NULL : inner);
    if (r)
        r[m - 1] = 1e4;
    for (int j = 0; jacobian && j < n; j++) {
        memcpy(jacobian + j * m, inner + j * (m - 1), (size_t)(m - 1) * sizeof *inner);
        jacobian[j * m + m - 1] = 0;
    }
    return status;
}

static int keep_gain(void *user, const rotid_lm_iteration *now)
{
    ((double *)user)[now->iteration] = now->gain_ratio;
    return 0;
}

/* f then is 5e7 and known to 1e-8, more than Bard's steps gain after the first ones: its difference would not tell them. */
UNIT_TEST(test_gain_ratio_keeps_its_digits_beside_a_large_constant_residual)
{
    for (int k = 0; k < mgh_count; k++) {
        struct mgh_problem problem = mgh_problems[k];
        struct outcome out;
        double alone[6], beside[6];
        rotid_lm_options options = {.size = sizeof options, .max_iterations = 5, .trace = keep_gain, .trace_user = alone};
        if (strcmp(problem.name, "Bard") != 0)
            continue;
        mgh_start(&problem, 1, out.x);
        (void)rotid_lm(15, 3, problem.residual, NULL, &options, NULL, out.x, out.r, out.jacobian, work, &out.result);
        options.trace_user = beside;
        options.gradient_tolerance = options.objective_tolerance = 1e-30;
        mgh_start(&problem, 1, out.x);
        (void)rotid_lm(16, 3, beside_a_constant, &problem, &options, NULL, out.x, out.r, out.jacobian, work, &out.result);
        assert_int_equal(out.result.iterations, 5);
        for (int i = 1; i <= 5; i++)
            assert_close(beside[i], alone[i], 1e-6, 0);
    }
}

#define DRAWS 20

struct noisy {
    const struct mgh_problem *problem;
    double noise;
    unsigned draw;
};

/* The same noise for the same x, as the rounding of an eigensolver is. */
static int noisy_residual(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    const struct noisy *noisy = user;
    int status = noisy->problem->residual(NULL, m, n, x, r, jacobian);
    for (int i = 0; r && i < m; i++) {
        uint64_t z = (uint64_t)i + 1000 * (uint64_t)noisy->draw, bits;
        for (int j = 0; j < n; j++) {
            memcpy(&bits, &x[j], sizeof bits);
            z = (z ^ bits) * 0x9E3779B97F4A7C15u;
            z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
            z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        }
        r[i] += noisy->noise * ((double)(z >> 11) * 0x1p-52 - 1);
    }
    return status;
}

/* Noise of 1e-10 of the residual, as a rotor has with eigenvalues good to 1e-11: f tells x to 1e-5, the gradient to 1e-9. Where
 * Gauss-Newton steps overshoot, as in the first two, rounding decides which of the last steps count. One draw of the noise costs
 * Chebyquad 10 from 4 evaluations fewer to 18 more, by the kernels of the BLAS: the mean of DRAWS is judged. */
UNIT_TEST(test_noise_in_the_residual_neither_spoils_the_gradient_nor_burns_evaluations)
{
    for (int k = 0; k < mgh_count; k++) {
        const struct mgh_problem *problem = &mgh_problems[k];
        struct noisy noisy = {problem, 1e-10 * sqrt(problem->minimum[0] / problem->m), 0};
        struct outcome clean, out;
        if (problem->minimum[0] == 0 || !strcmp(problem->name, "Meyer") || !strcmp(problem->name, "Brown-Dennis"))
            continue; /* these two need more than 100 steps without noise */
        (void)solve(problem, 1, &clean);
        int m = problem->m, n = problem->n, evaluations = 0;
        int overshoots = !strcmp(problem->name, "Freudenstein-Roth") || !strcmp(problem->name, "Jennrich-Sampson");
        for (noisy.draw = 0; noisy.draw < DRAWS; noisy.draw++) {
            mgh_start(problem, 1, out.x);
            int status = rotid_lm(m, n, noisy_residual, &noisy, NULL, NULL, out.x, out.r, out.jacobian, work, &out.result);
            recompute(problem, out.x, &out.objective, &out.cosine);
            assert_true(status > 0 && status != ROTID_STOP_ITERATIONS);
            assert_close(out.cosine, 0, 0, overshoots ? 1e-5 : 1e-8);
            evaluations += out.result.evaluations;
        }
        print_message("%-18s with noise %.1e: evaluations %.1f in the mean, without %d\n", problem->name, noisy.noise,
                      (double)evaluations / DRAWS, clean.result.evaluations);
        assert_true(evaluations <= DRAWS * ((overshoots ? 4 : 1) * clean.result.evaluations + 15));
    }
}
