/* Eigenpairs of K phi = lambda M phi, phi' M phi = 1, lambda ascending. */
#ifndef ROTID_LINALG_EIGEN_H
#define ROTID_LINALG_EIGEN_H

#include "base/pool.h"
#include "linalg/arrow.h"
#include "linalg/eigen_wide.h"
#include "linalg/factor.h"
#include "rotid.h"

/* ---- dense: the condensed problem (LAPACK dsygvx, dsygvd), solved as M phi = mu (K - s M) phi with a shift s < 0: rounding is
 * then relative to the lowest eigenvalues, which are the ones that are wanted, instead of to the highest */

struct eigen_dense {
    int n, count;
    double shift; /* of the size of the eigenvalues found last, 0 before */
    double *a, *b, *values, *vectors, *work;
    int *iwork, *ifail, lwork, liwork;
};

/* For the lowest `count` of n pairs. ROTID_OK or ROTID_ERROR_MEMORY. */
int eigen_dense_new(struct pool *pool, int n, int count, struct eigen_dense *e);

/* k, m [n * n] are kept. lambda [count], phi [n * count]. ROTID_OK, ROTID_ERROR_MASS, ROTID_ERROR_STIFFNESS or ROTID_ERROR_EIGEN.
 */
int eigen_dense_solve(struct eigen_dense *e, const double *k, const double *m, double *lambda, double *phi);

/* y [n * columns] := (K - s M)^-1 y with the matrices and the shift of the last eigen_dense_solve */
void eigen_dense_inverse(struct eigen_dense *e, int columns, double *y);

/* ---- banded: the full chain, in O(n) */

struct eigen_band {
    int n, count, block, depth;
    int from, to;          /* pairs from ... to - 1 are polished; the others have to be near alone */
    int started;           /* ritz holds the pairs of the call before */
    double within;         /* of the residual of a pair that is polished */
    int plain;             /* without polishing, in this attempt */
    int failures;          /* of polishing from a cold start */
    int known;             /* Ritz values in `value`: count, or with the guards of the block iteration block */
    double shift, largest; /* largest K_ii/M_ii: the size of the highest eigenvalue */
    struct factor factor, inertia, indefinite;
    int by_arrow; /* K - lambda M is factored as an arrow, which is quicker where few are far */
    int *row;     /* [n] of it */
    double *rows; /* [n * ARROW_SHIFTS] */
    struct arrow arrow;
    int *all; /* [n] 0 ... n - 1: no row is left out */
    rotid_matrix shifted;
    double *basis;      /* [n * block * depth], M-orthonormal */
    double *mass_basis; /* M basis */
    double *ritz;       /* [n * block] the current pairs, kept for the next call */
    double *image;      /* [n * block] (K - shift M)^-1 M ritz */
    double *value;      /* [block * depth] */
    double *residual;   /* [block] */
    double *shifts;     /* [3 count] workspace of eigen_polish */
    double *projected;  /* [(block * depth)^2] */
    double *work;       /* [max(2 n, 3 block depth)] */
};

/* For the lowest `count` pairs of matrices structured as `structure`. ROTID_OK or ROTID_ERROR_MEMORY. */
int eigen_band_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_band *e);

/* Near pairs, of the call before or by block Krylov iteration on (K - s M)^-1 M with a shift s < 0 and Rayleigh-Ritz on K; then
 * inverse iteration with a shift for each (eigen_polish.h), or where that fails the block iteration to the end. A Sturm count at
 * the end proves that none was missed. K positive semidefinite, M positive definite. lambda [count], phi [n * count]. ROTID_OK,
 * ROTID_ERROR_STIFFNESS, ROTID_ERROR_MASS or ROTID_ERROR_EIGEN. */
int eigen_band_solve(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi);

/* Only pairs from ... to - 1 of the count are wanted to the last digit; the others may be off by a part in a hundred of their
 * length, and by the square of that in lambda. None is missed all the same. */
void eigen_band_want(struct eigen_band *e, int from, int to);

/* As eigen_wide_within. */
void eigen_band_within(struct eigen_band *e, double residual);

/* The next solution begins with phi [n * count], vectors near the lowest pairs, in any scale. */
void eigen_band_begin(struct eigen_band *e, const double *phi);

/* ---- whichever is the fastest one: dense, of narrow bands, of wide ones (eigen_wide.h), on the matrices of the full model */

struct eigen_full {
    int dense;
    int wide;
    struct eigen_band band;
    struct eigen_wide panels;
    struct eigen_dense solver;
    double *k, *m; /* [n * n] dense copies */
    double *image, *product, *squares, *work;
};

/* For the lowest `count` pairs of matrices structured as `structure`. ROTID_OK or ROTID_ERROR_MEMORY. */
int eigen_full_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_full *e);
/* The dense one in any case. */
int eigen_full_new_dense(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_full *e);

/* As eigen_band_want, where that makes a difference. */
void eigen_full_want(struct eigen_full *e, int from, int to);

/* As eigen_wide_within and eigen_wide_vouch, where that makes a difference. */
void eigen_full_within(struct eigen_full *e, double residual);
void eigen_full_vouch(struct eigen_full *e);

/* The next solution begins with phi [n * count], vectors near the lowest pairs, in any scale; the dense solver needs none. */
void eigen_full_begin(struct eigen_full *e, const double *phi);

/* As eigen_band_solve. The dense solver is followed by one step of inverse iteration and Rayleigh-Ritz with K and M as they are:
 * the reduction to standard form costs the lowest pairs of a fine mesh some digits. */
int eigen_full_solve(struct eigen_full *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi);

#endif
