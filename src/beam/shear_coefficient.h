/* Shear coefficients of the Timoshenko beam, after Cowper. */
#ifndef ROTID_BEAM_SHEAR_COEFFICIENT_H
#define ROTID_BEAM_SHEAR_COEFFICIENT_H

#include "rotor/section.h"

/* Of a section, and its derivative with respect to nu. */
double shear_coefficient(const struct section *section, double nu, double *derivative);

#endif
