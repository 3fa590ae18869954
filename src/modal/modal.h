#ifndef ROTID_MODAL_MODAL_H
#define ROTID_MODAL_MODAL_H

/* Modal: modes of any rotid_model, their derivatives, and the residuals between them and measured modes.
 * In: rotid_model, rotid_measured, values x. Out: lambda, phi, dlambda/dx, dphi/dx; r(x) and dr/dx; correlations; pairs.
 *
 *   modes          prediction.c (prediction_compute): K(x), M(x), condensed by Guyan or IRS or in full, K phi = lambda M phi
 *   dlambda/dx     prediction.c (prediction_differentiate): phi'(dK - lambda dM) phi; condensed (36) by linalg/reduction.c
 *   dphi/dx        eigenvector_derivative.c: Nelson (nelson_dense_solve condensed, nelson_band_solve full), (K - lambda M) V = P
 *                  without the row of the largest component, dphi = V + (Q - phi'MV) phi (34, 35, 38); modal_superposition (37);
 *                  clusters within 1e-6 (eigenvalue_cluster) are taken not to turn in their subspace
 *   basis          basis.c (prediction_basis): pairs and their derivatives at x, a basis for the modes near x
 *   residuals      functional.c (functional_residual, functional_jacobian): HYBRID 1 - R*_k/w_k^2 (14, 15), HYBRID_F (16),
 *                  LIKELIHOOD (f~/f - 1)/s_k and (a_k phi~_kj - phi_kj)/s_kj, a_k the best scale of the shape; the standard
 *                  deviations s of a measured mode are data (rotid_measured), which src/ema or a deck states
 *   states         joint.c (joint_residual, joint_jacobian): residuals of several states over common unknowns, stacked
 *   correlation    correlation.c (rotid_mac, rotid_nco): NCO (45); pairing.c (pair_modes): by shape where it decides, or number
 *   checks         measured_check.c; eigenpair_derivative.c: rotid_eigenpair_derivative, one pair for a host
 *
 * Callers: fit; run, study; diagnose/columns.c for adjoints. The room sees a rotor through rotid_model alone: it must not
 * know beams, solids, causes or decks. */

#include "linalg/linalg.h"

/* ------------------------------------------------------------------------------------------------ eigenvector derivative */

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

/* ------------------------------------------------------------------------------------------------------------ prediction */

/* Modes of a model at given parameters, condensed or full, and their derivatives. Sees the model only through rotid_model. */

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
    int with_vectors;            /* there is room for dphi */
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
    double *here; /* [nparam] x of the last prediction_compute */
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
 * prediction_compute. Vectors of a cluster (eigenvalue_cluster) are taken not to turn in it, nearly so where it
 * goes on behind the pairs that are known, those asked for and one more. Statuses: CALLBACK, FINITE, CLOSE. */
int prediction_differentiate(struct prediction *p, const double *x, const int *wanted, int with_vectors);

/* dK/dx_q phi and dM/dx_q phi [n * count] of the wanted pairs of the full model, at the x of the last prediction_compute, until
 * the next call. Statuses: CALLBACK, FINITE. */
int prediction_images(struct prediction *p, const double *x, int q, const int *wanted, const double **dk_phi,
                      const double **dm_phi);

/* A basis for the modes of the full model near x, that of the last prediction_compute: the `given` vectors `first` [n * given],
 * which are orthonormal, the pairs, and for each wanted one and parameter dphi/dx_q where there is room for it, else (K + s M)^-1
 * (dK_q - lambda dM_q) phi with s half of the lowest eigenvalue wanted. V [n * *count] is orthonormal; what is a sum of columns
 * before, to 1e-6, is left out. Eigenvalues in it are off by the fourth order of the change of x, vectors by the second.
 * Statuses: MEMORY, CALLBACK, FINITE, CLOSE, STIFFNESS. */
int prediction_basis(struct pool *pool, struct prediction *p, const double *x, int given, const double *first, const int *wanted,
                     int *count, double **v);

/* The next solution of the full model begins with V phi, V [n * size], phi the pairs of `near`, of as many. */
void prediction_begin(struct prediction *p, int size, const double *v, const struct prediction *near);

/* Frequency of pair k [Hz]; 0 where its eigenvalue is not above zero. */
double prediction_hz(const struct prediction *p, int k);

/* Component of pair k at sensor s. */
double prediction_at_sensor(const struct prediction *p, int k, int s);
/* Where the vector of mode k and parameter q begins in dphi, kx and mx. */
ptrdiff_t prediction_place(const struct prediction *p, int k, int q);
/* The component of dphi_k/dx_q there. */
double prediction_derivative_at_sensor(const struct prediction *p, int k, int q, int s);

/* ------------------------------------------------------------------------------------------------------------ functional */

/* Residuals between measured and predicted modes, and their Jacobian. */

struct functional {
    int kind; /* ROTID_HYBRID, ROTID_HYBRID_F or ROTID_LIKELIHOOD */
    const rotid_measured *measured;
    struct prediction prediction;
    int with_vectors;   /* the residual depends on shapes */
    int *wanted;        /* [prediction.count]: pairs that a fitted mode uses */
    int *pair;          /* [nmode] pair of each measured mode */
    double *omega;      /* [nmode] measured, rad/s */
    double *shape;      /* [nmaster * nmode] measured, largest component 1, or NULL */
    int nresidual;      /* of the fitted modes: one a frequency, and one a measured shape component for the likelihood */
    double *quotient;   /* [nmode] R*_k of the last evaluation */
    double *work;       /* [2 nmaster] */
    int nwhole;         /* residuals of the whole, the last ones: of mass and centre of mass */
    double *whole_work; /* [n] */
};

/* Checks the measured data and makes room; with all modes held out there is no residual. ROTID_OK, MEMORY, ARGUMENT (data out of
 * range), UNPAIRED (a mode number beyond the model). */
int functional_new(struct pool *pool, int kind, int reduction, int derivative, const rotid_model *model,
                   const rotid_measured *measured, struct functional *f);

/* r [nresidual] at x, frequencies of all fitted modes first, then shapes mode by mode, then (r'M r - m^)/s and (r'M s/r'M r -
 * z^)/s as far as they were measured. Allocates nothing. Statuses of the prediction, and UNPAIRED where a shape is orthogonal to
 * its partner. */
int functional_residual(struct functional *f, const double *x, double *r);

/* dr/dx [nresidual * nparam] at the x of the last functional_residual. */
int functional_jacobian(struct functional *f, const double *x, double *jacobian);

/* r [nwhole] of the residuals of the whole moves with dM at the last evaluation. */
void functional_whole_derivative(struct functional *f, const rotid_matrix *dm, double *r);

/* Whether a mode is fitted: it is not held out. */
int functional_fits(const rotid_measured *measured, int mode);

/* Components of the shape that was measured of a mode, 0 where it is NaN or 0 everywhere. */
int functional_count_components(const struct functional *f, int mode);

/* The frequency residual of any mode, fitted or held out, at the last evaluation; the correlation of its shape with that of its
 * pair, NaN without shapes. */
double functional_frequency_residual(const struct functional *f, int mode);
double functional_mac(const struct functional *f, int mode);

/* ----------------------------------------------------------------------------------------------------------------- joint */

/* The residuals of one structure in several states, each a model with measured modes of its own, over unknowns that the models
 * share: r = (r_1, r_2, ...), and dr/dx of a state stands in the columns of the unknowns that its model uses. */

/* A state, as in rotid.h. */
struct joint_state {
    const rotid_model *model;
    const rotid_measured *measured;
    const int *parameter;
};

struct joint_part {
    struct functional functional;
    const int *parameter;
    double *x;        /* [nparam of the model] */
    double *jacobian; /* [nresidual * nparam] of the functional */
};

/* Residuals beside those of the modes, over the same unknowns: measured critical speeds of a machine. */
struct joint_more {
    int count;
    void *user;
    /* r [count] at x [nparam], NaN where there is none at this x; a status */
    int (*residual)(void *user, const double *x, double *r);
    /* dr/dx at x, column p from jacobian + p rows on; a status */
    int (*jacobian)(void *user, const double *x, int rows, double *jacobian);
};

struct joint {
    int nstate, nparam, nresidual;
    int last;                /* state that was evaluated last: of a failure the one that failed */
    struct joint_part *part; /* [nstate] */
    const struct joint_more *more;
};

/* Which of the unknowns parameter q of a model is. */
int joint_unknown(const int *parameter, int q);

/* The unknowns that the states name are below nparam. more: or NULL. Statuses of functional_new. */
int joint_new(struct pool *pool, int kind, int reduction, int derivative, int nparam, int nstate, const struct joint_state *state,
              const struct joint_more *more, struct joint *joint);

/* r [nresidual] at x [nparam]: state by state, as functional_residual has them, then those of `more`. Allocates nothing. Statuses
 * of that, of the first state without a residual. */
int joint_residual(struct joint *joint, const double *x, double *r);

/* dr/dx [nresidual * nparam] at the x of the last joint_residual. Parameters of a model that are one unknown add up. */
int joint_jacobian(struct joint *joint, const double *x, double *jacobian);

/* What measured modes have to be before a functional is made of them. ROTID_OK; ROTID_ERROR_ARGUMENT where data are out of range
 * or missing for the functional `kind`; ROTID_ERROR_UNPAIRED where a mode number lies beyond those of the model after
 * `reduction`. `failure` as in rotid.h. */
int measured_check(const rotid_model *model, const rotid_measured *measured, int kind, int reduction, char *failure);

/* --------------------------------------------------------------------------------------------------------------- pairing */

/* Which mode of the model each measured mode is. */

/* Measured shapes tell modes apart where the best correlation is at least this, and the next best at most half of it. */
#define PAIRING_LEAST 0.5

enum pairing_basis {
    PAIRED_BY_NUMBER, /* the shapes do not tell, or there are none: the number stands */
    PAIRED_BY_SHAPE
};

/* Pairs measured modes [nmode] with model modes [ncandidate] by their correlation [nmode * ncandidate] (NCO or MAC, column a
 * candidate; NULL: no shapes). number [nmode], counted from 1: in, as the data has it; out, as the shapes say where they say it.
 * Modes that the shapes place take their partner first, strongest correlation first; the others keep their number if it is still
 * free. basis [nmode]. Returns 0, or 1 + the index of a mode whose number was taken by another. used [ncandidate] is workspace.
 */
int pair_modes(int nmode, int ncandidate, const double *correlation, int *number, enum pairing_basis *basis, int *used);

#endif
