/* The catalogue: one line a cause. */
#ifndef ROTID_DIAGNOSE_CAUSES_CATALOGUE_H
#define ROTID_DIAGNOSE_CAUSES_CATALOGUE_H

#include "diagnose/causes/cause.h"

/* Number of causes, and the i-th of them. */
int catalogue_count(void);
const struct cause_kind *catalogue_item(int i);

/* By id, without regard to case; NULL where there is none. */
const struct cause_kind *catalogue_find(const char *id);

/* The cause whose effect this is. */
const struct cause_kind *catalogue_of(const struct effect *effect);

/* Takes one fault out of the data of the job by the cause of that id. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_ARGUMENT where
 * there is no such cause or sensor, or nothing that could be corrected. */
int correction_apply(struct pool *pool, struct job *job, const struct correction *correction);

#endif
