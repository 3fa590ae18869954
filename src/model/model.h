#ifndef ROTID_MODEL_MODEL_H
#define ROTID_MODEL_MODEL_H

/* Model: a rotor as equations of motion behind rotid_model, the door that a host's own model uses as well. The one place that
 * knows both a beam and a solid.
 * In: struct rotor, parameters, refinement of the mesh. Out: struct rotor_model; its `equations` evaluate K(x), M(x), dK/dx_p,
 * dM/dx_p and name the masters (the lateral degrees of freedom at the sensors) and the number of rigid modes.
 *
 *   opening        model.c (model_open): discretises, chooses the masters, counts rigid modes, fills rotid_model
 *   beam or solid  discrete.c (discrete_build, discrete_assemble, discrete_differentiate): one branch for each discretisation
 *   rigid modes    discrete.c (discrete_count_rigid): the lowest two, where their eigenvalue is near zero or
 *                  less than half of their potential energy phi'K phi is in bending and shear
 *   mesh limit     discrete.c (discrete_mesh_limit): f - share (g - f) of a mesh f and a refined or coarse one g (Richardson)
 *   basis          model.c (model_in_basis): a solid for motions u = V q alone, q its unknowns
 *   one run        models.c (models_for_run, models_discretise): meshes, mode counts and vectors are made once and used again
 *   meridian.c     the solid's mesh and motion for results
 *
 * Callers: run, diagnose, api, export, study, which give rotor_model.equations to src/modal or src/fit for modes and fits. Of
 * the rooms above only export looks into `discrete`. The room must not know measured data, residuals or fits. */

#include "beam/beam.h"
#include "rotor/rotor.h"
#include "solid/solid.h"

/* -------------------------------------------------------------------------------------------------------------- discrete */

/* A discretised rotor: a beam or a solid, the one place that knows there are two. */

/* in bending; in torsion and along the axis, src/beam/bar.c and harmonic 0 of a solid */
enum discretisation { AS_BEAM, AS_SOLID, AS_TORSION, AS_AXIAL, AS_SOLID_TORSION, AS_SOLID_AXIAL };
int discretisation_is_solid(enum discretisation as);

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
/* dK and dM are zero but in rows and columns *from ... *end - 1 of the band. */
void discrete_differentiate(const struct discrete *discrete, int p, rotid_matrix *dk, rotid_matrix *dm, int *from, int *end);
/* As solid_derivative_products; 1 of a beam. */
int discrete_derivative_products(const struct discrete *discrete, int p, int count, const double *u, double *dk_u, double *dm_u,
                                 int *from, int *end);
void discrete_mass_properties(const struct discrete *discrete, struct mass_properties *properties);

/* *p: the polar inertia P of what turns; *s: a lateral stiffness > 0 to the ground [N/m] evenly over the length of a group. Both
 * are added, at the values of the last discrete_assemble. */
void discrete_gyroscopic(const struct discrete *discrete, rotid_matrix *p);
void discrete_spread(const struct discrete *discrete, int group, double stiffness, rotid_matrix *s);

/* v [n]: the deflection of the section where spring i of the rotor is attached is v'u. */
void discrete_spring_motion(const struct discrete *discrete, int i, double *v);

/* u [2 n]: all of the rotor moves by 1; turns by theta = 1 about the left end. In torsion and along the axis there is the first
 * one alone. Returns their number. */
int discrete_rigid_motions(const struct discrete *discrete, double *u);

/* How many of the lowest modes are rigid-body or suspension modes: at most the rigid motions
 * that there are, those at zero or with most of their potential
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

/* How many elements member i (tie rods, then bars) has, and its deflection v [npoint] in the motion u at npoint >= 2 even places
 * z [npoint] from its left end to the right one. */
int discrete_member_elements(const struct discrete *discrete, int i);
void discrete_member_deflection(const struct discrete *discrete, int i, const double *u, int npoint, double *z, double *v);

/* Where frequencies f of a mesh and g of one refined by `refine` lead: to f - share (g - f). counts: the limit is the frequency
 * that counts, and f otherwise. finer, finer_share: the same the other way, from a mesh refined by `finer`, h, to
 * h - finer_share (f - h). may_be_off: how many times the way to it the limit may be off. */
struct mesh_limit {
    int refine;
    double share;
    int counts, finer;
    double finer_share, may_be_off;
};
struct mesh_limit discrete_mesh_limit(enum discretisation as, const struct rotor *rotor);

/* Time [s] in which a shear wave passes the longest element of a solid (solid_longest_passage), more of one
 * that locks (nu near 1/2). 0: of a beam, and of a solid without corners, whose coarse mesh has no element of the same length. */
double discrete_passage(const struct discrete *discrete);

/* members_mesh_error of a solid, 0 of beams, in the motion u of eigenvalue lambda, u'M u = 1. */
double discrete_members_error(const struct discrete *discrete, const double *u, double lambda);

/* v := the motion u of the same rotor on another mesh, a beginning for its modes: of a solid any, of a beam one whose elements
 * are those of the first one cut into equal parts, values of parameters being those of its last assembly. Returns 0 where there
 * is no such way: to a beam's coarser mesh. */
int discrete_transfer(const struct discrete *from, const double *u, const struct discrete *to, double *v);

/* ---------------------------------------------------------------------------------------------------------------- models */

/* The models of one run that are built already: a rotor's mesh and sections are made once, however often the rotor is opened with
 * other values or other parameters. Threads may share them. */

struct models;

/* What a reader of decks wants to know of a discretised rotor. */
struct model_size {
    int ndof;
    const int *sensor_dof; /* [nsensor] */
};

/* No models yet, and none taken up: all that are opened with these are discretised like this. NULL where memory is out. */
struct models *models_as(struct pool *pool, enum discretisation as);

/* How models that are opened with these are discretised: as beams where models is NULL. */
enum discretisation models_discretisation(const struct models *models);

/* The model of a rotor without parameters, in *models, which takes up no others. Statuses of discrete_build; *failed likewise. */
int models_begin(struct pool *pool, enum discretisation as, const struct rotor *rotor, struct models **models,
                 struct model_size *size, int *failed);

/* Models for a run, which begin with those of `given` (or NULL): `given` itself where it takes up others. NULL where memory is
 * out. */
struct models *models_for_run(struct pool *pool, struct models *given);

/* Models of the same run, of rotors as solids: `models` itself where its rotors are; NULL outside of a run. */
struct models *models_solids(struct models *models);

/* Ends what models_for_run began: the memory goes to the pool, and nothing is taken up any more. */
void models_end_run(struct pool *pool, struct models *models, const struct models *given);

/* A rotor discretised, by a mesh that is there already where there is one. *nrigid: rigid-body and suspension modes at the values
 * of the rotor, or as they are settled there, -1 where nobody has counted them. Statuses of discrete_build; *failed likewise. */
int models_discretise(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                      const struct parameter *parameter, int refine, struct discrete *discrete, int *nrigid, int *failed);

/* Keeps what somebody has counted. */
void models_keep_rigid(struct models *models, const struct rotor *rotor, int refine, int nrigid);

/* Keeps a copy of vectors phi [n * count] near the lowest modes, for models of that size to begin with; those kept before stay
 * where they are as many. From one thread alone: which vectors are met must not depend on who comes first. With models that take
 * up no others nothing happens. ROTID_OK or ROTID_ERROR_MEMORY. */
int models_keep_modes(struct models *models, int n, int count, const double *phi);

/* Those kept for models with n degrees of freedom, *count of them; NULL: none. */
const double *models_modes(struct models *models, int n, int *count);

/* ----------------------------------------------------------------------------------------------------------------- model */

/* A rotor as equations of motion, behind rotid_model: the door that a host's own model comes through as well. This room is the
 * one place that chooses what discretises a rotor: src/beam or src/solid. */

struct rotor_model {
    rotid_model equations;             /* user points to this struct: do not copy it */
    const struct rotor *rotor;         /* own copy, at the values of the last evaluation, with the springs of a sling */
    const struct parameter *parameter; /* [equations.nparam] */
    int naxis;
    const double *z;          /* [naxis] m: the places along the axis where the model has degrees of freedom */
    int *master;              /* [equations.nmaster] */
    struct discrete discrete; /* what src/export writes element by element and src/page draws; nobody else looks inside */
};

/* The model of a rotor with the given parameters at their values in the rotor; masters are the lateral degrees of freedom at the
 * sensors, without sensors all of the axis. refine >= 1 cuts every element. models: those built already, or NULL. Statuses of
 * discrete_build and discrete_count_rigid, ROTID_ERROR_ARGUMENT where two sensors fall on one node; *failed as for
 * discrete_build. */
int model_open(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
               const struct parameter *parameter, int refine, struct rotor_model *model, int *failed);

/* equations.derivatives, with the rows that they are in, as discrete_differentiate. */
void model_differentiate(const struct rotor_model *model, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm, int *from,
                         int *end);

/* equations.derivative_products, likewise; returns 1 where there is no such way: of beams, and where x_p moves more than elements
 * of a solid. */
int model_derivative_products(const struct rotor_model *model, const double *x, int p, int count, const double *u, double *dk_u,
                              double *dm_u, int *from, int *end);

/* Whether M is positive definite at all values: that of a solid, a sum of elements and disks of positive mass, unless a mass is a
 * parameter or a cause may take mass away. A factor of M would be a third of a solution. */
int model_mass_is_positive(const struct rotor_model *model);

/* A solid for motions u = V q alone: `equations` in q, with rows of V for its sensors. */
struct basis_model {
    rotid_model equations; /* user points to this struct: do not copy it */
    struct solid_basis basis;
};

/* At the values x, near which V [n * count], which is kept, is good; model, of a solid, stays open. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int model_in_basis(struct pool *pool, struct rotor_model *model, const double *x, int count, const double *v,
                   struct basis_model *out);

/* m: where master i is. */
double model_master_z(const struct rotor_model *model, int i);

/* The lateral degree of freedom nearest to z. */
int model_lateral_dof(const struct rotor_model *model, double z);

/* The motions of the whole, as in rotid_measured: whole [2 n]. */
void model_whole(const struct rotor_model *model, double *whole);

/* At the values of the last evaluation or discrete_set. */
void model_mass_properties(const struct rotor_model *model, struct mass_properties *properties);

/* The same of a rotor that nobody wants the modes of, at x [nparameter]. Statuses of discrete_build. */
int model_weigh(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                const struct parameter *parameter, const double *x, struct mass_properties *properties);

/* Puts an effect in the place of the last one of the model's rotor. ROTID_OK or ROTID_ERROR_MEMORY. */
int model_exchange_effect(struct pool *pool, struct rotor_model *model, const struct effect *effect);

/* *alone: whether sensor s has a node of a beam that no other sensor reads; a solid, whose sensors may be nearer to each other,
 * is asked no less. ROTID_OK or ROTID_ERROR_MEMORY. */
int model_sensor_alone(struct pool *pool, const struct rotor *rotor, int s, int *alone);

/* The solutions of a model begin with phi [n * count], modes of the same rotor on another mesh, as far as discrete_transfer has a
 * way there. ROTID_OK or ROTID_ERROR_MEMORY. */
int model_begin_with(struct pool *pool, struct rotor_model *model, const struct rotor_model *known, int count, const double *phi);

/* ------------------------------------------------------------------------------------------------------------ deflection */

/* How a rotor deflects in a motion of all degrees of freedom: along its axis, at its sensors, and the members beside it. Values
 * of parameters are those of the last evaluation. */

/* Lateral deflection at place i of model->z in the motion u [n]. */
double model_deflection(const struct rotor_model *model, int i, const double *u);

struct model_member { /* tie rods or bars */
    const char *name;
    int is_bars, elements; /* elements: over its length */
};

/* The i-th of them: tie rods first. */
struct model_member model_member(const struct rotor_model *model, int i);

/* -------------------------------------------------------------------------------------------------------------- meridian */

/* The mesh of a solid of revolution and the motion on it, as results carry them. NULL of a beam, and where memory is out. */

rotid_solid_mesh *meridian_size(struct pool *pool, const struct rotor_model *model);
/* Nodes and elements of its mesh; untouched of a beam. */
void meridian_count(const struct rotor_model *model, int *nodes, int *elements);

rotid_meridian *meridian_mesh(struct pool *pool, const struct rotor_model *model);

/* Of the motion u [n], at the values of the last evaluation. */
rotid_meridian_mode *meridian_mode(struct pool *pool, const struct rotor_model *model, const double *u);

#endif
