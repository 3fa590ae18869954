#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#include "linalg/linalg.h"

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

int mode_out_fit(const struct states *states, const int *number, const int *holdout, int k, const rotid_environment *environment,
                 const rotid_allocator *allocator, double *error_percent, double *shape)
{
    struct pool pool;
    rotid_fit_result *fit = NULL;
    pool_open(&pool, allocator);
    *error_percent = *shape = NAN;
    int nmode = states_modes(states, states->nstate), own, *without = POOL_ARRAY(&pool, int, nmode), left = 0,
        status = ROTID_ERROR_MEMORY;
    const struct job *job = job_of_mode(states, k, &own);
    if (without) {
        for (int m = 0; m < nmode; m++) {
            without[m] = holdout[m] || m == k;
            left += !without[m];
        }
        int enough = any_shapes(states) ? left > 0 : left >= states->nparameter;
        status = left && enough ? refit_until(&pool, states, number, without, 0, environment, &fit) : ROTID_ERROR_ARGUMENT;
    }
    if (!status) {
        *error_percent = 100 * (fit->predicted_hz[k] / job->measurement.frequency_hz[own] - 1);
        *shape = shape_difference(job, own, fit->mac[k]);
    }
    rotid_fit_free(fit);
    pool_close(&pool);
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

static int count_fitted(const struct job *job, const int *holdout)
{
    int count = 0;
    for (int k = 0; k < job->measurement.nmode; k++)
        count += !holdout[k];
    return count;
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
        double *q = basis + (ptrdiff_t)count * fit->nresidual, largest = 0, square = 0;
        for (int s = 0; s < nsensor; s++)
            largest = isfinite(shape[s]) ? fmax(largest, fabs(shape[s])) : largest;
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

/* Adds the columns of the Jacobian to the `count` of an orthonormal basis; returns how many there are then. */
static int orthonormalise(int nrow, int n, const double *jacobian, int count, double *basis)
{
    for (int p = 0; p < n; p++) {
        memcpy(basis + (ptrdiff_t)count * nrow, jacobian + (ptrdiff_t)p * nrow, (size_t)nrow * sizeof *basis);
        count = basis_extend(nrow, count, 1e-10, basis);
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
    int nsensor = job->rotor.nsensor, nrow = fit->nresidual, nfitted = count_fitted(job, holdout), next = first + nfitted;
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
        nfitted += count_fitted(&states->state[s].job, holdout + mode);
    if (!any_shapes(states) || nrow <= nfitted || nfitted < 1)
        return ROTID_OK;
    double *basis = POOL_ARRAY(pool, double, (size_t)nrow *(size_t)(fit->n + nfitted + 1));
    if (!basis)
        return ROTID_ERROR_MEMORY;
    for (int s = 0, mode = 0, row = 0; s < states->nstate; mode += states->state[s].job.measurement.nmode, s++) {
        const struct job *job = &states->state[s].job;
        rank = scale_directions(job, holdout + mode, fit, row + count_fitted(job, holdout + mode), rank, basis);
        row += fit->state_nresidual[s];
    }
    rank = orthonormalise(nrow, fit->n, fit->jacobian, rank, basis);
    for (int s = 0, mode = 0, row = 0; s < states->nstate && !status; mode += states->state[s].job.measurement.nmode, s++) {
        const struct job *job = &states->state[s].job;
        if (job_fits_shapes(job) && count_fitted(job, holdout + mode))
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
