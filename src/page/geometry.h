/* "geometry" of a result: the model as it is drawn and meshed. Positions and lengths in m. */
#ifndef ROTID_PAGE_GEOMETRY_H
#define ROTID_PAGE_GEOMETRY_H

#include "result/place.h"

struct drawn_material {
    const char *name;
    double e, g, nu, rho; /* Pa, Pa, 1, kg/m3 */
};

struct drawn_segment {
    int group, elements;
    double from, to;
    double outer, inner; /* diameters; of a rectangle its height in the bending plane, 0 */
    double stiff_outer;  /* diameter that carries stiffness, NaN where that is the whole */
};

struct drawn_group {
    const char *name;
    double from, to;
    struct drawn_material material;
    double hole_pitch; /* radius of the circle of axial holes, NaN: none */
};

struct drawn_bundle { /* tie rods, or bars */
    const char *name;
    int is_bars, number;
    double from, to, diameter, pitch; /* pitch radius */
};

struct drawn_point { /* a disk, spring or sensor */
    const char *name;
    double z, value, rotational; /* kg; N/m and N.m/rad; id of the sensor */
};

struct drawn_cause {
    const char *name, *id, *target;
    double z; /* m, NaN where it has no place */
};

struct geometry {
    double length;
    int ngroup, nsegment, nbundle, ndisk, nspring, nsensor, ncause, nnode;
    struct drawn_group *group;
    struct drawn_segment *segment; /* along the axis */
    struct drawn_bundle *bundle;
    struct drawn_point *disk, *spring, *sensor;
    struct drawn_cause *cause;
    double *node_z; /* [nnode] of the mesh of the axis */
};

/* The object under "geometry" of `above`, NULL where it is not there or wrong: reader->status tells. */
struct geometry *geometry_read(const struct json_place *above);

/* Largest radius; and that of the segment around z (the larger one where two meet). */
double geometry_radius(const struct geometry *geometry);
double geometry_radius_at(const struct geometry *geometry, double z);
/* Whether a parameter called "NAME.E" or the like is one of this group. */
int geometry_is_of(const struct drawn_group *group, const char *parameter);
/* Elements along the axis. */
int geometry_elements(const struct geometry *geometry);

#endif
