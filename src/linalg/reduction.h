/* Condensation onto master degrees of freedom: u = T x with T(K, M),
 *   K~ = T' K T,  M~ = T' M T.
 * Guyan (11-13): T = Psi = [Phi; I], Phi = -K_ii^-1 K_ic. IRS (O'Callahan 1989): T = Psi + S M Psi W, S = K_ii^-1 on the slaves
 * and zero elsewhere, W = M_g^-1 K_g with the matrices that Guyan gives.
 * Derivatives act on vectors; with columns of the identity they give dK~ and dM~ themselves. */
#ifndef ROTID_LINALG_REDUCTION_H
#define ROTID_LINALG_REDUCTION_H

#include "base/pool.h"
#include "linalg/factor.h"
#include "rotid.h"

struct reduction {
    int kind; /* ROTID_GUYAN or ROTID_IRS */
    int n, nc, ni;
    const int *master;
    int *slave, *nonzero;          /* [ni], [n] */
    const rotid_matrix *k, *m;     /* of the last reduction_compute: kept by the caller */
    struct factor factor;          /* K_ii */
    double *t;                     /* [n * nc] */
    double *kc, *mc;               /* [nc * nc] K~, M~ */
    double *psi, *kg, *mg;         /* IRS: [n * nc] and [nc * nc]; Guyan: the same as t, kc, mc */
    double *mg_factor, *w;         /* IRS: [nc * nc] */
    double *image;                 /* [n * max(nc, 3)] */
    double *u1, *u2, *u3, *slaves; /* [n] */
    double *c1, *c2, *c3;          /* [nc] */
};

/* `master` [nc], increasing, is kept, not copied. ROTID_OK or ROTID_ERROR_MEMORY. */
int reduction_new(struct pool *pool, int kind, const rotid_matrix *structure, int nc, const int *master, struct reduction *r);

/* T, K~ and M~ of K and M, which must stay unchanged while the derivatives below are used. ROTID_OK, ROTID_ERROR_SLAVE or
 * ROTID_ERROR_MASS. */
int reduction_compute(struct reduction *r, const rotid_matrix *k, const rotid_matrix *m);

/* u [n] := T x [nc] */
void reduction_expand(const struct reduction *r, const double *x, double *u);
/* x [nc] := T' u [n] */
void reduction_project(const struct reduction *r, const double *u, double *x);

/* u [n] := dT x for the derivatives dK, dM */
void reduction_derivative_expand(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *x, double *u);
/* x [nc] := dT' u [n] */
void reduction_derivative_project(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *u,
                                  double *x);

/* kx [nc] := dK~ x, mx [nc] := dM~ x, (40, 41) corrected; work [3 n + nc]. */
void reduction_derivative_multiply(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *x,
                                   double *kx, double *mx, double *work);

/* What an eigenpair (lambda, x) of the condensed problem needs for the derivative of lambda by any number of parameters: u = T x,
 * the residual (K - lambda M) u of the full model, and S times it. Vectors [n], supplied by the caller. */
struct reduction_mode {
    double *u, *residual, *adjoint, *scratch;
};

void reduction_mode_prepare(struct reduction *r, double lambda, const double *x, struct reduction_mode *mode);

/* For Guyan's reduction without T, K~ and M~: reduction_begin in place of reduction_compute, ROTID_OK or ROTID_ERROR_SLAVE, then
 * adjoint [n * count] := S (K - lambda M) u for u [n * count] = T x. Workspace [n * count]. */
int reduction_begin(struct reduction *r, const rotid_matrix *k, const rotid_matrix *m);
void reduction_adjoint(struct reduction *r, int count, const double *lambda, const double *u, double *adjoint, double *work);

/* dlambda = x' (dK~ - lambda dM~) x = u' (dK - lambda dM) u + 2 (K - lambda M) u . dT x, for x' M~ x = 1: (36). */
double reduction_eigenvalue_derivative(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, double lambda,
                                       const double *x, const struct reduction_mode *mode);

#endif
