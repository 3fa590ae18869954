/* Where sensors tell rivals apart: a design for each pair of them. */
#ifndef ROTID_SUGGEST_PAIR_DESIGN_H
#define ROTID_SUGGEST_PAIR_DESIGN_H

#include "suggest/plan.h"
#include "suggest/rivals.h"

/* design [ndesign]: the target is what rival b lacks where a is true, in the same test again at all the places, the parameters
 * are those of b with what is measured as prior; for the pairs of the best of the set, both ways, beside the model as it is where
 * there is one alone. None where the modes of such a pair have no partner. Statuses of memory and cancellation only. */
int pair_designs(struct pool *pool, const struct rivals *rivals, const struct places *places, double frequency_std,
                 double shape_std, int *ndesign, struct design **design);

#endif
