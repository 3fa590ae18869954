/* What changed between two states: the unknowns and what imitates the errors of the model are fitted to the first, what the model
 * still misses there is taken out of the data of the second, and the second is diagnosed with the unknowns held. An error of the
 * model that both states have is in neither. */
#ifndef ROTID_DIAGNOSE_CHANGED_H
#define ROTID_DIAGNOSE_CHANGED_H

#include "diagnose/diagnose.h"

/* *out := the job of state `after` with the unknowns that it shares held at what fits `before`, beside effects that imitate what
 * else is there. Its modes are those that both states have, with the frequencies f_a p_b/f_b, p_b what the fitted model predicts
 * for f_b on a mesh without error, and with the shapes a - g (b - s phi_b) at the sensors that both have, s and g the
 * least-squares scales of the model's shape to b and of b to a. The noise of both adds in squares, and so does what is missed
 * times how much the mode is another one in both, d, d^2 = (2 ln f_a/f_b)^2 + 1 - MAC(a, b) less what noise makes of that: what
 * the model misses of a mode moves with it. ROTID_ERROR_ARGUMENT where a name is none of a state, or the data of one do not
 * suffice (the list says what was expected); statuses of identify_run. */
int changed_job(struct pool *pool, const struct states *states, const char *before, const char *after,
                const struct diagnose_options *options, const rotid_environment *environment, struct message_list *notes,
                struct job *out);

#endif
