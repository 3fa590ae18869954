#include "ema/ema.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ema/channels.h"
#include "ema/guard.h"
#include "ema/impacts.h"
#include "ema/local.h"
#include "ema/modes.h"
#include "ema/noise.h"
#include "ema/per_point.h"
#include "ema/picking.h"
#include "ema/poles.h"
#include "ema/selection.h"
#include "ema/shapes.h"
#include "ema/stabilisation.h"
#include "ema/zoom.h"

#define TWO_PI        6.283185307179586
#define LEAST_LINES   16
#define LARGEST_ORDER 120
#define ITERATIONS    40
#define NEAR_WIDTHS   3
#define SUSPECT       2
#define NOT_PICKED    (-1)

struct extraction {
    struct pool *pool;
    const struct frf_set *set;
    struct ema_options options;
    const rotid_environment *environment;
    int first, last; /* lines of the set in the band */
    int *usable;
    struct ema_points points;
    struct ema_band band;
    int stated; /* the lines came with a variance */
    int ncandidate;
    double complex *candidate;
    int *quality_flags; /* [ncandidate] of picks, or NOT_PICKED; NULL without picks */
    struct ema *out;
};

static void set_defaults(struct ema_options *o, int nline)
{
    if (!(o->frequency_tolerance > 0))
        o->frequency_tolerance = 0.002;
    if (!(o->damping_tolerance > 0))
        o->damping_tolerance = 0.05;
    if (o->threads < 1)
        o->threads = 1;
    int most = 2 * nline / 3;
    if (o->order <= 0)
        o->order = LARGEST_ORDER;
    o->order = o->order < most ? o->order : most;
    o->order = o->order < 2 ? 2 : o->order;
}

static int find_lines(struct extraction *job)
{
    const struct frf_set *set = job->set;
    const struct ema_options *o = &job->options;
    job->last = set->nline;
    while (job->first < job->last &&
           (set->frequency_hz[job->first] <= 0 || (o->low_hz > 0 && set->frequency_hz[job->first] < o->low_hz)))
        job->first++;
    while (job->last > job->first && o->high_hz > 0 && set->frequency_hz[job->last - 1] > o->high_hz)
        job->last--;
    for (int i = job->first + 1; i < job->last; i++)
        if (!(set->frequency_hz[i] > set->frequency_hz[i - 1]))
            return ROTID_ERROR_ARGUMENT;
    return job->last - job->first >= LEAST_LINES ? ROTID_OK : ROTID_ERROR_ARGUMENT;
}

static int prepare(struct extraction *job)
{
    int n = job->set->nfrf, status = n > 0 ? find_lines(job) : ROTID_ERROR_ARGUMENT, alive = 0;
    if (status != ROTID_OK)
        return status;
    set_defaults(&job->options, job->last - job->first);
    job->out->nfrf = n;
    job->out->channel = POOL_ARRAY(job->pool, struct ema_channel, n);
    job->usable = POOL_ARRAY(job->pool, int, n);
    if (!job->out->channel || !job->usable)
        return ROTID_ERROR_MEMORY;
    status = shapes_points(job->pool, job->set, &job->points, job->out);
    if (status == ROTID_OK)
        status = channels_check(job->pool, job->set, job->first, job->last, job->out->channel, job->usable);
    for (int c = 0; status == ROTID_OK && c < n; c++)
        alive += job->usable[c];
    if (status == ROTID_OK && !alive)
        status = ROTID_ERROR_ARGUMENT;
    if (status == ROTID_OK)
        status = ema_band_new(job->pool, job->set, job->first, job->last, job->usable, &job->band);
    job->stated = job->band.variance != NULL;
    return status;
}

/* Candidates from the stabilisation table, or what the user picked. */
static int find_candidates(struct extraction *job, struct stabilisation *table)
{
    const struct ema_options *o = &job->options;
    struct ema *out = job->out;
    int status = zoom_compute(job->pool, &job->band, job->set->window_decay, o, table, &job->ncandidate, &job->candidate);
    if (status != ROTID_OK)
        return status;
    out->order = table->order;
    out->npole = table->npole;
    out->pole = table->table;
    return status;
}

/* Keeps the candidates that earn their place: refined, or where no refinement is wanted as they came. */
static int earn(struct extraction *job)
{
    int *from = POOL_ARRAY(job->pool, int, job->ncandidate);
    double complex *pole = POOL_ARRAY(job->pool, double complex, job->ncandidate);
    if (!from || !pole)
        return ROTID_ERROR_MEMORY;
    int status = ROTID_OK;
    if (!job->stated) {
        status = selection_screen(job->pool, &job->band, job->options.threads, job->environment, &job->ncandidate, job->candidate,
                                  from);
        if (status == ROTID_OK)
            status = noise_from_residual(job->pool, &job->band, job->options.threads, job->environment, job->ncandidate,
                                         job->candidate);
    }
    memcpy(pole, job->candidate, (size_t)job->ncandidate * sizeof *pole);
    if (status == ROTID_OK)
        status = selection_earn(job->pool, &job->band, job->options.threads, job->environment, &job->ncandidate, pole, from);
    for (int r = 0; status == ROTID_OK && r < job->ncandidate; r++)
        job->candidate[r] = job->options.no_refinement ? job->candidate[from[r]] : pole[r];
    if (status == ROTID_OK)
        status = local_merge(job->pool, &job->band, &job->ncandidate, job->candidate);
    if (status == ROTID_OK && !job->stated)
        status =
            noise_from_residual(job->pool, &job->band, job->options.threads, job->environment, job->ncandidate, job->candidate);
    return status;
}

/* What the user picked joins what was found, or marks it where the pole of the table for that frequency is the same to half a
 * half-power bandwidth. The modes that were not picked stay in the fit, where they are not mistaken for residuals, and are not
 * reported. */
static int add_picks(struct extraction *job, const struct stabilisation *table)
{
    int npick = job->options.npick, found = job->ncandidate, all = found;
    double complex *pick = POOL_ARRAY(job->pool, double complex, npick);
    double complex *pole = POOL_ARRAY(job->pool, double complex, found + npick);
    int *unstable = POOL_ARRAY(job->pool, int, npick);
    job->quality_flags = POOL_ARRAY(job->pool, int, found + npick);
    if (!pick || !pole || !unstable || !job->quality_flags)
        return ROTID_ERROR_MEMORY;
    stabilisation_picks(table, npick, job->options.pick_hz, pick, unstable);
    for (int r = 0; r < found; r++) {
        pole[r] = job->candidate[r];
        job->quality_flags[r] = NOT_PICKED;
    }
    for (int i = 0; i < npick; i++) {
        int same = -1;
        for (int r = 0; r < found && same < 0; r++)
            if (fabs(cimag(pole[r]) - cimag(pick[i])) < fmax(fabs(creal(pole[r])), fabs(creal(pick[i]))))
                same = r;
        if (same < 0) {
            same = all;
            pole[all++] = pick[i];
        }
        job->quality_flags[same] = unstable[i] ? EMA_UNSTABLE : 0;
    }
    job->candidate = pole;
    job->ncandidate = all;
    return ROTID_OK;
}

static int fit_modes(struct extraction *job)
{
    struct modal_fit fit;
    struct refinement refinement;
    const struct ema_band *band = &job->band;
    struct ema *out = job->out;
    int n = job->ncandidate, nguard = 0, status = ROTID_OK, *line = POOL_ARRAY(job->pool, int, band->nline);
    double complex *pole = POOL_ARRAY(job->pool, double complex, n + GUARD_MOST);
    if (!line || !pole)
        return ROTID_ERROR_MEMORY;
    memcpy(pole, job->candidate, (size_t)n * sizeof *pole);
    if (!job->options.no_refinement)
        status = guard_poles(job->pool, band, job->options.threads, job->environment, n, pole, &nguard);
    n += nguard;
    if (status == ROTID_OK)
        status = modes_new(job->pool, n, job->options.per_point, out);
    if (status != ROTID_OK || n == 0)
        return status;
    int nline = modal_fit_lines(band, n, pole, FIT_WIDTHS, selection_lines(band, n, FIT_PRODUCTS), line);
    status = refinement_open(job->pool, band, nline, line, 0, band->nchannel, n, pole, job->options.threads, &fit, &refinement);
    if (status != ROTID_OK)
        return status;
    for (int r = 0; r < n; r++) {
        fit.loose[r] = r >= n - nguard;
        fit.held[r] = fit.loose[r] && guard_is_far(band, pole[r]);
    }
    status = refine_poles(&fit, job->options.no_refinement ? 0 : ITERATIONS, job->environment, &refinement);
    if (status != ROTID_OK)
        return status;
    out->refined = refinement.iterations;
    out->std_from_impacts = job->stated;
    double *gain = POOL_ARRAY(job->pool, double, n);
    status = gain ? impacts_spread(job->pool, job->set, job->first, band, line, &fit, gain) : ROTID_ERROR_MEMORY;
    if (status != ROTID_OK)
        return status;
    modes_from_fit(band, &fit, &refinement, job->set->window_decay, out);
    /* what is not reported goes behind, where the synthesis still finds it */
    struct ema_mode *behind = POOL_ARRAY(job->pool, struct ema_mode, n);
    int reported = 0, others = 0, *suspect = POOL_ARRAY(job->pool, int, n);
    double *common = POOL_ARRAY(job->pool, double, (size_t)n *(size_t)band->nchannel);
    if (!behind || !suspect || !common)
        return ROTID_ERROR_MEMORY;
    modal_fit_local_noise(&fit, n, NEAR_WIDTHS, common);
    for (int r = 0; r < n; r++) {
        double complex at = fit.pole[r] * fit.scale;
        int inside = r < n - nguard && !refinement.moved[r] && cimag(at) >= band->low && cimag(at) <= band->high;
        if (r >= n - nguard || (job->quality_flags ? job->quality_flags[r] == NOT_PICKED : !inside)) {
            behind[others++] = out->mode[r];
            continue;
        }
        struct ema_mode mode = out->mode[r];
        mode.quality_flags |= job->quality_flags ? job->quality_flags[r] : 0;
        /* the scores of the channels tell cheaply whether they agree on the frequency */
        suspect[reported] = refinement.widened[(ptrdiff_t)2 * r + 1] > SUSPECT;
        for (int k = 0; k < band->nchannel; k++)
            /* reported <= r: what has been read is written over */
            common[k + (ptrdiff_t)reported * band->nchannel] =
                common[k + (ptrdiff_t)r * band->nchannel] * (fit.weight ? 1 : fit.sigma[k] * fit.sigma[k]);
        out->mode[reported++] = mode;
    }
    if (others)
        memcpy(out->mode + reported, behind, (size_t)others * sizeof *behind);
    out->nmode = reported;
    out->nguard = others;
    return per_point_frequencies(job->pool, band, job->set->window_decay, suspect, common, gain, job->environment, out);
}

static int finish(struct extraction *job)
{
    struct ema *out = job->out;
    double complex *work = POOL_ARRAY(job->pool, double complex, job->points.nreference);
    if (!work)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < out->nmode; r++)
        shapes_of_mode(job->set, &job->points, job->usable, out, &out->mode[r], work);
    for (int r = 0; r < out->nmode; r++) {
        if (out->mode[r].modal_mass < 0)
            out->mode[r].quality_flags |= EMA_NEGATIVE_MASS;
        if (job->options.no_refinement) /* nobody asked for it */
            out->mode[r].quality_flags &= ~EMA_NOT_REFINED;
    }
    int status = modes_judge(job->pool, &job->band, job->set->window_decay, out);
    if (status != ROTID_OK)
        return status;
    return channels_compare(job->pool, job->set, job->first, job->last, job->usable, out);
}

static int by_frequency_of_mode(const void *a, const void *b)
{
    double x = ((const struct ema_mode *)a)->frequency_hz, y = ((const struct ema_mode *)b)->frequency_hz;
    return (x > y) - (x < y);
}

static int is_cancelled(const struct extraction *job)
{
    const rotid_environment *e = job->environment;
    return e && e->cancelled && e->cancelled(e->context);
}

static int extract(struct extraction *job, struct stabilisation *table)
{
    int status = find_candidates(job, table);
    if (status == ROTID_OK && is_cancelled(job))
        status = ROTID_STOP_CANCELLED;
    if (status == ROTID_OK)
        status = earn(job);
    if (status != ROTID_OK)
        return status;
    sort_poles((size_t)job->ncandidate, job->candidate);
    if (job->options.npick > 0)
        status = add_picks(job, table);
    if (status != ROTID_OK)
        return status;
    status = fit_modes(job);
    if (status != ROTID_OK)
        return status;
    qsort(job->out->mode, (size_t)job->out->nmode, sizeof *job->out->mode, by_frequency_of_mode);
    double complex *pole = POOL_ARRAY(job->pool, double complex, job->out->nmode);
    if (!pole)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < job->out->nmode; r++)
        pole[r] = job->out->mode[r].pole - job->set->window_decay;
    stabilisation_assign(table, job->out->nmode, pole, job->options.frequency_tolerance, job->options.damping_tolerance);
    return ROTID_OK;
}

int ema_compute(struct pool *pool, const struct frf_set *set, const struct ema_options *options,
                const rotid_environment *environment, struct ema *out)
{
    struct stabilisation table = {0};
    struct extraction job = {.pool = pool, .set = set, .environment = environment, .out = out};
    if (options)
        job.options = *options;
    *out = (struct ema){0};
    int status = prepare(&job);
    if (status == ROTID_OK && is_cancelled(&job))
        status = ROTID_STOP_CANCELLED;
    if (status == ROTID_OK && job.options.method == EMA_QUADRATURE)
        status = picking_compute(pool, &job.band, &job.options, set->window_decay, out);
    else if (status == ROTID_OK)
        status = extract(&job, &table);
    if (status == ROTID_OK)
        status = finish(&job);
    return status;
}
