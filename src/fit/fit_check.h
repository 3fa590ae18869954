/* What rotid_fit refuses. */
#ifndef ROTID_FIT_FIT_CHECK_H
#define ROTID_FIT_FIT_CHECK_H

#include "rotid.h"

/* ROTID_OK, or ROTID_ERROR_ARGUMENT or _UNPAIRED with the reason in failure. All three structs are of this library's size. */
int fit_check(const rotid_model *model, const rotid_parameter *parameter, const rotid_measured *measured,
              const rotid_fit_options *options, char *failure);

#endif
