/* The model as a Python script that builds a ross.Rotor (package ross-rotordynamics) and, when it is run, prints its bending
 * frequencies at rest beside those of rotid. */
#ifndef ROTID_EXPORT_ROSS_H
#define ROTID_EXPORT_ROSS_H

#include <stdio.h>

#include "export/ross_model.h"

/* ROTID_OK or ROTID_ERROR_MEMORY. */
int ross_write(struct pool *pool, FILE *stream, const struct ross_model *ross);

#endif
