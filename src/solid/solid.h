/* A rotor as a body of revolution: its first circumferential harmonic on the mesh of a meridian, with what is attached to it, and
 * the parameters that may vary. A client of src/rotor beside src/beam. What has no meaning here is refused with
 * ROTID_ERROR_SECTION: see solid_refusal. What a cause does to the sections of a beam (rotor/effect.h) does nothing here. */
#ifndef ROTID_SOLID_SOLID_H
#define ROTID_SOLID_SOLID_H

#include "base/pool.h"
#include "rotid.h"
#include "rotor/parameter.h"
#include "solid/integrals.h"
#include "solid/mesh.h"
#include "solid/motion.h"

struct solid_line { /* of the mesh: the motion of the section there */
    struct motion v, theta;
};

struct solid {
    struct rotor rotor; /* own copy of everything a parameter can change */
    struct solid_mesh mesh;
    struct integrals *integrals; /* [nelement] */
    struct solid_line *line;     /* [nslice + 1] */
    struct motion *stretch;      /* [2 ntierod] W at the pitch radius of both ends */
    int nfar, *far;              /* their degrees of freedom, which meet across the band */
    int nparameter;
    const struct parameter *parameter; /* [nparameter] */
    int elastic_only;                  /* leaves springs and axial forces out of K: what bends the rotor itself */
};

/* The solid of a rotor, with end springs from the sling added (44). `parameter` [nparameter] is kept; rule: NULL, what follows
 * from the rotor; refine as for solid_mesh_build. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_SECTION with the group, tie rod or
 * bars in *failed (groups, then tie rods, then bars, then the mesh as a whole). */
int solid_build(struct pool *pool, const struct rotor *rotor, int nparameter, const struct parameter *parameter,
                const struct solid_rule *rule, int refine, struct solid *solid, int *failed);

/* Why solid_build refused a rotor with ROTID_ERROR_SECTION and this *failed, and what was expected; to follow the place. */
const char *solid_refusal(const struct rotor *rotor, int failed);

/* Whether the outline has a re-entrant corner, where errors fall slower than elsewhere. */
int solid_has_corners(const struct rotor *rotor);

/* The same for a rotor of the same shape (rotor_same_shape) as that of `built`, whose mesh it shares. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int solid_of_shape(struct pool *pool, const struct solid *built, const struct rotor *rotor, int nparameter,
                   const struct parameter *parameter, struct solid *solid);

/* K and M at the values x of the parameters, which stay in solid->rotor. x may be NULL where nparameter is 0. */
void solid_assemble(struct solid *solid, const double *x, rotid_matrix *k, rotid_matrix *m);

/* Sets the parameters to x, without K and M. */
void solid_set(struct solid *solid, const double *x);

/* dK/dx_p and dM/dx_p at the values of the last solid_assemble. */
void solid_differentiate(const struct solid *solid, int p, rotid_matrix *dk, rotid_matrix *dm);

/* Tie rods, bars, disks and the masses of effects included, at the values of the last solid_assemble. */
void solid_mass_properties(const struct solid *solid, struct mass_properties *properties);

/* U, V, W [24] of the nodes of an element in the motion u [ndof]. */
void solid_element_motion(const struct solid *solid, const struct solid_element *element, const double *u, double *local);

/* u [2 ndof]: U = 1, V = -1, W = 0, and U = -z, V = z, W = r. */
void solid_rigid_motions(const struct solid *solid, double *u);

/* Strain energy [J] of each element in the motion u [ndof], for the amplitude u: energy [nelement]. */
void solid_strain_energy(const struct solid *solid, const double *u, double *energy);

#endif
