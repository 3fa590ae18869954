#include <math.h>
#include <string.h>

#include "base/entry.h"
#include "base/sized.h"
#include "linalg/least_squares.h"
#include "rotid.h"

#define MU_MOST    1e16   /* beyond it a step is below rounding */
#define MU_LEAST   1e-100 /* nothing at all: what is left is `floor` */
#define FIRST      10     /* a first step changes x by no more than this many times itself (More 1978: 0.1 to 100) */
#define LONGER     4      /* than the last step that was good, at most */
#define SHORTER    0.1    /* than a step that failed, at least */
#define HALF       0.5    /* and at most */
#define FALL       3      /* mu falls by this factor behind a good step (Nielsen 1999), by twice as much behind the next one */
#define NOISE      1e-12  /* rounding of J, 1e-16, over the part of x by which it may move what r does not determine */
#define REGULAR    1e-28  /* keeps the QR regular where r is small */
#define FLAT       1e-8 /* predicted decrease over objective below which the noise of a computed objective can hide the decrease */
#define FLAT_TRIES 5    /* steps that neither lower f by more than its noise nor the gradient, before the iteration ends */

struct lm {
    int m, n;
    rotid_residual residual;
    void *user;
    rotid_lm_options options;
    double *x, *r, *jacobian; /* the caller's: the best point */
    double *trial, *trial_r, *step, *gradient, *norm, *scale, *old, *work;
    double *floor; /* of the damping: parts of the columns of J too small to tell from its rounding */
    rotid_lm_result *result;
    double mu;     /* relative to the present size of J */
    double size;   /* that: the largest |J_j|/D_j, 1 unless every column has shrunk */
    double fall;   /* factor of mu behind the next good step */
    double radius; /* of |D h| */
    double length, gain;
};

size_t rotid_lm_workspace(int m, int n)
{
    return 8 * (size_t)n + 2 * (size_t)m + (size_t)m * (size_t)n + least_squares_workspace(m, n);
}

static double half_square(int m, const double *r)
{
    double sum = 0;
    for (int i = 0; i < m; i++)
        sum += r[i] * r[i];
    return sum / 2;
}

static int all_finite(ptrdiff_t n, const double *x)
{
    for (ptrdiff_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            return 0;
    return 1;
}

/* |D x| */
static double scaled_length(const struct lm *lm)
{
    double sum = 0;
    for (int j = 0; j < lm->n; j++)
        sum += lm->scale[j] * lm->x[j] * lm->scale[j] * lm->x[j];
    return sqrt(sum);
}

/* Jacobian at x, gradient J'r, scale D = largest column norms so far, cosine. */
static int linearise(struct lm *lm)
{
    lm->result->jacobians++;
    if (lm->residual(lm->user, lm->m, lm->n, lm->x, NULL, lm->jacobian))
        return ROTID_ERROR_CALLBACK;
    if (!all_finite((ptrdiff_t)lm->m * lm->n, lm->jacobian))
        return ROTID_ERROR_FINITE;
    double length = sqrt(2 * lm->result->objective), size = 0;
    lm->result->cosine = 0;
    for (int j = 0; j < lm->n; j++) {
        const double *column = lm->jacobian + (ptrdiff_t)j * lm->m;
        double square = 0;
        lm->gradient[j] = 0;
        for (int i = 0; i < lm->m; i++) {
            square += column[i] * column[i];
            lm->gradient[j] += column[i] * lm->r[i];
        }
        if (!isfinite(square))
            return ROTID_ERROR_FINITE;
        double norm = lm->floor[j] = sqrt(square);
        lm->norm[j] = fmax(lm->norm[j], norm);
        lm->scale[j] =
            lm->norm[j] > 0 ? lm->norm[j] : 1; /* where a column has been zero so far any scale keeps the system regular */
        size = fmax(size, norm / lm->scale[j]);
        if (length > 0 && norm > 0) /* with the norm of the column here, not with D: where J has shrunk by 1e10 D would end the
                                       iteration */
            lm->result->cosine = fmax(lm->result->cosine, fabs(lm->gradient[j]) / (norm * length));
    }
    lm->size = size > 0 ? size : 1;
    double part = sqrt(fmax(REGULAR, length > 0 ? NOISE * length / fmax(length, scaled_length(lm)) : 0));
    for (int j = 0; j < lm->n; j++)
        lm->floor[j] *= part;
    return size > 0 || length == 0 || lm->result->jacobians > 1 ? ROTID_OK
                                                                : ROTID_ERROR_RANK; /* J = 0 later: the gradient has vanished */
}

/* h'(F^2 h - g)/2, F what damped the step: the decrease that the linear model promises */
static double predicted_decrease(const struct lm *lm)
{
    double sum = 0, mu = lm->mu * lm->size * lm->size;
    for (int j = 0; j < lm->n; j++)
        sum += lm->step[j] * ((mu * lm->scale[j] * lm->scale[j] + lm->floor[j] * lm->floor[j]) * lm->step[j] - lm->gradient[j]);
    return sum / 2;
}

/* (r - r+)'(r + r+)/2: the difference of two nearly equal sums of squares without their cancellation */
static double actual_decrease(const struct lm *lm)
{
    double sum = 0;
    for (int i = 0; i < lm->m; i++)
        sum += (lm->r[i] - lm->trial_r[i]) * (lm->r[i] + lm->trial_r[i]);
    return sum / 2;
}

static int negligible(const struct lm *lm)
{
    double eps = lm->options.step_tolerance;
    for (int j = 0; j < lm->n; j++)
        if (!(fabs(lm->step[j]) <= eps * (fabs(lm->x[j]) + eps)))
            return 0;
    return 1;
}

/* A damped step from x. Returns 0 with the trial point and its residual in place, a stop reason, or an error. *refused: the trial
 * has no residual. */
static int try_step(struct lm *lm, double *predicted, int *refused)
{
    double square = lm->size * lm->size, mu = lm->mu * square;
    if (least_squares_damped_step(lm->m, lm->n, lm->jacobian, lm->r, lm->scale, lm->floor, lm->radius, &mu, lm->step, &lm->length,
                                  lm->work))
        return ROTID_ERROR_LIBRARY;
    lm->mu = mu / square;
    *predicted = predicted_decrease(lm);
    if (negligible(lm))
        return ROTID_STOP_STEP;
    if (!(*predicted > lm->options.objective_tolerance * lm->result->objective))
        return ROTID_STOP_OBJECTIVE;
    for (int j = 0; j < lm->n; j++)
        lm->trial[j] = lm->x[j] + lm->step[j];
    lm->result->evaluations++;
    *refused = lm->residual(lm->user, lm->m, lm->n, lm->trial, lm->trial_r, NULL) || !all_finite(lm->m, lm->trial_r);
    return ROTID_OK;
}

static void accept(struct lm *lm)
{
    memcpy(lm->x, lm->trial, (size_t)lm->n * sizeof *lm->x);
    memcpy(lm->r, lm->trial_r, (size_t)lm->m * sizeof *lm->r);
    lm->result->objective = half_square(lm->m, lm->r);
}

/* Near the minimum the decrease drowns in the rounding of r long before the gradient does (Hager and Zhang 2005 make the same
 * point for line searches): the step is then judged by the gradient. Returns 0 with the trial accepted and linearised,
 * STOP_OBJECTIVE with everything as it was (but for scales, those of a neighbour), or an error. */
static int accept_by_gradient(struct lm *lm)
{
    size_t m = (size_t)lm->m, n = (size_t)lm->n;
    double *x = lm->old, *gradient = x + n, *r = gradient + n, *jacobian = r + m, cosine = lm->result->cosine,
           f = lm->result->objective;
    memcpy(x, lm->x, n * sizeof *x);
    memcpy(gradient, lm->gradient, n * sizeof *x);
    memcpy(r, lm->r, m * sizeof *x);
    memcpy(jacobian, lm->jacobian, m * n * sizeof *x);
    accept(lm);
    int status = linearise(lm);
    if (status || lm->result->cosine < cosine)
        return status;
    memcpy(lm->x, x, n * sizeof *x);
    memcpy(lm->gradient, gradient, n * sizeof *x);
    memcpy(lm->r, r, m * sizeof *x);
    memcpy(lm->jacobian, jacobian, m * n * sizeof *x);
    lm->result->cosine = cosine;
    lm->result->objective = f;
    return ROTID_STOP_OBJECTIVE;
}

/* Behind a step that was accepted: mu after Nielsen, and a radius. */
static void relax(struct lm *lm)
{
    double t = 2 * lm->gain - 1, factor = 1 - t * t * t;
    if (factor < 1.0 / FALL) { /* good steps in a row: as mu grew by ever larger factors, were it too small, it falls by such */
        factor = 1 / lm->fall;
        lm->fall *= 2;
    } else {
        lm->fall = FALL;
    }
    lm->mu = fmax(lm->mu * factor, MU_LEAST);
    lm->radius = lm->gain < 0.25 ? HALF * lm->length : LONGER * lm->length;
}

/* Behind one that was not: f along it is a parabola through what is known, whose minimum is the next length (More 1978). */
static void tighten(struct lm *lm, double actual, int refused)
{
    double slope = 0;
    for (int j = 0; j < lm->n; j++)
        slope += lm->gradient[j] * lm->step[j];
    double part = refused ? SHORTER : actual < 0 ? HALF * slope / (slope + actual) : HALF;
    lm->radius = fmax(SHORTER, fmin(HALF, part)) * lm->length;
    lm->fall = FALL;
}

/* Steps of growing damping until one lowers the objective; the accepted point is linearised. */
static int descend(struct lm *lm)
{
    for (int flat_steps = 0;;) {
        double predicted, actual;
        int refused, status = try_step(lm, &predicted, &refused);
        if (status)
            return status;
        actual = refused ? -1 : actual_decrease(lm);
        lm->gain = refused ? -1 : actual / predicted;
        double flat = FLAT * lm->result->objective;
        if (lm->gain > 0.25 || (lm->gain > 0 && predicted > flat)) {
            accept(lm);
            relax(lm);
            return linearise(lm);
        }
        if (!refused && predicted < flat && fabs(actual) < flat) {
            double before = lm->result->cosine;
            status = accept_by_gradient(lm);
            if (status == ROTID_OK && lm->result->cosine < before / 3)
                lm->mu = fmax(lm->mu / FALL, MU_LEAST);
            if (status != ROTID_STOP_OBJECTIVE || ++flat_steps == FLAT_TRIES)
                return status;
        }
        tighten(lm, actual, refused);
        if (lm->mu > MU_MOST)
            return ROTID_STOP_STALLED;
    }
}

static int report(struct lm *lm)
{
    if (!lm->options.trace)
        return 0;
    rotid_lm_iteration now = {.iteration = lm->result->iterations,
                              .objective = lm->result->objective,
                              .mu = lm->mu,
                              .gain_ratio = lm->gain,
                              .cosine = lm->result->cosine,
                              .x = lm->x,
                              .gradient = lm->gradient};
    return lm->options.trace(lm->options.trace_user, &now);
}

static int minimise(struct lm *lm)
{
    lm->result->evaluations = 1;
    if (lm->residual(lm->user, lm->m, lm->n, lm->x, lm->r, NULL))
        return ROTID_ERROR_CALLBACK;
    if (!all_finite(lm->m, lm->r))
        return ROTID_ERROR_FINITE;
    lm->result->objective = half_square(lm->m, lm->r);
    if (!isfinite(lm->result->objective))
        return ROTID_ERROR_FINITE;
    int status = linearise(lm);
    /* where x says how far away things are, a part of that; but x may happen to be near zero: then as far as would take all of r
     */
    lm->radius = fmax(FIRST * scaled_length(lm), sqrt(2 * lm->result->objective));
    while (!status) {
        if (report(lm))
            return ROTID_STOP_CANCELLED;
        if (lm->result->objective == 0 || lm->result->cosine <= lm->options.gradient_tolerance)
            return ROTID_STOP_GRADIENT;
        if (lm->result->iterations >= lm->options.max_iterations)
            return ROTID_STOP_ITERATIONS;
        status = descend(lm);
        lm->result->iterations += status == ROTID_OK;
    }
    return status;
}

static double or_default(double value, double standard)
{
    return value > 0 ? value : standard;
}

static int check_arguments(int m, int n, rotid_residual residual, const double *x, const double *r, const double *jacobian,
                           const double *work, const rotid_lm_result *result, char *failure)
{
    if (m < 1 || n < 1)
        return refuse(failure, "m is %d and n is %d, expected 1 or more", m, n);
    const char *missing = !residual   ? "residual"
                          : !x        ? "x"
                          : !r        ? "r"
                          : !jacobian ? "jacobian"
                          : !work     ? "work"
                          : !result   ? "result"
                                      : NULL;
    if (missing)
        return refuse(failure, "%s is NULL, expected one", missing);
    for (int j = 0; j < n; j++)
        if (!isfinite(x[j]))
            return refuse(failure, "x[%d] is %g, expected a number to start from", j, x[j]);
    return ROTID_OK;
}

static int run(int m, int n, rotid_residual residual, void *user, const rotid_lm_options *options, char *failure, double *x,
               double *r, double *jacobian, double *work, rotid_lm_result *result)
{
    struct lm lm = {.m = m, .n = n, .residual = residual, .user = user, .x = x, .r = r, .jacobian = jacobian, .result = result};
    int status = check_arguments(m, n, residual, x, r, jacobian, work, result, failure);
    if (!status && options)
        status = sized_take(SIZED_LM_OPTIONS, options, failure, &lm.options);
    if (status)
        return status;
    *result = (rotid_lm_result){0};
    if (lm.options.max_iterations <= 0)
        lm.options.max_iterations = 100;
    lm.options.gradient_tolerance = or_default(lm.options.gradient_tolerance, 1e-10);
    lm.options.step_tolerance = or_default(lm.options.step_tolerance, 1e-12);
    lm.options.objective_tolerance = or_default(lm.options.objective_tolerance, 1e-16);
    lm.mu = or_default(lm.options.initial_damping, 1e-14);
    lm.fall = FALL;
    lm.gain = NAN;
    lm.trial = work;
    lm.step = lm.trial + n;
    lm.gradient = lm.step + n;
    lm.norm = lm.gradient + n;
    lm.scale = lm.norm + n;
    lm.floor = lm.scale + n;
    lm.trial_r = lm.floor + n;
    lm.old = lm.trial_r + m;
    lm.work = lm.old + 2 * (size_t)n + (size_t)m + (size_t)m * (size_t)n;
    memset(lm.norm, 0, (size_t)n * sizeof *lm.norm);
    result->status = minimise(&lm);
    result->mu = lm.mu;
    return result->status;
}

int rotid_lm(int m, int n, rotid_residual residual, void *user, const rotid_lm_options *options, char *failure, double *x,
             double *r, double *jacobian, double *work, rotid_lm_result *result)
{
    struct entry entry;
    int status = entry_open(&entry, NULL, failure);
    if (!status)
        status = run(m, n, residual, user, options, failure, x, r, jacobian, work, result);
    return entry_close(&entry, status);
}
