/* Derivatives of eigenvectors: (K - lambda M) dphi = P, phi' M dphi = Q (34, 35), for phi' M phi = 1,
 *   P = -(dK - dlambda M - lambda dM) phi,  Q = -1/2 phi' dM phi.
 * Nelson (1976): leave out the row and column where phi is largest, solve for V, dphi = V + c phi, c = Q - phi' M V.
 * Modal superposition (37, 38 corrected): V = sum over j != k of phi_j (phi_j' P)/(lambda_j - lambda_k), needing every vector. */
#ifndef ROTID_MODAL_EIGENVECTOR_DERIVATIVE_H
#define ROTID_MODAL_EIGENVECTOR_DERIVATIVE_H

#include "base/pool.h"
#include "linalg/factor.h"
#include "linalg/symmetric.h"
#include "rotid.h"

/* Eigenvalues nearer than this part of themselves have vectors that a change of parameter can turn at will. */
#define CLOSE_EIGENVALUES 1e-6

int eigenvalue_is_close(int count, const double *lambda, int k);

/* P [n] and *q from M phi, dK phi and dM phi [n]. Returns dlambda = phi' (dK - lambda dM) phi. */
double nelson_right_side(int n, double lambda, const double *phi, const double *m_phi, const double *dk_phi, const double *dm_phi,
                         double *p, double *q);

/* ---- dense: the condensed problem */

struct nelson_dense {
    int n, left_out;
    struct symmetric factor;
};

int nelson_dense_new(struct pool *pool, int n, struct nelson_dense *d);
/* Prepares for the mode (lambda, phi) of K, M [n * n]. ROTID_OK or ROTID_ERROR_CLOSE. */
int nelson_dense_prepare(struct nelson_dense *d, const double *k, const double *m, double lambda, const double *phi);
/* dphi [n] from P [n] (kept), Q and M phi [n]. */
void nelson_dense_solve(struct nelson_dense *d, const double *phi, const double *m_phi, const double *p, double q, double *dphi);

/* All n pairs: lambda [n], phi [n * n]. */
void modal_superposition(int n, const double *lambda, const double *phi, int k, const double *m_phi, const double *p, double q,
                         double *dphi);

/* ---- banded: the full chain */

struct nelson_band {
    int n, left_out;
    int *kept;
    rotid_matrix shifted;
    struct factor factor;
    double *residual, *shorter; /* [n * most] */
};

/* For at most `most` right-hand sides at once. */
int nelson_band_new(struct pool *pool, const rotid_matrix *structure, int most, struct nelson_band *b);
int nelson_band_prepare(struct nelson_band *b, const rotid_matrix *k, const rotid_matrix *m, double lambda, const double *phi);
/* dphi [n * columns] from P [n * columns] (kept), Q [columns] and M phi [n]. */
void nelson_band_solve(struct nelson_band *b, int columns, const double *phi, const double *m_phi, const double *p,
                       const double *q, double *dphi);

#endif
