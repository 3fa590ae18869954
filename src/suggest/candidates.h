/* The tests worth a thought for the rivals of a diagnosis, each judged. */
#ifndef ROTID_SUGGEST_CANDIDATES_H
#define ROTID_SUGGEST_CANDIDATES_H

#include "suggest/plan.h"
#include "suggest/suggest.h"

/* Fills tests, in the order of their rank, rivals' margins of places, and out->test. options: with defaults settled. Statuses of
 * memory, cancellation and the models of plan_design. */
int candidates_judge(struct pool *pool, const struct places *places, const rotid_suggest_options *options,
                     const rotid_environment *environment, struct suggestion *out);

#endif
