/* What the rounds start from: the model of the user, on a mesh and on data that are not to blame themselves. */
#ifndef ROTID_DIAGNOSE_BASE_H
#define ROTID_DIAGNOSE_BASE_H

#include "diagnose/engine.h"

/* The fit of all states: of each, *first that of the first with the fit of all. Statuses of identify_states. */
int base_identify(struct engine *engine, const struct states *states, struct message_list *notes, struct identification **each,
                  struct identification *first);
/* Fit, mesh fine enough. ROTID_ERROR_ARGUMENT where nothing is left to judge by. */
int base_prepare(struct engine *engine);
/* Once more with the residuals, the data having changed. */
int base_again(struct engine *engine);
/* Elements of a job until the error of its mesh, which the spectrum states, is negligible beside the noise: what is too small to
 * be a cause still moves a modulus by part of its interval. */
int base_refine(struct pool *pool, struct job *job, const int *number, const struct spectrum *spectrum);
/* "lower" or "upper": the bound at which parameter p of the base ends. */
const char *base_bound_side(const struct engine *engine, int p);
/* What the condensation of the user's own fit costs. */
int base_note_reduction(struct engine *engine);
/* Residuals of the base by mode and by sensor. */
int base_residuals(struct engine *engine);

#endif
