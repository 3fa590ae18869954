#ifndef ROTID_FIT_FIT_H
#define ROTID_FIT_FIT_H

/* Fit: values of unknowns from measured modes, with their covariance. rotid_fit (one model), rotid_fit_states (several).
 * In: rotid_model, rotid_measured, rotid_parameter (start, bounds), options. Out: rotid_fit_result: x, covariance, intervals.
 *
 *   entrance       fit.c (rotid_fit, rotid_fit_states): min f(x) = 1/2 sum r^2 r, dr/dx of modal/joint.c; checks: fit_check.c
 *   bounds         bounds.c: x = alpha + (beta - alpha)/(1 + exp(chi y)) (30); the minimiser works on y
 *   beginning      fit.c (begin_near): the minimum of models of few unknowns near the start, made anew until they agree
 *   minimiser      lm.c (rotid_lm): (J'J + mu s^2 D^2 + F^2) h = -J'r by QR (linalg/least_squares.c), gain ratio, radius
 *   covariance     fit.c (covariance_compute): C = w^2 (J'J)^-1 J'S J (J'J)^-1 in relative parameters; std of a parameter is
 *                  sqrt(C_pp), w^2 = max(1, chi2/dof) where the noise S is known, else w^2 S = 2f/dof; intervals by 1.96 or
 *                  Student's t; directions of small singular value are reported as not determined
 *   quantiles      quantile.c: Student's t, chi-square; interval.c: when an interval counts as wide, its text in per cent
 *   second opinion baseline.c (baseline_run): BOBYQA, Sbplx, SLSQP of NLopt on the same problem
 *   host's model   check_jacobian.c (rotid_check_jacobian), check_model.c (rotid_check_model): derivatives against differences
 *
 * Callers: run/identify.c and hosts; diagnose, suggest, report, page, ... for quantiles and the rules of interval.c. The only
 * room that calls NLopt. It must not know rotors or causes, nor how measured modes were paired: it fits the numbers given. */

#include "modal/modal.h"

/* -------------------------------------------------------------------------------------------------------------- baseline */

/* The same problem given to NLopt: an independent minimiser from the same start to the same tolerance. */

/* 0 where this is built without NLopt. */
int baseline_exists(void);

/* Algorithms: BOBYQA (from two parameters on), Sbplx, and SLSQP with the gradient. 0 where built without NLopt. */
int baseline_count(int nparam);

/* Minimises the objective, of `near` where that is not NULL, with each algorithm in x/|start| within the bounds; value and
 * gradient at the end are of `joint`. out [baseline_count(n)], x of each on `keep`;
 * *count of them are filled: where a model has a wide band, a solid, Sbplx is left out, which takes four times the evaluations of
 * BOBYQA, 0.1 s each. work [nresidual * (n + 1)]. ROTID_OK, MEMORY, or CANCELLED as soon as the environment says so. */
int baseline_run(struct pool *keep, struct joint *joint, struct joint *near, const rotid_parameter *parameter,
                 const rotid_environment *environment, double *work, rotid_baseline *out, int *count);

/* ---------------------------------------------------------------------------------------------------------------- bounds */

/* The bijection (30) between an unbounded y and x in (lower, upper):
 *   x = alpha + (beta - alpha)/(1 + exp(chi y)) */

double bounds_to_x(const rotid_parameter *parameter, double chi, double y);
double bounds_to_y(const rotid_parameter *parameter, double chi, double x);
/* dx/dy */
double bounds_slope(const rotid_parameter *parameter, double chi, double y);
/* dr/dy [m * n] := dr/dx dx/dy; a column that is nothing but rounding beside the others becomes zero. A parameter that does
 * nothing keeps its value then: all of r seems to be gained by a leap of it, and where the fit refuses that, it refuses with it
 * what the step does to the others. */
void bounds_jacobian(int m, int n, const rotid_parameter *parameter, double chi, const double *y, const double *dr_dx,
                     double *dr_dy);
/* The sigmoid saturates where x is this near to a bound, as part of the interval: -1 lower, 1 upper, 0 neither. Of an interval
 * that spans decades the lower one also has to be near beside itself or beside what the start is above it. */
int bounds_pressed(const rotid_parameter *parameter, double x);

/* ------------------------------------------------------------------------------------------------------------ covariance */

/* What the data say about the parameters: covariance, correlation, intervals, undetermined directions. */

struct covariance_input {
    int m, n;
    const double *jacobian;  /* [m * n] with respect to x_p/|x_p|: relative parameters */
    const double *r;         /* [m] */
    const double *noise_std; /* [m] of the residuals where the noise is known (1 for a likelihood), else NULL */
    int nscale;              /* degrees of freedom spent on the scales of the shapes */
    const double *x;         /* [n] */
    const int *fixed;        /* [n] nonzero: pressed against a bound, taken as known */
};

size_t covariance_workspace(int m, int n);

/* Fills covariance ... widened_by, chi2 and dof of the result, with Student's t where the variance comes from the residuals and
 * the sandwich (J'J)^-1 J' S J (J'J)^-1 where the functional does not weigh by the noise S it is given. Directions that the data
 * determine to no better than half of the parameters' own size are called undetermined, and parameters whose 95 % interval holds
 * zero not identifiable. ROTID_OK or ROTID_ERROR_LIBRARY. */
int covariance_compute(const struct covariance_input *input, rotid_fit_result *result, double *work);

/* ------------------------------------------------------------------------------------------------------------- fit check */

/* What rotid_fit and rotid_fit_states refuse. */

/* The problem of a fit. All structs are of this library's size. */
struct fit_problem {
    int nstate, nparam;
    int named;                        /* the host knows its states: reasons say which */
    const struct joint_state *state;  /* [nstate] */
    const rotid_parameter *parameter; /* [nparam] */
    const struct joint_more *more;    /* residuals beside those of the modes, or NULL */
    const struct fit_near *near;      /* or NULL */
};

/* Models of few unknowns that stand for those of the states near a point: the minimiser goes through these before it goes on with
 * the states, and NLopt through these alone. */
struct fit_near {
    void *user;
    /* *state [nstate] on the pool near the point where `joint`, of the states, was evaluated last, and where those of the last
     * call were, unless `anew`; a status. Anything but ROTID_OK and ROTID_ERROR_MEMORY: there are none */
    int (*models)(void *user, struct pool *pool, struct joint *joint, int anew, const struct joint_state **state);
    /* The next solution of `joint` begins with the vectors of `near`, of the last models, where that was evaluated last. */
    void (*begin)(void *user, const struct joint *near, struct joint *joint);
};

/* rotid_fit_states with such residuals (or NULL), whose unknowns may be others than those of the states, and such models (or
 * NULL). */
int fit_states_more(int nstate, const rotid_state *state, int nparam, const rotid_parameter *parameter,
                    const struct joint_more *more, const struct fit_near *near, const rotid_fit_options *options,
                    const rotid_environment *environment, char *failure, rotid_fit_result **result);

/* ROTID_OK, or ROTID_ERROR_ARGUMENT or _UNPAIRED with the reason in failure. */
int fit_check(const struct fit_problem *problem, const rotid_fit_options *options, char *failure);

/* Its parts: a model, and the parameters with their bounds and starts, of which `count` says how rotid.h calls their number. */
int fit_check_model(const rotid_model *model, char *failure);
int fit_check_parameters(const char *count, int nparam, const rotid_parameter *parameter, char *failure);

/* -------------------------------------------------------------------------------------------------------------- interval */

/* What is said of the interval of a parameter: one rule for every command. */

/* A parameter is determined where its fit says so (`identifiable`: the 95 % interval does not hold zero, and no combination that
 * the data leave open has a part of it). One that is determined is wide where half of its interval is more than
 * this part of its value: it says little about a modulus. */
#define INTERVAL_WIDE 0.15
/* Of a value: a change that a linear calculation promises beyond it is only known to be large. */
#define LINEAR_MOST 0.5

/* Half of the interval in per cent of the value; NaN where there is none, or the value is 0. */
double interval_half_percent(double value, double lower, double upper);
/* Whether that is more than INTERVAL_WIDE; 0 where there is none. */
int interval_is_wide(double value, double lower, double upper);

/* "3.1 %", two digits, or as many as there are before the point. percent >= 0. Returns text. */
const char *percent_text(double percent, char text[32]);
/* "up to 3.1 %"; "more than 50 %" beyond LINEAR_MOST. */
const char *linear_percent_text(double percent, char text[32]);

/* -------------------------------------------------------------------------------------------------------------- quantile */

/* Tail probabilities that intervals and tests need. */

/* The t with P(|T| <= t) = 0.95 for Student's distribution with dof >= 1 degrees of freedom; dof 0: the normal distribution. */
double quantile_student_95(int dof);

/* The t with P(|T| > t) = outside, 0 < outside < 1, dof >= 1. */
double quantile_student(double outside, int dof);

/* P(chi2 >= x) with dof > 0 degrees of freedom, which need not be whole. */
double chi_square_tail(double x, double dof);

/* The x with P(chi2 > x) = outside, 0 < outside < 1, dof >= 1. */
double chi_square_limit(double outside, int dof);

#endif
