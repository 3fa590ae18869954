#include "run/frf_settle.h"

#include <math.h>
#include <string.h>

#define TWO_PI        6.28318530717958647692
#define DEFAULT_LINES 1601 /* where the card gives no lines, as many as a usual analyser has */
#define MOST_LINES    1000000

static int refuse_settling(struct message_list *notes, const struct job *job, const char *text)
{
    message_add(notes, SEVERITY_ERROR, job->deck, 1, 1, "%s", text);
    return ROTID_ERROR_ARGUMENT;
}

/* ------------------------------------------------------------------------------------------------ lines */

static int measured_lines(const struct job *job, const struct frf_set *set, struct message_list *notes, struct frf_result *out)
{
    const struct frf_request *request = &job->options.frf;
    int first = 0, last = set->nline - 1;
    double low = request->low_hz * (1 - 1e-9), high = request->high_hz * (1 + 1e-9);
    while (first <= last && !(set->frequency_hz[first] > 0 && set->frequency_hz[first] >= low))
        first++; /* nothing is free of its suspension at 0 Hz */
    while (last >= first && request->high_hz > 0 && set->frequency_hz[last] > high)
        last--;
    out->skip = first;
    out->nline = last - first + 1;
    out->frequency_hz = set->frequency_hz + first;
    out->decay = set->window_decay;
    out->quantity = request->has_quantity ? request->quantity : set->quantity;
    return out->nline > 0
               ? ROTID_OK
               : refuse_settling(notes, job, "no measured line lies between LOW and HIGH, expected other limits on *FRF");
}

static int requested_lines(struct pool *pool, const struct job *job, struct message_list *notes, struct frf_result *out)
{
    const struct frf_request *request = &job->options.frf;
    double low = request->low_hz, high = request->high_hz;
    for (int k = 0; k < job->measurement.nmode; k++) {
        if (request->low_hz <= 0 && (!k || job->measurement.frequency_hz[k] / 2 < low))
            low = job->measurement.frequency_hz[k] / 2;
        if (request->high_hz <= 0)
            high = fmax(high, 1.1 * job->measurement.frequency_hz[k]);
    }
    if (!(low > 0 && high > low))
        return refuse_settling(
            notes, job, "the lines of the transfer functions are not known, expected LOW and HIGH [Hz] on *FRF, LOW first");
    double step = request->step_hz;
    if (step > 0 && (high - low) / step >= MOST_LINES)
        return refuse_settling(notes, job, "there are more than 1000000 lines, expected a larger STEP on *FRF");
    out->nline = step > 0 ? (int)floor((high - low) / step * (1 + 1e-12)) + 1 : request->nline ? request->nline : DEFAULT_LINES;
    double *hz = POOL_ARRAY(pool, double, out->nline);
    if (!hz)
        return ROTID_ERROR_MEMORY;
    for (int l = 0; l < out->nline; l++)
        hz[l] = step > 0 ? low + step * l : low + (high - low) * l / (out->nline - 1);
    out->frequency_hz = hz;
    out->quantity = request->quantity;
    return ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------ damping */

/* A ratio of zero is that of a file or deck which does not know it. */
static int has_ratio(const struct job *job, int k)
{
    return job->measurement.damping[k] > 0 && job->measurement.damping[k] < 1;
}

int frf_choose_damping(struct pool *pool, const struct job *job, const struct comparison *compared, struct message_list *notes,
                       struct frf_result *out)
{
    const struct synthesis *s = &out->synthesis;
    double stated = job->options.frf.damping, smallest = INFINITY, sum = 0;
    int count = 0;
    out->zeta = POOL_ARRAY(pool, double, s->nmode);
    out->damping = POOL_ARRAY(pool, enum frf_damping, s->nmode);
    out->moved_lambda = POOL_ARRAY(pool, double, s->nmode);
    if (!out->zeta || !out->damping || !out->moved_lambda)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; compared && k < compared->nmode; k++)
        if (has_ratio(job, k)) {
            smallest = fmin(smallest, job->measurement.damping[k]);
            sum += job->measurement.damping[k];
            count++;
        }
    if (!count && stated <= 0)
        return refuse_settling(
            notes, job,
            "no mode has a damping ratio, expected one as third value of *MODES, in the file of *MEASURED, or DAMPING= on "
            "*FRF");
    memcpy(out->moved_lambda, s->lambda, (size_t)s->nmode * sizeof *s->lambda);
    for (int r = 0; r < s->nmode; r++) {
        int rigid = r < s->nrigid;
        out->damping[r] = stated > 0 ? FRF_DAMPING_STATED : rigid ? FRF_DAMPING_SMALLEST : FRF_DAMPING_MEAN;
        out->zeta[r] = stated > 0 ? stated : rigid ? smallest : sum / count;
    }
    for (int k = 0; compared && k < compared->nmode; k++) {
        int r = s->nrigid + compared->number[k] - 1;
        double omega = TWO_PI * job->measurement.frequency_hz[k];
        if (r >= s->nmode)
            continue;
        out->moved_lambda[r] = omega * omega;
        if (has_ratio(job, k)) {
            out->zeta[r] = job->measurement.damping[k];
            out->damping[r] = FRF_DAMPING_MEASURED;
        }
    }
    return ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------ modes and lines */

static int nearest_line(const struct frf_result *out, double hz)
{
    int low = 0, high = out->nline - 1;
    while (high - low > 1) {
        int middle = low + (high - low) / 2;
        *(out->frequency_hz[middle] <= hz ? &low : &high) = middle;
    }
    return hz - out->frequency_hz[low] < out->frequency_hz[high] - hz ? low : high;
}

static double lowest(const struct frf_band *band)
{
    return isfinite(band->measured_hz) ? fmin(band->measured_hz, band->model_hz) : band->model_hz;
}

static double highest(const struct frf_band *band)
{
    return isfinite(band->measured_hz) ? fmax(band->measured_hz, band->model_hz) : band->model_hz;
}

/* Borders half-way between the resonances of neighbours, so that both peaks of a mode whose frequency is off by percent lie
 * within its lines. */
int frf_make_bands(struct pool *pool, const struct job *job, const struct comparison *compared, struct frf_result *out)
{
    const struct synthesis *s = &out->synthesis;
    double from = out->frequency_hz[0], to = out->frequency_hz[out->nline - 1];
    out->band = POOL_ARRAY(pool, struct frf_band, s->nmode);
    if (!out->band)
        return ROTID_ERROR_MEMORY;
    for (int r = s->nrigid; r < s->nmode; r++) {
        struct frf_band band = {.mode = r - s->nrigid + 1, .measured = -1, .model_hz = sqrt(s->lambda[r]) / TWO_PI, .worst = -1};
        band.measured_hz = NAN;
        for (int k = 0; compared && k < compared->nmode; k++)
            if (compared->number[k] == band.mode) {
                band.measured = k;
                band.measured_hz = job->measurement.frequency_hz[k];
                out->any_swapped = 1;
            }
        if (highest(&band) < from || lowest(&band) > to)
            continue;
        band.at_model = nearest_line(out, band.model_hz);
        band.at_measured = isfinite(band.measured_hz) ? nearest_line(out, band.measured_hz) : band.at_model;
        out->band[out->nband++] = band;
    }
    for (int b = 0; b < out->nband; b++) {
        struct frf_band *band = &out->band[b];
        double next = b + 1 < out->nband ? (highest(band) + lowest(band + 1)) / 2 : INFINITY;
        band->first = b ? out->band[b - 1].last + 1 : 0;
        band->last = out->nline - 1;
        while (band->last >= band->first && out->frequency_hz[band->last] > next)
            band->last--;
    }
    return ROTID_OK;
}

int frf_choose_lines(struct pool *pool, const struct job *job, const struct frf_set *set, struct message_list *notes,
                     struct frf_result *out)
{
    return set ? measured_lines(job, set, notes, out) : requested_lines(pool, job, notes, out);
}
