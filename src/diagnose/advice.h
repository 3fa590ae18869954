/* The measurement that would separate the causes that these data leave ambiguous. */
#ifndef ROTID_DIAGNOSE_ADVICE_H
#define ROTID_DIAGNOSE_ADVICE_H

#include "diagnose/engine.h"
#include "diagnose/round.h"

/* The measurement that separates the members of an ambiguous set best; last: the fits of that round, NULL where they are gone.
 * NULL where memory is out. */
const char *advise(struct engine *engine, const struct diagnosis_round *round, const struct round_result *last);

#endif
