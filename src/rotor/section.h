/* Cross sections: area and second moment of the stiff part and of the part with mass. */
#ifndef ROTID_ROTOR_SECTION_H
#define ROTID_ROTOR_SECTION_H

#include "rotor/rotor.h"

struct section {
    double stiff_area, stiff_inertia; /* m2, m4: what carries bending and shear */
    double mass_area, mass_inertia;   /* of the part that has mass */
    int rectangular;
    double ratio, stiff_outer; /* of a round section: inner over outer diameter of the stiff part, and that one [m] */
};

/* Round section; outer > inner >= 0 and stiff_outer > inner [m]. A stiffness diameter smaller than the outer one leaves the mass.
 */
void section_round(double outer, double inner, double stiff_outer, struct section *section);
/* height lies in the bending plane. */
void section_rectangular(double height, double width, struct section *section);

/* Takes `number` >= 3 evenly spaced holes of diameter d on the pitch radius e out of a round section: each hole has
 * I = pi d^4/64 + S e^2/2 on average over the angle, exactly so for 3 or more. Holes outside the stiffness diameter cost mass
 * only. ratio stays that of the section without holes, and with it the shear coefficient: the equivalent annulus of (6) would
 * move it. ROTID_OK or ROTID_ERROR_SECTION where less than nothing would be left. */
int section_perforate(int number, double d, double e, double stiff_outer, struct section *section);

/* Area and second moment of `number` round rods of diameter d at pitch radius e: S = N pi d^2/4, own = N pi d^4/64,
 * pitch = S e^2/2; own + pitch is the inertia of (7), corrected. */
void section_rods(int number, double d, double e, double *area, double *own, double *pitch);

/* The section of a segment without its layers, and of a ring of a layer; each with the holes of its own group. ROTID_OK or
 * ROTID_ERROR_SECTION. */
int section_of_segment(const struct rotor *rotor, int segment, struct section *section);
int section_of_ring(const struct rotor *rotor, int ring, struct section *section);

#endif
