/* Dense twins of src/linalg for tests: the definitions spelled out and LAPACK's own drivers, slow and independent. Matrices are
 * column-major; what is returned lives in the pool. */
#ifndef ROTID_TESTS_DENSE_H
#define ROTID_TESTS_DENSE_H

#include "support.h"

/* [count] zeros; the test fails when memory is out. */
double *numbers(struct pool *pool, ptrdiff_t count);

double *random_numbers(struct pool *pool, struct random_stream *stream, ptrdiff_t count);

/* A random positive definite matrix of the structure: sums of g g' over windows of the band and over the block, and `floor` I. */
void random_positive(struct pool *pool, struct random_stream *stream, int n, int kd, int nfar, const int *far, double floor,
                     rotid_matrix *a);

/* A as rotid.h defines it: band plus block. */
double *dense_of(struct pool *pool, const rotid_matrix *a);

/* A(row, column) for the rows [nrow] and columns [ncolumn] listed. */
double *dense_part(struct pool *pool, int n, const double *a, int nrow, const int *row, int ncolumn, const int *column);

/* A [rows * inner] B [inner * columns], and A [inner * rows]' B. */
double *dense_product(struct pool *pool, int rows, int inner, int columns, const double *a, const double *b);
double *dense_transposed_product(struct pool *pool, int rows, int inner, int columns, const double *a, const double *b);

/* A^-1 B by dgesv. */
double *dense_solution(struct pool *pool, int n, int columns, const double *a, const double *b);

/* All pairs of K phi = lambda M phi, ascending, phi' M phi = 1, by dsygv on M phi = mu (K - shift M) phi: in the usual form the
 * error of the lowest eigenvalue of a beam is eps times its highest. K - shift M must be positive definite. */
void dense_pairs(struct pool *pool, int n, const double *k, const double *m, double shift, double *lambda, double *phi);

/* Largest sum of absolute values over the columns. */
double dense_norm(int rows, int columns, const double *a);

/* T of (12), [n * nc], and of IRS = Psi + S M Psi Mg^-1 Kg, by dgesv on the partitions; slaves are all that are not masters. */
double *dense_guyan(struct pool *pool, int n, const double *k, int nc, const int *master);
double *dense_irs(struct pool *pool, int n, const double *k, const double *m, int nc, const int *master);
/* T' A T */
double *dense_congruence(struct pool *pool, int n, int nc, const double *a, const double *t);

#endif
