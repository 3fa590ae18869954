/* Eigenpairs of wide bands, the inner part of eigen_full: block Lanczos iteration. */
#ifndef ROTID_LINALG_EIGEN_WIDE_H
#define ROTID_LINALG_EIGEN_WIDE_H

#include "linalg/lanczos.h"

struct eigen_wide {
    int n, count, block;
    int started;           /* ritz holds the pairs of the call before */
    int definite;          /* M of the call before was positive definite */
    double shift, largest; /* largest K_ii/M_ii: the size of the highest eigenvalue */
    int *all;              /* [n] 0 ... n - 1: no row is left out */
    struct pencil pencil;
    struct factor factor; /* of K - shift M; in between of M and for the Sturm count */
    struct lanczos lanczos;
    double *ritz;  /* [n * block] the current vectors, kept for the next call */
    double *value; /* [block] ascending, INFINITY where not known */
};

/* For the lowest `count` pairs of matrices structured as `structure`, a wide one. ROTID_OK or ROTID_ERROR_MEMORY. */
int eigen_wide_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_wide *e);

/* Block Lanczos iteration with (K - s M)^-1 M, s < 0, in the inner product of M, every block orthogonal to all before it; from
 * the vectors of the call before, or from random ones with a first shift that finds a better one. A Sturm count at the end proves
 * that none was missed. K positive semidefinite, M positive definite. lambda [count], phi [n * count]. ROTID_OK,
 * ROTID_ERROR_STIFFNESS, ROTID_ERROR_MASS or ROTID_ERROR_EIGEN. */
int eigen_wide_solve(struct eigen_wide *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi);

/* The next solution begins with phi [n * count], vectors near the lowest pairs, in any scale. */
void eigen_wide_begin(struct eigen_wide *e, const double *phi);

#endif
