#include "linalg/linalg.h"

#define MU_MOST    1e16   /* beyond it a step is below rounding */
#define MU_LEAST   1e-100 /* no damping; `floor` remains */
#define FIRST      10     /* a first step changes x by no more than this many times itself (More 1978: 0.1 to 100) */
#define LONGER     4      /* than the last step that was good, at most */
#define SHORTER    0.1    /* than a step that failed, at least */
#define HALF       0.5    /* and at most */
#define FALL       3      /* mu falls by this factor behind a good step (Nielsen 1999), by twice as much behind the next one */
#define NOISE      1e-12  /* rounding of J, 1e-16, over the part of x by which it may move what r does not determine */
#define REGULAR    1e-28  /* keeps the QR regular where r is small */
#define FLAT       1e-8   /* decrease over objective below which the noise of a computed objective can hide it */
#define CREEP      5      /* steps whose decrease together tells a creep along a valley */
#define FLAT_TRIES 5      /* steps that neither lower f by more than its noise nor the gradient, before the iteration ends */
#define ROUNDED    1e-14  /* change of r over |D x| that the rounding of x makes: no step can be told from it */
#define HIDDEN     10 /* changes of f by steps from which f should not change: what hides behind them (one change is one sample) */
#define SHRUNK     1e-100 /* of J beside what it was: smaller, its square would have no double */
#define EXPONENT   1000   /* of the unit, at most: its inverse has to have a double, too */

struct lm {
    int m, n;
    rotid_residual residual;
    void *user;
    char *failure;
    int returned; /* by the callback when it was asked last */
    rotid_lm_options options;
    double *x, *r, *jacobian; /* the caller's: the best point */
    double unit;              /* a power of two: the largest component of unit r is between a half and one, and its square has a
                                 double whatever the size of r. Below, what is "in units" is multiplied by it, without rounding */
    double *scaled;           /* r in units */
    double objective;         /* half the square of r in units */
    double *trial, *trial_r, *trial_jacobian;
    double *step, *gradient; /* in units */
    double *column;          /* norms of the Jacobian that was asked for last */
    double *norm, *scale, *scratch, *work;
    double *floor; /* of the damping: parts of the columns of J too small to tell from its rounding */
    rotid_lm_result *result;
    double mu;     /* relative to the present size of J */
    double size;   /* present size of J: the largest |J_j|/D_j, 1 unless every column has shrunk */
    double fall;   /* factor of mu behind the next good step */
    double radius; /* of |D h|, in units */
    double length, gain;
    double noise; /* change of f by the last trial from the best point, 0 where there was none or it had no residual */
};

size_t rotid_lm_workspace(int m, int n)
{
    return m < 1 || n < 1 ? 0 : 8 * (size_t)n + 2 * (size_t)m + (size_t)m * (size_t)n + least_squares_workspace(m, n);
}

/* unit, r in units and half its square, behind a change of r; the radius goes along. */
static void measure(struct lm *lm)
{
    double largest = largest_magnitude(lm->m, lm->r), before = lm->unit, sum = 0;
    int exponent;
    (void)frexp(largest, &exponent);
    if (largest > 0)
        lm->unit = ldexp(1, -(exponent > EXPONENT ? EXPONENT : exponent < -EXPONENT ? -EXPONENT : exponent));
    lm->radius *= lm->unit / before;
    for (int i = 0; i < lm->m; i++) {
        lm->scaled[i] = lm->unit * lm->r[i];
        sum += lm->scaled[i] * lm->scaled[i];
    }
    lm->objective = sum / 2;
    lm->result->objective = sum / 2 / lm->unit / lm->unit;
}

/* |D x| in units */
static double length_of_x(struct lm *lm)
{
    for (int j = 0; j < lm->n; j++)
        lm->scratch[j] = lm->unit * lm->x[j];
    return least_squares_length(lm->n, lm->scale, lm->scratch);
}

/* Why there is nothing to start from, unless the callback has said more. */
static int callback_failed(struct lm *lm, const char *asked)
{
    return lm->failure && *lm->failure ? ROTID_ERROR_CALLBACK
                                       : failure_say(lm->failure, ROTID_ERROR_CALLBACK,
                                                     "residual returned %d when asked for %s, expected 0", lm->returned, asked);
}

/* The Jacobian at the point whose residual was computed last, the norms of its columns in `column`. Nonzero where no usable one
 * exists. */
static int ask_jacobian(struct lm *lm, const double *x, double *jacobian)
{
    lm->result->jacobians++;
    lm->returned = lm->residual(lm->user, lm->m, lm->n, x, NULL, jacobian);
    if (lm->returned)
        return ROTID_ERROR_CALLBACK;
    for (int j = 0; j < lm->n; j++) {
        lm->column[j] = least_squares_length(lm->m, NULL, jacobian + (ptrdiff_t)j * lm->m);
        if (!isfinite(lm->column[j]))
            return ROTID_ERROR_FINITE;
    }
    return ROTID_OK;
}

/* gradient [n] = J'r in units of the Jacobian asked for last, r [m] in units; returns the largest cosine between r and a column
 * of J: with the norm of the column here, not with D: where J has shrunk by 1e10 D would end the iteration. */
static double differentiate(const struct lm *lm, const double *r, const double *jacobian, double *gradient)
{
    double largest = 0, length = least_squares_length(lm->m, NULL, r);
    for (int j = 0; j < lm->n; j++) {
        gradient[j] = product_dot(lm->m, jacobian + (ptrdiff_t)j * lm->m, r);
        if (lm->column[j] > 0 && length > 0)
            largest = fmax(largest, fabs(gradient[j]) / lm->column[j] / length);
    }
    return largest;
}

/* Gradient J'r, scale D = largest column norms so far, cosine, of the best point. Returns whether J has a column. */
static int linearise(struct lm *lm)
{
    double length = sqrt(2 * lm->objective), largest = 0, size = 0;
    lm->result->cosine = differentiate(lm, lm->scaled, lm->jacobian, lm->gradient);
    for (int j = 0; j < lm->n; j++) {
        lm->norm[j] = fmax(lm->norm[j], lm->column[j]);
        largest = fmax(largest, lm->norm[j]);
    }
    for (int j = 0; j < lm->n; j++) { /* where a column has been zero so far any scale keeps the system regular */
        lm->scale[j] = lm->norm[j] > 0 ? lm->norm[j] : largest > 0 ? largest : 1;
        size = fmax(size, lm->column[j] / lm->scale[j]);
    }
    lm->size = size > 0 ? fmax(size, SHRUNK) : 1;
    double part = sqrt(fmax(REGULAR, length > 0 ? NOISE * length / fmax(length, length_of_x(lm)) : 0));
    for (int j = 0; j < lm->n; j++)
        lm->floor[j] = part * lm->column[j];
    return size > 0;
}

/* h'(F^2 h - g)/2, F what damped the step: the decrease that the linear model promises */
static double predicted_decrease(const struct lm *lm, double mu, const double *step)
{
    double sum = 0, root = sqrt(mu) * lm->size;
    for (int j = 0; j < lm->n; j++) {
        double damping = root * lm->scale[j] * step[j], floor = lm->floor[j] * step[j];
        sum += damping * damping + floor * floor - step[j] * lm->gradient[j];
    }
    return sum / 2;
}

/* (r - r+)'(r + r+)/2: the difference of two nearly equal sums of squares without their cancellation */
static double actual_decrease(const struct lm *lm)
{
    double sum = 0;
    for (int i = 0; i < lm->m; i++)
        sum += (lm->scaled[i] - lm->unit * lm->trial_r[i]) * (lm->scaled[i] + lm->unit * lm->trial_r[i]);
    return sum / 2;
}

static int negligible(const struct lm *lm, const double *step)
{
    double eps = lm->options.step_tolerance;
    for (int j = 0; j < lm->n; j++)
        if (!(fabs(step[j] / lm->unit) <= eps * (fabs(lm->x[j]) + eps)))
            return 0;
    return 1;
}

/* step [n] within radius; its damping is the given mu or larger. */
static int solve(struct lm *lm, double radius, double *mu, double *step)
{
    double square = lm->size * lm->size, damping = *mu * square;
    if (least_squares_damped_step(lm->m, lm->n, lm->jacobian, lm->scaled, lm->scale, lm->floor, radius, &damping, step,
                                  &lm->length, lm->work))
        return ROTID_ERROR_LIBRARY;
    *mu = damping / square;
    return ROTID_OK;
}

/* Damping and radius make any step short and any promise small, so neither tells a minimum: the Gauss-Newton step does. Returns
 * STOP_STEP where that is negligible; STOP_OBJECTIVE where what it promises drowns in the noise of f (stated or seen: the last
 * trial was too short to change f) or in the rounding of x, or where no parameter alone would lower f by more than the noise, f
 * cos^2 (at the minimum of m = n residuals that do not vanish J is singular, and the Gauss-Newton step promises all of f);
 * STOP_STALLED where there is something to gain: J is not that of r, or r does not follow it as far as any step that can be told
 * from none. */
static int what_is_left(struct lm *lm)
{
    double mu = MU_LEAST, length = lm->length, rounded = ROUNDED * length_of_x(lm);
    if (solve(lm, INFINITY, &mu, lm->scratch))
        return ROTID_ERROR_LIBRARY;
    lm->length = length;
    double promise = predicted_decrease(lm, mu, lm->scratch);
    if (negligible(lm, lm->scratch))
        return ROTID_STOP_STEP;
    return promise <= fmax(FLAT, lm->options.objective_tolerance) * lm->objective || promise <= HIDDEN * lm->noise ||
                   2 * promise <= rounded * rounded || lm->result->cosine * lm->result->cosine <= FLAT
               ? ROTID_STOP_OBJECTIVE
               : ROTID_STOP_STALLED;
}

/* A damped step from x, behind `failed` others from there. Returns 0 with the trial point and its residual in place, a stop
 * reason, or an error. *refused: the trial has no residual. */
static int try_step(struct lm *lm, int failed, double *predicted, int *refused)
{
    if (solve(lm, lm->radius, &lm->mu, lm->step))
        return ROTID_ERROR_LIBRARY;
    *predicted = predicted_decrease(lm, lm->mu, lm->step);
    if (negligible(lm, lm->step) || !(*predicted > lm->options.objective_tolerance * lm->objective)) {
        int reason = what_is_left(lm);
        if (failed || reason != ROTID_STOP_STALLED) /* else damping is left from where it was due: the next steps may be longer */
            return reason;
    }
    for (int j = 0; j < lm->n; j++)
        lm->trial[j] = lm->x[j] + lm->step[j] / lm->unit;
    if (!all_finite(lm->n, lm->trial)) { /* a column so small that the step overflows */
        *refused = 1;
        return ROTID_OK;
    }
    lm->result->evaluations++;
    *refused = lm->residual(lm->user, lm->m, lm->n, lm->trial, lm->trial_r, NULL) || !all_finite(lm->m, lm->trial_r);
    return ROTID_OK;
}

/* To the trial, whose residual and Jacobian are there. */
static void move(struct lm *lm)
{
    memcpy(lm->x, lm->trial, (size_t)lm->n * sizeof *lm->x);
    memcpy(lm->r, lm->trial_r, (size_t)lm->m * sizeof *lm->r);
    memcpy(lm->jacobian, lm->trial_jacobian, (size_t)lm->m * (size_t)lm->n * sizeof *lm->jacobian);
    measure(lm);
    (void)linearise(lm); /* J = 0: the gradient has vanished */
}

/* After an accepted step: update mu (Nielsen 1999) and the step bound. */
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

/* After a rejected step: f along the step is a parabola through the known values, whose minimum is the next length (More 1978).
 */
static void tighten(struct lm *lm, double actual, int refused)
{
    double slope = 0;
    for (int j = 0; j < lm->n; j++)
        slope += lm->gradient[j] * lm->step[j];
    double part = refused ? SHORTER : actual < 0 ? HALF * slope / (slope + actual) : HALF;
    lm->radius = fmax(SHORTER, fmin(HALF, part)) * lm->length;
    lm->fall = FALL;
}

/* Steps of growing damping until one lowers the objective and has a Jacobian; x moves there. */
static int descend(struct lm *lm)
{
    lm->noise = 0;
    for (int failed = 0, flat_steps = 0;; failed = 1) {
        double predicted, actual, flat = FLAT * lm->objective;
        int refused = 0, status = try_step(lm, failed, &predicted, &refused);
        if (status)
            return status;
        actual = refused ? -1 : actual_decrease(lm);
        lm->gain = refused ? -1 : actual / predicted;
        lm->noise = refused ? 0 : fabs(actual);
        if (lm->gain > 0.25 || (lm->gain > 0 && predicted > flat)) {
            refused = ask_jacobian(lm, lm->trial, lm->trial_jacobian);
            if (!refused) {
                relax(lm);
                move(lm);
                return ROTID_OK;
            }
        } else if (!refused && predicted < flat && fabs(actual) < flat && what_is_left(lm) != ROTID_STOP_STALLED) {
            /* Near the minimum the decrease drowns in the rounding of r long before the gradient does (Hager and Zhang 2005 make
             * the same point for line searches): the step is then judged by the gradient. */
            double before = lm->result->cosine, now;
            refused = ask_jacobian(lm, lm->trial, lm->trial_jacobian);
            for (int i = 0; i < lm->m; i++)
                lm->work[i] = lm->unit * lm->trial_r[i];
            now = refused ? INFINITY : differentiate(lm, lm->work, lm->trial_jacobian, lm->scratch);
            if (now < before) {
                if (now < before / 3)
                    lm->mu = fmax(lm->mu / FALL, MU_LEAST);
                move(lm);
                return ROTID_OK;
            }
            if (!refused && ++flat_steps == FLAT_TRIES)
                return what_is_left(lm);
        }
        tighten(lm, actual, refused);
        if (lm->mu > MU_MOST)
            return what_is_left(lm);
    }
}

static int report(struct lm *lm)
{
    if (!lm->options.trace)
        return 0;
    for (int j = 0; j < lm->n; j++)
        lm->scratch[j] = lm->gradient[j] / lm->unit;
    rotid_lm_iteration now = {.iteration = lm->result->iterations,
                              .objective = lm->result->objective,
                              .mu = lm->mu,
                              .gain_ratio = lm->gain,
                              .cosine = lm->result->cosine,
                              .x = lm->x,
                              .gradient = lm->scratch};
    return lm->options.trace(lm->options.trace_user, &now);
}

/* objective: of the last CREEP points and this one, one after the other */
static int creeps(const struct lm *lm, double *objective)
{
    int now = lm->result->iterations;
    double *before = &objective[now % CREEP], then = *before;
    *before = lm->result->objective;
    double worth = fmax(lm->options.decrease_tolerance * *before, lm->options.decrease_least);
    return now >= CREEP && worth > 0 && then - *before < worth;
}

static int minimise(struct lm *lm)
{
    double objective[CREEP];
    lm->result->evaluations = 1;
    lm->returned = lm->residual(lm->user, lm->m, lm->n, lm->x, lm->r, NULL);
    if (lm->returned)
        return callback_failed(lm, "r at the start");
    if (!all_finite(lm->m, lm->r))
        return ROTID_ERROR_FINITE;
    measure(lm);
    int status = ask_jacobian(lm, lm->x, lm->jacobian);
    if (status == ROTID_ERROR_CALLBACK)
        return callback_failed(lm, "the jacobian");
    if (!status && !linearise(lm) && lm->objective > 0)
        status = ROTID_ERROR_RANK;
    /* where x says how far away things are, a part of that; but x may happen to be near zero: then as far as would take all of r
     */
    lm->radius = fmax(FIRST * length_of_x(lm), sqrt(2 * lm->objective));
    while (!status) {
        if (report(lm))
            return ROTID_STOP_CANCELLED;
        if (lm->objective == 0 || lm->result->cosine <= lm->options.gradient_tolerance)
            return ROTID_STOP_GRADIENT;
        if (creeps(lm, objective))
            return ROTID_STOP_OBJECTIVE;
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
    struct lm lm = {.m = m,
                    .n = n,
                    .residual = residual,
                    .user = user,
                    .failure = failure,
                    .x = x,
                    .r = r,
                    .jacobian = jacobian,
                    .result = result};
    int status = check_arguments(m, n, residual, x, r, jacobian, work, result, failure);
    if (!status && options)
        status = sized_take(SIZED_LM_OPTIONS, options, failure, &lm.options);
    if (status)
        return status;
    *result = (rotid_lm_result){0};
    if (lm.options.max_iterations <= 0)
        lm.options.max_iterations = 1000;
    lm.options.gradient_tolerance = or_default(lm.options.gradient_tolerance, 1e-10);
    lm.options.step_tolerance = or_default(lm.options.step_tolerance, 1e-12);
    lm.options.objective_tolerance = or_default(lm.options.objective_tolerance, 1e-16);
    lm.mu = or_default(lm.options.initial_damping, 1e-14);
    lm.fall = FALL;
    lm.gain = NAN;
    lm.unit = 1;
    lm.trial = work;
    lm.step = lm.trial + n;
    lm.gradient = lm.step + n;
    lm.norm = lm.gradient + n;
    lm.scale = lm.norm + n;
    lm.floor = lm.scale + n;
    lm.scratch = lm.floor + n;
    lm.column = lm.scratch + n;
    lm.scaled = lm.column + n;
    lm.trial_r = lm.scaled + m;
    lm.trial_jacobian = lm.trial_r + m;
    lm.work = lm.trial_jacobian + (size_t)m * (size_t)n;
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
