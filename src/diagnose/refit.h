/* Fits of a job with one more cause in it, from several starts, and the small bookkeeping of jobs that grow. */
#ifndef ROTID_DIAGNOSE_REFIT_H
#define ROTID_DIAGNOSE_REFIT_H

#include "diagnose/scan.h"
#include "run/identify.h"

/* Tolerances of the fits of a diagnosis: enough for chi2 to 1e-6; the final model is fitted to the end. */
#define REFIT_GRADIENT 1e-5
#define REFIT_STEP     1e-7

/* *to := the job `from` with the effect in its rotor and its parameters (those not fixed) behind the job's own, between their
 * physical bounds; starts are x [nparameter] (the job's own starts, where NULL) and the effect's values, moved off the bounds.
 * `to` may be the job itself. ROTID_OK or ROTID_ERROR_MEMORY. */
int job_with_effect(struct pool *pool, const struct job *from, const double *x, const struct effect *effect,
                    const struct cause_kind *cause, const int *fixed, struct job *to);

/* The job with its starts at x [nparameter], which are moved off the bounds. `to` may be the job itself. */
int job_started_at(struct pool *pool, const struct job *job, const double *x, struct job *to);

struct refit {
    struct job job;        /* with the effect at the best values, which are also the starts */
    rotid_fit_result *fit; /* NULL where no start led anywhere */
    double chi2;
    double other_chi2,
        other_place; /* best fit that ended at another place, more than a width or 3 % of the length away; NaN: none */
};

/* Best of the fits from the most promising places of the candidate. Statuses of memory and cancellation only: a fit that fails
 * leaves fit NULL. */
int refit_candidate(struct pool *pool, const struct job *job, const int *number, const int *holdout, const double *x,
                    const struct scan *scan, int candidate, const rotid_environment *environment, struct refit *refit);

/* One fit with the options of a diagnosis. */
int refit_job(struct pool *pool, const struct job *job, const int *number, const int *holdout,
              const rotid_environment *environment, rotid_fit_result **fit);

/* The effect's values at x [nparameter] of a job. */
void effect_at(const struct job *job, int effect, const double *x, struct effect *out);

#endif
