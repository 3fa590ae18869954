/* A motion of a solid on another mesh of the same rotor: where the solution on a finer mesh begins. */
#ifndef ROTID_SOLID_TRANSFER_H
#define ROTID_SOLID_TRANSFER_H

#include "solid/solid.h"

/* v [ndof of `to`] := the motion u [ndof of `from`] at the nodes, sensors and members of `to`. Elements are taken to be straight,
 * which those at corners are not: a beginning, no interpolation to the last digit. */
void solid_transfer(const struct solid *from, const double *u, const struct solid *to, double *v);

#endif
