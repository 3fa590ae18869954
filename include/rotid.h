/* rotid: the bending stiffness of a rotor from its measured modes.
 *
 * In the order of use: bring your own model (rotid_fit), building blocks (elements, Levenberg-Marquardt, mode correlation).
 *
 * Conventions, once for all routines
 *   Units are SI; frequencies whose name ends in _hz are in hertz, all others in rad/s.
 *   Matrices are column-major, indices count from 0.
 *   A node of a beam has two degrees of freedom, the lateral deflection v and the rotation theta = -dv/dz of its section.
 *   Every routine returns a status: 0 done, negative an error, positive a reason why an iteration ended.
 *   No routine prints, exits, reads files, handles signals or keeps state between calls; calls on different data may run at
 *   the same time. The number of BLAS threads stays what the host has set. */
#ifndef ROTID_H
#define ROTID_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define ROTID_API __attribute__((visibility("default")))
#else
#define ROTID_API
#endif

#define ROTID_VERSION "0.1.0"

/* ------------------------------------------------------------------------------------------------ status */

/* name, value, text */
#define ROTID_STATUS_LIST(X)                                                                                                     \
    X(ROTID_OK, 0, "done")                                                                                                       \
    X(ROTID_STOP_GRADIENT, 1, "the gradient vanished")                                                                           \
    X(ROTID_STOP_STEP, 2, "the step became negligible")                                                                          \
    X(ROTID_STOP_OBJECTIVE, 3, "the decrease that is left is below rounding")                                                    \
    X(ROTID_STOP_ITERATIONS, 4, "the iteration limit was reached")                                                               \
    X(ROTID_STOP_STALLED, 5, "no step lowers the objective")                                                                     \
    X(ROTID_STOP_CANCELLED, 6, "cancelled")                                                                                      \
    X(ROTID_ERROR_ARGUMENT, -1, "an argument is out of its range")                                                               \
    X(ROTID_ERROR_MEMORY, -2, "out of memory")                                                                                   \
    X(ROTID_ERROR_MASS, -3, "the mass matrix is not positive definite")                                                          \
    X(ROTID_ERROR_SLAVE, -4, "the stiffness of the slave degrees of freedom is not positive definite")                           \
    X(ROTID_ERROR_STIFFNESS, -5, "the stiffness matrix is not positive semidefinite")                                            \
    X(ROTID_ERROR_EIGEN, -6, "the eigenvalue iteration did not converge")                                                        \
    X(ROTID_ERROR_CLOSE, -7, "two eigenvalues are too close for their vectors to be differentiated")                             \
    X(ROTID_ERROR_UNPAIRED, -8, "a measured mode has no partner in the model")                                                   \
    X(ROTID_ERROR_RANK, -9, "the Jacobian has no usable column")                                                                 \
    X(ROTID_ERROR_CALLBACK, -10, "a callback reported a failure")                                                                \
    X(ROTID_ERROR_FINITE, -11, "a value is not finite")                                                                          \
    X(ROTID_ERROR_SECTION, -12, "the section is not an annulus: its squared inner diameter would be negative")                   \
    X(ROTID_ERROR_SYNTAX, -13, "the input is malformed")                                                                         \
    X(ROTID_ERROR_IO, -14, "a file cannot be read or written")                                                                   \
    X(ROTID_ERROR_LIBRARY, -15, "a library reported a failure that should not occur")

enum {
#define ROTID_STATUS_ENUM(name, value, text) name = (value),
    ROTID_STATUS_LIST(ROTID_STATUS_ENUM)
#undef ROTID_STATUS_ENUM
};

/* The text of a status; "unknown status" for any other value. Never NULL, not to be freed. */
ROTID_API const char *rotid_status_text(int status);
/* Its name, such as "ROTID_OK". */
ROTID_API const char *rotid_status_name(int status);

/* ------------------------------------------------------------------------------------------------ environment */

typedef struct rotid_allocator {
    void *(*allocate)(void *context, size_t bytes); /* aligned for any type, or NULL */
    void (*release)(void *context, void *block);
    void *context;
} rotid_allocator;

/* What a host may hand to a long call. NULL anywhere: malloc, never cancelled, silent. */
typedef struct rotid_environment {
    const rotid_allocator *allocator;
    int (*cancelled)(void *context); /* polled once per iteration; nonzero ends the call with ROTID_STOP_CANCELLED */
    void (*progress)(void *context, const char *stage, int step); /* told of every iteration, of the baseline every evaluation */
    void *context;
} rotid_environment;

/* ------------------------------------------------------------------------------------------------ bring your own model */

/* A symmetric matrix A = B + P C P': a band B, and a small dense block C on a few degrees of freedom that couple across it
 * (tie rods join the two ends of a core). n >= 1, 0 <= kd <= n - 1; a dense matrix is a band with kd = n - 1. */
typedef struct rotid_matrix {
    int n, kd, nfar;
    const int *far; /* [nfar] degrees of freedom of C, increasing */
    double *band;   /* [(kd + 1) * n] lower triangle: B(i, j) = band[(i - j) + j * (kd + 1)], j <= i <= min(n - 1, j + kd) */
    double *block;  /* [nfar * nfar] C, both triangles */
} rotid_matrix;

/* A model with nparam >= 0 parameters x. Both callbacks receive matrices of the structure declared here, set to zero, and return
 * 0 or anything else for failure. K is positive semidefinite, M positive definite. */
typedef struct rotid_model {
    int n, kd, nfar;
    const int *far;
    int nparam;
    int nrigid;        /* the lowest nrigid modes are not counted: rigid-body and suspension modes */
    int nmaster;       /* number of sensors */
    const int *master; /* [nmaster] degree of freedom of each sensor, distinct, increasing */
    int (*matrices)(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass);
    /* dK/dx_p and dM/dx_p; NULL: central differences of fourth order of `matrices` over x_p (1 +- 0.004), which must be valid
     * there; 1e-9 accurate for parameters that act strongly, 1e-7 for weak ones */
    int (*derivatives)(void *user, const double *x, int p, rotid_matrix *stiffness, rotid_matrix *mass);
    void *user;
} rotid_model;

/* The measured modes. Shapes are optional; their scale and sign are free, each mode is scaled to a largest component of 1
 * before use. */
typedef struct rotid_measured {
    int nmode;
    const int *number;           /* [nmode] mode of the model that each is paired with, counted from 1 after the rigid ones */
    const double *frequency_hz;  /* [nmode] > 0 */
    const double *frequency_std; /* [nmode] relative standard deviation > 0, or NULL where the noise is not known */
    const double *shape;         /* [nmaster * nmode] column-major at the masters, NaN where not measured; or NULL */
    const double *shape_std;     /* [nmaster * nmode] relative to the largest component of the mode; or NULL */
    const int *holdout;          /* [nmode] nonzero: predicted and compared, not fitted; or NULL */
} rotid_measured;

typedef struct rotid_parameter {
    const char *name, *unit;    /* texts for reports; may be NULL */
    double lower, upper, start; /* lower < start < upper, start != 0 */
} rotid_parameter;

enum { ROTID_HYBRID, ROTID_HYBRID_F, ROTID_LIKELIHOOD }; /* functional */
enum { ROTID_REDUCTION_NONE, ROTID_GUYAN, ROTID_IRS };   /* reduction */
enum { ROTID_NELSON, ROTID_MODAL };                      /* eigenvector derivative; ROTID_MODAL needs a reduction */

/* Zero-initialise, or rotid_fit_defaults: a zero takes the default in brackets. */
typedef struct rotid_fit_options {
    int functional, reduction, derivative;
    int max_iterations;        /* [100] */
    double gradient_tolerance; /* [1e-10] of the cosine between the residual and each column of the Jacobian */
    double step_tolerance;     /* [1e-12] relative step */
    double bijection_chi;      /* [0.05] chi of x = alpha + (beta - alpha)/(1 + exp(chi y)), variables scaled by their start */
    int baseline;              /* nonzero: minimise the same objective with NLopt as well */
} rotid_fit_options;

ROTID_API void rotid_fit_defaults(rotid_fit_options *options);

typedef struct rotid_fit_iteration {
    int iteration;
    double objective;  /* half the sum of squared residuals */
    double gradient;   /* largest component of the gradient with respect to x_p / start_p */
    double mu;         /* damping in use */
    double gain_ratio; /* actual over predicted decrease of the step that led here; NaN at iteration 0 */
    double step;       /* norm of that step in x_p / start_p */
} rotid_fit_iteration;

typedef struct rotid_baseline {
    const char *algorithm, *result; /* NLopt's names */
    int code;                       /* NLopt's result */
    int usable;                     /* converged, or stopped by rounding at a minimum */
    double objective, seconds, gradient;
    int evaluations; /* of the model; each gradient counts as part of its evaluation */
    double *x;       /* [nparam] */
} rotid_baseline;

/* Everything is owned by the result and released with it. n = nparam, m = nmode of the measured data. */
typedef struct rotid_fit_result {
    int status;    /* why the iteration ended: ROTID_STOP_... */
    int converged; /* a minimum was reached: inside the bounds or pressed against one */
    int any_at_bound, any_undetermined;
    int n, m, nresidual, dof;
    double objective, gradient, chi2, chi2_per_dof; /* chi2 is NaN where the noise is not known */
    int iterations, evaluations, jacobians;
    double seconds;
    double *x, *std, *ci_lower, *ci_upper; /* [n]; NaN where they cannot be stated */
    int *at_bound, *identifiable;          /* [n] */
    double *covariance, *correlation;      /* [n * n] */
    double condition_number;               /* of the Jacobian with respect to x_p / x_p*; NaN where n = 0 */
    double *singular_value;                /* [n] of that Jacobian, decreasing */
    double *direction;                     /* [n * n] right singular vectors, column j belongs to singular_value[j] */
    int *direction_undetermined;           /* [n] */
    double widened_by;                     /* factor by which the intervals were widened, 1 where they were not */
    int variance_from_residuals;           /* 1: Student t with dof; 0: from the stated noise */
    double *predicted_hz, *mac, *residual; /* [m]; mac NaN without a shape; residual of the functional, held-out modes too */
    double *r;        /* [nresidual] of the fitted modes at x: their frequencies, then for a likelihood the measured components of
                         their shapes mode by mode, sensors increasing; objective = r'r/2 */
    double *jacobian; /* [nresidual * n] column-major, dr_i/dx_p there */
    int nhistory;
    rotid_fit_iteration *history; /* [nhistory], iteration 0 first */
    double *history_x;            /* [n * nhistory] */
    int nbaseline;
    rotid_baseline *baseline;
    void *memory; /* internal */
} rotid_fit_result;

/* Minimises f(x) = 1/2 sum r^2 over lower < x < upper by Levenberg-Marquardt on y with the bijection of the paper's (30).
 *   ROTID_HYBRID      r_k = 1 - R*_k / w^_k^2, R*_k = phi^' K~ phi~ / (phi^' M~ phi~)            (15)
 *   ROTID_HYBRID_F    r_k = 1 - R*_k / (w^_k w~_k)                                                (16)
 *   ROTID_LIKELIHOOD  r_k = (f_k - f^_k)/s_k and (a_k phi_kj - phi^_kj)/s_kj, a_k the best scale; needs frequency_std, and
 *                     shape_std where shapes are given
 * Entry: `nparam` parameters, `measured` with at least one fitted mode. With nparam = 0 (`parameter` may be NULL) the model is
 * only evaluated and compared: converged with ROTID_STOP_GRADIENT after 0 iterations, chi2 and dof of the residuals, arrays over
 * the parameters empty, no baseline. Exit: *result, to be freed with rotid_fit_free, also when the iteration ended without
 * convergence (status >= 0). On an error (< 0) *result is NULL. Statuses: every ROTID_ERROR_ but SYNTAX and IO. Memory:
 * O(nmaster^2 + n kd). The iteration itself allocates nothing. */
ROTID_API int rotid_fit(const rotid_model *model, const rotid_parameter *parameter, const rotid_measured *measured,
                        const rotid_fit_options *options, const rotid_environment *environment, rotid_fit_result **result);
/* NULL is allowed. The allocator of the environment that the fit was given has to exist until then. */
ROTID_API void rotid_fit_free(rotid_fit_result *result);

/* ------------------------------------------------------------------------------------------------ building blocks: the beam */

/* Shear coefficient of an annulus after Cowper, (A.3): a = inner/outer diameter in [0, 1], -1 < nu <= 0.5. */
ROTID_API double rotid_shear_coefficient_annulus(double nu, double a);
/* Of a rectangle: 10 (1 + nu)/(12 + 11 nu) (Cowper 1966). */
ROTID_API double rotid_shear_coefficient_rectangle(double nu);

/* Cylinder of area S [m2] and second moment I [m4], (6): outer^2 = 8 I/S + 2 S/pi, inner^2 = 8 I/S - 2 S/pi.
 * ROTID_ERROR_SECTION when the inner diameter would be imaginary, ROTID_ERROR_ARGUMENT unless S, I > 0. */
ROTID_API int rotid_equivalent_cylinder(double area, double inertia, double *outer, double *inner);

/* Element matrices [16] for (v1, theta1, v2, theta2). EI [N.m2] bending, kGS [N] shear stiffness, length l [m] > 0;
 * phi = 12 EI/(kGS l^2), (A.2); rhoS [kg/m], rhoI [kg.m]; axial force F [N], tension positive.
 *   rotid_element_stiffness  (A.1)        rotid_element_geometric  (A.4) corrected, see docs/errata.md
 *   rotid_element_mass       (B.1) + (B.2) */
ROTID_API void rotid_element_stiffness(double ei, double kgs, double l, double *stiffness);
ROTID_API void rotid_element_geometric(double force, double phi, double l, double *stiffness);
ROTID_API void rotid_element_mass(double rhos, double rhoi, double phi, double l, double *mass);

/* ------------------------------------------------------------------------------------------------ building blocks: least squares
 */

/* At x [n], one of the two: the residual r [m] (jacobian is NULL), or the jacobian [m * n] column-major, dr_i/dx_j (r is NULL),
 * always at the point whose residual was asked for last, so that what both need is computed once. Returns 0, or nonzero where x
 * has no residual: at the start that ends the call, later the step is refused and a shorter one tried. */
typedef int (*rotid_residual)(void *user, int m, int n, const double *x, double *r, double *jacobian);

typedef struct rotid_lm_iteration {
    int iteration;
    double objective, mu, gain_ratio;
    double cosine;              /* largest cosine between r and a column of J */
    const double *x, *gradient; /* [n] the accepted point, J' r */
} rotid_lm_iteration;

/* Zero takes the default in brackets. */
typedef struct rotid_lm_options {
    int max_iterations;                                            /* [100] */
    double gradient_tolerance;                                     /* [1e-10] on that cosine */
    double step_tolerance;                                         /* [1e-12] |dx_j| <= eps (|x_j| + eps) for every j */
    double objective_tolerance;                                    /* [1e-16] predicted decrease over the objective */
    double initial_damping;                                        /* [1e-3] */
    int (*trace)(void *user, const rotid_lm_iteration *iteration); /* NULL, or told of every accepted point; nonzero cancels */
    void *trace_user;
} rotid_lm_options;

typedef struct rotid_lm_result {
    int status, iterations, evaluations, jacobians;
    double objective, cosine, mu;
} rotid_lm_result;

/* Length of the workspace of rotid_lm in doubles. */
ROTID_API size_t rotid_lm_workspace(int m, int n);

/* Levenberg-Marquardt: min 1/2 r'r. Each step solves (J'J + mu D^2) h = -J'r by QR of [J; sqrt(mu) D], D the largest column
 * norms of J so far (More 1978); mu follows the gain ratio (Nielsen 1999; Madsen, Nielsen, Tingleff 2004, 3.2), the actual
 * decrease being (r - r+)'(r + r+)/2, which keeps its digits at the optimum.
 * Entry: m >= 1, n >= 1 (m < n is allowed: the damped step is of least norm), x [n] start. Exit: x the best point, r [m] and
 * jacobian [m * n] there. Workspace: work [rotid_lm_workspace(m, n)]. Allocates nothing.
 * Returns the stop reason (> 0) or ROTID_ERROR_ARGUMENT, _CALLBACK (no residual at the start), _FINITE (residual at the start),
 * _RANK (J = 0 there with r != 0), _LIBRARY. */
ROTID_API int rotid_lm(int m, int n, rotid_residual residual, void *user, const rotid_lm_options *options, double *x, double *r,
                       double *jacobian, double *work, rotid_lm_result *result);

/* ------------------------------------------------------------------------------------------------ building blocks: modes */

/* Modal assurance criterion (a'b)^2/((a'a)(b'b)) over the components that are finite in both; 0 where one vanishes. */
ROTID_API double rotid_mac(int n, const double *a, const double *b);

/* Normalised cross orthogonality (45) with the symmetric mass matrix [n * n] of the masters; NaN components count as 0.
 * work [n]. */
ROTID_API double rotid_nco(int n, const double *mass, const double *a, const double *b, double *work);

#ifdef __cplusplus
}
#endif

#endif
