/* Dense products, column-major. */
#ifndef ROTID_LINALG_PRODUCT_H
#define ROTID_LINALG_PRODUCT_H

/* C [m * n] := A' B, A [k * m], B [k * n]; all sizes >= 1. */
void product_transposed(int m, int n, int k, const double *a, const double *b, double *c);
/* C [m * n] := C - A B, A [m * k], B [k * n]. */
void product_subtract(int m, int n, int k, const double *a, const double *b, double *c);

#endif
