/* Eigenpairs of wide bands, the inner part of eigen_full: block Lanczos iteration. */
#ifndef ROTID_LINALG_EIGEN_WIDE_H
#define ROTID_LINALG_EIGEN_WIDE_H

#include "linalg/lanczos.h"

struct eigen_wide {
    int n, count, block;
    int started;           /* ritz holds the pairs of the call before */
    int from, to;          /* pairs from ... to - 1 are wanted to the last digit; the others have to be near alone */
    int vouched, definite; /* M is positive definite, somebody says; that of the call before was */
    double shift, largest; /* largest K_ii/M_ii: the size of the highest eigenvalue */
    int *all;              /* [n] 0 ... n - 1: no row is left out */
    struct pencil pencil;
    struct factor factor; /* of K - shift M; in between of M and for the Sturm count */
    struct lanczos lanczos;
    double *ritz;      /* [n * block] the current vectors, kept for the next call */
    double within;     /* of the residual of a pair that is wanted */
    double *tolerance; /* [block] of that of each pair */
    double *value;     /* [block] ascending, INFINITY where not known */
};

/* For the lowest `count` pairs of matrices structured as `structure`, a wide one. ROTID_OK or ROTID_ERROR_MEMORY. */
int eigen_wide_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_wide *e);

/* Block Lanczos iteration with (K - s M)^-1 M, s < 0, in the inner product of M, every block orthogonal to all before it; from
 * the vectors of the call before, or from random ones with a first shift that finds a better one. A Sturm count at the end proves
 * that none was missed. K positive semidefinite, M positive definite. lambda [count], phi [n * count]. ROTID_OK,
 * ROTID_ERROR_STIFFNESS, ROTID_ERROR_MASS or ROTID_ERROR_EIGEN. */
int eigen_wide_solve(struct eigen_wide *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi);

/* As eigen_band_want; the eigenvalues of the others are then off by the square of 1e-4. */
void eigen_wide_want(struct eigen_wide *e, int from, int to);

/* Vectors off by `residual` at most, and eigenvalues by its square, in place of as good as their arithmetic. */
void eigen_wide_within(struct eigen_wide *e, double residual);

/* M is positive definite for a reason that the caller knows: it is not factored to see that. */
void eigen_wide_vouch(struct eigen_wide *e);

/* The next solution begins with phi [n * count], vectors near the lowest pairs, in any scale. */
void eigen_wide_begin(struct eigen_wide *e, const double *phi);

#endif
