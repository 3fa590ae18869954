/* A diagnosis as hosts and files have it. */
#ifndef ROTID_API_RESULT_DIAGNOSIS_H
#define ROTID_API_RESULT_DIAGNOSIS_H

#include "diagnose/diagnose.h"

/* deck: the states as the user states them, whose FIT `today` was fitted with. It leans on both. Without
 * messages and the extended deck. The result of `d`; where memory is out the pool says so. */
rotid_diagnosis *result_diagnosis(struct pool *pool, const struct states *deck, struct diagnosis *d);

/* A candidate at its best values; where memory is out the pool says so. */
rotid_cause result_cause(struct pool *pool, const struct candidate *candidate);

#endif
