/* What all who report a diagnosis look up alike. */
#ifndef ROTID_DIAGNOSE_ITEMS_H
#define ROTID_DIAGNOSE_ITEMS_H

#include "diagnose/diagnose.h"

/* Name and unit of parameter p of a candidate, that of the card for a fault of the measurement; NULL behind the last. */
const struct effect_parameter_name *candidate_parameter(const struct candidate *candidate, int p);

/* The word for its shape or mount, NULL where its cause has none. */
const char *candidate_variant(const struct candidate *candidate);

/* Index in the fit (may be NULL) of the unknown [fit->n] of that name, -1 where there is none. */
int fitted_parameter(const rotid_parameter *unknown, const rotid_fit_result *fit, const char *name);

#endif
