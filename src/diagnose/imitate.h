/* A model brought near the data of a state by whatever does it: the fewer are missed by it, the less is left of an error of the
 * model where another state is judged beside the same model. Nothing is named by that. */
#ifndef ROTID_DIAGNOSE_IMITATE_H
#define ROTID_DIAGNOSE_IMITATE_H

#include "diagnose/diagnose.h"

/* Whether an effect may stay in a rotor beside another one of its kind at its target: factors of fields over z multiply, masses
 * and springs at points add up. */
int effect_can_stay(const struct effect *effect);

/* *out := the job, whose FIT is that of a diagnosis, with up to three effects that can stay, each the one whose fit is best
 * beside those before, as long as noise does not explain what is left and the gain is that of a name; the job itself where its
 * data do not suffice to judge a model by. Statuses of memory and cancellation only. */
int imitate(struct pool *pool, const struct job *job, const struct diagnose_options *options,
            const rotid_environment *environment, struct job *out);

#endif
