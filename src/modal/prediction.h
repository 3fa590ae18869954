/* Modes of a model at given parameters, condensed or full, and their derivatives. Sees the model only through rotid_model. */
#ifndef ROTID_MODAL_PREDICTION_H
#define ROTID_MODAL_PREDICTION_H

#include "base/pool.h"
#include "linalg/eigen.h"
#include "linalg/eigen_guyan.h"
#include "linalg/reduction.h"
#include "modal/eigenvector_derivative.h"
#include "rotid.h"

struct prediction {
    const rotid_model *model;
    int reduction, derivative;
    char *failure; /* NULL, or where the model's part in an error is told, as in rotid.h */
    int count;     /* pairs computed, rigid ones included */
    int size;      /* length of a vector: nmaster when condensed, n when full */
    rotid_matrix k, m, dk, dm, other_k, other_m;
    int dk_is_zero, dm_is_zero; /* most parameters leave one of the matrices alone */
    struct reduction condensed;
    struct reduction_mode *mode; /* [count], condensed */
    struct eigen_guyan guyan;    /* in place of what follows, where it applies */
    int by_bands;                /* the pairs are those of `guyan`, and K~ and M~ have not been formed */
    int begun;                   /* lambda is near the pairs of the next solution */
    double *full_phi;            /* [n * count] T phi */
    double *adjoint;             /* [n * count] */
    struct eigen_dense dense;
    struct eigen_full full;
    struct nelson_dense nelson_dense;
    struct nelson_band nelson_band;
    double *lambda;   /* [count], ascending */
    double *phi;      /* [size * count], mass-normalised */
    double *dlambda;  /* [count * nparam]; only where differentiated */
    double *dphi;     /* [size * nparam * count]: the parameters of a mode beside each other */
    double *right;    /* [size * nparam * count] P of (34) */
    double *constant; /* [CLUSTER_MOST * nparam * count] Q of (35), and phi_j' M dphi_k along the other members of a cluster */
    double *m_phi;    /* [size * count] */
    double *kx, *mx;  /* [size * nparam * count]: dK phi_k and dM phi_k of the condensed matrices */
    double *below;    /* [size * nparam]: of a cluster that goes on, dphi with an eigenvalue below */
    double *image;    /* [2 size * count] dK phi and dM phi of the full matrices */
    double *x, *work;
    int *turned;  /* [count] pairs whose derivatives are those of the last prediction_compute; of the vectors in full, else of
                     lambda */
    double *here; /* [nparam] x of that */
};

/* count <= nmaster (condensed) or n. with_vectors: room for dphi. ROTID_OK, ROTID_ERROR_MEMORY, ROTID_ERROR_ARGUMENT. */
int prediction_new(struct pool *pool, const rotid_model *model, int reduction, int derivative, int count, int with_vectors,
                   struct prediction *p);

/* k, m := K and M at x [nparam]. Statuses: CALLBACK, FINITE. */
int prediction_matrices(struct prediction *p, const double *x);

/* K, M and the pairs at x [nparam]. Allocates nothing. Statuses: CALLBACK, FINITE, SLAVE, STIFFNESS, MASS, EIGEN. */
int prediction_compute(struct prediction *p, const double *x);

/* dk, dm := dK/dx_q, dM/dx_q at the x of the last prediction_compute: the host's, or differences where it has none. Statuses:
 * CALLBACK, FINITE. */
int prediction_matrix_derivatives(struct prediction *p, const double *x, int q);

/* Derivatives of eigenvalues of the pairs with wanted [count] nonzero, and of their vectors where asked for, at the x of the last
 * prediction_compute. Vectors of a cluster (modal/eigenvector_derivative.h) are taken not to turn in it, nearly so where it
 * goes on behind the pairs that are known, those asked for and one more. Statuses: CALLBACK, FINITE, CLOSE. */
int prediction_differentiate(struct prediction *p, const double *x, const int *wanted, int with_vectors);

/* Frequency of pair k [Hz]; 0 where its eigenvalue is not above zero. */
double prediction_hz(const struct prediction *p, int k);

/* Component of pair k at sensor s. */
double prediction_at_sensor(const struct prediction *p, int k, int s);
/* Where the vector of mode k and parameter q begins in dphi, kx and mx. */
ptrdiff_t prediction_place(const struct prediction *p, int k, int q);
/* The component of dphi_k/dx_q there. */
double prediction_derivative_at_sensor(const struct prediction *p, int k, int q, int s);

#endif
