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

#endif
