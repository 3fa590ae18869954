/* The envelope of the cones at the steps of a rotor's diameter. */
#ifndef ROTID_DIAGNOSE_CAUSES_STEP_STIFFNESS_H
#define ROTID_DIAGNOSE_CAUSES_STEP_STIFFNESS_H

#include "rotor/rotor.h"

#define STEPS_AT_ONCE 64 /* that reach into one element: those farther to the right are left out, which no real rotor has */

struct step {
    double z, diameter; /* m; the smaller one of the two */
};

/* Diameter that carries stiffness at z of a segment [m]; angle in degrees, 90 and more: no cone. */
double step_stiffness_diameter(const struct rotor *rotor, int segment, double z, double angle);

#endif
