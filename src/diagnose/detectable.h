/* What could not be seen, and where along the axis it would show. */
#ifndef ROTID_DIAGNOSE_DETECTABLE_H
#define ROTID_DIAGNOSE_DETECTABLE_H

#include "diagnose/engine.h"
#include "diagnose/round.h"

/* The amplitude that the scan finds in 9 of 10 tests, >= 0: an amplitude a moves the whitened residual by a |c|, the score is
 * normal about that with variance 1, so a |c| = sqrt(threshold) + 1.28. INFINITY where the item is not usable. */
double amplitude_shown(const struct scan_item *item, double threshold);

/* result.detectable of *engine->out by the scan of the last round. ROTID_OK or ROTID_ERROR_MEMORY. */
int detectable_sizes(struct engine *engine, const struct round_result *last);
int localise(struct engine *engine, const struct scan *scan);

#endif
