#ifndef ROTID_ROTOR_ROTOR_H
#define ROTID_ROTOR_ROTOR_H

/* Rotor: what a rotor is, whatever discretises it: geometry, materials, attachments, the parameters that vary, the effects of
 * causes. In: struct rotor as src/deck fills it, values x of parameters. Out: a rotor at x, sections, forces, factors, rates.
 *
 *   structure      rotor.c (rotor_length, rotor_mass, ...); copy.c (rotor_copy; rotor_same_shape: may two rotors share a mesh?)
 *   sling          copy.c (rotor_set_sling): end springs (44) from mass and centre of mass
 *   sections       section.c (section_of_segment, section_of_ring): S, I of annulus or rectangle less N holes, each
 *                  pi d^4/64 + S e^2/2; section_rods: S = N pi d^2/4, I = I_0 + S e^2/2 of a bundle (7)
 *   bundles        section.c (bundle_of_tierod, bundle_of_bars): rods in torsion and along the axis
 *   parameters     parameter.c: parameter_find resolves a name ("core.E", "front.k", "cause.depth"); parameters_set writes x
 *   effects        hooks of struct effect_kind, implemented in src/diagnose/causes: field (factors on E, G, rho along z), section
 *                  (EI, kGS of a beam), tierod, spring, point (mass or ground spring), joint. Each returns its value or the
 *                  exact derivative with respect to its parameter p
 *   all effects    effects.c: products of the factors (effects_on_axis, effects_on_tierod, effects_on_spring) and their rates
 *   axial force    effects.c (rotor_axial_force): F(z) = preload - sum N T of the self-equilibrated tie rods around z; from F
 *                  src/beam and src/solid make the geometric stiffness K_G of the axis
 *
 * Callers: beam, solid, model, the causes, run and all above. The room must not know meshes, matrices, modes or measured data. */

#include "base/base.h"

/* ----------------------------------------------------------------------------------------------------------------- rotor */

/* A rotor as the deck describes it: groups of segments laid end to end, and what is attached to them. Positions are metres from
 * the left end, resolved and inside [0, length]. How a rotor is discretised is no matter of this room: src/model. */

struct material {
    const char *name;
    double e, g, nu, rho; /* Pa, Pa, -, kg/m3 */
    int isotropic;        /* G = E/2(1+nu), whatever g holds */
    int laminated;        /* a stack of sheets across the axis: e and g hold along the axis, nu and the next two of the sheets */
    double sheet_e, stacking; /* Pa, share of the stack's length that is steel; in the plane E = stacking sheet_e */
};

struct segment {
    int group, elements, rectangular;
    double length;
    double outer, inner, stiff_outer; /* round */
    double height, width;             /* rectangular */
};

struct group {
    const char *name;
    struct material material; /* a copy: identifying one group leaves the others unchanged */
    int holes;                /* 0 where there is no perforation */
    double hole_diameter, hole_pitch;
    double preload; /* N, tension positive */
    int layer_of;   /* -1: a group of the axis; else the group on whose segments its rings lie */
};

struct ring { /* of a layer, bonded to what lies within and outside: see group.layer_of */
    int group, segment;
    double outer, inner; /* m */
};

enum bundle_model {
    BUNDLE_RODS, /* slender rods: own bending, and stretch of the rods by the rotation of the ends */
    BUNDLE_TUBE  /* the paper's equivalent cylinder */
};

struct tierod {
    const char *name;
    struct material material;
    double from, to;
    enum bundle_model model;
    int self_equilibrated;
    int number, elements;
    double diameter, pitch, tension; /* tension N a rod */
};

struct bars { /* short-circuit bars: fixed to the core at their centre only */
    const char *name;
    struct material material;
    double center, length;
    enum bundle_model model;
    int number, elements; /* elements: over the whole length, even */
    double diameter, pitch;
};

struct disk {
    const char *name;
    double position, mass, diametral, polar; /* kg, kg.m2 */
    double hub_length, hub_outer;            /* m; 0: no hub is stated */
};

struct spring {
    const char *name;
    double position, lateral, rotational; /* N/m, N.m/rad */
    double torsional, axial;              /* N.m/rad, N/m: about and along the axis */
};

struct sensor {
    int id;
    double position;
};

struct effect; /* below */

/* What a rotor does in a mode: its lateral deflection in one plane, the rotation about its axis, the displacement along it. Small
 * motions of a rotor whose section is symmetric do not couple the three. */
enum mode_type { MODE_BENDING, MODE_TORSION, MODE_AXIAL };

#define ROTOR_MOST_ELEMENTS 10000 /* with its bundles: what a deck may have, and what no mesh is refined beyond */

struct rotor {
    int ngroup; /* those of the axis from left to right, then the layers */
    int nsegment, nring, ntierod, nbars, ndisk, nspring, nsensor, neffect;
    struct group *group;
    struct segment *segment; /* in order along the axis, those of a group together */
    struct ring *ring;       /* of the layers, those of a segment from the axis outwards */
    struct tierod *tierod;
    struct bars *bars;
    struct disk *disk;
    struct spring *spring;
    struct sensor *sensor; /* by increasing position */
    struct effect *effect; /* causes that are part of the model */
    double sling;          /* length, 0 where there is none */
    int count_all;     /* modes are numbered from the lowest vibration, those on the supports among them; 0: from the lowest one
                          that bends the rotor */
    int settled_rigid; /* one more than the rigid-body and suspension modes below mode 1, where measured modes were numbered above
                          so many, whatever becomes of the springs since; 0: they are counted at the values of the rotor */
};

double rotor_length(const struct rotor *rotor);

/* The segment at z [m], at an end of two the left one; beyond the rotor the first or the last. */
int rotor_segment_at(const struct rotor *rotor, double z);
/* Of the axis, as the deck has them. */
long rotor_elements(const struct rotor *rotor);

/* How many groups are of the axis: the first ones. */
int rotor_axis_groups(const struct rotor *rotor);

/* Diameters between which a segment lies with its layers, a round one. */
void rotor_diameters(const struct rotor *rotor, int segment, double *outer, double *inner);

/* How much too high, relatively, beam theory makes frequencies where the diameter steps: the largest of modes 1 to 4 of three
 * sections of equal length beside the converged solid (docs/solid.md), c(ratio) D/length of the rotor within a quarter for
 * length/D from 3 to
 * 30. *z, *ratio: of the worst step, between outer diameters that carry stiffness. 0 without a step. */
double rotor_step_error(const struct rotor *rotor, double *z, double *ratio);

/* First and last position of a group; a layer has those of its host. */
void rotor_group_span(const struct rotor *rotor, int group, double *from, double *to);

/* G of a material: its own, or E/2(1+nu). */
double material_shear_modulus(const struct material *material);

/* kg, from the dimensions alone: segments, layers, holes, rods, bars and disks. */
double rotor_mass(const struct rotor *rotor);
/* The same of a group alone: its segments or rings, less its holes. */
double rotor_group_mass(const struct rotor *rotor, int group);

/* A copy with arrays of its own; names are shared. A rotor that hangs on a sling gets two springs more, of no stiffness yet.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
int rotor_copy(struct pool *pool, const struct rotor *rotor, struct rotor *copy);

/* (44): a rotor_copy of this mass [kg] and centre of mass [m] hangs by its left end on the sling; sets the last two springs. */
void rotor_set_sling(struct rotor *rotor, double mass, double center);

/* Both ends of the hub of a disk, inside the rotor. */
void rotor_hub_span(const struct rotor *rotor, int disk, double *from, double *to);

/* Whether two rotors differ at most in names and in what rotor_same_values compares: whether a discretisation of one serves the
 * other. */
int rotor_same_shape(const struct rotor *a, const struct rotor *b);

/* Whether two rotors of the same shape agree in all that a parameter can change. */
int rotor_same_values(const struct rotor *a, const struct rotor *b);

struct mass_properties {
    double mass, center; /* kg, m from the left end */
    double inertia;      /* kg.m2 about a diameter through the centre */
};

/* ---------------------------------------------------------------------------------------------------------------- effect */

/* What a cause changes in a rotor: fields over z, members, masses, joints. Every discretisation of a rotor asks these hooks; the
 * causes themselves live in src/diagnose/causes. An effect at its neutral values changes nothing. Every hook gives values (p < 0)
 * or their derivatives with respect to its parameter p (p >= 0), and returns 0 where the effect leaves the thing alone or the
 * derivative vanishes; the output is then not touched. A hook an effect has no use for is NULL. */

#define EFFECT_MOST_PARAMETERS 4

struct effect_span { /* a stretch of the axis within one segment, from < to: an element, or the share of an integration point */
    int group, segment;
    double from, to; /* m */
};

/* Factors on the material of a stretch, none of which depends on the material's own values: E, G and rho of a group can be
 * identified beside them. Of the moduli the harmonic mean over the stretch, since the compliances of a row add up; of the density
 * the plain mean. Neutral: 1 each; derivatives: 0 each. */
struct effect_field {
    double e, g, rho;
};

/* Factors on the stiffness of a beam's section, for what beam theory itself gets wrong; nothing to a model that has no sections.
 */
struct effect_section {
    double ei, kgs;
};

struct effect_bundle {     /* of tie rods */
    double young, tension; /* factors on E (and on G with it) and on the tension */
    int as_rods;           /* nonzero: coupled as RODS whatever the deck says; not differentiated */
};

struct effect_point {           /* anywhere on the axis, which moves with the rotor there */
    double z, mass;             /* m, kg */
    double lateral, rotational; /* springs to the ground [N/m, N.m/rad] */
};

/* What becomes of a spring of the deck: k := factor k, then in series with a compliance, k := k/(1 + c k), at another place. */
struct effect_spring {
    double factor;              /* on both stiffnesses */
    double lateral, rotational; /* compliance [m/N, rad/(N.m)] */
    double shift;               /* m */
};

struct effect_parameter_name {
    const char *name, *unit;
};

struct effect_kind {
    const char *id; /* of method and deck: "stiffness_local" */
    int nparameter;
    struct effect_parameter_name parameter[EFFECT_MOST_PARAMETERS];
    int at_sensor; /* nonzero: the target is a sensor */
    int at_disk;   /* nonzero: the target is a disk, with which it is left out; its parameter adds to the diametral inertia */
    int (*field)(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                 struct effect_field *field);
    int (*section)(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                   struct effect_section *section);
    /* of the tie rods, or the spring, that are its target */
    void (*tierod)(const struct effect *effect, int p, struct effect_bundle *bundle);
    void (*spring)(const struct effect *effect, int p, struct effect_spring *change);
    int moves_springs; /* the hook above may give a shift, which is 0 at neutral */
    /* the i-th lumped mass or spring to the ground; with p < 0 a 0 says that there is no i-th one */
    int (*point)(const struct effect *effect, const struct rotor *rotor, int i, int p, struct effect_point *point);
    int joint; /* nonzero: a massless rotational spring in series at the end of group `target`, its parameter [rad/(N.m)] */
    /* how many of the parameters this effect uses, which may depend on its variant; NULL: all of them */
    int (*count)(const struct effect *effect);
};

struct effect {
    const char *name; /* of the CAUSE card */
    const struct effect_kind *kind;
    int target;  /* index of the group, tie rod, spring, disk or sensor; of the group left of an interface; -1: none */
    int variant; /* of the kind, such as the shape of a soft zone */
    double value[EFFECT_MOST_PARAMETERS];
    int stays;       /* nonzero: it is no cause that was found, and another one of its kind at its target may come */
    double bound[2]; /* of its size, where a deck states them or they were widened; both 0: those of its cause */
};

/* The number of parameters in use, the first ones of the kind. */
int effect_parameters(const struct effect *effect);

/* ------------------------------------------------------------------------------------------------------------- parameter */

/* What of a rotor can vary, by name: the modulus of a group, the stiffness of a spring, the depth of a cause. */

enum parameter_kind {
    PARAMETER_E,
    PARAMETER_G,
    PARAMETER_NU,
    PARAMETER_RHO,
    PARAMETER_TIEROD_E,
    PARAMETER_TENSION,
    PARAMETER_SPRING_K,
    PARAMETER_SPRING_K_ROT,
    PARAMETER_DISK_MASS,
    PARAMETER_DISK_INERTIA,
    PARAMETER_EFFECT
};

struct parameter {
    enum parameter_kind kind;
    int index;       /* of the group, tie rod, spring, disk or effect */
    int component;   /* of the effect, else 0 */
    int nalso;       /* of E, G, nu or rho: groups that have it in common with that one, */
    const int *also; /* [nalso] which the owner of the parameters keeps */
};

#define PARAMETER_SHARED_BY '=' /* "left.E=right.E" is one parameter of two groups */

/* The next name of "left.E=right.E" to `name` [PARAMETER_NAME]. Returns what follows, or NULL behind the last one. */
#define PARAMETER_NAME 1100 /* as long as a line of a deck */
const char *parameter_next_name(const char *names, char name[PARAMETER_NAME]);

/* Whether it is a stiffness of a spring. */
int parameter_is_of_spring(const struct parameter *parameter);

/* Whether it is a value of the material of this group. */
int parameter_is_of_group(const struct parameter *parameter, int group);

/* Whether both have a value in common. */
int parameters_overlap(const struct parameter *a, const struct parameter *b);

/* Finds "group.E", "group.G", ".nu", ".rho", "tierod.E", ".tension", "spring.k", ".k_rot", "disk.mass", ".inertia", and the
 * parameters of effects that have a name, "cause.depth". Returns 0 and *parameter, 1 when no object has that name, 2 when the
 * object has no such parameter; *unit is set with 0. */
int parameter_find(const struct rotor *rotor, const char *name, struct parameter *parameter, const char **unit);

/* The names there are, "left.E, left.G, ...", for messages; of the object alone that `of` ("left.x") names where there is one.
 * Behind PARAMETERS_LISTED of them their number. NULL where memory is out. */
#define PARAMETERS_LISTED 24
const char *parameter_list(struct pool *pool, const struct rotor *rotor, const char *of);

/* The starts [n] of unknowns; NULL where memory is out. */
double *parameter_starts(struct pool *pool, int n, const rotid_parameter *bounds);

/* Its value in the rotor, to read or to set. G of an isotropic material is not stored: give the group a G of its own first. */
double *parameter_value(const struct rotor *rotor, struct parameter parameter);

/* Sets n parameters to x [n], shared ones in all their groups. */
void parameters_set(const struct rotor *rotor, int n, const struct parameter *parameter, const double *x);

/* The same of one that is stated: a G becomes that of the group itself, where its material was isotropic. */
void parameter_state(const struct rotor *rotor, const struct parameter *parameter, double value);

/* --------------------------------------------------------------------------------------------------------------- effects */

/* What the effects of a rotor do together: products of their factors, and how one parameter moves the product.
 */

/* The product over all effects. */
struct effect_field effects_on_axis(const struct rotor *rotor, const struct effect_span *span, int sections);

/* Derivative of those factors with respect to a parameter of an effect, divided by the factors; 0 where they do not depend on it.
 */
int effects_axis_rate(const struct rotor *rotor, struct parameter parameter, const struct effect_span *span, int sections,
                      struct effect_field *rate);

/* Factors of a tie rod. */
struct effect_bundle effects_on_tierod(const struct rotor *rotor, int tierod);

/* Their derivatives; 0 where they do not depend on the parameter. as_rods of *d stays 0. */
int effects_tierod_derivative(const struct rotor *rotor, struct parameter parameter, int tierod, struct effect_bundle *d);

/* Place and stiffness of a spring of the deck, without mass; and how they move with its own stiffness or with a parameter of an
 * effect, 0 where they do not. */
void effects_on_spring(const struct rotor *rotor, int spring, struct effect_point *point);
int effects_spring_derivative(const struct rotor *rotor, struct parameter parameter, int spring, struct effect_point *d);

/* Whether an effect may move it. */
int effects_move_spring(const struct rotor *rotor, int spring);

/* Diametral inertia of a disk; and the disk whose one grows with a parameter, kg.m2 for kg.m2, or -1. */
double effects_on_disk(const struct rotor *rotor, int disk);
int effects_disk_of(const struct rotor *rotor, struct parameter parameter);

/* Force on the axis at z of a group [N], tension positive: its preload less what the tie rods press together there, with
 * `followed` and the tension of rods of one element, which then move with the axis everywhere; and the derivative, 0 where it
 * does not depend on the parameter. */
double rotor_axial_force(const struct rotor *rotor, int group, double z, int followed);
double rotor_axial_force_derivative(const struct rotor *rotor, struct parameter parameter, double z, int followed);

/* --------------------------------------------------------------------------------------------------------------- section */

/* Cross sections: area and second moment of the stiff part and of the part with mass. */

struct section {
    double stiff_area, stiff_inertia; /* m2, m4: what carries bending and shear */
    double mass_area, mass_inertia;   /* of the part that has mass */
    int rectangular;
    double ratio, stiff_outer; /* of a round section: inner over outer diameter of the stiff part, and that one [m] */
    double torsion, polar;     /* m4: Saint-Venant's constant of the stiff part, polar inertia of the part that has mass. A round
                                  section keeps its circles also where it has holes: torsion = 2 stiff_inertia then, which is an
                                  upper bound */
};

/* Round section; outer > inner >= 0 and stiff_outer > inner [m]. A stiffness diameter smaller than the outer one leaves the mass.
 */
void section_round(double outer, double inner, double stiff_outer, struct section *section);
/* height lies in the bending plane. */
void section_rectangular(double height, double width, struct section *section);

/* Takes `number` >= 3 evenly spaced holes of diameter d on the pitch radius e out of a round section: each hole has
 * I = pi d^4/64 + S e^2/2 on average over the angle, exactly so for 3 or more. Holes outside the stiffness diameter cost mass
 * only. ratio stays that of the section without holes, and with it the shear coefficient: the equivalent annulus of (6) would
 * move it. ROTID_OK or ROTID_ERROR_SECTION where less than nothing would be left. */
int section_perforate(int number, double d, double e, double stiff_outer, struct section *section);

/* Area and second moment of `number` round rods of diameter d at pitch radius e: S = N pi d^2/4, own = N pi d^4/64,
 * pitch = S e^2/2; own + pitch is the inertia of (7), corrected. */
void section_rods(int number, double d, double e, double *area, double *own, double *pitch);

/* In torsion and along the axis: stiffness c and inertia j per length of an element or a bundle, and its length; as a direction:
 * their derivatives. K = c/l [1 -1; -1 1], M = j l/6 [2 1; 1 2]. */
struct bar {
    double stiffness, mass, length;
};

/* Of a bundle of rods between its ends, type MODE_TORSION or MODE_AXIAL: c = N(G J_0 + T R^2 + 12 E I_0 R^2/l^2),
 * j = N rho S (R^2 + d^2/8), or N E S, N rho S; the derivative with respect to a parameter. elastic_only: without T R^2. */
struct bar bundle_of_tierod(const struct rotor *rotor, enum mode_type type, int elastic_only, int i, double length);
struct bar bundle_of_tierod_by(const struct rotor *rotor, enum mode_type type, int elastic_only, int i, double length,
                               struct parameter parameter);

/* Inertia of bars, which move with the section at their centre [kg.m2; kg]. */
double bundle_of_bars(const struct rotor *rotor, enum mode_type type, int i);

/* The section of a segment without its layers, and of a ring of a layer; each with the holes of its own group. ROTID_OK or
 * ROTID_ERROR_SECTION. */
int section_of_segment(const struct rotor *rotor, int segment, struct section *section);
int section_of_ring(const struct rotor *rotor, int ring, struct section *section);

#endif
