/* rotid_lm as a host calls it first, with every option at its default, on NIST's nonlinear regression problems, and that its path
 * and the check of a Jacobian do not depend on the unit of the residual. */
#include "more_garbow_hillstrom.h"
#include "nist_regression.h"
#include "support.h"

static double r[NIST_MOST_OBSERVATIONS], jacobian[NIST_MOST_OBSERVATIONS * MGH_MOST_PARAMETERS], work[100000];

UNIT_TEST(test_problems_have_the_jacobians_and_the_minima_that_are_certified)
{
    for (int k = 0; k < nist_count; k++) {
        const struct nist_problem *p = &nist_problems[k];
        double scale[NIST_MOST_PARAMETERS], error[NIST_MOST_PARAMETERS], doubt[NIST_MOST_PARAMETERS], sum = 0;
        for (int j = 0; j < p->n; j++)
            scale[j] = 0.1 * fabs(p->certified[j]);
        assert_true(rotid_check_jacobian_workspace(p->m, p->n) <= sizeof work / sizeof *work);
        assert_status(rotid_check_jacobian(p->m, p->n, nist_residual, (void *)p, p->certified, scale, NULL, error, doubt, work),
                      ROTID_OK);
        for (int j = 0; j < p->n; j++)
            assert_true(error[j] <= 1e-7);
        assert_int_equal(nist_residual((void *)p, p->m, p->n, p->certified, r, NULL), 0);
        for (int i = 0; i < p->m; i++)
            sum += r[i] * r[i];
        assert_true(nist_solved(p, sum));
    }
}

static int solve(const struct nist_problem *p, int start, const rotid_lm_options *options, double *b, rotid_lm_result *result)
{
    assert_true(rotid_lm_workspace(p->m, p->n) <= sizeof work / sizeof *work);
    memcpy(b, p->start[start], sizeof p->start[start]);
    return rotid_lm(p->m, p->n, nist_residual, (void *)p, options, NULL, b, r, jacobian, work, result);
}

/* BoxBOD from its first start: the fifth step makes exp(-b2 t) vanish beside 1 at every t, and no b2 near there changes a digit
 * of r. That is no minimum, and has to be said. */
UNIT_TEST(test_every_start_is_solved_or_said_to_be_stalled)
{
    int solved = 0, evaluations = 0;
    for (int k = 0; k < nist_count; k++)
        for (int start = 0; start < 2; start++) {
            const struct nist_problem *p = &nist_problems[k];
            double b[NIST_MOST_PARAMETERS], deviations = 0;
            rotid_lm_result result;
            int status = solve(p, start, NULL, b, &result), reached = nist_solved(p, 2 * result.objective);
            for (int j = 0; j < p->n; j++)
                deviations = fmax(deviations, fabs(b[j] - p->certified[j]) / p->std[j]);
            print_message("%-8s %d %-22s %s within %.0e standard deviations, cosine %.0e, iterations %d evaluations %d\n",
                          p->name, start + 1, rotid_status_name(status), reached ? "solved" : "not solved", deviations,
                          result.cosine, result.iterations, result.evaluations);
            solved += reached;
            evaluations += result.evaluations;
            if (reached) {
                assert_true(status == ROTID_STOP_GRADIENT || status == ROTID_STOP_STEP || status == ROTID_STOP_OBJECTIVE);
                assert_true(deviations < (p->sum < 1e-20 ? 1 : 1e-3));
            } else {
                assert_string_equal(p->name, "BoxBOD");
                assert_int_equal(start, 0);
                assert_status(status, ROTID_STOP_STALLED);
            }
        }
    print_message("%d of %d solved in %d evaluations\n", solved, 2 * nist_count, evaluations);
    assert_int_equal(solved, 2 * nist_count - 1);
    assert_true(evaluations < 4000); /* 3350 */
}

struct in_unit {
    rotid_residual residual;
    void *user;
    double unit;
};

static int in_unit(void *user, int m, int n, const double *x, double *out, double *j)
{
    const struct in_unit *in = user;
    int status = in->residual(in->user, m, n, x, out, j);
    for (int i = 0; out && i < m; i++)
        out[i] *= in->unit;
    for (int i = 0; j && i < m * n; i++)
        j[i] *= in->unit;
    return status;
}

/* In a unit that is a power of two everything is the same to the last bit, but r, J and f that carry it. */
static void compare_paths(struct in_unit *in, int m, int n, const double *start)
{
    static const int exponents[] = {664, -664, 500, -500}; /* of about 1e200, 1e-200, 1e150, 1e-150 */
    rotid_lm_options options = {.size = sizeof options, .max_iterations = 60};
    double x[MGH_MOST_PARAMETERS], error[2 * MGH_MOST_PARAMETERS], same[2 * MGH_MOST_PARAMETERS];
    rotid_lm_result plain;
    assert_true(rotid_check_jacobian_workspace(m, n) <= sizeof work / sizeof *work);
    memcpy(x, start, (size_t)n * sizeof *x);
    in->unit = 1;
    assert_status(rotid_check_jacobian(m, n, in_unit, in, x, NULL, NULL, error, error + n, work), ROTID_OK);
    int end = rotid_lm(m, n, in_unit, in, &options, NULL, x, r, jacobian, work, &plain);
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
        double other[MGH_MOST_PARAMETERS];
        rotid_lm_result result;
        memcpy(other, start, (size_t)n * sizeof *x);
        in->unit = ldexp(1, exponents[e]);
        assert_int_equal(rotid_lm(m, n, in_unit, in, &options, NULL, other, r, jacobian, work, &result), end);
        assert_memory_equal(other, x, (size_t)n * sizeof *x);
        assert_int_equal(result.evaluations, plain.evaluations);
        assert_int_equal(result.jacobians, plain.jacobians);
        assert_true(result.cosine == plain.cosine && result.mu == plain.mu);
        memcpy(other, start, (size_t)n * sizeof *x);
        assert_status(rotid_check_jacobian(m, n, in_unit, in, other, NULL, NULL, same, same + n, work), ROTID_OK);
        assert_memory_equal(same, error, 2 * (size_t)n * sizeof *same);
        double f = ldexp(plain.objective, 2 * exponents[e]); /* infinite, or zero, where it has no double */
        assert_true(result.objective == f);
    }
}

UNIT_TEST(test_path_does_not_depend_on_the_unit_of_the_residual)
{
    for (int k = 0; k < nist_count; k++)
        for (int start = 0; start < 2; start++) {
            struct in_unit in = {nist_residual, (void *)&nist_problems[k], 1};
            compare_paths(&in, nist_problems[k].m, nist_problems[k].n, nist_problems[k].start[start]);
        }
    for (int k = 0; k < mgh_count; k++) {
        struct in_unit in = {mgh_problems[k].residual, NULL, 1};
        double x[MGH_MOST_PARAMETERS];
        mgh_start(&mgh_problems[k], 1, x);
        compare_paths(&in, mgh_problems[k].m, mgh_problems[k].n, x);
    }
}

/* The columns of J as well: in the largest and smallest units of r and x at once nothing overflows that has a double. */
UNIT_TEST(test_start_may_be_of_any_size)
{
    static const double sizes[] = {1e-290, 1e-200, 1, 1e200, 1e290};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        struct in_unit in = {nist_residual, (void *)&nist_problems[0], sizes[k]};
        const struct nist_problem *p = &nist_problems[0];
        double b[NIST_MOST_PARAMETERS];
        rotid_lm_result result;
        memcpy(b, p->start[1], sizeof p->start[1]);
        int status = rotid_lm(p->m, p->n, in_unit, &in, NULL, NULL, b, r, jacobian, work, &result);
        assert_true(status > 0 && status <= ROTID_STOP_OBJECTIVE);
        for (int j = 0; j < p->n; j++)
            assert_close(b[j], p->certified[j], 1e-6, 0);
    }
}
