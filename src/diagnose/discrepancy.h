/* What a cause that is an approximation, such as the cone at a step, leaves: noise behind it. */
#ifndef ROTID_DIAGNOSE_DISCREPANCY_H
#define ROTID_DIAGNOSE_DISCREPANCY_H

#include "diagnose/diagnose.h"

int discrepancy_of(const struct cause_kind *cause); /* nonzero: it leaves something */

/* sigma := sqrt(sigma^2 + sign d^2) in the states in which the candidate acts, in arrays of their own: d is what its cause leaves
 * of a frequency, and of the largest component of a shape. sign -1 takes out again what was added. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int discrepancy_add(struct pool *pool, const struct candidate *c, int sign, struct states *states);

#endif
