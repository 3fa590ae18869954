/* The mesh of a rotor: nodes along the axis, then the inner nodes of rods and bars; degrees of freedom 2 i (v) and 2 i + 1
 * (theta). */
#ifndef ROTID_BEAM_MESH_H
#define ROTID_BEAM_MESH_H

#include "base/pool.h"
#include "rotor/rotor.h"

struct chain {               /* a run of elements whose inner nodes are numbered in a row */
    int first_end, last_end; /* nodes it joins; last_end -1: free, its last node is an inner one */
    int inner, count;        /* first inner node, their number */
};

struct mesh {
    int naxis;                    /* nodes on the axis */
    double *z;                    /* [naxis] */
    int nelement;                 /* on the axis: between nodes e and e + 1 */
    int *segment;                 /* [nelement] */
    int nnode;                    /* all of them */
    int ndof, kd;                 /* 2 nnode, 3 */
    int nfar, *far;               /* degrees of freedom where members meet across the band */
    struct chain *tierod;         /* [rotor->ntierod] */
    struct chain *bars;           /* [2 * rotor->nbars]: left and right half */
    int *spring_node, *disk_node; /* [nspring], [ndisk] */
    int *sensor_node;             /* [nsensor], not decreasing */
    int end_node;
};

/* A node at every end of a segment and of a hub, sensor, spring, disk, tie-rod end and bar centre; a node nearer than 1 % of the
 * element there is taken instead of a new one (coordinates of test files carry six digits, and a sliver of an element ruins the
 * conditioning). Then each element is cut into `refine` equal parts. ROTID_OK or ROTID_ERROR_MEMORY. */
int mesh_build(struct pool *pool, const struct rotor *rotor, int refine, struct mesh *mesh);

/* The node on the axis nearest to z. */
int mesh_node_at(const struct mesh *mesh, double z);

/* Elements of a chain, and its i-th node from the end where it begins, 0 <= i <= elements. */
int chain_elements(const struct chain *chain);
int chain_node(const struct chain *chain, int i);

#endif
