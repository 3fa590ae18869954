/* A rotor as the deck describes it: groups of segments laid end to end, and what is attached to them. Positions are metres from
 * the left end, resolved and inside [0, length]. How a rotor is discretised is no matter of this room: src/model. */
#ifndef ROTID_ROTOR_ROTOR_H
#define ROTID_ROTOR_ROTOR_H

#include "base/pool.h"

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
};

struct sensor {
    int id;
    double position;
};

struct effect; /* rotor/effect.h */

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
    int settled_rigid; /* one more than the rigid-body and suspension modes below mode 1, where measured modes were numbered above
                          so many, whatever becomes of the springs since; 0: they are counted at the values of the rotor */
};

double rotor_length(const struct rotor *rotor);

/* How many groups are of the axis: the first ones. */
int rotor_axis_groups(const struct rotor *rotor);

/* Diameters between which a segment lies with its layers, a round one. */
void rotor_diameters(const struct rotor *rotor, int segment, double *outer, double *inner);

/* First and last position of a group; a layer has those of its host. */
void rotor_group_span(const struct rotor *rotor, int group, double *from, double *to);

/* G of a material: its own, or E/2(1+nu). */
double material_shear_modulus(const struct material *material);

/* kg, from the dimensions alone: segments, layers, holes, rods, bars and disks. */
double rotor_mass(const struct rotor *rotor);

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

#endif
