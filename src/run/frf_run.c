#include "run/frf_run.h"

#include <math.h>
#include <string.h>

#include "run/frf_points.h"

#define TWO_PI        6.28318530717958647692
#define ABOVE         4    /* modes are taken up to this many times the highest line; the rest is static to within 1/16 squared */
#define DEFAULT_LINES 1601 /* where the card gives no lines, as many as a usual analyser has */
#define MOST_LINES    1000000

static int refuse(struct message_list *notes, const struct job *job, const char *text)
{
    message_add(notes, SEVERITY_ERROR, job->deck, 1, 1, "%s", text);
    return ROTID_ERROR_ARGUMENT;
}

/* ------------------------------------------------------------------------------------------------ lines */

static int measured_lines(const struct job *job, const struct frf_set *set, struct message_list *notes, struct frf_result *out)
{
    const struct frf_request *request = &job->frf;
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
    return out->nline > 0 ? ROTID_OK
                          : refuse(notes, job, "no measured line lies between LOW and HIGH, expected other limits on *FRF");
}

static int requested_lines(struct pool *pool, const struct job *job, struct message_list *notes, struct frf_result *out)
{
    const struct frf_request *request = &job->frf;
    double low = request->low_hz, high = request->high_hz;
    for (int k = 0; k < job->nmode; k++) {
        if (request->low_hz <= 0 && (!k || job->frequency_hz[k] / 2 < low))
            low = job->frequency_hz[k] / 2;
        if (request->high_hz <= 0)
            high = fmax(high, 1.1 * job->frequency_hz[k]);
    }
    if (!(low > 0 && high > low))
        return refuse(notes, job,
                      "the lines of the transfer functions are not known, expected LOW and HIGH [Hz] on *FRF, LOW first");
    double step = request->step_hz;
    if (step > 0 && (high - low) / step >= MOST_LINES)
        return refuse(notes, job, "there are more than 1000000 lines, expected a larger STEP on *FRF");
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
    return job->damping[k] > 0 && job->damping[k] < 1;
}

static int choose_damping(struct pool *pool, const struct job *job, const struct comparison *compared, struct message_list *notes,
                          struct frf_result *out)
{
    const struct synthesis *s = &out->synthesis;
    double stated = job->frf.damping, smallest = INFINITY, sum = 0;
    int count = 0;
    out->zeta = POOL_ARRAY(pool, double, s->nmode);
    out->damping = POOL_ARRAY(pool, enum frf_damping, s->nmode);
    out->moved_lambda = POOL_ARRAY(pool, double, s->nmode);
    if (!out->zeta || !out->damping || !out->moved_lambda)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; compared && k < compared->nmode; k++)
        if (has_ratio(job, k)) {
            smallest = fmin(smallest, job->damping[k]);
            sum += job->damping[k];
            count++;
        }
    if (!count && stated <= 0)
        return refuse(
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
        double omega = TWO_PI * job->frequency_hz[k];
        if (r >= s->nmode)
            continue;
        out->moved_lambda[r] = omega * omega;
        if (has_ratio(job, k)) {
            out->zeta[r] = job->damping[k];
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
static int make_bands(struct pool *pool, const struct job *job, const struct comparison *compared, struct frf_result *out)
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
                band.measured_hz = job->frequency_hz[k];
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

/* ------------------------------------------------------------------------------------------------ curves */

static struct synthesis_lines lines_of(const struct frf_result *result)
{
    return (struct synthesis_lines){
        .nline = result->nline, .frequency_hz = result->frequency_hz, .quantity = result->quantity, .decay = result->decay};
}

void frf_synthesised(const struct frf_result *result, int first, int count, double complex *h, double complex *work)
{
    struct synthesis_lines lines = lines_of(result);
    synthesis_evaluate(&result->synthesis, &lines, result->synthesis.lambda, result->zeta, first, count, h, work);
}

void frf_measured_curve(const struct frf_result *result, const struct frf_set *set, int row, double complex *h)
{
    const struct frf_row *r = &result->row[row];
    int powers = (int)result->quantity - (set ? (int)set->quantity : 0);
    for (int l = 0; l < result->nline; l++) {
        double complex s = result->decay + I * (TWO_PI * result->frequency_hz[l]), value = NAN;
        if (set && r->measured)
            value = r->sign * r->measured->h[result->skip + l];
        for (int p = 0; p < powers; p++)
            value *= s;
        for (int p = powers; p < 0; p++)
            value /= s;
        h[l] = value;
    }
}

/* ------------------------------------------------------------------------------------------------ agreement */

static void compare_band(struct frf_result *out, int row, int b, const double complex *measured, const double complex *h,
                         const double complex *moved)
{
    struct frf_band *band = &out->band[b];
    struct frf_at_mode *at = &out->at[b + (ptrdiff_t)row * out->nband];
    int n = band->last - band->first + 1;
    double largest = 0, apart = 0;
    for (int l = band->first; l <= band->last; l++)
        if (isfinite(creal(measured[l])) && isfinite(cimag(measured[l]))) {
            largest = fmax(largest, cabs(measured[l]));
            apart = fmax(apart, cabs(measured[l] - h[l]));
        }
    frf_sums_add(&band->sums, n, measured + band->first, h + band->first);
    frf_sums_add(&band->moved, n, measured + band->first, moved + band->first);
    frf_sums_add(&band->resonance, 1, measured + band->at_measured, h + band->at_model);
    double complex quotient = measured[band->at_measured] / h[band->at_model];
    at->level_db = 20 * log10(cabs(quotient));
    at->phase_deg = carg(quotient) * 360 / TWO_PI;
    at->deviation = largest > 0 ? apart / largest : NAN;
    if (isfinite(at->deviation) &&
        (band->worst < 0 || at->deviation > out->at[b + (ptrdiff_t)band->worst * out->nband].deviation))
        band->worst = row;
}

static int compare_rows(struct pool *pool, const struct frf_measured *measured, const rotid_environment *environment,
                        struct frf_result *out)
{
    struct pool scratch;
    struct synthesis_lines lines = lines_of(out);
    size_t block = (size_t)out->nline * SYNTHESIS_TOGETHER;
    out->at = POOL_ARRAY(pool, struct frf_at_mode, (size_t)out->nband * (size_t)out->nrow);
    pool_open(&scratch, pool->allocator);
    double complex *h = POOL_ARRAY(&scratch, double complex, block), *moved = POOL_ARRAY(&scratch, double complex, block),
                   *work = POOL_ARRAY(&scratch, double complex, out->nline);
    int status = out->at && h && moved && work ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int first = 0; first < out->nrow && !status; first += SYNTHESIS_TOGETHER) {
        int count = out->nrow - first < SYNTHESIS_TOGETHER ? out->nrow - first : SYNTHESIS_TOGETHER;
        if (environment && environment->cancelled && environment->cancelled(environment->context))
            break;
        synthesis_evaluate(&out->synthesis, &lines, out->synthesis.lambda, out->zeta, first, count, h, work);
        synthesis_evaluate(&out->synthesis, &lines, out->moved_lambda, out->zeta, first, count, moved, work);
        for (int c = 0; c < count; c++) {
            struct frf_row *row = &out->row[first + c];
            ptrdiff_t at = (ptrdiff_t)c * out->nline;
            frf_measured_curve(out, measured->set, first + c, work);
            frf_sums_add(&row->sums, out->nline, work, h + at);
            frf_sums_add(&row->moved, out->nline, work, moved + at);
            frf_sums_join(&out->sums, &row->sums);
            frf_sums_join(&out->moved, &row->moved);
            for (int b = 0; b < out->nband; b++)
                compare_band(out, first + c, b, work, h + at, moved + at);
        }
        out->ndone += count;
        if (environment && environment->progress)
            environment->progress(environment->context, "transfer function", out->ndone);
    }
    pool_close(&scratch);
    return status;
}

/* ------------------------------------------------------------------------------------------------ the whole */

static int open_synthesis(struct pool *pool, const struct job *job, const struct identification *identified,
                          const struct frf_measured *measured, struct message_list *notes, struct frf_result *out)
{
    struct client *client = POOL_NEW(pool, struct client);
    struct synthesis_pair *pair = POOL_ARRAY(pool, struct synthesis_pair, out->nrow);
    int *dof = POOL_ARRAY(pool, int, 2 * (size_t)out->nrow), npoint;
    if (!client || !pair || !dof)
        return ROTID_ERROR_MEMORY;
    int status = frf_place_points(pool, job, identified != NULL, measured, notes, out, client, pair, dof, &npoint);
    if (status)
        return status;
    out->up_to_hz = ABOVE * out->frequency_hz[out->nline - 1];
    status = synthesis_open(pool, &client->model, identified ? identified->fit->x : NULL, out->up_to_hz,
                            client->model.nrigid + comparison_highest(job), npoint, dof, out->nrow, pair, &out->synthesis);
    if (status == ROTID_ERROR_ARGUMENT)
        message_add(notes, SEVERITY_ERROR, job->deck, 1, 1,
                    "the model has more than %d modes below %.6g Hz, %d times the highest line, expected a lower HIGH on *FRF",
                    SYNTHESIS_MOST_MODES, out->up_to_hz, ABOVE);
    return status;
}

int frf_run(struct pool *pool, const struct job *job, const struct identification *identified,
            const struct frf_measured *measured, const rotid_environment *environment, struct message_list *notes,
            struct frf_result *out)
{
    const struct comparison *compared = identified ? &identified->compared : NULL;
    *out = (struct frf_result){.is_measured = measured != NULL};
    int status = measured ? measured_lines(job, measured->set, notes, out) : requested_lines(pool, job, notes, out);
    if (!status)
        status = frf_choose_rows(pool, job, measured, notes, out);
    if (!status)
        status = open_synthesis(pool, job, identified, measured, notes, out);
    if (!status)
        status = choose_damping(pool, job, compared, notes, out);
    if (!status)
        status = make_bands(pool, job, compared, out);
    if (!status && measured)
        return compare_rows(pool, measured, environment, out);
    out->ndone = out->nrow;
    return status;
}
