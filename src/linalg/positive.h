/* Dense symmetric positive definite matrices (LAPACK dpotrf, dpotri). */
#ifndef ROTID_LINALG_POSITIVE_H
#define ROTID_LINALG_POSITIVE_H

/* A [n * n], of which the lower triangle is read, is overwritten by A^-1, both triangles; *log_determinant of A. n >= 0. Returns
 * 0, or 1 where A is not positive definite. */
int positive_invert(int n, double *a, double *log_determinant);

#endif
