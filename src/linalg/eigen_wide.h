/* Eigenpairs of wide bands, the inner part of eigen_full: block Lanczos iteration. */
#ifndef ROTID_LINALG_EIGEN_WIDE_H
#define ROTID_LINALG_EIGEN_WIDE_H

#include "base/random.h"
#include "linalg/factor.h"

struct eigen_wide {
    int n, count, block, most;
    int started;       /* ritz holds the pairs of the call before */
    int definite;      /* M of the call before was positive definite */
    int size, next;    /* columns of the basis that were multiplied, and of the block behind them that were not */
    int last, outside; /* columns that were multiplied last, and columns of R below */
    struct random_stream stream;
    double shift, largest; /* largest K_ii/M_ii: the size of the highest eigenvalue */
    int *all;              /* [n] 0 ... n - 1: no row is left out */
    struct pencil pencil;
    struct factor factor;                   /* of K - shift M; in between of M and for the Sturm count */
    double *basis, *mass_basis;             /* [n * (most + 2 block)] V with V' M V = 1, and M V */
    double *ritz, *image;                   /* [n * block] the current vectors, kept for the next call; workspace */
    double *projected, *vector, *component; /* [most^2] V' M (K - shift M)^-1 M V, upper triangle; its vectors; workspace */
    double *value;                          /* [block] ascending */
    double *theta;                          /* [most] largest eigenvalues of `projected` */
    int *iwork;                             /* [12 most] */
    double *remainder; /* [4 block^2] R: what (K - shift M)^-1 M makes of the last columns beyond them is Q R */
    double *work;      /* [34 most] */
};

/* For the lowest `count` pairs of matrices structured as `structure`, a wide one. ROTID_OK or ROTID_ERROR_MEMORY. */
int eigen_wide_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_wide *e);

/* Block Lanczos iteration with (K - s M)^-1 M, s < 0, in the inner product of M, every block orthogonal to all before it; from
 * the vectors of the call before, or from random ones with a first shift that finds a better one. A Sturm count at the end proves
 * that none was missed. K positive semidefinite, M positive definite. lambda [count], phi [n * count]. ROTID_OK,
 * ROTID_ERROR_STIFFNESS, ROTID_ERROR_MASS or ROTID_ERROR_EIGEN. */
int eigen_wide_solve(struct eigen_wide *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi);

#endif
