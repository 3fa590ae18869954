/* The two dense kernels of a least-squares fit. */
#ifndef ROTID_LINALG_LEAST_SQUARES_H
#define ROTID_LINALG_LEAST_SQUARES_H

#include <stddef.h>

/* |D h|, D = diag(scale [n]), NULL: 1; of any size that has a double, as its square may not. NaN where a component is. */
double least_squares_length(int n, const double *scale, const double *h);

size_t least_squares_workspace(int m, int n);

/* h [n]: min |J h + r|^2 + mu |D h|^2 + |F h|^2, D = diag(scale), F = diag(floor), by QR of the three on top of each other, which
 * must leave no h free. mu > 0 is raised where h would be longer than |D h| = radius > 0, to where it is not by more than a tenth
 * (Newton's iteration on 1/|D h|: Hebden 1973, More 1978); *length of the step that is returned. J [m * n], r [m] are kept. work
 * [least_squares_workspace(m, n)]. Returns 0, or 1 where the QR meets a zero on its diagonal or something not finite. */
int least_squares_damped_step(int m, int n, const double *jacobian, const double *r, const double *scale, const double *floor,
                              double radius, double *mu, double *h, double *length, double *work);

size_t singular_values_workspace(int m, int n);

/* J [m * n] = U S V': value [n] decreasing (zeros past min(m, n)), direction [n * n] = V. J is kept.
 * work [singular_values_workspace(m, n)]. Returns 0, or 1 without convergence. */
int singular_values(int m, int n, const double *jacobian, double *value, double *direction, double *work);

#endif
