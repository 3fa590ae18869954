/* What of an element does not depend on its material: integrals over its area, from which K and M of any transversely isotropic
 * material follow as sums. With n = N/r and strains e_rr = U,r; e_tt = (U + V)/r; e_zz = W,z; g_rz = U,z + W,r;
 * g_rt = V,r - (U + V)/r; g_tz = V,z - W/r:
 *   K = pi int B' C B r dr dz,  M = pi rho int N'N r dr dz. */
#ifndef ROTID_SOLID_INTEGRALS_H
#define ROTID_SOLID_INTEGRALS_H

#include "solid/elasticity.h"
#include "solid/mesh.h"

#define SHARES 3 /* Gauss points along z: causes act on the share of each with factors of its own */

enum integral { BY_R_R, BY_N_N, BY_Z_Z, BY_R_N, BY_R_Z, BY_N_Z, BY_MASS, INTEGRALS };

/* value[i][a + 8 b]: pi int X_a Y_b r dr dz, X and Y being derivatives with respect to r, N/r, or those with respect to z */
struct integrals {
    double value[SHARES][INTEGRALS][SOLID_NODES * SOLID_NODES];
};

void integrals_of(const struct solid_mesh *mesh, const struct solid_element *element, struct integrals *integrals);

/* Adds to k [24 * 24] the stiffness of one share, constants c, and of an axial stress [Pa], tension positive; both triangles. */
void integrals_add_stiffness(const struct integrals *integrals, int share, const struct elasticity *c, double stress, double *k);

/* Adds rho times those of mass to m [8 * 8], which stands for each of U, V, W. */
void integrals_add_mass(const struct integrals *integrals, int share, double rho, double *m);

/* From and to, along z, of a share of a slice. */
void integrals_share_span(double left, double right, int share, double *from, double *to);

#endif
