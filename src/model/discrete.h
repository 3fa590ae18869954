/* A discretised rotor: a beam or a solid, the one place that knows there are two. */
#ifndef ROTID_MODEL_DISCRETE_H
#define ROTID_MODEL_DISCRETE_H

#include "beam/beam.h"
#include "solid/solid.h"

enum discretisation { AS_BEAM, AS_SOLID };

struct discrete {
    enum discretisation as;
    struct beam beam;
    struct solid solid;
};

#define COARSE_MESH 0 /* of a solid: with a sixth of its unknowns */

/* refine >= 1: a mesh that much finer; COARSE_MESH. Statuses of beam_build and solid_build; *failed likewise. */
int discrete_build(struct pool *pool, enum discretisation as, const struct rotor *rotor, int nparameter,
                   const struct parameter *parameter, int refine, struct discrete *discrete, int *failed);

/* Why discrete_build refused a rotor with ROTID_ERROR_SECTION and this *failed, and what was expected. */
const char *discrete_refusal(enum discretisation as, const struct rotor *rotor, int failed);

/* The same for a rotor of the same shape, whose mesh it shares. ROTID_OK or ROTID_ERROR_MEMORY. */
int discrete_of_shape(struct pool *pool, const struct discrete *built, const struct rotor *rotor, int nparameter,
                      const struct parameter *parameter, struct discrete *discrete);

/* Own copy of the rotor, at the values of the last evaluation. */
const struct rotor *discrete_rotor(const struct discrete *discrete);

/* Structure of K and M, in the members of *structure that are no storage. */
void discrete_structure(const struct discrete *discrete, rotid_matrix *structure);

void discrete_set(struct discrete *discrete, const double *x);
void discrete_assemble(struct discrete *discrete, const double *x, rotid_matrix *k, rotid_matrix *m);
void discrete_differentiate(const struct discrete *discrete, int p, rotid_matrix *dk, rotid_matrix *dm);
void discrete_mass_properties(const struct discrete *discrete, struct mass_properties *properties);

/* How many of the lowest modes are rigid-body or suspension modes: at most two, those at zero or with most of their potential
 * energy in springs and axial forces instead of bending. modes: vectors near the lowest ones, to begin with, as in rotid_model.
 * Nothing is left on the pool. Statuses of eigen_full_solve. */
int discrete_count_rigid(const struct pool *pool, struct discrete *discrete, const double *x, int nmodes, const double *modes,
                         int *nrigid);

/* Places along the axis where the lateral motion of the rotor is one degree of freedom: their number, where they are [m], and
 * that degree of freedom. */
int discrete_places(const struct discrete *discrete);
const double *discrete_place_z(const struct discrete *discrete);
int discrete_place_dof(const struct discrete *discrete, int i);

/* The degree of freedom of a sensor's motion, and where the mesh has it [m]. */
int discrete_sensor_dof(const struct discrete *discrete, int sensor);
double discrete_sensor_z(const struct discrete *discrete, int sensor);

/* After another effect took the place of one: settles where joints are. ROTID_OK or ROTID_ERROR_MEMORY. */
int discrete_place_joints(struct pool *pool, struct discrete *discrete);

/* How many elements member i (tie rods, then bars) has, and its deflection v [npoint] at npoint >= 2 even places z [npoint]. */
int discrete_member_elements(const struct discrete *discrete, int i);
void discrete_member_deflection(const struct discrete *discrete, int i, const double *u, int npoint, double *z, double *v);

/* Where frequencies f of a mesh and g of one refined by `refine` lead: to f - share (g - f). counts: the limit is the frequency
 * that counts, and f otherwise. finer, finer_share: the same the other way, from a mesh refined by `finer`, h, to
 * h - finer_share (f - h). */
struct mesh_limit {
    int refine;
    double share;
    int counts, finer;
    double finer_share;
};
struct mesh_limit discrete_mesh_limit(enum discretisation as, const struct rotor *rotor);

/* v := the motion u of the same rotor on another mesh, a beginning for its modes: of a solid any, of a beam one whose elements
 * are those of the first one cut into equal parts, values of parameters being those of its last assembly. Returns 0 where there
 * is no such way: to a beam's coarser mesh. */
int discrete_transfer(const struct discrete *from, const double *u, const struct discrete *to, double *v);

#endif
