/* What is attached to a solid: springs, disks, lumped masses, tie rods and bars. */
#ifndef ROTID_SOLID_ATTACHED_H
#define ROTID_SOLID_ATTACHED_H

#include "solid/solid.h"

/* Adds to K and M, or for p >= 0 their derivatives with respect to solid->parameter[p]. k or m may be NULL. */
void attached_assemble(const struct solid *solid, int p, rotid_matrix *k, rotid_matrix *m);

/* Adds the masses about the left end: zeroth, first and second moments [kg, kg.m, kg.m2]. */
void attached_moments(const struct solid *solid, double moment[3]);

/* The i-th lumped mass or spring of all effects; *effect and *i begin at 0 and -1. Returns 0 when there are no more. */
int attached_next_point(const struct solid *solid, int *effect, int *i, struct effect_point *point);

#endif
