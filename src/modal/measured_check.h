/* What measured modes have to be before a functional is made of them. */
#ifndef ROTID_MODAL_MEASURED_CHECK_H
#define ROTID_MODAL_MEASURED_CHECK_H

#include "rotid.h"

/* ROTID_OK; ROTID_ERROR_ARGUMENT where data are out of range or missing for the functional `kind`; ROTID_ERROR_UNPAIRED where a
 * mode number lies beyond those of the model after `reduction`. `failure` as in rotid.h. */
int measured_check(const rotid_model *model, const rotid_measured *measured, int kind, int reduction, char *failure);

#endif
