/* Tie rods and bars beside a solid: chains of beam elements from line to line of the mesh, which bend by themselves. Tie rods
 * move with the section at both ends and are stretched by W at their pitch radius there; bars move with the section at their
 * centre. Tie rods of one element move with the section everywhere (solid_mesh_follows): their mass and tension act line by line,
 * and their own bending stiffness, below a thousandth of that of what they press together, is left out. */
#ifndef ROTID_SOLID_MEMBERS_H
#define ROTID_SOLID_MEMBERS_H

#include "solid/solid.h"

/* Adds to K and M, or for p >= 0 their derivatives with respect to solid->parameter[p]; the matrices may be NULL. */
void members_assemble(const struct solid *solid, int p, rotid_matrix *k, rotid_matrix *m);

/* Adds moments of mass about the left end, as attached_moments. */
void members_moments(const struct solid *solid, double moment[3]);

/* Deflection of member i at z, in the motion u: cubic between lines, by v and theta there. */
double members_deflection_at(const struct solid *solid, int i, const double *u, double z);

/* The same, v [npoint], at npoint >= 2 even places z [npoint] from its left end to the right one. */
void members_deflection(const struct solid *solid, int i, const double *u, int npoint, double *z, double *v);

#endif
