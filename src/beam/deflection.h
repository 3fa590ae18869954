/* How a beam deflects between its nodes in a motion of these. */
#ifndef ROTID_BEAM_DEFLECTION_H
#define ROTID_BEAM_DEFLECTION_H

#include "beam/beam.h"

/* Deflection v [npoint] of tie rods or bars at npoint >= 2 even places z [npoint] from the left end of the bundle to its right
 * end, in the motion u [ndof] of all degrees of freedom: between the nodes by the static shapes of the elements, as for a lumped
 * mass. The values of the parameters are those of the last beam_assemble. */
void tierod_deflection(const struct beam *beam, int tierod, const double *u, int npoint, double *z, double *v);
void bars_deflection(const struct beam *beam, int bars, const double *u, int npoint, double *z, double *v);

/* fine_u [ndof of fine]: the motion u [ndof] of the beam, by the same shapes, at the nodes of a mesh whose elements are those of
 * the beam cut into equal parts. */
void beam_prolong(const struct beam *beam, const double *u, const struct mesh *fine, double *fine_u);

#endif
