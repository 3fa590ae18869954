/* Derivatives of eigenvectors: (K - lambda M) dphi = P, phi' M dphi = Q (34, 35), for phi' M phi = 1,
 *   P = -(dK - dlambda M - lambda dM) phi,  Q = -1/2 phi' dM phi.
 * Nelson (1976): leave out the row and column where phi is largest, solve for V, dphi = V + c phi, c = Q - phi' M V.
 * Modal superposition (37, 38 corrected): V = sum over j != k of phi_j (phi_j' P)/(lambda_j - lambda_k), needing every vector.
 *
 * Pairs whose eigenvalues are close form a cluster C. Its subspace has a derivative that is well conditioned; the vectors turn in
 * it by (phi_j' P)/(lambda_j - lambda_k), which says nothing beyond steps of the relative distance. So they are taken not to
 * turn: dphi = V + sum over j in C of q_j phi_j,  phi_j' M V = 0,  q_j = -1/2 phi_j' dM phi, where V solves with P less its part
 * in C, and as many rows and columns are left out as C has members. The derivative of sum over C of phi phi', and with it that of
 * the subspace, is exact; a cluster of one is Nelson's method. */
#ifndef ROTID_MODAL_EIGENVECTOR_DERIVATIVE_H
#define ROTID_MODAL_EIGENVECTOR_DERIVATIVE_H

#include "base/pool.h"
#include "linalg/factor.h"
#include "linalg/symmetric.h"
#include "rotid.h"

/* Eigenvalues nearer than this part of themselves have vectors that a change of parameter can turn at will. */
#define CLOSE_EIGENVALUES 1e-6
#define CLUSTER_MOST      8 /* pairs */
/* Where a cluster has further members, behind the pairs that are known or beyond CLUSTER_MOST, V is the mean of the solutions for
 * lambda (1 - BESIDE) and lambda (1 + BESIDE), prepared with no row left out (members = 0): of a pair at a distance of d it has
 * d/(d^2 - (lambda BESIDE)^2), which is 1/d but for (lambda BESIDE/d)^2, and nothing of those that are equal. */
#define BESIDE 3e-5

/* The cluster of pair k: neighbours in a row, each that near to the next. Returns how many, 1 where k stands alone; *first: the
 * lowest. */
int eigenvalue_cluster(int count, const double *lambda, int k, int *first);

/* P [n] and *q from M phi, dK phi and dM phi [n]. Returns dlambda = phi' (dK - lambda dM) phi. */
double nelson_right_side(int n, double lambda, const double *phi, const double *m_phi, const double *dk_phi, const double *dm_phi,
                         double *p, double *q);

/* In what follows phi and m_phi [n * members] are the vectors of the cluster and M times them, q [members] the components of dphi
 * along them: q_j = phi_j' M dphi. A preparation is for one mode of it, with eigenvalue lambda. Where a pair that is none of the
 * members makes the matrix singular, it is prepared for an eigenvalue beside; ROTID_ERROR_CLOSE where that is no better. */

struct nelson_rows {
    int count;
    int left_out[CLUSTER_MOST]; /* [count] where the vectors differ most, increasing */
    int *kept;                  /* [n] the others */
    double *pivot;              /* [n * CLUSTER_MOST] */
};

/* ---- dense: the condensed problem */

struct nelson_dense {
    int n;
    struct nelson_rows rows;
    struct symmetric factor;
};

int nelson_dense_new(struct pool *pool, int n, struct nelson_dense *d);
int nelson_dense_prepare(struct nelson_dense *d, const double *k, const double *m, double lambda, int members, const double *phi);
/* dphi [n] from P [n] (kept). */
void nelson_dense_solve(struct nelson_dense *d, int members, const double *phi, const double *m_phi, const double *p,
                        const double *q, double *dphi);

/* Number of eigenvalues below `lambda`; a factor that was prepared is lost. */
int nelson_dense_below(struct nelson_dense *d, const double *k, const double *m, double lambda);

/* All n pairs: lambda [n], phi [n * n]; of pair k, whose cluster begins at `first`. m_phi: of the members. */
void modal_superposition(int n, const double *lambda, const double *phi, int k, int first, int members, const double *m_phi,
                         const double *p, const double *q, double *dphi);

/* ---- banded: the full chain */

struct nelson_band {
    int n;
    struct nelson_rows rows;
    const rotid_matrix *k, *m; /* of nelson_band_begin */
    double lambda;             /* of nelson_band_prepare */
    rotid_matrix shifted;      /* of narrow bands: K - lambda M */
    struct pencil pencil;      /* of wide ones: K and M */
    struct factor factor, inertia;
    int *all;                   /* [n] */
    double *residual, *shorter; /* [n * most] */
};

/* For at most `most` right-hand sides at once. */
int nelson_band_new(struct pool *pool, const rotid_matrix *structure, int most, struct nelson_band *b);
/* In what follows K and M are these, which must stay as they are. */
void nelson_band_begin(struct nelson_band *b, const rotid_matrix *k, const rotid_matrix *m);
/* Y [n * columns] := M X */
void nelson_band_multiply_mass(struct nelson_band *b, int columns, const double *x, double *y);
/* A factor that was prepared is lost. */
int nelson_band_below(struct nelson_band *b, double lambda);
int nelson_band_prepare(struct nelson_band *b, double lambda, int members, const double *phi);
/* dphi [n * columns] from P [n * columns] (kept), q [members * columns]. A P that has a part in the cluster loses it: the columns
 * of (K - lambda M)^+ come from unit vectors and q = 0. */
void nelson_band_solve(struct nelson_band *b, int columns, int members, const double *phi, const double *m_phi, const double *p,
                       const double *q, double *dphi);

#endif
