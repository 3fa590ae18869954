/* rotid_lm beside MINPACK's lmder (libcminpack) on the problems of More, Garbow and Hillstrom: the same residuals and Jacobians,
 * the same starts, tolerances of 1e-12 on the decrease and on the step and none on the gradient, 2000 evaluations at most,
 * everything else as each comes. A start counts as solved where the sum of squares, recomputed at the point that came back, is
 * that of a known minimum (mgh_reached). rotid_lm must solve every start that lmder solves, and reach no worse a minimum. */
#include <cminpack.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "base/base.h"
#include "more_garbow_hillstrom.h"

#define TOLERANCE   1e-12
#define EVALUATIONS 2000
#define SCATTERED   20  /* starts around each */
#define SPREAD      0.2 /* of every variable, at most */

struct outcome {
    double x[MGH_MOST_PARAMETERS], sum;
    int evaluations, jacobians, minimum; /* index of the one reached, -1: none */
};

static double work[60000], r[MGH_MOST_RESIDUALS], jacobian[MGH_MOST_RESIDUALS * MGH_MOST_PARAMETERS];

static void judge(const struct mgh_problem *problem, struct outcome *out)
{
    (void)problem->residual(NULL, problem->m, problem->n, out->x, r, NULL);
    out->sum = 0;
    for (int i = 0; i < problem->m; i++)
        out->sum += r[i] * r[i];
    out->minimum = out->evaluations <= EVALUATIONS ? mgh_reached(problem, out->sum) : -1;
}

/* lmder knows of no point without a residual: it sees the infinities. */
static int minpack_residual(void *user, int m, int n, const double *x, double *fvec, double *fjac, int ldfjac, int flag)
{
    const struct mgh_problem *problem = user;
    (void)ldfjac;
    (void)problem->residual(NULL, m, n, x, flag == 1 ? fvec : NULL, flag == 1 ? NULL : fjac);
    return 0;
}

static void run_minpack(const struct mgh_problem *problem, struct outcome *out)
{
    int m = problem->m, n = problem->n, pivot[MGH_MOST_PARAMETERS];
    double *diag = work, *qtf = diag + n, *w1 = qtf + n, *w2 = w1 + n, *w3 = w2 + n, *w4 = w3 + n;
    (void)lmder(minpack_residual, (void *)(uintptr_t)problem, m, n, out->x, r, jacobian, m, TOLERANCE, TOLERANCE, 0, EVALUATIONS,
                diag, 1, 100, 0, &out->evaluations, &out->jacobians, pivot, qtf, w1, w2, w3, w4);
    judge(problem, out);
}

static void run_rotid(const struct mgh_problem *problem, struct outcome *out)
{
    rotid_lm_options options = {.size = sizeof options,
                                .max_iterations = EVALUATIONS,
                                .objective_tolerance = TOLERANCE,
                                .step_tolerance = TOLERANCE,
                                .gradient_tolerance = DBL_EPSILON};
    rotid_lm_result result;
    (void)rotid_lm(problem->m, problem->n, problem->residual, NULL, &options, NULL, out->x, r, jacobian, work, &result);
    out->evaluations = result.evaluations;
    out->jacobians = result.jacobians;
    judge(problem, out);
}

static const char *verdict(const struct mgh_problem *problem, const struct outcome *out)
{
    if (out->minimum < 0)
        return "-";
    for (int k = 0; k < problem->nminimum; k++)
        if (problem->minimum[k] < problem->minimum[out->minimum])
            return "local";
    return "solved";
}

/* Returns whether rotid_lm does what lmder does; counts [2] of solved starts, lmder's and rotid_lm's. */
static int compare(const struct mgh_problem *problem, double factor, int *counts)
{
    struct outcome peer, own;
    mgh_start(problem, factor, peer.x);
    mgh_start(problem, factor, own.x);
    run_minpack(problem, &peer);
    run_rotid(problem, &own);
    counts[0] += peer.minimum >= 0;
    counts[1] += own.minimum >= 0;
    int good =
        peer.minimum < 0 || (own.minimum >= 0 && problem->minimum[own.minimum] <= problem->minimum[peer.minimum] * (1 + 1e-12));
    printf("   %-16s x%-3g | %-6s %-12.6g %5d %5d | %-6s %-12.6g %5d %5d%s\n", problem->name, factor, verdict(problem, &peer),
           peer.sum, peer.evaluations, peer.jacobians, verdict(problem, &own), own.sum, own.evaluations, own.jacobians,
           good ? "" : " <-");
    return good;
}

/* One start is luck where the path is long: the same from starts scattered around it. */
static void scatter(const struct mgh_problem *problem, double factor, int *counts)
{
    struct random_stream stream = {1};
    for (int s = 0; s < SCATTERED; s++) {
        struct outcome peer, own;
        mgh_start(problem, factor, own.x);
        for (int j = 0; j < problem->n; j++)
            peer.x[j] = own.x[j] *= 1 + SPREAD * (2 * random_uniform(&stream) - 1);
        run_minpack(problem, &peer);
        run_rotid(problem, &own);
        counts[0] += peer.minimum >= 0;
        counts[1] += own.minimum >= 0;
    }
}

int main(void)
{
    int counts[2] = {0}, scattered[2] = {0}, failures = 0;
    printf("   %-16s %-4s | %-31s | %s\n", "", "", "lmder: sum of squares, r, J", "rotid_lm: sum of squares, r, J");
    for (int k = 0; k < mgh_count; k++) {
        int good = 1;
        for (int f = 0; f < 3; f++)
            good &= compare(&mgh_problems[k], mgh_factors[f], counts);
        printf("%s %s: rotid_lm solves what lmder solves\n", good ? "ok" : "FAILED", mgh_problems[k].name);
        failures += !good;
        for (int f = 0; f < 3; f++)
            scatter(&mgh_problems[k], mgh_factors[f], scattered);
    }
    printf("   starts solved: lmder %d, rotid_lm %d of %d\n", counts[0], counts[1], 3 * mgh_count);
    int good = scattered[1] >= scattered[0];
    printf("%s scattered starts: lmder solves %d, rotid_lm %d of %d\n", good ? "ok" : "FAILED", scattered[0], scattered[1],
           3 * mgh_count * SCATTERED);
    return failures || !good;
}
