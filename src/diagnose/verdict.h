/* From rounds to a verdict. */
#ifndef ROTID_DIAGNOSE_VERDICT_H
#define ROTID_DIAGNOSE_VERDICT_H

#include "diagnose/engine.h"
#include "diagnose/round.h"

/* The winner of a round becomes part of the model, with what it leaves as an approximation added to the noise. */
int accept_cause(struct engine *engine, const struct diagnosis_round *round, struct round_result *result);
/* The verdict: adequate, named, ambiguous or unexplained, with what it rests on. last: the round that named nothing more. */
int reach_verdict(struct engine *engine, struct round_result *last);

#endif
