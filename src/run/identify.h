/* Identification of a job: pairing, fit, pairing again at the fitted model, and the errors of the numbers. */
#ifndef ROTID_RUN_IDENTIFY_H
#define ROTID_RUN_IDENTIFY_H

#include "run/compare.h"
#include "run/states.h"

struct identification {
    rotid_fit_result *fit;      /* to be freed with rotid_fit_free */
    struct comparison compared; /* at the fitted model */
    struct spectrum spectrum;   /* of the fitted model */
    int shapes_fitted;          /* they took part in the residual or in the quotient */
    struct mass_properties mass;
    double *baseline_hz; /* [nmode * fit->nbaseline] predicted at the points of NLopt, NaN where there is no model */
};

/* One fit of a job with the pairing `number` [nmode] and the modes `holdout` [nmode] left out; no notes, no spectrum. mass may be
 * NULL. Statuses of rotid_fit and model_open. */
int identify_fit(struct pool *pool, const struct job *job, const int *number, const int *holdout,
                 const rotid_fit_options *options, const rotid_environment *environment, struct mass_properties *mass,
                 rotid_fit_result **fit);

/* The same of several states together, number and holdout of all one behind the other. */
int identify_fit_states(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                        const rotid_fit_options *options, const rotid_environment *environment, rotid_fit_result **fit);

/* With nothing to identify the model is compared as it stands. baseline: NLopt as well. Notes and reasons go to the list.
 * Statuses of rotid_fit and of comparison_make, ROTID_ERROR_ARGUMENT where nothing is measured (the list says so). */
int identify_run(struct pool *pool, const struct job *job, int baseline, const rotid_environment *environment,
                 struct message_list *notes, struct identification *out);

/* The same without the errors of the numbers, mesh_error_percent and, without shapes, the condensed model of the spectrum: for
 * many runs of one deck. */
int identify_run_bare(struct pool *pool, const struct job *job, int baseline, const rotid_environment *environment,
                      struct message_list *notes, struct identification *out);

/* The same over the states of a deck: out [nstate], each with the fit as its state sees it, all unknowns but its modes and
 * residuals alone, chi2 of these. *fit: of all, to be freed with rotid_fit_free, in place of those. */
int identify_states(struct pool *pool, const struct states *states, int baseline, const rotid_environment *environment,
                    struct message_list *notes, struct identification *out, rotid_fit_result **fit);

/* The same with as little as identify_run_bare. */
int identify_states_bare(struct pool *pool, const struct states *states, int baseline, const rotid_environment *environment,
                         struct message_list *notes, struct identification *out, rotid_fit_result **fit);

/* The fit that identify_states left in `out` of a state, for those that work on its job: of its own unknowns alone, n, x, std,
 * limits, at_bound and identifiable in the order of the job; without what goes over pairs of them. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int identify_own_unknowns(struct pool *pool, const struct state *state, struct identification *out);

/* Warns where the condensed model that was fitted has other frequencies than the full one, of which `what` is said: "written". */
void identify_warn_of_reduction(const struct job *job, const struct identification *result, const char *what,
                                struct message_list *notes);

#endif
