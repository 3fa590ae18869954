/* The Timoshenko element of the paper's annexes: v cubic, theta quadratic, exact for loads at its nodes.
 * Degrees of freedom (v1, theta1, v2, theta2) with theta = -dv/dz where there is no shear. This is the place that states it. */
#ifndef ROTID_BEAM_ELEMENT_H
#define ROTID_BEAM_ELEMENT_H

/* The five quantities an element depends on, and its length. As a direction of differentiation: their derivatives, length 0. */
struct element {
    double ei;    /* N.m2 */
    double kgs;   /* N, shear coefficient times G times area */
    double rhos;  /* kg/m */
    double rhoi;  /* kg.m */
    double force; /* N, tension positive */
    double length;
};

/* k [16] = K_f + K_G (4), m [16] = M_v + M_theta (5) */
void element_matrices(const struct element *element, double *k, double *m);

/* Derivatives of both in the direction d: the sum over the five quantities of partial derivative times d's component. */
void element_derivatives(const struct element *element, const struct element *d, double *dk, double *dm);

#endif
