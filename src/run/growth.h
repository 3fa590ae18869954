/* How the hybrid functionals grow away from the optimum: Figure 3 of the paper. */
#ifndef ROTID_RUN_GROWTH_H
#define ROTID_RUN_GROWTH_H

#include "run/job.h"

enum { GROWTH_E, GROWTH_F, GROWTH_KINDS }; /* HYBRID with (15), HYBRID_F with (16) */

struct growth {
    int points;
    double *epsilon2;        /* [points] 1e-6 ... 1e-2, evenly in the logarithm */
    double *f[GROWTH_KINDS]; /* [points] at x0 (1 + eps); NaN where the model has no modes */
    double slope[GROWTH_KINDS],
        intercept[GROWTH_KINDS]; /* of ln f over ln eps^2, least squares; NaN where an f is none, or rounding */
    double *shapes_alone;        /* [points] f(E) at x0: nothing but rounding (docs/errata.md) */
};

/* Data: frequencies and shapes of modes 1 ... modes of the model itself at x0 [n] of the parameters, so that f(x0) = 0, by the
 * reduction of the job's FIT; as in (17) and (18) every parameter is raised by eps, and to each measured shape eps times an
 * arbitrary vector of its own length is added, drawn from `seed`. Statuses of the prediction. */
int growth_run(struct pool *pool, const struct job *job, int n, const struct parameter *parameter, const double *x0, int modes,
               unsigned long seed, struct growth *growth);

#endif
