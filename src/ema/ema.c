#include "ema/ema.h"

#include <math.h>
#include <string.h>

#include "ema/channels.h"
#include "ema/local.h"
#include "ema/modes.h"
#include "ema/per_point.h"
#include "ema/selection.h"
#include "ema/shapes.h"
#include "ema/stabilisation.h"
#include "ema/zoom.h"

#define TWO_PI        6.283185307179586
#define LEAST_LINES   16
#define LARGEST_ORDER 120
#define ITERATIONS    40
#define SUSPECT       2

struct job {
    struct pool *pool;
    const struct frf_set *set;
    struct ema_options options;
    const rotid_environment *environment;
    int first, last; /* lines of the set in the band */
    int *usable;
    struct ema_points points;
    struct ema_band band;
    int ncandidate;
    double complex *candidate;
    int *unstable; /* [ncandidate] of picks, else NULL */
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

static int find_lines(struct job *job)
{
    const struct frf_set *set = job->set;
    const struct ema_options *o = &job->options;
    job->last = set->nline;
    while (job->first < job->last && (set->frequency_hz[job->first] <= 0 ||
                                      (o->low_hz > 0 && set->frequency_hz[job->first] < o->low_hz)))
        job->first++;
    while (job->last > job->first && o->high_hz > 0 && set->frequency_hz[job->last - 1] > o->high_hz)
        job->last--;
    for (int i = job->first + 1; i < job->last; i++)
        if (!(set->frequency_hz[i] > set->frequency_hz[i - 1]))
            return ROTID_ERROR_ARGUMENT;
    return job->last - job->first >= LEAST_LINES ? ROTID_OK : ROTID_ERROR_ARGUMENT;
}

static int prepare(struct job *job)
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
        status = ema_band_new(job->pool, job->set, job->options.low_hz, job->options.high_hz, job->usable, &job->band);
    return status;
}

/* Candidates from the stabilisation table, or what the user picked. */
static int find_candidates(struct job *job, struct stabilisation *table)
{
    const struct ema_options *o = &job->options;
    struct ema *out = job->out;
    int status = zoom_compute(job->pool, &job->band, job->set->window_decay, o, table, &job->ncandidate, &job->candidate);
    if (status != ROTID_OK)
        return status;
    out->order = table->order;
    out->npole = table->npole;
    out->pole = table->table;
    if (o->npick <= 0)
        return ROTID_OK;
    job->ncandidate = o->npick;
    job->candidate = POOL_ARRAY(job->pool, double complex, o->npick);
    job->unstable = POOL_ARRAY(job->pool, int, o->npick);
    if (!job->candidate || !job->unstable)
        return ROTID_ERROR_MEMORY;
    stabilisation_picks(table, o->npick, o->pick_hz, job->candidate, job->unstable);
    return ROTID_OK;
}

/* Keeps the candidates that earn their place: refined, or where no refinement is wanted as they came. */
static int earn(struct job *job)
{
    if (job->options.npick > 0)
        return ROTID_OK;
    int *from = POOL_ARRAY(job->pool, int, job->ncandidate);
    double complex *pole = POOL_ARRAY(job->pool, double complex, job->ncandidate);
    if (!from || !pole)
        return ROTID_ERROR_MEMORY;
    memcpy(pole, job->candidate, (size_t)job->ncandidate * sizeof *pole);
    int status = selection_earn(job->pool, &job->band, job->options.threads, job->environment, &job->ncandidate, pole, from);
    for (int r = 0; status == ROTID_OK && r < job->ncandidate; r++)
        job->candidate[r] = job->options.no_refinement ? job->candidate[from[r]] : pole[r];
    if (status == ROTID_OK)
        status = local_merge(job->pool, &job->band, &job->ncandidate, job->candidate);
    return status;
}

static int fit_modes(struct job *job)
{
    struct modal_fit fit;
    struct refinement refinement;
    const struct ema_band *band = &job->band;
    struct ema *out = job->out;
    int n = job->ncandidate, *line = POOL_ARRAY(job->pool, int, band->nline);
    int status = line ? modes_new(job->pool, n, job->options.per_point, out) : ROTID_ERROR_MEMORY;
    if (status != ROTID_OK || n == 0)
        return status;
    int nline = modal_fit_lines(band, n, job->candidate, FIT_WIDTHS, selection_lines(band, n, FIT_PRODUCTS), line);
    status = modal_fit_new(job->pool, band, nline, line, 0, band->nchannel, n, job->options.threads, &fit);
    if (status == ROTID_OK)
        status = refinement_new(job->pool, &fit, &refinement);
    if (status != ROTID_OK)
        return status;
    for (int r = 0; r < n; r++)
        fit.pole[r] = job->candidate[r] / fit.scale;
    status = refine_poles(&fit, job->options.no_refinement ? 0 : ITERATIONS, job->environment, &refinement);
    if (status != ROTID_OK)
        return status;
    out->refined = refinement.iterations;
    out->std_from_impacts = band->variance != NULL;
    modes_from_fit(band, &fit, &refinement, job->set->window_decay, out);
    for (int r = 0; r < n; r++)
        if (job->unstable && job->unstable[r])
            out->mode[r].doubts |= EMA_UNSTABLE;
    int *suspect = POOL_ARRAY(job->pool, int, n);
    if (!suspect)
        return ROTID_ERROR_MEMORY;
    /* the scores of the channels tell cheaply whether they agree on the frequency */
    for (int r = 0; r < n; r++)
        suspect[r] = refinement.widened[2 * r + 1] > SUSPECT;
    return per_point_frequencies(job->pool, band, job->set->window_decay, suspect, job->environment, out);
}

static int finish(struct job *job)
{
    struct ema *out = job->out;
    double complex *work = POOL_ARRAY(job->pool, double complex, job->points.nreference);
    if (!work)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < out->nmode; r++)
        shapes_of_mode(job->set, &job->points, job->usable, out, &out->mode[r], work);
    int status = modes_judge(job->pool, &job->band, job->set->window_decay, out);
    if (status != ROTID_OK)
        return status;
    return channels_compare(job->pool, job->set, job->first, job->last, job->usable, out);
}

int ema_compute(struct pool *pool, const struct frf_set *set, const struct ema_options *options,
                const rotid_environment *environment, struct ema *out)
{
    struct stabilisation table = {0};
    struct job job = {.pool = pool, .set = set, .environment = environment, .out = out};
    if (options)
        job.options = *options;
    *out = (struct ema){0};
    int status = prepare(&job);
    if (status == ROTID_OK)
        status = find_candidates(&job, &table);
    if (status == ROTID_OK)
        status = earn(&job);
    if (status == ROTID_OK)
        status = fit_modes(&job);
    if (status == ROTID_OK)
        status = finish(&job);
    return status;
}
