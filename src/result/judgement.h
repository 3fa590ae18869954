/* What is judged of a result, made once for tables, pages and sentences. */
#ifndef ROTID_RESULT_JUDGEMENT_H
#define ROTID_RESULT_JUDGEMENT_H

#include "rotid.h"

#define JUDGEMENT_CHANCE 0.01 /* a misfit that noise exceeds less often is no noise */

/* Of the modes that have an error_percent: its rms over those that were fitted, or held out [%], NaN of none; the fitted one
 * whose frequency is worst, -1 of none. */
double fit_rms_percent(const rotid_identification *fit, int holdout);
int fit_worst_mode(const rotid_identification *fit);
/* How often the stated noise alone leaves a misfit of chi2 or more; NaN without noise or degrees of freedom. */
double fit_p_value(const rotid_identification *fit);
/* Whether that is less than JUDGEMENT_CHANCE: the model is not adequate for the data. 0 where no noise is stated, chi2 NaN. */
int misfit_is_inadequate(double chi2, int dof);
int fit_is_inadequate(const rotid_identification *fit);
/* The fit as one of its states has it: what that has for itself in place of what all have. */
rotid_identification fit_of_state(const rotid_identification *fit, int s);
/* The name of the state that entry k of modes is of; NULL where the deck is one state. */
const char *fit_state_of_mode(const rotid_identification *fit, int k);
/* The parameter of this name, or NULL; fit may be NULL. */
const rotid_fitted_parameter *fit_parameter(const rotid_identification *fit, const char *name);

/* Of what may hide in a parameter the cause that moves it most, where that is by more than half of its 95 % interval; else NULL.
 */
const rotid_hidden *hidden_in(int count, const rotid_hidden *hidden, const rotid_fitted_parameter *parameter);

/* How many sets of causes cannot be told apart, a pair being one. */
int verdict_sets(const rotid_verdict *verdict);
/* Whether alternative cause i is meant together with the one before it. */
int verdict_is_pair(const rotid_verdict *verdict, int i);

/* The fit as the deck states it, where it gives other parameters than the base model by a different choice; else NULL. */
const rotid_identification *diagnosis_today(const rotid_diagnosis *d);
/* The candidates of a round, from 0: the set first, then the others, best first; their count. */
const rotid_candidate *diagnosis_candidates(const rotid_diagnosis *d, int round, int *count);
/* Whether a card of the deck asked for the cause, which has the name of that card then. */
int diagnosis_is_suspected(const rotid_diagnosis *d, const rotid_cause *cause);
/* By how much a candidate leads another one of its round: chi2 and a penalty for each parameter that was searched for, as the
 * decision counts them. */
double candidate_lead(const rotid_candidate *a, const rotid_candidate *b);
/* Whether a candidate was not refused for a reason of its own, such as its size or what it does to modes held out. */
int candidate_is_rival(const rotid_candidate *candidate);
/* The best candidate of a round, and the best other one that is a rival, as indices of diagnosis_candidates; -1: none. */
void diagnosis_leaders(const rotid_diagnosis *d, int round, int *first, int *second);

#endif
