/* The paper's equivalent cylinder of a bundle of rods. */
#ifndef ROTID_BEAM_CYLINDER_H
#define ROTID_BEAM_CYLINDER_H

#include "rotor/section.h"

/* Cylinder of the given area and inertia (6). ROTID_OK or ROTID_ERROR_SECTION. */
int section_equivalent(double area, double inertia, struct section *section);

#endif
