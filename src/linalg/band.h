/* Factors of a narrow band and their solutions, in LAPACK's storage. A beam's band is so narrow that LAPACK, which calls a BLAS
 * routine for every column, would spend its time on calls. Wide bands: wide.h.
 * Right-hand sides are interleaved, b[i * lanes + lane], lanes = 1, 2 or 4: the recurrences of one wait for each other; those
 * of four are one vector. What is computed in a lane does not depend on their number. */
#ifndef ROTID_LINALG_BAND_H
#define ROTID_LINALG_BAND_H

#define BAND_LANES 4 /* most */

/* A = L L', lower triangle A(i, j) = band[(i - j) + j * (kd + 1)], overwritten by L. Returns 0, or 1 when A is not positive
 * definite. */
int band_cholesky(int n, int kd, double *band);
void band_cholesky_solve(int n, int kd, const double *band, int lanes, double *b);

/* P A = L U, A(i, j) = band[2 kd + (i - j) + j * (3 kd + 1)], the first kd rows zero; pivot [n] counts from 1. Returns 0, or 1
 * when A is singular. */
int band_lu(int n, int kd, double *band, int *pivot);
void band_lu_solve(int n, int kd, const double *band, const int *pivot, int lanes, double *b);

/* B := B - X R for B [n], R [count] interleaved, X [n * count] by columns */
void band_subtract(int n, int count, const double *x, int lanes, const double *r, double *b);

/* B [n] interleaved := rows row [n] of `columns` columns X, each of this length; lanes: columns, or 4 for 3. And back. */
void band_gather(int n, const int *row, int columns, int length, const double *x, int lanes, double *b);
void band_scatter(int n, const int *row, int columns, int length, int lanes, const double *b, double *x);

#endif
