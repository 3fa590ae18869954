/* The meridian of a rotor as a mesh of eight-node quadrilaterals, and what its nodes do in bending: u_r = U cos t, u_t = V sin t,
 * u_z = W cos t. Nodes lie on lines of constant z, the ends of a slice, and half-way between; degrees of freedom are numbered
 * line by line, so that the band is as wide as two lines and what lies between them.
 *
 * On the axis V = -U and W = 0. A re-entrant corner of the outline is a singularity like a crack's, of exponent 0.545: the
 * half-way nodes of the edges that meet there lie at a quarter of their length, by which an element follows a square root. */
#ifndef ROTID_SOLID_MESH_H
#define ROTID_SOLID_MESH_H

#include "base/pool.h"
#include "rotor/rotor.h"

#define SOLID_NODES 8 /* of an element: four corners from (inner, left) by (outer, left), then the edges between */
#define SOLID_DOFS  (3 * SOLID_NODES) /* U, V, W of each */

/* How fine. What is 0 follows from the rotor. */
struct solid_rule {
    double corner;  /* m: elements at a re-entrant corner */
    double largest; /* m */
    int straight;   /* nonzero: edges at a corner keep their half-way nodes half-way */
};

struct solid_node {
    double r, z;
    int dof[3]; /* of U, V, W; -1: none. On the axis V has that of U, and the sign is -1 */
};

struct solid_element {
    int node[SOLID_NODES];
    int slice, segment, group; /* group: that of the material */
    double share;              /* of its volume that is not holes */
    double extra;              /* m2: cross section outside the stiffness diameter, which has mass only, on the outer edge */
    int sensor;                /* that U of node 5, half-way along the outer edge, stands for, or -1: see solid_mesh.sensor_dof */
    double at_sensor[3];       /* share of the nodes 1, 5, 2 in the motion of the sensor */
};

struct solid_mesh {
    int nslice;
    double *z;    /* [nslice + 1] lines */
    int *segment; /* [nslice] */
    int *first;   /* [nslice + 1] first element of a slice */
    int nnode;
    struct solid_node *node; /* line by line, from the axis outwards */
    int *line;               /* [2 nslice + 2] first node of each line: 2 i is line i, 2 i + 1 half-way to the next */
    int *surface;            /* [2 nslice + 1] node at the surface of each */
    double *surface_z;       /* [2 nslice + 1] m: what U of that node is the motion of */
    int nelement;
    struct solid_element *element;
    int *sensor_dof; /* [nsensor] the motion of the surface at the sensor is an unknown itself */
    int *member_dof; /* [nmember * (nslice + 1)]: solid_mesh_member_dof */
    int ndof, kd;
};

#define SOLID_MOST_SLENDER                                                                                                       \
    (1000 * (1 + 1e-9))            /* length over largest diameter: rounding of K leaves 1e-4 of the first frequency */
#define SOLID_MOST_UNKNOWNS 200000 /* of the mesh that is not refined: some gigabytes of K and M */

/* ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_SECTION with the group in *failed where holes leave nothing, a group is
 * rectangular or its first section does not touch the one before; groups, tie rods and bars together where the mesh has too many
 * unknowns or the rotor is too slender. refine >= 1 divides the size of the elements at corners, and by its root the largest; 0:
 * the coarse mesh, with corners six times as large and across the largest twice. */
int solid_mesh_build(struct pool *pool, const struct rotor *rotor, const struct solid_rule *rule, int refine,
                     struct solid_mesh *mesh, int *failed);

/* Whether member i moves with the section on all of its lines: tie rods of one element, which lie in the holes of what they press
 * together. More elements bend by themselves between their ends. */
int solid_mesh_follows(const struct rotor *rotor, int i);

/* The line nearest to z. */
int solid_mesh_line(const struct solid_mesh *mesh, double z);

/* Where member i (tie rods, then bars) begins and ends: lines. */
void solid_mesh_member(const struct rotor *rotor, const struct solid_mesh *mesh, int i, int *from, int *to);

/* The degree of freedom of v of a member on a line, theta following it; -1 where it moves with the rotor or has ended. */
int *solid_mesh_member_dof(const struct solid_mesh *mesh, int member, int line);

/* The slice that holds z, and its outermost element. */
int solid_mesh_slice(const struct solid_mesh *mesh, double z);
int solid_mesh_outermost(const struct solid_mesh *mesh, int slice);

#endif
