#include "run/frf_run.h"

#include <math.h>
#include <string.h>

#include "run/frf_points.h"
#include "run/frf_settle.h"

#define TWO_PI  6.28318530717958647692
#define STRANGE 0.1 /* loss of FRAC with measured frequencies that no scatter of them explains */
#define ABOVE   4   /* modes are taken up to this many times the highest line; the rest is static to within 1/16 squared */

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

/* At the resonances, and where the curves are furthest apart. */
static void judge_band(struct frf_result *out, int row, int b, const double complex *measured, const double complex *h)
{
    struct frf_band *band = &out->band[b];
    struct frf_at_mode *at = &out->at[b + (ptrdiff_t)row * out->nband];
    double largest = 0, apart = 0; /* squares */
    for (int l = band->first; l <= band->last; l++) {
        double re = creal(measured[l]), im = cimag(measured[l]), dre = re - creal(h[l]), dim = im - cimag(h[l]);
        if (!isfinite(re) || !isfinite(im))
            continue;
        largest = fmax(largest, re * re + im * im);
        apart = fmax(apart, dre * dre + dim * dim);
    }
    frf_sums_add(&band->resonance, 1, measured + band->at_measured, h + band->at_model);
    double complex quotient = measured[band->at_measured] / h[band->at_model];
    at->level_db = 20 * log10(cabs(quotient));
    at->phase_deg = carg(quotient) * 360 / TWO_PI;
    at->deviation = largest > 0 ? sqrt(apart / largest) : NAN;
    if (isfinite(at->deviation) &&
        (band->worst < 0 || at->deviation > out->at[b + (ptrdiff_t)band->worst * out->nband].deviation))
        band->worst = row;
}

static void compare_row(struct frf_result *out, int row, const double complex *measured, const double complex *h,
                        const double complex *moved)
{
    struct frf_row *r = &out->row[row];
    for (int b = 0; b < out->nband; b++) { /* every line belongs to one band */
        struct frf_band *band = &out->band[b];
        struct frf_sums sums = {0}, shifted = {0};
        int n = band->last - band->first + 1;
        frf_sums_add(&sums, n, measured + band->first, h + band->first);
        frf_sums_add(&shifted, n, measured + band->first, moved + band->first);
        frf_sums_join(&band->sums, &sums);
        frf_sums_join(&band->moved, &shifted);
        frf_sums_join(&r->sums, &sums);
        frf_sums_join(&r->moved, &shifted);
        judge_band(out, row, b, measured, h);
    }
    if (!out->nband) {
        frf_sums_add(&r->sums, out->nline, measured, h);
        frf_sums_add(&r->moved, out->nline, measured, moved);
    }
    frf_sums_join(&out->sums, &r->sums);
    frf_sums_join(&out->moved, &r->moved);
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
            ptrdiff_t at = (ptrdiff_t)c * out->nline;
            frf_measured_curve(out, measured->set, first + c, work);
            compare_row(out, first + c, work, h + at, moved + at);
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
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    struct synthesis_pair *pair = POOL_ARRAY(pool, struct synthesis_pair, out->nrow);
    int *dof = POOL_ARRAY(pool, int, 2 * (size_t)out->nrow), npoint;
    if (!model || !pair || !dof)
        return ROTID_ERROR_MEMORY;
    int status = frf_place_points(pool, job, identified != NULL, measured, notes, out, model, pair, dof, &npoint);
    if (status)
        return status;
    out->up_to_hz = ABOVE * out->frequency_hz[out->nline - 1];
    status = synthesis_open(pool, &model->equations, identified ? identified->fit->x : NULL, out->up_to_hz,
                            model->equations.nrigid + comparison_highest(job), npoint, dof, out->nrow, pair, &out->synthesis);
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
    int status = frf_choose_lines(pool, job, measured ? measured->set : NULL, notes, out);
    if (!status)
        status = frf_choose_rows(pool, job, measured, notes, out);
    if (!status)
        status = open_synthesis(pool, job, identified, measured, notes, out);
    if (!status)
        status = frf_choose_damping(pool, job, compared, notes, out);
    if (!status)
        status = frf_make_bands(pool, job, compared, out);
    if (!measured)
        out->ndone = out->nrow;
    else if (!status)
        status = compare_rows(pool, measured, environment, out);
    if (!status && frf_sums_frac(&out->moved) < frf_sums_frac(&out->sums) - STRANGE)
        message_add(
            notes, SEVERITY_WARNING, NULL, 0, 0,
            "the measured functions fit the frequencies of the model (FRAC %.3f) better than those of the measured modes (%.3f): "
            "do they come from the same test?",
            frf_sums_frac(&out->sums), frf_sums_frac(&out->moved));
    return status;
}
