/* From the rotor's materials, sections and forces to the five quantities of an element, and how a parameter moves them. */
#ifndef ROTID_BEAM_QUANTITIES_H
#define ROTID_BEAM_QUANTITIES_H

#include "beam/beam.h"
#include "beam/element.h"

/* What couples the two ends of a bundle of rods beside its bending: the stretch of rods at a pitch radius, E (S e^2/2)/L on the
 * relative rotation, and the inertia of rods that move axially in proportion to it. */
struct stretch {
    double stiffness; /* N.m/rad */
    double inertia;   /* kg.m2, all of it: a third at each end, a sixth between */
};

/* Element e of the axis. */
void axis_quantities(const struct beam *beam, int e, struct element *element);
/* Its derivative with respect to a parameter; returns 0 where that is zero. */
int axis_direction(const struct beam *beam, struct parameter parameter, int e, struct element *d);

/* One of the elements of a bundle, its length given; and the stretch over the whole bundle (zero for a tube). */
void tierod_quantities(const struct beam *beam, int tierod, double length, struct element *element, struct stretch *stretch);
int tierod_direction(const struct beam *beam, struct parameter parameter, int tierod, struct element *d,
                     struct stretch *dstretch);
/* Bars are not identified. inertia: of bars that follow the rotation of their centre axially. */
void bars_quantities(const struct beam *beam, int bars, double length, struct element *element, double *inertia);

#endif
