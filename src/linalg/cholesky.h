/* Real symmetric positive definite systems kept as their Cholesky factor A = L L' (LAPACK dpotrf, dpotrs, dtrtrs). */
#ifndef ROTID_LINALG_CHOLESKY_H
#define ROTID_LINALG_CHOLESKY_H

/* a [n * n], of which the lower triangle is read, is overwritten there by L. n >= 0. Returns 0, or 1 where A is not positive
 * definite. */
int cholesky_factor(int n, double *a);

/* b [n * columns] := A^-1 b */
void cholesky_solve(int n, const double *factor, int columns, double *b);

/* b [n * columns] := L^-1 b */
void cholesky_forward(int n, const double *factor, int columns, double *b);

/* b [m] := L_m^-T b with the leading m * m block of L [n * n], which is the factor of the leading block of A: one factor and one
 * forward substitution serve the systems of all sizes m = 1 ... n. */
void cholesky_backward_leading(int m, int n, const double *factor, double *b);

#endif
