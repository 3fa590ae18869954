/* Values and intervals of the named causes in the final fit. */
#ifndef ROTID_DIAGNOSE_CAUSE_INTERVALS_H
#define ROTID_DIAGNOSE_CAUSE_INTERVALS_H

#include "diagnose/engine.h"

/* Takes the values of the extended model's fit into the causes of the diagnosis, with their intervals: those of the fit, but
 * where the round found that they say too much; of a place for which no linear model holds, because its interval reaches beyond
 * an end of the rotor or the width beside it ends at a bound, that of the profile of chi2, which goes into the fit as well.
 * Statuses of memory and cancellation only. */
int cause_intervals(const struct engine *engine);

#endif
