/* What could not be seen, and where along the axis it would show. */
#ifndef ROTID_DIAGNOSE_DETECTABLE_H
#define ROTID_DIAGNOSE_DETECTABLE_H

#include "diagnose/engine.h"
#include "diagnose/round.h"

int detectable_sizes(struct engine *engine, const struct round_result *last);
int localise(struct engine *engine, const struct scan *scan);

#endif
