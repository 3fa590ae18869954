/* Inside of the oracle, shared by its files alone.
 *
 * A system becomes stations and pieces once (oracle_model.c); for every frequency the pieces become members
 * (oracle_member_mesh.c) and these the factored dynamic stiffness (oracle_assembly.c), from which oracle.c takes counts,
 * frequencies and shapes. */
#ifndef ORACLE_MODEL_H
#define ORACLE_MODEL_H

#include "oracle.h"

#define ORACLE_MEMBERS_MAX 1000

/* Position where something changes. Stations 0 .. stations-1 bound the pieces 0 .. stations-2. */
struct oracle_station {
    double z, spring, mass;
    double rotational_spring[2], inertia[2]; /* left and right of the hinge */
    double flexibility;
    int hinged, must_be_node;
    int dof[4]; /* of a node: v, theta left, theta right, moment of the hinge; dof[0] = -1 if it is none */
};

/* Uniform stretch, the whole of a piece or an equal part of it. */
struct oracle_cell {
    const struct oracle_segment *segment;
    double z, length;
    int station; /* at its left end; -1 inside a piece */
    int node;    /* 1 if a node is at its left end, which is where a member starts */
};

/* What lies between two nodes: one or more cells. */
struct oracle_member {
    int cell;   /* its first */
    int mixed;  /* 1 if its forces are unknowns */
    int dof[6]; /* v, theta at the left end, v, theta, Q, M at the right end */
};

struct oracle_model {
    const struct oracle_system *system;
    double length;
    int stations, cells, cell_room, members, member_room, dofs, dof_room;
    struct oracle_station *station;
    int *parallel_station; /* a and b of each parallel member */
    const struct oracle_segment **piece;
    struct oracle_cell *cell;
    struct oracle_member *member;
    double mass;         /* of everything */
    double reference;    /* of the order of the first elastic omega */
    double floor_lambda; /* omega^2 up to which it counts as zero */
    double *matrix, *scale, *vector, *work;
    int *pivot;
};

/* Checks the system and splits the beam at the ends of segments, points and parallel members. Whatever it returns,
 * oracle_model_free. */
int oracle_model_build(const struct oracle_system *system, struct oracle_model *model);
void oracle_model_free(struct oracle_model *model);

/* Members without a clamped resonance below sqrt(lambda), their degrees of freedom, and room for the matrices. */
int oracle_make_members(struct oracle_model *model, double lambda);

/* Factors the scaled D(lambda) with the members as they are; lambda may be negative. Then D x = b is solved by oracle_solve for
 * x[i]/scale[i]; held degrees of freedom have scale 0. log_determinant is that of the scaled matrix. */
int oracle_evaluate(struct oracle_model *model, double lambda, int *negative, double *log_determinant);

void oracle_multiply(const double a[16], const double b[16], double product[16]);

/* Transfer matrix over the member that starts at this cell. */
void oracle_member_transfer(const struct oracle_model *model, int cell, double lambda, double product[16]);

/* Equilibrium of a station inside a member: Q and M jump by jump[0] v and jump[1] theta. */
void oracle_station_jump(const struct oracle_station *station, double lambda, double jump[2]);

#endif
