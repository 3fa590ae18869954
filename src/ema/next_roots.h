/* Roots of the polynomial of an order from those of the order before: an order of a stabilisation table after the other. */
#ifndef ROTID_EMA_NEXT_ROOTS_H
#define ROTID_EMA_NEXT_ROOTS_H

#include "base/complex.h"

/* root [n] of x^n + c[0] x^(n-1) + ... + c[n-1] by Ehrlich's and Aberth's iteration (Aberth 1973), which takes n^2 operations a
 * step where the eigenvalues of the companion matrix take n^3. It begins with `before` [n - 2], roots of the polynomial of the
 * order before, and a pair in the largest gap. Real roots come out real, others as conjugate pairs. Returns 0, or 1 where that
 * was not reached: the roots are then to be had as eigenvalues. done [n] and angle [n] are workspace. */
int next_roots(int n, const double *c, const double complex *before, double complex *root, int *done, double *angle);

#endif
