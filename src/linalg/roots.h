/* Roots of a real polynomial, as eigenvalues of its companion matrix (LAPACK dgebal, dhseqr). */
#ifndef ROTID_LINALG_ROOTS_H
#define ROTID_LINALG_ROOTS_H

#include <stddef.h>

#include "base/complex.h"

size_t polynomial_roots_workspace(int n); /* doubles */

/* root [n] of x^n + c[0] x^(n-1) + ... + c[n-1], n >= 1; work [polynomial_roots_workspace(n)]. Returns 0, or 1 where a
 * coefficient is not finite or the iteration did not converge. */
int polynomial_roots(int n, const double *c, double complex *root, double *work);

#endif
