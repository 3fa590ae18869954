/* A motion of something on the rotor as a sum of degrees of freedom, by which springs, masses and members act inside the band:
 * stiffness s along the motion t'u adds s t t'. */
#ifndef ROTID_SOLID_MOTION_H
#define ROTID_SOLID_MOTION_H

#include "base/pool.h"
#include "rotid.h"
#include "solid/mesh.h"

struct motion {
    int count;
    int *dof;       /* [count] each once */
    double *weight; /* [count] */
};

/* Of the section at a line as a whole: the means over its area, as of a plate that spreads a load and adds no stiffness,
 *   v = int (U - V)/2 r dr / int r dr,  theta = int W r^2 dr / int r^3 dr.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
int motion_of_section(struct pool *pool, const struct solid_mesh *mesh, int line, struct motion *v, struct motion *theta);

/* W of a line at a pitch radius as the annulus pitch -+ reach tilts: pitch int W r^2 dr / int r^3 dr, which is theta pitch where
 * the section stays plane. A load on a circle would sink in without limit. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_SECTION
 * where the section does not reach there. */
int motion_axial(struct pool *pool, const struct solid_mesh *mesh, int line, double pitch, double reach, struct motion *w);

/* U, V or W (component 0, 1, 2) of the surface at z, into room for SURFACE_MOST degrees of freedom; with by_place of its
 * derivative with respect to z. */
#define SURFACE_MOST 3
void motion_of_surface(const struct solid_mesh *mesh, double z, int component, int by_place, int *dof, double *weight,
                       struct motion *motion);

double motion_value(const struct motion *motion, const double *u);

/* a += value (x y' + y x')/2 */
void motion_add(rotid_matrix *a, double value, const struct motion *x, const struct motion *y);

#endif
