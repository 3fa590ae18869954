/* Where a fit has to start that no straight line from the model without a cause leads to: an effect so large that modes change
 * their order, or that its drop is no longer linear in its size. */
#ifndef ROTID_DIAGNOSE_FAR_STARTS_H
#define ROTID_DIAGNOSE_FAR_STARTS_H

#include "diagnose/round.h"

struct far_start {
    const struct cause_kind *cause;
    struct effect effect; /* with its target, at the values to start from */
};

/* Behind the refits of a round, while nothing is named and where even the best leaves more than FAR_RATE of chi2 a degree of
 * freedom; once in a diagnosis, of one state, as a beam. Every candidate is looked at with sizes over all of its bounds, at
 * places along the rotor, the modes paired anew with each; what comes nearest is fitted with its own pairing. Where one of these
 * fits leaves less than half of what all others do, a degree of freedom, it is the start of its candidate from then on, its
 * pairing is settled for all, and the round has to be repeated: *changed. Statuses of memory and cancellation only. */
int far_starts_search(struct engine *engine, const struct round_result *result, int *changed);

/* Gives the scan's candidate the start that was found. */
void far_starts_mark(const struct engine *engine, struct scan *scan);

#endif
