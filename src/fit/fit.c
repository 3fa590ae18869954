#include <limits.h>

#include "fit/fit.h"

#define UNSEEN       1e-11 /* of the largest column of the Jacobian */
#define RANK         1e-10 /* singular values below this part of the largest are rounding */
#define UNDETERMINED 0.5   /* relative standard deviation along a direction: about as much change is allowed as there is value */
#define TAKES_PART   0.3   /* component of a unit direction */
#define FREE         1e-6 /* a component of a direction without any information that still leaves a parameter without an interval */

size_t covariance_workspace(int m, int n)
{
    size_t square = (size_t)n * (size_t)n;
    return (size_t)m * (size_t)n + 2 * square + (size_t)n + singular_values_workspace(m, n);
}

/* inner [n * n] := sum over rows of s_i^2 J_i' J_i in the basis of the right singular vectors, divided by the singular values:
 * S^-1 U' diag(s^2) U S^-1, without U. Directions below the rank are left zero. */
static void inner_covariance(const struct covariance_input *in, const double *jacobian, const rotid_fit_result *result,
                             double *inner, double *row)
{
    int m = in->m, n = in->n;
    memset(inner, 0, (size_t)n * (size_t)n * sizeof *inner);
    for (int i = 0; i < m; i++) {
        double std = in->noise_std ? in->noise_std[i] : 1;
        for (int j = 0; j < n; j++) {
            double s = result->singular_value[j], sum = 0;
            for (int k = 0; k < n; k++)
                sum += jacobian[i + (ptrdiff_t)k * m] * result->direction[k + (ptrdiff_t)j * n];
            row[j] = s > RANK * result->singular_value[0] ? sum / (s * s) : 0;
        }
        for (int j = 0; j < n; j++)
            for (int k = 0; k < n; k++)
                inner[k + (ptrdiff_t)j * n] += std * std * row[j] * row[k];
    }
}

static void scale_of_noise(const struct covariance_input *in, int nfixed, rotid_fit_result *result)
{
    double chi2 = 0;
    for (int i = 0; i < in->m; i++) {
        double r = in->noise_std ? in->r[i] / in->noise_std[i] : in->r[i];
        chi2 += r * r;
    }
    result->dof = in->m - (in->n - nfixed) - in->nscale;
    result->variance_from_residuals = !in->noise_std;
    result->chi2 = in->noise_std ? chi2 : NAN;
    result->chi2_per_dof = in->noise_std && result->dof > 0 ? chi2 / result->dof : NAN;
    result->widened_by = in->noise_std && result->chi2_per_dof > 1 ? sqrt(result->chi2_per_dof) : 1;
}

/* cov [n * n] of the relative parameters := V inner V' variance */
static void outer_covariance(int n, const double *direction, const double *inner, double variance, double *cov)
{
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
            double sum = 0;
            for (int j = 0; j < n; j++)
                for (int k = 0; k < n; k++)
                    sum += direction[a + (ptrdiff_t)j * n] * inner[j + (ptrdiff_t)k * n] * direction[b + (ptrdiff_t)k * n];
            cov[a + (ptrdiff_t)b * n] = variance * sum;
        }
}

/* Which directions, and with them which parameters, the data leave open. */
static void judge_directions(const struct covariance_input *in, const double *inner, double variance, double t,
                             rotid_fit_result *result)
{
    int n = in->n;
    for (int p = 0; p < n; p++)
        result->identifiable[p] = !in->fixed[p];
    for (int j = 0; j < n; j++) {
        double s = result->singular_value[j], spread = sqrt(variance * inner[j + (ptrdiff_t)j * n]);
        int rank_lost = !(s > RANK * result->singular_value[0]), of_fixed = 0;
        for (int p = 0; p < n; p++)
            of_fixed |= in->fixed[p] && fabs(result->direction[p + (ptrdiff_t)j * n]) > 0.999;
        result->direction_undetermined[j] = !of_fixed && (rank_lost || (isfinite(spread) && spread > UNDETERMINED));
        for (int p = 0; p < n && result->direction_undetermined[j]; p++) {
            double part = fabs(result->direction[p + (ptrdiff_t)j * n]);
            if (part >= (rank_lost ? FREE : TAKES_PART))
                result->identifiable[p] = 0;
            if (rank_lost && part >= FREE)
                result->std[p] = NAN;
        }
        result->any_undetermined |= result->direction_undetermined[j];
    }
    for (int p = 0; p < n; p++)
        if (t * result->std[p] > fabs(in->x[p])) { /* the 95 % interval holds zero */
            result->identifiable[p] = 0;
            result->any_undetermined = 1;
        }
}

int covariance_compute(const struct covariance_input *in, rotid_fit_result *result, double *work)
{
    int m = in->m, n = in->n, nfixed = 0;
    double *jacobian = work, *inner = jacobian + (ptrdiff_t)m * n, *cov = inner + (ptrdiff_t)n * n, *row = cov + (ptrdiff_t)n * n;
    memcpy(jacobian, in->jacobian, (size_t)m * (size_t)n * sizeof *jacobian);
    for (int p = 0; p < n; p++)
        if (in->fixed[p]) {
            memset(jacobian + (ptrdiff_t)p * m, 0, (size_t)m * sizeof *jacobian);
            nfixed++;
        }
    if (n && singular_values(m, n, jacobian, result->singular_value, result->direction, row + n))
        return ROTID_ERROR_LIBRARY;
    double least = n > nfixed ? result->singular_value[n - nfixed - 1] : 0;
    result->condition_number = least > 0 ? result->singular_value[0] / least : n ? INFINITY : NAN;
    inner_covariance(in, jacobian, result, inner, row);
    scale_of_noise(in, nfixed, result);

    double variance = result->widened_by * result->widened_by;
    int stated = in->noise_std || result->dof > 0;
    if (!in->noise_std && result->dof > 0)
        variance = 2 * result->objective / result->dof;
    if (!stated)
        variance = NAN;
    outer_covariance(n, result->direction, inner, variance, cov);
    for (int p = 0; p < n; p++)
        result->std[p] = in->fixed[p] ? NAN : fabs(in->x[p]) * sqrt(cov[p + (ptrdiff_t)p * n]);
    double t = quantile_student_95(in->noise_std && result->widened_by <= 1 ? 0 : result->dof);
    judge_directions(in, inner, variance, t, result);
    for (int p = 0; p < n; p++) {
        result->ci_lower[p] = in->x[p] - t * result->std[p];
        result->ci_upper[p] = in->x[p] + t * result->std[p];
        for (int q = 0; q < n; q++) {
            ptrdiff_t pq = p + (ptrdiff_t)q * n;
            int known = isfinite(result->std[p]) && isfinite(result->std[q]);
            result->covariance[pq] = known ? cov[pq] * fabs(in->x[p] * in->x[q]) : NAN;
            result->correlation[pq] = known ? cov[pq] / sqrt(cov[p + (ptrdiff_t)p * n] * cov[q + (ptrdiff_t)q * n]) : NAN;
        }
    }
    return ROTID_OK;
}

#define HISTORY 101 /* iterations that there is room for from the start: those of the default, and iteration 0 */
#define LEAP    5   /* of chi y in one step: further, the sigmoid saturates, J vanishes, and the parameter is caught at a bound */

struct fit {
    const rotid_parameter *parameter;
    const rotid_environment *environment;
    struct joint joint;
    rotid_fit_options options;
    rotid_fit_result *result;
    struct pool *keep;
    int n, named, callback_status, history_rows, history_failed;
    int beside;    /* evaluations of the states that the minimiser did not ask for */
    char *failure; /* of the host: why the last evaluation failed */
    double *x, *y, *r, *jacobian, *work;
    double *bounded;        /* dr/dx that was asked for last */
    const double *known;    /* r at the start, where the joint stands there already, until it is asked for */
    int jacobian_known;     /* nonzero: `jacobian` and `bounded` are those there, until they are asked for */
    const double *accepted; /* y of the last accepted point, NULL before the first */
    int before;             /* iterations before those of the minimiser that runs */
    double begin;           /* on the clock */
};

void rotid_fit_defaults(size_t size, rotid_fit_options *options)
{
    const rotid_fit_options standard = {.size = size,
                                        .functional = ROTID_LIKELIHOOD,
                                        .reduction = ROTID_REDUCTION_NONE,
                                        .derivative = ROTID_NELSON,
                                        .max_iterations = 100,
                                        .gradient_tolerance = 1e-10,
                                        .step_tolerance = 1e-12,
                                        .bijection_chi = 0.05};
    memset(options, 0, size);
    memcpy(options, &standard, size < sizeof standard ? size : sizeof standard);
}

/* A column that is rounding beside the largest one is of an unknown that the data do not see: zero, or its steps are noise. */
static void clear_rounding(int m, int n, double *jacobian)
{
    double largest = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int p = 0; p < n; p++) {
            double *column = jacobian + (ptrdiff_t)m * p, norm = sqrt(product_dot(m, column, column));
            if (!pass)
                largest = fmax(largest, norm);
            else if (norm < UNSEEN * largest)
                memset(column, 0, (size_t)m * sizeof *column);
        }
}

/* rotid_residual in the unbounded variables y */
static int residual(void *user, int m, int n, const double *y, double *r, double *jacobian)
{
    struct fit *fit = user;
    double chi = fit->options.bijection_chi;
    if (fit->failure)
        *fit->failure = 0; /* what is left at the end is of the evaluation that ended the call */
    for (int p = 0; r && fit->accepted && p < n; p++)
        if (!(fabs(chi * (y[p] - fit->accepted[p])) <= LEAP))
            return 1;
    for (int p = 0; p < n; p++)
        fit->x[p] = bounds_to_x(&fit->parameter[p], chi, y[p]);
    if (r && fit->known) {
        memcpy(r, fit->known, (size_t)m * sizeof *r);
        fit->known = NULL;
        fit->beside--;
        fit->callback_status = ROTID_OK;
    } else if (r) {
        fit->callback_status = joint_residual(&fit->joint, fit->x, r);
    } else if (fit->jacobian_known) {
        fit->jacobian_known = 0;
    } else {
        fit->callback_status = joint_jacobian(&fit->joint, fit->x, fit->bounded);
        bounds_jacobian(m, n, fit->parameter, chi, y, fit->bounded, jacobian);
        clear_rounding(m, n, jacobian);
    }
    return fit->callback_status && fit->named ? failure_say_of(fit->failure, fit->callback_status, "state[%d]: ", fit->joint.last)
                                              : fit->callback_status;
}

/* Predicted frequencies, correlation and residual of every mode at the last evaluation, those of a state from `first` on. */
static void compare_modes(struct functional *f, int first, rotid_fit_result *result)
{
    for (int k = 0; k < f->measured->nmode; k++) {
        result->predicted_hz[first + k] = prediction_hz(&f->prediction, f->pair[k]);
        result->residual[first + k] = functional_frequency_residual(f, k);
        result->mac[first + k] = functional_mac(f, k);
    }
}

/* A trace that keeps nothing of the models near the start. */
static int trace_near(void *user, const rotid_lm_iteration *now)
{
    struct fit *fit = user;
    fit->accepted = now->x;
    return environment_cancelled(fit->environment);
}

/* Everything that is known of an accepted point while the functional stands there: the host is not asked for it again, as it may
 * have failed for good since. */
static void keep_point(struct fit *fit)
{
    rotid_fit_result *result = fit->result;
    memcpy(result->x, fit->x, (size_t)fit->n * sizeof *result->x);
    memcpy(result->r, fit->r, (size_t)result->nresidual * sizeof *result->r);
    memcpy(result->jacobian, fit->bounded, (size_t)result->nresidual * (size_t)fit->n * sizeof *result->jacobian);
    for (int s = 0, first = 0; s < result->nstate; first += result->state_m[s++])
        compare_modes(&fit->joint.part[s].functional, first, result);
}

/* Room for twice as many iterations. Returns 0, or 1 where memory runs out. */
static int grow_history(struct fit *fit)
{
    rotid_fit_result *result = fit->result;
    size_t rows = 2 * (size_t)fit->history_rows, n = (size_t)fit->n;
    size_t taken = (size_t)result->nhistory;
    rotid_fit_iteration *history = POOL_COPY(fit->keep, result->history, taken, rows - taken);
    double *x = POOL_COPY(fit->keep, result->history_x, taken * n, (rows - taken) * n);
    if (!history || !x || rows > INT_MAX)
        return 1;
    result->history = history;
    result->history_x = x;
    fit->history_rows = (int)rows;
    return 0;
}

/* Keeps the point, and the history in the variables x/|start|; polls the host. */
static int trace(void *user, const rotid_lm_iteration *now)
{
    struct fit *fit = user;
    rotid_fit_result *result = fit->result;
    int n = fit->n, row = result->nhistory;
    fit->accepted = now->x;
    keep_point(fit);
    fit->history_failed = row == fit->history_rows && grow_history(fit);
    if (fit->history_failed)
        return 1;
    double *x = result->history_x + (ptrdiff_t)row * n, step = 0, gradient = 0;
    for (int p = 0; p < n; p++) {
        double unit = fabs(fit->parameter[p].start),
               slope = bounds_slope(&fit->parameter[p], fit->options.bijection_chi, now->x[p]);
        x[p] = bounds_to_x(&fit->parameter[p], fit->options.bijection_chi, now->x[p]);
        if (slope != 0)
            gradient = fmax(gradient, fabs(now->gradient[p] / slope * unit));
        if (row)
            step += (x[p] - x[p - n]) * (x[p] - x[p - n]) / (unit * unit);
    }
    result->history[row] = (rotid_fit_iteration){.iteration = fit->before + now->iteration,
                                                 .objective = now->objective,
                                                 .gradient = gradient,
                                                 .mu = now->mu,
                                                 .gain_ratio = now->gain_ratio,
                                                 .step = sqrt(step),
                                                 .seconds = clock_seconds() - fit->begin};
    result->nhistory++;
    environment_progress(fit->environment, "Levenberg-Marquardt, iteration", fit->before + now->iteration);
    return environment_cancelled(fit->environment);
}

static int new_result(struct pool *keep, const struct joint *joint, int history_rows, rotid_fit_result *result)
{
    int n = joint->nparam, nresidual = joint->nresidual, m = 0;
    size_t square = (size_t)n * (size_t)n, rows = (size_t)history_rows;
    result->nstate = joint->nstate;
    result->state_m = POOL_ARRAY(keep, int, joint->nstate);
    result->state_nresidual = POOL_ARRAY(keep, int, joint->nstate);
    if (!result->state_m || !result->state_nresidual)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < joint->nstate; s++) {
        m += result->state_m[s] = joint->part[s].functional.measured->nmode;
        result->state_nresidual[s] = joint->part[s].functional.nresidual;
    }
    result->n = n;
    result->m = m;
    result->nresidual = nresidual;
    result->r = POOL_ARRAY(keep, double, nresidual);
    result->jacobian = POOL_ARRAY(keep, double, (size_t)nresidual *(size_t)n);
    double **arrays[] = {&result->x, &result->std, &result->ci_lower, &result->ci_upper, &result->singular_value};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        *arrays[i] = POOL_ARRAY(keep, double, n);
    double **by_mode[] = {&result->predicted_hz, &result->mac, &result->residual};
    for (size_t i = 0; i < sizeof by_mode / sizeof *by_mode; i++)
        *by_mode[i] = POOL_ARRAY(keep, double, m);
    result->at_bound = POOL_ARRAY(keep, int, n);
    result->identifiable = POOL_ARRAY(keep, int, n);
    result->direction_undetermined = POOL_ARRAY(keep, int, n);
    result->covariance = POOL_ARRAY(keep, double, square);
    result->correlation = POOL_ARRAY(keep, double, square);
    result->direction = POOL_ARRAY(keep, double, square);
    result->history = POOL_ARRAY(keep, rotid_fit_iteration, rows);
    result->history_x = POOL_ARRAY(keep, double, rows *(size_t)n);
    result->baseline = POOL_ARRAY(keep, rotid_baseline, baseline_count(n));
    return keep->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

/* Standard deviations of the residuals: of the noise the user states, in the units of the functional. NULL where it is not known.
 */
static const double *residual_noise(const struct fit *fit, double *std)
{
    const struct joint *joint = &fit->joint;
    int row = 0;
    for (int i = 0; i < joint->nresidual; i++)
        std[i] = 1;
    for (int s = 0; s < joint->nstate; s++) {
        const rotid_measured *measured = joint->part[s].functional.measured;
        if (!joint->part[s].functional.nresidual)
            continue;
        if (!measured->frequency_std)
            return NULL;
        for (int k = 0; k < measured->nmode && fit->options.functional != ROTID_LIKELIHOOD; k++)
            if (functional_fits(measured, k)) /* r = 1 - lambda/w^2 moves by twice, 1 - w~/w^ by once the relative error of w^ */
                std[row++] = (fit->options.functional == ROTID_HYBRID ? 2 : 1) * measured->frequency_std[k];
    }
    return std;
}

static int count_scales(const struct fit *fit)
{
    int count = 0;
    for (int s = 0; s < fit->joint.nstate && fit->options.functional == ROTID_LIKELIHOOD; s++) {
        const struct functional *f = &fit->joint.part[s].functional;
        for (int k = 0; k < f->measured->nmode; k++)
            count += functional_count_components(f, k) > 0 && functional_fits(f->measured, k);
    }
    return count;
}

/* Largest component of the Gauss-Newton step that is left, in relative parameters, fixed ones apart. */
static double step_left(const struct fit *fit, const double *relative_gradient)
{
    const rotid_fit_result *result = fit->result;
    int n = fit->n;
    double worst = 0;
    for (int p = 0; p < n; p++) {
        double h = 0;
        for (int j = 0; j < n; j++) {
            double s = result->singular_value[j], c = 0;
            for (int q = 0; q < n; q++)
                c += result->direction[q + (ptrdiff_t)j * n] * (result->at_bound[q] ? 0 : relative_gradient[q]);
            if (s > 1e-8 * result->singular_value[0])
                h += result->direction[p + (ptrdiff_t)j * n] * c / (s * s);
        }
        worst = fmax(worst, fabs(h));
    }
    return worst;
}

#define KNOWN_APART 3 /* standard deviations: so far from a bound the data know a value that is near it for its wide range */

/* Everything about the best point. */
static int conclude(struct fit *fit, const rotid_lm_result *lm)
{
    rotid_fit_result *result = fit->result;
    int n = fit->n, m = fit->joint.nresidual, pulled_inside = 0;
    double *noise = fit->work, *gradient = noise + m, *rest = gradient + n;
    result->status = lm->status;
    result->iterations = lm->iterations;
    result->evaluations = lm->evaluations + fit->beside;
    result->jacobians = lm->jacobians;
    result->objective = 0;
    for (int i = 0; i < m; i++)
        result->objective += result->r[i] * result->r[i] / 2;
    for (int p = 0; p < n; p++) {
        double g = 0, square = 0, *relative = fit->jacobian + (ptrdiff_t)p * m;
        for (int i = 0; i < m; i++) {
            relative[i] = result->jacobian[i + (ptrdiff_t)p * m] * fabs(result->x[p]);
            square += relative[i] * relative[i];
            g += relative[i] * result->r[i];
        }
        gradient[p] = g;
        result->gradient = fmax(result->gradient, fabs(g * fit->parameter[p].start / result->x[p]));
        int side = bounds_pressed(&fit->parameter[p], result->x[p]);
        double apart = side < 0 ? result->x[p] - fit->parameter[p].lower : fit->parameter[p].upper - result->x[p];
        if (square * apart * apart * (m - n) > KNOWN_APART * KNOWN_APART * 2 * result->objective * result->x[p] * result->x[p])
            side = 0;
        result->at_bound[p] = side != 0;
        result->any_at_bound |= side != 0;
        /* f falls towards the inside, by more than rounding: the parameter was only caught there */
        pulled_inside |= side * g > 1e-6 * sqrt(2 * square * result->objective);
    }
    struct covariance_input input = {.m = m,
                                     .n = n,
                                     .jacobian = fit->jacobian,
                                     .r = result->r,
                                     .noise_std = residual_noise(fit, noise),
                                     .nscale = count_scales(fit),
                                     .x = result->x,
                                     .fixed = result->at_bound};
    int status = covariance_compute(&input, result, rest);
    /* a stop on the limit, or a stall, may still be at the minimum: the step that is left decides */
    result->converged = result->status != ROTID_STOP_CANCELLED && !pulled_inside &&
                        (rotid_status_converged(result->status) || step_left(fit, gradient) < 1e-6);
    return status;
}

/* Where nothing is to be minimised, as the models near y are at their minimum there, or there are no parameters: what is known of
 * that point. status: why it is the end. */
static int compare_only(struct fit *fit, int status, rotid_lm_result *lm)
{
    int m = fit->joint.nresidual, n = fit->n;
    double *gradient = fit->work;
    *lm = (rotid_lm_result){.evaluations = 1, .jacobians = n > 0};
    if (residual(fit, m, n, fit->y, fit->r, NULL) || (n && residual(fit, m, n, fit->y, NULL, fit->jacobian)))
        return ROTID_ERROR_CALLBACK;
    lm->objective = product_dot(m, fit->r, fit->r) / 2;
    if (!isfinite(lm->objective))
        return ROTID_ERROR_FINITE;
    for (int p = 0; p < n; p++)
        gradient[p] = product_dot(m, fit->jacobian + (ptrdiff_t)p * m, fit->r);
    rotid_lm_iteration now = {.objective = lm->objective, .gain_ratio = NAN, .x = fit->y, .gradient = gradient};
    lm->status = trace(fit, &now) ? ROTID_STOP_CANCELLED : status;
    return lm->status;
}

/* *joint: of models near the point that was evaluated last, where there are any, else *there is 0. */
static int open_near(struct pool *pool, struct fit *fit, const struct fit_problem *problem, int anew, struct joint *joint,
                     int *there)
{
    const rotid_fit_options *options = &fit->options;
    const struct joint_state *state;
    int status = problem->near->models(problem->near->user, pool, &fit->joint, anew, &state);
    if (!status)
        status = joint_new(pool, options->functional, options->reduction, options->derivative, fit->n, problem->nstate, state,
                           problem->more, joint);
    *there = !status;
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
}

#define NEAR_ROUNDS 6
#define NEAR_AGREES 1e-6 /* of the objective, or a hundredth of the decrease that is worth nothing */

/* r'r/2 of the states at x, infinite where there is none */
static double objective_at(struct fit *fit, const double *x)
{
    int m = fit->joint.nresidual;
    fit->beside++;
    double sum = joint_residual(&fit->joint, x, fit->r) ? (double)INFINITY : product_dot(m, fit->r, fit->r) / 2;
    return isfinite(sum) ? sum : (double)INFINITY;
}

/* y := the minimum of models near the start, made anew where the last one ended until they agree there with the states: what the
 * minimiser has to do with the states themselves is a step then, or, where a decrease is worth nothing, none (*end: why the
 * minimum of the models is one; else 0): what a step still promises there comes from jumps of the model, and the Jacobian of the
 * models, 1e-5 to 1e-4 off, is that of the fit. A point that is no better for the states is left, but known to the next models.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
static int begin_near(struct pool *pool, struct fit *fit, const struct fit_problem *problem, rotid_lm_options *options, int *end)
{
    int n = fit->n, there = 1, agrees = 0, stands = 0, status = ROTID_OK;
    double *best = POOL_ARRAY(pool, double, n), *r = POOL_ARRAY(pool, double, fit->joint.nresidual), lowest,
           worth = options->decrease_least;
    const struct joint full = fit->joint;
    rotid_lm_options near_options = *options;
    struct pool of_round[2]; /* the models of a round go when those of the one behind the next are made */
    if (!best || !r)
        return ROTID_ERROR_MEMORY;
    *end = 0;
    for (int i = 0; i < 2; i++)
        pool_open(&of_round[i], pool->allocator);
    near_options.trace = trace_near;
    memcpy(best, fit->y, (size_t)n * sizeof *best);
    for (int p = 0; p < n; p++)
        fit->x[p] = fit->parameter[p].start;
    lowest = objective_at(fit, fit->x);
    for (int round = 0; round < NEAR_ROUNDS && isfinite(lowest) && !agrees; round++) {
        struct joint near;
        rotid_lm_result lm;
        struct pool *own = &of_round[round % 2];
        pool_close(own);
        pool_open(own, pool->allocator);
        status = open_near(own, fit, problem, round == 0 || stands, &near, &there);
        if (status || !there)
            break;
        memcpy(fit->y, best, (size_t)n * sizeof *best);
        fit->accepted = NULL;
        fit->joint = near;
        int stop = rotid_lm(full.nresidual, n, residual, fit, &near_options, NULL, fit->y, fit->r, fit->jacobian, fit->work, &lm);
        fit->joint = full;
        if (stop < 0 || stop == ROTID_STOP_CANCELLED)
            break;
        for (int p = 0; p < n; p++)
            fit->x[p] = bounds_to_x(&fit->parameter[p], fit->options.bijection_chi, fit->y[p]);
        if (!joint_residual(&near, fit->x, fit->r))
            problem->near->begin(problem->near->user, &near, &fit->joint);
        double now = objective_at(fit, fit->x);
        stands = now < lowest;
        agrees = fabs(now - lm.objective) <= fmax(worth / 100, NEAR_AGREES * now);
        *end = agrees && stands && worth > 0 ? lm.status : 0;
        if (*end) {
            fit->joint = near;
            fit->jacobian_known = !residual(fit, full.nresidual, n, fit->y, NULL, fit->jacobian);
            fit->joint = full;
        }
        if (stands) {
            lowest = now;
            memcpy(best, fit->y, (size_t)n * sizeof *best);
            memcpy(r, fit->r, (size_t)full.nresidual * sizeof *r);
        }
    }
    for (int i = 0; i < 2; i++)
        pool_close(&of_round[i]);
    memcpy(fit->y, best, (size_t)n * sizeof *best);
    fit->accepted = NULL;
    fit->known = stands ? r : NULL;
    if (agrees && lowest > 0)
        options->objective_tolerance = fmax(options->objective_tolerance, worth / lowest);
    return status;
}

#define BESIDE_BOUND 1e-3 /* of the interval: from here a minimum at the bound is tried where no step of y lowers f any more */
#define ON_BOUND     1e-9
#define NO_RISE      1e-6 /* of f: its rounding, and nothing beside its own spread */

/* Towards a bound x(y) flattens, and the minimiser stalls short of a minimum there, where rounding has it. Unknowns beside a
 * bound are put to it and the others fitted on from there; that is the end unless it raises f, else *lm and what
 * is kept of its end stay. ROTID_OK or ROTID_ERROR_MEMORY. */
static int press_to_bounds(struct pool *pool, struct fit *fit, const rotid_lm_options *options, rotid_lm_result *lm)
{
    int n = fit->n, m = fit->joint.nresidual, found = 0;
    double chi = fit->options.bijection_chi, *y = POOL_COPY(pool, fit->y, n, 0);
    rotid_lm_options rest = *options;
    rotid_lm_result trial, last;
    if (!y)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < n; p++) {
        const rotid_parameter *q = &fit->parameter[p];
        double x = fit->result->x[p], span = q->upper - q->lower, part = (x - q->lower) / span;
        int side = part < BESIDE_BOUND ? -1 : part > 1 - BESIDE_BOUND;
        if (side && !bounds_pressed(q, x)) {
            y[p] = bounds_to_y(q, chi, side < 0 ? q->lower + ON_BOUND * span : q->upper - ON_BOUND * span);
            found |= isfinite(y[p]);
        }
    }
    rest.max_iterations -= lm->iterations + 1;
    rest.trace = trace_near;
    fit->accepted = NULL;
    if (!found || rest.max_iterations < 1 ||
        rotid_lm(m, n, residual, fit, &rest, NULL, y, fit->r, fit->jacobian, fit->work, &trial) < 0)
        return ROTID_OK;
    fit->beside += trial.evaluations;
    if (trial.status == ROTID_STOP_CANCELLED)
        lm->status = trial.status;
    if (trial.status == ROTID_STOP_CANCELLED || !(trial.objective <= (1 + NO_RISE) * lm->objective))
        return ROTID_OK;
    rest.trace = trace;
    fit->accepted = NULL;
    fit->before = lm->iterations + 1;
    if (rotid_lm(m, n, residual, fit, &rest, NULL, y, fit->r, fit->jacobian, fit->work, &last) < 0)
        return ROTID_OK;
    last.iterations += fit->before;
    last.evaluations += lm->evaluations;
    last.jacobians += lm->jacobians;
    *lm = last;
    return ROTID_OK;
}

static int run(struct pool *keep, struct pool *pool, struct fit *fit, const struct fit_problem *problem)
{
    const rotid_fit_options *options = &fit->options;
    int n = fit->n, status = joint_new(pool, options->functional, options->reduction, options->derivative, n, problem->nstate,
                                       problem->state, problem->more, &fit->joint);
    int m = fit->joint.nresidual;
    for (int s = 0; s < problem->nstate && !status; s++)
        fit->joint.part[s].functional.prediction.failure = fit->failure;
    fit->keep = keep;
    fit->history_rows = options->max_iterations < HISTORY ? options->max_iterations + 1 : HISTORY;
    if (!status)
        status = new_result(keep, &fit->joint, fit->history_rows, fit->result);
    if (status)
        return status;
    size_t lm_work = rotid_lm_workspace(m, n), end_work = covariance_workspace(m, n) + (size_t)m + (size_t)n;
    fit->x = POOL_ARRAY(pool, double, n);
    fit->y = POOL_ARRAY(pool, double, n);
    fit->r = POOL_ARRAY(pool, double, m);
    fit->jacobian = POOL_ARRAY(pool, double, (size_t)m *(size_t)n);
    fit->work = POOL_ARRAY(pool, double, lm_work > end_work ? lm_work : end_work);
    fit->bounded = POOL_ARRAY(pool, double, (size_t)m *(size_t)n);
    if (!fit->bounded || !fit->x || !fit->y || !fit->r || !fit->jacobian || !fit->work)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < n; p++) {
        const rotid_parameter *q = &fit->parameter[p];
        fit->y[p] = bounds_to_y(q, options->bijection_chi, q->start);
        if (!isfinite(fit->y[p]))
            return refuse(fit->failure, "parameter[%d]%s%.40s has lower %g, start %g, upper %g, expected a start apart from both",
                          p, q->name ? " " : "", q->name ? q->name : "", q->lower, q->start, q->upper);
    }

    rotid_lm_options lm_options = {.size = sizeof lm_options,
                                   .max_iterations = options->max_iterations,
                                   .gradient_tolerance = options->gradient_tolerance,
                                   .step_tolerance = options->step_tolerance,
                                   .decrease_tolerance = options->decrease_tolerance,
                                   .decrease_least = options->decrease_least,
                                   .objective_tolerance = options->objective_tolerance,
                                   .trace = trace,
                                   .trace_user = fit};
    rotid_lm_result lm;
    int end = 0;
    fit->begin = clock_seconds();
    if (n && problem->near)
        status = begin_near(pool, fit, problem, &lm_options, &end);
    if (status)
        return status;
    status = n && !end ? rotid_lm(m, n, residual, fit, &lm_options, NULL, fit->y, fit->r, fit->jacobian, fit->work, &lm)
                       : compare_only(fit, end ? end : ROTID_STOP_GRADIENT, &lm);
    if (status == ROTID_STOP_STALLED && !fit->history_failed && press_to_bounds(pool, fit, &lm_options, &lm))
        return ROTID_ERROR_MEMORY;
    fit->result->seconds = clock_seconds() - fit->begin;
    if (fit->history_failed)
        return ROTID_ERROR_MEMORY;
    if (status < 0)
        return status == ROTID_ERROR_CALLBACK && fit->callback_status ? fit->callback_status : status;
    status = conclude(fit, &lm);
    if (!status && n && options->baseline && lm.status != ROTID_STOP_CANCELLED) {
        int count, there;
        struct joint near;
        there = problem->near && isfinite(objective_at(fit, fit->result->x));
        if (there)
            status = open_near(pool, fit, problem, 1, &near, &there);
        if (!status)
            status = baseline_run(keep, &fit->joint, there ? &near : NULL, fit->parameter, fit->environment, fit->work,
                                  fit->result->baseline, &count);
        if (status == ROTID_STOP_CANCELLED)
            status = ROTID_OK;
        else if (!status)
            fit->result->nbaseline = count;
    }
    return status;
}

static int make_result(struct entry *entry, const struct fit_problem *problem, const rotid_fit_options *options,
                       rotid_fit_result **result)
{
    int status = fit_check(problem, options, entry->failure);
    if (status)
        return status;
    struct pool first, *keep;
    pool_open(&first, entry->environment.allocator);
    rotid_fit_result *made = POOL_NEW(&first, rotid_fit_result);
    keep = made ? POOL_NEW(&first, struct pool) : NULL;
    status = ROTID_ERROR_MEMORY;
    if (keep) {
        struct fit fit = {.parameter = problem->parameter,
                          .environment = &entry->environment,
                          .options = *options,
                          .result = made,
                          .n = problem->nparam,
                          .named = problem->named,
                          .failure = entry->failure};
        rotid_fit_options standard;
        rotid_fit_defaults(sizeof standard, &standard);
        if (fit.options.max_iterations <= 0)
            fit.options.max_iterations = standard.max_iterations;
        if (!(fit.options.bijection_chi > 0))
            fit.options.bijection_chi = standard.bijection_chi;
        status = run(&first, &entry->scratch, &fit, problem);
        *keep = first; /* the result carries the pool that it lives on */
        made->memory = keep;
    }
    if (status)
        pool_close(&first);
    else
        *result = made;
    return status;
}

/* NULL: zeros, the defaults. */
static int take_options(const rotid_fit_options *given, char *failure, rotid_fit_options *options)
{
    memset(options, 0, sizeof *options);
    return given ? sized_take(SIZED_FIT_OPTIONS, given, failure, options) : ROTID_OK;
}

int rotid_fit(const rotid_model *model, const rotid_parameter *parameter, const rotid_measured *measured,
              const rotid_fit_options *options, const rotid_environment *environment, char *failure, rotid_fit_result **result)
{
    struct entry entry;
    rotid_model own_model;
    rotid_measured own_measured;
    rotid_fit_options own_options;
    int status = entry_open(&entry, environment, failure);
    if (result)
        *result = NULL;
    if (!status && (!model || !measured || !result))
        status = refuse(failure, "%s is NULL, expected a struct", !model ? "model" : !measured ? "measured" : "result");
    if (!status)
        status = sized_take(SIZED_MODEL, model, failure, &own_model);
    if (!status)
        status = sized_take(SIZED_MEASURED, measured, failure, &own_measured);
    if (!status)
        status = take_options(options, failure, &own_options);
    const struct joint_state state = {.model = &own_model, .measured = &own_measured};
    const struct fit_problem problem = {.nstate = 1, .nparam = own_model.nparam, .state = &state, .parameter = parameter};
    if (!status)
        status = make_result(&entry, &problem, &own_options, result);
    return entry_close(&entry, status);
}

/* One state into structs of this library's size. */
static int take_state(const char *given, int s, char *failure, rotid_state *own, rotid_model *model, rotid_measured *measured)
{
    size_t size, of_first;
    memcpy(&of_first, given, sizeof of_first);
    given += (size_t)s * of_first;
    memcpy(&size, given, sizeof size);
    if (size != of_first)
        return refuse(failure, "state[%d].size is %zu, expected that of the first, %zu", s, size, of_first);
    int status = sized_take(SIZED_STATE, given, failure, own);
    if (!status && (!own->model || !own->measured))
        status = refuse(failure, "%s is NULL, expected a struct", own->model ? "measured" : "model");
    if (!status)
        status = sized_take(SIZED_MODEL, own->model, failure, model);
    if (!status)
        status = sized_take(SIZED_MEASURED, own->measured, failure, measured);
    return status ? failure_say_of(failure, status, "state[%d]: ", s) : status;
}

static int take_states(struct pool *pool, int nstate, const rotid_state *given, char *failure, struct joint_state **out)
{
    rotid_model *model = POOL_ARRAY(pool, rotid_model, nstate);
    rotid_measured *measured = POOL_ARRAY(pool, rotid_measured, nstate);
    struct joint_state *state = *out = POOL_ARRAY(pool, struct joint_state, nstate);
    int status = model && measured && state ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int s = 0; s < nstate && !status; s++) {
        rotid_state own;
        status = take_state((const char *)given, s, failure, &own, &model[s], &measured[s]);
        if (!status)
            state[s] = (struct joint_state){&model[s], &measured[s], own.parameter};
    }
    return status;
}

int fit_states_more(int nstate, const rotid_state *state, int nparam, const rotid_parameter *parameter,
                    const struct joint_more *more, const struct fit_near *near, const rotid_fit_options *options,
                    const rotid_environment *environment, char *failure, rotid_fit_result **result)
{
    struct entry entry;
    struct joint_state *own;
    rotid_fit_options own_options;
    int status = entry_open(&entry, environment, failure);
    if (result)
        *result = NULL;
    if (!status && (!state || !result))
        status = refuse(failure, "%s is NULL, expected a struct", state ? "result" : "state");
    if (!status && (nstate < 1 || nparam < 0))
        status = nstate < 1 ? refuse(failure, "nstate is %d, expected 1 or more", nstate)
                            : refuse(failure, "nparam is %d, expected 0 or more", nparam);
    if (!status)
        status = take_options(options, failure, &own_options);
    if (!status)
        status = take_states(&entry.scratch, nstate, state, failure, &own);
    if (!status) {
        const struct fit_problem problem = {
            .nstate = nstate, .nparam = nparam, .named = 1, .state = own, .parameter = parameter, .more = more, .near = near};
        status = make_result(&entry, &problem, &own_options, result);
    }
    return entry_close(&entry, status);
}

int rotid_fit_states(int nstate, const rotid_state *state, int nparam, const rotid_parameter *parameter,
                     const rotid_fit_options *options, const rotid_environment *environment, char *failure,
                     rotid_fit_result **result)
{
    return fit_states_more(nstate, state, nparam, parameter, NULL, NULL, options, environment, failure, result);
}

void rotid_fit_free(rotid_fit_result *result)
{
    if (!result)
        return;
    struct pool pool = *(struct pool *)result->memory;
    pool_close(&pool);
}
