/* A rotor as a deck describes it, with positions resolved to metres from the left end. */
#ifndef HIDE_ROTOR_H
#define HIDE_ROTOR_H

#include "hide.h"
#include "hide_cards.h"

#define HIDE_NAME            64
#define HIDE_MOST_GROUPS     32
#define HIDE_MOST_RINGS      4
#define HIDE_MOST_SEGMENTS   256
#define HIDE_MOST_TIES       8
#define HIDE_MOST_ATTACHED   128
#define HIDE_MOST_PARAMETERS 32

struct hide_material {
    char name[HIDE_NAME];
    double e, g, nu, rho;
    int isotropic;  /* G = E/2(1+nu), whatever g holds */
    double sheet_e; /* of a stack of sheets, nu being that of a sheet; 0: no stack */
    double stacking;
};

struct hide_group {
    char name[HIDE_NAME];
    struct hide_material material;
    double from, to;
    int holes;
    double hole_diameter, hole_pitch;
    double preload;
    int free_modulus, free_density; /* E, G or nu, rho are identified */
};

struct hide_ring {
    int group;
    double outer, inner;
};

struct hide_segment {
    int group, rectangular, rings;
    double from, to;
    double outer, inner, stiff; /* diameters; stiff: the outer one that carries stiffness */
    double height, width;
    struct hide_ring ring[HIDE_MOST_RINGS]; /* layers */
};

struct hide_tie {
    char name[HIDE_NAME];
    struct hide_material material;
    double from, to;
    int tube, equilibrated, number;
    double diameter, pitch, tension;
};

struct hide_disk {
    char name[HIDE_NAME];                     /* "" where there is none: then its number in the deck is its name */
    double z, mass, inertia, hub_length, hub; /* hub: its outer diameter, 0 where there is none */
};

struct hide_spring {
    char name[HIDE_NAME]; /* "" where there is none: then its number in the deck is its name */
    double z, lateral, rotational;
};

struct hide_sensor {
    long id;
    double z;
};

struct hide_parameter {
    char name[2 * HIDE_NAME];
    double lower, upper, start, truth;
};

struct hide_rotor {
    int materials, groups, shafts, segments, ties, disks, springs, sensors, parameters;
    double length, sling; /* sling: 0 where there is none; groups: first the shafts, end to end, then the layers */
    struct hide_material material[HIDE_MOST_GROUPS];
    struct hide_group group[HIDE_MOST_GROUPS];
    struct hide_segment segment[HIDE_MOST_SEGMENTS];
    struct hide_tie tie[HIDE_MOST_TIES];
    struct hide_disk disk[HIDE_MOST_ATTACHED];
    struct hide_spring spring[HIDE_MOST_ATTACHED];
    struct hide_sensor sensor[HIDE_MOST_SENSORS];
    struct hide_parameter parameter[HIDE_MOST_PARAMETERS];
};

/* rotor has been set to zero. */
int hide_rotor_read(const struct hide_cards *cards, const char *name, struct hide_rotor *rotor,
                    const struct hide_message *message);

/* Metres, start, end, GROUP.start, GROUP.end. Nonzero if it lies inside the rotor. */
int hide_position(const struct hide_rotor *rotor, const char *text, double *z);

/* By name; -1 where there is none. A spring or a disk is also found by its number from 1. */
int hide_find_group(const struct hide_rotor *rotor, const char *name);
int hide_find_tie(const struct hide_rotor *rotor, const char *name);
int hide_find_spring(const struct hide_rotor *rotor, const char *name);
int hide_find_disk(const struct hide_rotor *rotor, const char *name);
int hide_find_sensor(const struct hide_rotor *rotor, long id);

double hide_shear_modulus(const struct hide_material *material);

#endif
