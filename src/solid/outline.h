/* The outline of a rotor's meridian: which material is where, its re-entrant corners, and the lines that a mesh needs. */
#ifndef ROTID_SOLID_OUTLINE_H
#define ROTID_SOLID_OUTLINE_H

#include "base/pool.h"
#include "rotor/rotor.h"
#include "solid/mesh.h"

/* Radii of segment s without and with its rings [m]. */
double outline_inner(const struct rotor *rotor, int s);
double outline_outer(const struct rotor *rotor, int s);

/* Whether segment s > 0 touches the one before: more than a circle. */
int outline_touch(const struct rotor *rotor, int s);

/* The group whose material lies at radius r of segment s, or -1. */
int outline_group(const struct rotor *rotor, int s, double r);

/* Share of the volume of the group's material at radius r that is not holes. */
double outline_share(const struct rotor *rotor, int group, double r);

/* Whether the end z of segment s < nsegment - 1 has a re-entrant corner at radius r. */
int outline_corner(const struct rotor *rotor, int s, double r);

/* Length over the largest diameter. */
double outline_slenderness(const struct rotor *rotor);

/* Whether any end of a segment has one. */
int outline_has_corners(const struct rotor *rotor);

/* Lines of constant r, x [*nr], and of constant z, z [*nz] with the segment [*nz - 1] of each slice. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int outline_lines(struct pool *pool, const struct rotor *rotor, const struct solid_rule *rule, int refine, int *nr, double **r,
                  int *nz, double **z, int **segment);

#endif
