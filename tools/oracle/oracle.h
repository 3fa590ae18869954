/* Exact natural frequencies and shapes of a stepped Timoshenko beam: the truth that tests compare with. It shares no code with
 * librotid.
 *
 * The beam lies along z from 0; v is the lateral deflection and theta the rotation of the section, theta = -dv/dz where shear is
 * negligible. With the time factor removed and lambda = omega^2, the motion makes
 *
 *     1/2 int [ EI theta'^2 + kGS (v' + theta)^2 + F v'^2 - lambda (rhoS v^2 + rhoI theta^2) ] dz
 *
 * plus the energies of the points and of the parallel members stationary. F is the axial force, tension positive, which acts on
 * v' (Engesser). No mesh error is involved: between two nodes the differential equation is solved exactly (oracle_transfer), and
 * the natural frequencies below omega are counted by the theorem of Wittrick and Williams (Q. J. Mech. Appl. Math. 24, 1971).
 *
 * SI units and 0-based arrays. Every routine returns 0 or a negative ORACLE_ERROR, keeps no state and prints nothing. */
#ifndef ORACLE_H
#define ORACLE_H

enum {
    ORACLE_OK = 0,
    ORACLE_ERROR_ARGUMENT = -1, /* a size, pointer or property out of its range */
    ORACLE_ERROR_MEMORY = -2,
    ORACLE_ERROR_UNSTABLE = -3, /* the axial forces or negative springs buckle the system: some omega^2 is negative */
    ORACLE_ERROR_RANGE = -4,    /* the frequency is so high that it would take more than 1000 members */
    ORACLE_ERROR_SHAPE = -5     /* the shape vanishes at every point asked for, so it cannot be scaled */
};

/* Sides of a joint; elsewhere both mean the same. */
enum { ORACLE_LEFT = 0, ORACLE_RIGHT = 1 };

/* Uniform stretch of the beam; the segments are laid end to end from z = 0. length, bending, shear, mass > 0, inertia >= 0,
 * shear + axial > 0. shear may be INFINITY, which with inertia = 0 gives the Euler-Bernoulli beam. */
struct oracle_segment {
    double length;  /* m */
    double bending; /* EI [N.m2] */
    double shear;   /* kGS [N] */
    double mass;    /* rhoS [kg/m] */
    double inertia; /* rhoI [kg.m] */
    double axial;   /* F [N], tension positive */
};

/* What sits at one position; members left at zero are absent. Several points may share a position and add up. Positions closer
 * than 1e-9 of the beam length to one another or to the end of a segment are taken as the same. */
struct oracle_point {
    double z;                 /* m, from 0 to the length of the beam */
    double spring;            /* lateral, to the ground [N/m]; INFINITY holds v = 0 */
    double rotational_spring; /* to the ground [N.m/rad]; INFINITY holds theta = 0 */
    double mass;              /* kg, >= 0 */
    double inertia;           /* diametral [kg.m2], >= 0 */
    double flexibility;       /* of a hinge between the left and the right side of z [rad/(N.m)], >= 0; INFINITY is a free hinge.
                                 v and the shear force are continuous. Only inside the beam. */
    int side;                 /* ORACLE_LEFT or ORACLE_RIGHT of a hinge at z: where rotational_spring and inertia hold on */
};

/* Member without inner degrees of freedom between two positions of the beam, such as a bundle of tie rods: symmetric stiffness
 * and mass matrices on (v_a, theta_a, v_b, theta_b). */
struct oracle_parallel {
    double z_a, z_b;
    int side_a, side_b; /* of a hinge at z_a and z_b */
    double stiffness[16];
    double mass[16];
};

/* The system belongs to the caller; nothing in it is changed. Arrays of size 0 may be NULL. */
struct oracle_system {
    int segments;
    const struct oracle_segment *segment;
    int points;
    const struct oracle_point *point;
    int parallels;
    const struct oracle_parallel *parallel;
};

/* count: number of natural frequencies below omega [rad/s], > 0; those of rigid bodies, which are zero, count. */
int oracle_count(const struct oracle_system *system, double omega, int *count);

/* frequency_hz[0..number-1]: natural frequencies first, first + 1, ..., counted from 1 for the lowest, in ascending order,
 * repeated ones as often as they occur. The search ends at a relative 1e-13; rounding adds less than 1e-12 as a rule, but with
 * parallel members about 1e-16 times the ratio of their stiffness to that of soft springs. The modes of a free rigid body come
 * first and are reported as 0: zero means that omega^2 is below 1e-12 times 1/(m (L^3/EI + L/kGS)), with the mean EI and kGS, the
 * whole mass m and length L, or below 1e-13 of the stiffness of the parallel members over m, whose rounding decides there. */
int oracle_frequencies(const struct oracle_system *system, int first, int number, double *frequency_hz);

/* Shape of the mode at frequency_hz, which oracle_frequencies has found, at z[0..points-1] (any order, 0 to the length of the
 * beam). The largest |deflection| of these points is +1; rotation has the same factor and may be NULL. At a hinge rotation is the
 * left one. Of a repeated frequency it gives one shape out of the possible ones; at 0, some motion of the rigid bodies. */
int oracle_shape(const struct oracle_system *system, double frequency_hz, int points, const double *z, double *deflection,
                 double *rotation);

/* ---- Builders ---- */

/* N slender rods parallel to the axis, evenly spaced on a circle, that hold on to the beam at both ends. */
struct oracle_tie {
    int count;           /* N >= 3 */
    double diameter;     /* of one rod [m] */
    double pitch_radius; /* of the circle through their axes [m] */
    double length;       /* m */
    double young;        /* Pa */
    double poisson;
    double density; /* kg/m3 */
    double tension; /* of one rod [N] */
};

/* Shear coefficient of a circular section after Cowper; ratio = inner over outer diameter, 0 for a full one. */
double oracle_cowper(double poisson, double ratio);

/* Segment with an annular section; inner_diameter may be 0. kGS takes oracle_cowper(poisson) and the shear modulus as given. */
int oracle_round_segment(double length, double outer_diameter, double inner_diameter, double young, double shear_modulus,
                         double poisson, double density, double axial, struct oracle_segment *segment);

/* Stiffness and mass of one finite element with the properties of segment: the energies above integrated with the deflection and
 * rotation that the unloaded beam takes under end displacements (v cubic, theta quadratic). */
int oracle_beam_element(const struct oracle_segment *segment, double stiffness[16], double mass[16]);

/* Rods as rods: stretching through the relative rotation of the ends, and the N rods' own small bending as one finite element. */
int oracle_tie_rods(const struct oracle_tie *tie, double stiffness[16], double mass[16]);

/* Rods as the wall of the tube of equal area S and second moment I, one finite element. It has a hole only if I > S^2/(4 pi). */
int oracle_tie_tube(const struct oracle_tie *tie, double stiffness[16], double mass[16]);

/* ---- Building blocks: matrices are row-major ---- */

/* Transfer matrix of the state (v, theta, Q, M) over length (>= 0) of a uniform stretch at lambda = omega^2; segment->length is
 * not used. Q = kGS (v' + theta) + F v' and M = EI theta' are what the part to the right exerts on the part to the left. */
void oracle_transfer(const struct oracle_segment *segment, double length, double lambda, double transfer[16]);

/* Dynamic stiffness on (v1, theta1, v2, theta2) of a member with this transfer matrix; fails if the member resonates with both
 * ends clamped. */
int oracle_dynamic_stiffness(const double transfer[16], double stiffness[16]);

/* Another form of it on (v1, theta1, v2, theta2, Q2, M2): a symmetric matrix whose last two rows say, set to zero, what v2 and
 * theta2 are, the others being the end forces. It stays accurate for short members, whose stiffness is far above their inertia
 * forces. Eliminating Q2 and M2 gives the dynamic stiffness. Fails at a resonance with end 1 clamped and end 2 free. */
int oracle_mixed_member(const double transfer[16], double matrix[36]);

/* Symmetric indefinite P A P' = L D L' after Bunch and Kaufman. a: n by n, lower triangle used and overwritten by L and D;
 * pivot[n]. negative: number of negative eigenvalues of A. log_determinant: of |det A|. A pivot that is exactly zero becomes
 * DBL_EPSILON, so the entries of A should be of order one. */
void oracle_factor(int n, double *a, int *pivot, int *negative, double *log_determinant);

/* Solves A x = b in place with the factors; work[n]. */
void oracle_solve(int n, const double *a, const int *pivot, double *x, double *work);

#endif
