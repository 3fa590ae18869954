/* Dense products, column-major. */
#ifndef ROTID_LINALG_PRODUCT_H
#define ROTID_LINALG_PRODUCT_H

/* a' b */
double product_dot(int n, const double *a, const double *b);

/* Column `count` of the basis [n * (count + 1)] is taken orthogonal to those before it, which are orthonormal, twice because once
 * leaves errors of the size of the cancellation, and scaled to length 1. Returns count + 1, or count where no more than the part
 * `least` of it is left. */
int basis_extend(int n, int count, double least, double *basis);

/* C [m * n] := A' B, A [k * m], B [k * n]; all sizes >= 1. */
void product_transposed(int m, int n, int k, const double *a, const double *b, double *c);
/* C [n * n] := A' A, both triangles, A [k * n]; sizes >= 1. Half the work of product_transposed. */
void product_gram(int n, int k, const double *a, double *c);
/* C [m * n] := C - A B, A [m * k], B [k * n]. */
void product_subtract(int m, int n, int k, const double *a, const double *b, double *c);
/* y [m] := part A x, A [m * k], x [k]; nothing where m is 0. */
void product_combine(int m, int k, double part, const double *a, const double *x, double *y);

#endif
