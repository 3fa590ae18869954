#include "diagnose/diagnose.h"

double shape_difference(const struct job *job, int k, double mac)
{
    double sum = 0, largest = 0;
    int count = 0;
    for (int s = 0; s < job->rotor.nsensor && job->measurement.shape; s++) {
        double value = job->measurement.shape[s + (ptrdiff_t)k * job->rotor.nsensor];
        if (!isfinite(value))
            continue;
        sum += value * value;
        largest = fmax(largest, fabs(value));
        count++;
    }
    return count > 1 && largest > 0 && isfinite(mac) ? sqrt(fmax(0, 1 - mac) * sum / count) / largest : NAN;
}

/* The state of measured mode k of all; *own: its index there. */
static const struct job *job_of_mode(const struct states *states, int k, int *own)
{
    int s = 0;
    for (; k >= states->state[s].job.measurement.nmode; s++)
        k -= states->state[s].job.measurement.nmode;
    *own = k;
    return &states->state[s].job;
}

static int any_shapes(const struct states *states)
{
    int any = 0;
    for (int s = 0; s < states->nstate; s++)
        any |= job_fits_shapes(&states->state[s].job);
    return any;
}

/* ---- a mode left out: one Gauss-Newton step from the fit of all, and a fit only where the model does not follow that step
 *
 *   (J'J - J_k'J_k) d = -(J'r - J_k'r_k), J_k and r_k the rows of the mode; the model at x + d has the residual r + J d where one
 *   step is all there is */

#define FOLLOWS 0.03 /* standard deviations, every row */

/* marked [nresidual] := 1 for the rows of measured mode k of all, 0 for the others. */
static void mark_rows(const struct states *states, const int *holdout, int k, const rotid_fit_result *fit, char *marked)
{
    int mode = 0, row = 0;
    for (int s = 0; s < states->nstate; row += fit->state_nresidual[s++]) {
        const struct job *job = &states->state[s].job;
        int nsensor = job_fits_shapes(job) ? job->rotor.nsensor : 0, line = row, next = row + job_fitted(job, holdout + mode);
        for (int j = 0; j < job->measurement.nmode; j++, mode++) {
            if (holdout[mode])
                continue;
            marked[line++] = mode == k;
            for (int i = 0; i < nsensor; i++)
                if (isfinite(job->measurement.shape[i + (ptrdiff_t)j * nsensor]))
                    marked[next++] = mode == k;
        }
    }
}

/* x [n] := the fit's, one Gauss-Newton step on without the rows marked; r [nresidual] := what is expected there. work:
 * [m * n + m + 3 n + least_squares_workspace]. Returns 0, or 1 where the rest does not determine x, or a bound is in the way. */
static int step_without(const rotid_parameter *bounds, const rotid_fit_result *fit, const char *marked, double *work, double *x,
                        double *r)
{
    int n = fit->n, m = fit->nresidual;
    double *jacobian = work, *rest = jacobian + (ptrdiff_t)m * n, *one = rest + m, *held = one + n, *step = held + n, damping = 0,
           length;
    memcpy(rest, fit->r, (size_t)m * sizeof *rest); /* rows whose derivatives are zero have no part in a step */
    for (int p = 0; p < n; p++) {
        one[p] = 1;
        held[p] = fit->at_bound[p];
        for (int i = 0; i < m; i++)
            jacobian[i + (ptrdiff_t)p * m] =
                marked[i] || fit->at_bound[p] ? 0 : fit->jacobian[i + (ptrdiff_t)p * m] * fabs(fit->x[p]);
    }
    if (n && least_squares_damped_step(m, n, jacobian, rest, one, held, INFINITY, &damping, step, &length, step + n))
        return 1;
    memcpy(r, fit->r, (size_t)m * sizeof *r);
    for (int p = 0; p < n; p++) {
        double by = step[p] * fabs(fit->x[p]);
        x[p] = fit->x[p] + by;
        for (int i = 0; i < m; i++)
            r[i] += fit->jacobian[i + (ptrdiff_t)p * m] * by;
        if (!(fit->at_bound[p] || (x[p] > bounds[p].lower && x[p] < bounds[p].upper)))
            return 1;
    }
    return 0;
}

/* *follows: whether the model does. The rest as mode_out_fit. */
static int mode_out_step(struct pool *pool, const struct states *states, const rotid_fit_result *fit, const int *number,
                         const int *holdout, int k, double *error_percent, double *shape, int *follows)
{
    size_t n = (size_t)fit->n, m = (size_t)fit->nresidual;
    char *marked = POOL_ARRAY(pool, char, m);
    double *work = POOL_ARRAY(pool, double, m *n + m + 3 * n + least_squares_workspace(fit->nresidual, fit->n)),
           *x = POOL_ARRAY(pool, double, n), *r = POOL_ARRAY(pool, double, m);
    if (!marked || !work || !x || !r)
        return ROTID_ERROR_MEMORY;
    mark_rows(states, holdout, k, fit, marked);
    *follows = !step_without(states->bounds, fit, marked, work, x, r);
    for (int s = 0, mode = 0, row = 0; s < states->nstate && *follows; row += fit->state_nresidual[s], s++) {
        const struct job *job = &states->state[s].job;
        struct columns columns = {0};
        double *own = state_values(pool, &states->state[s], x);
        int is_here = k >= mode && k < mode + job->measurement.nmode, status = own ? ROTID_OK : ROTID_ERROR_MEMORY;
        if (!status && (fit->state_nresidual[s] || is_here))
            status = columns_open(pool, job, number + mode, holdout + mode, NULL, own, &columns);
        if (status == ROTID_ERROR_MEMORY)
            return status;
        *follows = !status && columns.nrow == fit->state_nresidual[s];
        for (int i = 0; i < fit->state_nresidual[s] && *follows; i++)
            *follows = fabs(columns.r[i] - r[row + i]) < FOLLOWS;
        if (is_here && *follows) {
            const struct functional *f = &columns.functional;
            *error_percent = 100 * (prediction_hz(&f->prediction, f->pair[k - mode]) / f->measured->frequency_hz[k - mode] - 1);
            *shape = shape_difference(job, k - mode, functional_mac(f, k - mode));
        }
        mode += job->measurement.nmode;
    }
    return ROTID_OK;
}

int mode_out_fit(const struct states *states, const rotid_fit_result *from, const int *number, const int *holdout, int k,
                 const rotid_environment *environment, const rotid_allocator *allocator, double *error_percent, double *shape)
{
    struct pool pool;
    rotid_fit_result *fit = NULL;
    pool_open(&pool, allocator);
    *error_percent = *shape = NAN;
    int nmode = states_modes(states, states->nstate), own, *without = POOL_ARRAY(&pool, int, nmode), left = 0, follows = 0,
        status = without ? ROTID_OK : ROTID_ERROR_MEMORY;
    const struct job *job = job_of_mode(states, k, &own);
    for (int m = 0; m < nmode && without; m++) {
        without[m] = holdout[m] || m == k;
        left += !without[m];
    }
    if (!status && !(left && (any_shapes(states) || left >= states->nparameter)))
        status = ROTID_ERROR_ARGUMENT;
    if (!status && environment_cancelled(environment))
        status = ROTID_STOP_CANCELLED;
    if (!status && from)
        status = mode_out_step(&pool, states, from, number, holdout, k, error_percent, shape, &follows);
    if (!status && !follows)
        status = refit_until(&pool, states, number, without, 0, environment, &fit);
    if (!status && fit) {
        *error_percent = 100 * (fit->predicted_hz[k] / job->measurement.frequency_hz[own] - 1);
        *shape = shape_difference(job, own, fit->mac[k]);
    }
    rotid_fit_free(fit);
    pool_close(&pool);
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

/* Directions of the scales of the fitted modes of a state behind the `count` columns of the basis, of unit length: they lie in
 * different rows. Residual plus measured shape is the predicted one. next: its first row of a shape. Returns their number then.
 */
static int scale_directions(const struct job *job, const int *holdout, const rotid_fit_result *fit, int next, int count,
                            double *basis)
{
    int nsensor = job->rotor.nsensor;
    for (int k = 0; k < job->measurement.nmode && job_fits_shapes(job); k++) {
        const double *shape = job->measurement.shape + (ptrdiff_t)k * nsensor,
                     *std = job->measurement.shape_std + (ptrdiff_t)k * nsensor;
        double *q = basis + (ptrdiff_t)count * fit->nresidual, largest = largest_magnitude(nsensor, shape), square = 0;
        for (int s = 0; s < nsensor && !holdout[k]; s++) {
            if (!isfinite(shape[s]))
                continue;
            q[next] = fit->r[next] + shape[s] / (largest * std[s]);
            square += q[next] * q[next];
            next++;
        }
        for (int i = 0; i < fit->nresidual && square > 0; i++)
            q[i] /= sqrt(square);
        count += square > 0;
    }
    return count;
}

/* What sensors leave when they are not fitted. */
struct left_out {
    int count;
    double sum, difference; /* of squares */
};

/* The sensors of one state, whose rows begin at `first`. basis [nresidual * rank] */
static int sensors_of_state(struct pool *pool, const struct job *job, const int *holdout, const rotid_fit_result *fit, int first,
                            int rank, const double *basis, struct left_out *out)
{
    int nsensor = job->rotor.nsensor, nrow = fit->nresidual, nfitted = job_fitted(job, holdout), next = first + nfitted;
    int *row = POOL_ARRAY(pool, int, (size_t)nfitted *(size_t)nsensor), *at = POOL_ARRAY(pool, int, nfitted);
    double *right = POOL_ARRAY(pool, double, nfitted);
    struct symmetric block;
    if (!row || !at || !right)
        return ROTID_ERROR_MEMORY;
    int status = symmetric_new(pool, nfitted, &block);
    if (status)
        return status;
    for (int k = 0, m = 0; k < job->measurement.nmode; k++) {
        for (int s = 0; s < nsensor && !holdout[k]; s++)
            row[m + (ptrdiff_t)s * nfitted] = isfinite(job->measurement.shape[s + (ptrdiff_t)k * nsensor]) ? next++ : -1;
        m += !holdout[k];
    }
    for (int s = 0; s < nsensor; s++) {
        int rows = 0;
        for (int m = 0; m < nfitted; m++)
            if (row[m + (ptrdiff_t)s * nfitted] >= 0)
                at[rows++] = row[m + (ptrdiff_t)s * nfitted];
        for (int i = 0; i < rows; i++) { /* residual without the sensor: (I - H_ss)^-1 r_s */
            right[i] = fit->r[at[i]];
            for (int j = 0; j < rows; j++) {
                double h = 0;
                for (int b = 0; b < rank; b++)
                    h += basis[at[i] + (ptrdiff_t)b * nrow] * basis[at[j] + (ptrdiff_t)b * nrow];
                block.a[i + (ptrdiff_t)j * rows] = (i == j) - h;
            }
        }
        if (!rows || symmetric_factor(&block, rows))
            continue;
        symmetric_solve(&block, rows, right);
        for (int i = 0, k = 0, m = 0; k < job->measurement.nmode; k++) {
            if (holdout[k])
                continue;
            if (row[m++ + (ptrdiff_t)s * nfitted] < 0)
                continue;
            double std = job->measurement.shape_std[s + (ptrdiff_t)k * nsensor];
            out->sum += right[i] * right[i];
            out->difference += right[i] * right[i] * std * std;
            i++;
            out->count++;
        }
    }
    return ROTID_OK;
}

int sensor_out(struct pool *pool, const struct states *states, const int *holdout, const rotid_fit_result *fit,
               double *standardised, double *shape_rms)
{
    struct left_out out = {0};
    int nrow = fit->nresidual, nfitted = 0, rank = 0, status = ROTID_OK;
    *standardised = *shape_rms = NAN;
    for (int s = 0, mode = 0; s < states->nstate; mode += states->state[s].job.measurement.nmode, s++)
        nfitted += job_fitted(&states->state[s].job, holdout + mode);
    if (!any_shapes(states) || nrow <= nfitted || nfitted < 1)
        return ROTID_OK;
    double *basis = POOL_ARRAY(pool, double, (size_t)nrow *(size_t)(fit->n + nfitted + 1));
    if (!basis)
        return ROTID_ERROR_MEMORY;
    for (int s = 0, mode = 0, row = 0; s < states->nstate; mode += states->state[s].job.measurement.nmode, s++) {
        const struct job *job = &states->state[s].job;
        rank = scale_directions(job, holdout + mode, fit, row + job_fitted(job, holdout + mode), rank, basis);
        row += fit->state_nresidual[s];
    }
    rank = basis_add(nrow, fit->n, fit->jacobian, 1e-10, rank, basis);
    for (int s = 0, mode = 0, row = 0; s < states->nstate && !status; mode += states->state[s].job.measurement.nmode, s++) {
        const struct job *job = &states->state[s].job;
        if (job_fits_shapes(job) && job_fitted(job, holdout + mode))
            status = sensors_of_state(pool, job, holdout + mode, fit, row, rank, basis, &out);
        row += fit->state_nresidual[s];
    }
    if (!status && out.count) {
        *standardised = sqrt(out.sum / out.count);
        *shape_rms = sqrt(out.difference / out.count);
    }
    return status;
}

void fitted_errors(const struct states *states, const int *holdout, const rotid_fit_result *fit, int held, double *rms_percent,
                   double *max_percent, double *shape_rms)
{
    double sum = 0, shapes = 0;
    int count = 0, with_shape = 0;
    *max_percent = NAN;
    for (int k = 0; k < states_modes(states, states->nstate); k++) {
        int own;
        const struct job *job = job_of_mode(states, k, &own);
        if ((holdout[k] != 0) != held)
            continue;
        double error = 100 * (fit->predicted_hz[k] / job->measurement.frequency_hz[own] - 1),
               shape = shape_difference(job, own, fit->mac[k]);
        *max_percent = count++ ? fmax(*max_percent, fabs(error)) : fabs(error);
        sum += error * error;
        if (isfinite(shape)) {
            shapes += shape * shape;
            with_shape++;
        }
    }
    *rms_percent = count ? sqrt(sum / count) : NAN;
    *shape_rms = with_shape ? sqrt(shapes / with_shape) : NAN;
}
