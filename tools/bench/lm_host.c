/* For callgrind with --collect-atstart=no: rotid_lm or, with the argument "lmder", MINPACK on the regression problems of NIST
 * from both starts, tolerances of 1e-12 on the decrease and on the step. Collected is what the minimisers do, not the residuals.
 * Prints how many starts were solved. */
#include <cminpack.h>
#include <float.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <valgrind/callgrind.h>

#include "nist_regression.h"
#include "rotid.h"

#define TOLERANCE   1e-12
#define EVALUATIONS 2000

static double work[10000], r[NIST_MOST_OBSERVATIONS], jacobian[NIST_MOST_OBSERVATIONS * NIST_MOST_PARAMETERS];

static int residual(void *user, int m, int n, const double *x, double *out, double *j)
{
    CALLGRIND_TOGGLE_COLLECT;
    int status = nist_residual(user, m, n, x, out, j);
    CALLGRIND_TOGGLE_COLLECT;
    return status;
}

/* lmder knows of no point without a residual: it sees the infinities. */
static int minpack_residual(void *user, int m, int n, const double *x, double *out, double *j, int rows, int flag)
{
    (void)rows;
    (void)residual(user, m, n, x, flag == 1 ? out : NULL, flag == 1 ? NULL : j);
    return 0;
}

static void minimise(const struct nist_problem *problem, int minpack, double *x)
{
    int m = problem->m, n = problem->n, pivot[NIST_MOST_PARAMETERS], evaluations, jacobians;
    void *user = (void *)(uintptr_t)problem;
    double *diag = work, *qtf = diag + n, *w1 = qtf + n, *w2 = w1 + n, *w3 = w2 + n, *w4 = w3 + n;
    rotid_lm_options options = {.size = sizeof options,
                                .max_iterations = EVALUATIONS,
                                .objective_tolerance = TOLERANCE,
                                .step_tolerance = TOLERANCE,
                                .gradient_tolerance = DBL_EPSILON};
    rotid_lm_result result;
    CALLGRIND_TOGGLE_COLLECT;
    if (minpack)
        (void)lmder(minpack_residual, user, m, n, x, r, jacobian, m, TOLERANCE, TOLERANCE, 0, EVALUATIONS, diag, 1, 100, 0,
                    &evaluations, &jacobians, pivot, qtf, w1, w2, w3, w4);
    else
        (void)rotid_lm(m, n, residual, user, &options, NULL, x, r, jacobian, work, &result);
    CALLGRIND_TOGGLE_COLLECT;
}

int main(int count, char **argument)
{
    int solved = 0;
    for (int k = 0; k < 2 * nist_count; k++) {
        const struct nist_problem *problem = &nist_problems[k / 2];
        double x[NIST_MOST_PARAMETERS], sum = 0;
        memcpy(x, problem->start[k % 2], sizeof x);
        minimise(problem, count > 1 && !strcmp(argument[1], "lmder"), x);
        (void)nist_residual((void *)(uintptr_t)problem, problem->m, problem->n, x, r, NULL);
        for (int i = 0; i < problem->m; i++)
            sum += r[i] * r[i];
        solved += nist_solved(problem, sum);
    }
    printf("%d\n", solved);
    return 0;
}
