/* What the screen and the JSON of a diagnosis look up alike. */
#ifndef ROTID_REPORT_DIAGNOSIS_ITEMS_H
#define ROTID_REPORT_DIAGNOSIS_ITEMS_H

#include "diagnose/diagnose.h"

/* Name and unit of parameter p of a candidate, that of the card for a fault of the measurement; NULL behind the last. */
const struct effect_parameter_name *candidate_parameter(const struct candidate *candidate, int p);

/* Index in the fit (may be NULL) of the parameter of that name, -1 where there is none. */
int fitted_parameter(const struct job *job, const rotid_fit_result *fit, const char *name);

#endif
