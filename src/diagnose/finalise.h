/* The final model, the gain, the verdict in words. */
#ifndef ROTID_DIAGNOSE_FINALISE_H
#define ROTID_DIAGNOSE_FINALISE_H

#include "diagnose/engine.h"
#include "diagnose/round.h"

/* last: the round that named nothing more, or NULL. */
int finalise(struct engine *engine, const struct round_result *last);

#endif
