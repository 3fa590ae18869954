/* Fits of all states with one more cause in them, or two, from several starts, and the small bookkeeping of jobs that grow.
 * number and holdout are those of all states, one behind the other, and x is that of the unknowns of all. */
#ifndef ROTID_DIAGNOSE_REFIT_H
#define ROTID_DIAGNOSE_REFIT_H

#include "diagnose/scan.h"
#include "run/identify.h"

/* Tolerances of the fits of a diagnosis: enough for chi2 to 1e-6 but in a valley; the final model is fitted to the end. */
#define REFIT_GRADIENT  1e-5
#define REFIT_STEP      1e-7
#define REFIT_OBJECTIVE 1e-6 /* what another step would gain: sizes are good to a hundredth of their standard deviation */
#define REFIT_DECREASE  1e-4 /* a tenth of a unit of chi2 is worth nothing beside margins of some */
/* Of chi2, well beyond those: so far above the model without its cause, a fit did not find what it contains. */
#define REFIT_WORSE 0.01

/* *to := the job `from` with the effect in its rotor and its parameters (those not fixed) behind the job's own, between their
 * physical bounds; a cause that asks for a solid makes the rotor one instead. Starts are x [nparameter] (the job's own starts,
 * where NULL) and the effect's values, moved off the bounds. `to` may be the job itself. ROTID_OK or ROTID_ERROR_MEMORY. */
int job_with_effect(struct pool *pool, const struct job *from, const double *x, const struct effect *effect,
                    const struct cause_kind *cause, const int *fixed, struct job *to);

/* The job with its starts at x [nparameter], moved inside where they press on a bound: the bijection of the fit is flat there,
 * and a parameter that a missing cause has pushed to its bound would stay. `to` may be the job itself. */
int job_started_at(struct pool *pool, const struct job *job, const double *x, struct job *to);

/* The same for the states with `in` [nstate] nonzero (NULL: all), which share the parameters of the effect: unknowns behind those
 * of all, between what is possible in every one of these states. A solid they are all together. */
int states_with_effect(struct pool *pool, const struct states *from, const double *x, const struct effect *effect,
                       const struct cause_kind *cause, const int *fixed, const int *in, struct states *to);

/* The same for the starts of all. */
int states_started_at(struct pool *pool, const struct states *states, const double *x, struct states *to);

/* The bounds and the start of unknown p of all for the states that have it. */
void states_share_bounds(struct states *states, int p);

/* *to := the states with the values that their effects have at x. */
int states_at(struct pool *pool, const struct states *states, const double *x, struct states *to);

struct refit {
    struct states states;  /* with the effects of the set at the best values, which are also the starts */
    rotid_fit_result *fit; /* NULL where no start led anywhere */
    double chi2;
    double other_chi2,
        other_place; /* best fit that ended at another place, more than a width or 3 % of the length away; NaN: none */
};

/* Best of the fits from the most promising places of the set, the states' own parameters starting at x [nparameter], which is
 * where the scan was made (at those of the set, where it has some); and at `deck` [nparameter] (NULL: none) as well where none of
 * those fits succeeded, one of these parameters ends at a bound, or one at x is more than three times as large or small as in the
 * deck. Statuses of memory and cancellation only: where every fit fails, or ends above the model without its causes, which it
 * contains, fit is NULL. */
int refit_set(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
              const double *deck, const struct scan *scan, const struct scan_set *set, const rotid_environment *environment,
              struct refit *refit);

/* Number of effect m of a set in the rotor of state s with the set, in which it acts: the last ones are those of the set. */
int refit_effect(const struct scan *scan, const struct scan_set *set, int m, int s, const struct rotor *rotor);

/* The fit of the states, which is taken over, in the place of what *refit has. ROTID_OK or ROTID_ERROR_MEMORY. */
int refit_keep(struct pool *pool, const struct states *states, rotid_fit_result *fit, struct refit *refit);

/* Does one of the first nown parameters end at a bound? */
int fit_at_bound(const rotid_fit_result *fit, int nown);

/* Fits once more with the first nown parameters starting at `own`; *fit is replaced where that is better. */
int refit_again(struct pool *pool, const struct states *states, int nown, const double *own, const int *number,
                const int *holdout, const rotid_environment *environment, rotid_fit_result **fit);

/* *drop of chi2 that is gained where the bounds at which the first nown parameters end in `fit` are ten times as far; 0 where
 * none does, or where there is no such model. */
int refit_beyond(struct pool *pool, const struct states *states, int nown, const rotid_fit_result *fit, const int *number,
                 const int *holdout, const rotid_environment *environment, double *drop);

/* One fit with the options of a diagnosis, which ends where another step would gain less than this part of the objective
 * (REFIT_OBJECTIVE; 0: at the minimum). */
int refit_until(struct pool *pool, const struct states *states, const int *number, const int *holdout, double objective,
                const rotid_environment *environment, rotid_fit_result **fit);
/* One that ends at REFIT_OBJECTIVE; refit_job: of a job that is the only state. */
int refit_states(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                 const rotid_environment *environment, rotid_fit_result **fit);
int refit_job(struct pool *pool, const struct job *job, const int *number, const int *holdout,
              const rotid_environment *environment, rotid_fit_result **fit);

/* The values of effect number `effect` of a state at x of the unknowns of all. */
void effect_at(const struct state *state, int effect, const double *x, struct effect *out);

#endif
