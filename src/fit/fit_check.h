/* What rotid_fit refuses. */
#ifndef ROTID_FIT_FIT_CHECK_H
#define ROTID_FIT_FIT_CHECK_H

#include "rotid.h"

/* ROTID_OK, or ROTID_ERROR_ARGUMENT or _UNPAIRED with the reason in failure. All three structs are of this library's size. */
int fit_check(const rotid_model *model, const rotid_parameter *parameter, const rotid_measured *measured,
              const rotid_fit_options *options, char *failure);

/* Its parts: the model, and its parameters with their bounds and starts. */
int fit_check_model(const rotid_model *model, char *failure);
int fit_check_parameters(int count, const rotid_parameter *parameter, char *failure);

#endif
