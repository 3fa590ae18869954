/* Shear coefficients of the Timoshenko beam, after Cowper, and after Dharmarajan and McCutchen (J. Composite Materials 7, 1973)
 * where the material is another one along the axis than across it. */
#ifndef ROTID_BEAM_SHEAR_COEFFICIENT_H
#define ROTID_BEAM_SHEAR_COEFFICIENT_H

#include "rotor/section.h"

/* Of a section, and its derivative with respect to nu. */
double shear_coefficient(const struct section *section, double nu, double *derivative);

/* k G of a section of this material [Pa], and its derivatives: what a material resists shear with, but for the area. */
struct shear_resistance {
    double kg, by_e, by_g, by_nu; /* by_g: where G is the material's own; by_e: where G follows E, it follows here too */
};
void shear_resistance(const struct section *section, const struct material *material, struct shear_resistance *shear);

#endif
