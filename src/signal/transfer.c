#include "signal/transfer.h"

#include <math.h>

#include "base/parallel.h"
#include "signal/block.h"
#include "signal/estimator.h"
#include "signal/fft.h"
#include "signal/window.h"

#define HIGHEST 0.45 /* of the sampling rate: up to there the filters of a converter are flat */
#define RINGING_SAMPLES                                                                                                          \
    128 /* in which the steepest anti-alias filter of an analyser rings down; less cut off bends the lines below it */
#define FASTEST 1e12 /* Hz, and its inverse the slowest sampling: spectra stay within the range of double */

struct worker { /* workspace of one thread */
    struct fft fft;
    double *force, *response;            /* [n] */
    double complex *forced, *responding; /* [n/2 + 1] */
    struct spectra sum;                  /* of nline */
    double complex *part;                /* [nline] */
    double *weight;                      /* [most impacts of a transfer function] */
    double *smooth;
};

struct work {
    const struct time_record *record;
    double rate;
    const struct transfer_options *options;
    struct block_plan plan;
    int *member; /* [first[nfrf]] impact of each column */
    int lowest;  /* line of the transform that is line 0 of the set */
    double *exponential;
    struct worker *worker;
    struct transfer *out;
};

static int in_range(double rate, enum frf_quantity quantity, const struct transfer_options *o, int threads)
{
    const double positive[] = {o->pretrigger, o->block, o->low_hz, o->high_hz};
    for (size_t i = 0; i < sizeof positive / sizeof *positive; i++)
        if (!(positive[i] >= 0 && isfinite(positive[i])))
            return 0;
    return rate >= 1 / FASTEST && rate <= FASTEST && quantity >= FRF_DISPLACEMENT && quantity <= FRF_ACCELERATION &&
           o->estimator >= TRANSFER_H1 && o->estimator <= TRANSFER_HV && o->threshold >= 0 && o->threshold < 1 &&
           isfinite(o->force_window) && o->exponential >= 0 && o->exponential <= 1 && threads >= 1;
}

static int same_function(const struct time_record *record, const struct frf *frf)
{
    return record->response_node == frf->response_node && record->response_direction == frf->response_direction &&
           record->reference_node == frf->reference_node && record->reference_direction == frf->reference_direction;
}

/* Transfer functions in the order in which the records name them first, and the impacts that each of them averages. */
static int group(struct pool *pool, int nrecord, struct work *work, int *bad_record)
{
    struct transfer *out = work->out;
    const struct block_plan *plan = &work->plan;
    out->nimpact = plan->first[nrecord];
    out->impact = plan->impact;
    out->set.frf = POOL_ARRAY(pool, struct frf, nrecord);
    out->first = POOL_ARRAY(pool, int, nrecord + 1);
    work->member = POOL_ARRAY(pool, int, out->nimpact);
    int *of = POOL_ARRAY(pool, int, nrecord), count = 0;
    if (!out->set.frf || !out->first || !work->member || !of)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < nrecord; r++) {
        const struct time_record *record = &work->record[r];
        while (of[r] < out->set.nfrf && !same_function(record, &out->set.frf[of[r]]))
            of[r]++;
        if (of[r] == out->set.nfrf)
            out->set.frf[out->set.nfrf++] = (struct frf){
                .line = record->line,
                .response_node = record->response_node,
                .response_direction = record->response_direction,
                .reference_node = record->reference_node,
                .reference_direction = record->reference_direction,
            };
    }
    for (int f = 0; f < out->set.nfrf; f++) {
        *bad_record = -1;
        for (int r = 0; r < nrecord; r++) {
            if (of[r] == f && *bad_record < 0)
                *bad_record = r;
            for (int k = plan->first[r]; of[r] == f && k < plan->first[r + 1]; k++)
                if (plan->impact[k].used)
                    work->member[count++] = k;
        }
        out->first[f + 1] = count;
        out->set.frf[f].averages = count - out->first[f];
        if (!out->set.frf[f].averages)
            return ROTID_ERROR_ARGUMENT;
    }
    *bad_record = -1;
    return ROTID_OK;
}

static int choose_lines(struct pool *pool, enum frf_quantity quantity, struct work *work)
{
    const struct transfer_options *o = work->options;
    struct frf_set *set = &work->out->set;
    int n = work->plan.n;
    double step = work->rate / n, high = fmin(o->high_hz > 0 ? o->high_hz : HIGHEST * work->rate, work->rate / 2);
    /* a limit that is meant to be a line may be off by rounding */
    double lowest = fmax(1, ceil(o->low_hz / step - 1e-6)), highest = floor(high / step + 1e-6);
    if (!(highest >= lowest))
        return ROTID_ERROR_ARGUMENT;
    work->lowest = (int)lowest;
    set->nline = (int)highest - work->lowest + 1;
    set->quantity = quantity;
    set->frequency_hz = POOL_ARRAY(pool, double, set->nline);
    work->exponential = POOL_ARRAY(pool, double, n);
    if (!set->frequency_hz || !work->exponential)
        return ROTID_ERROR_MEMORY;
    for (int l = 0; l < set->nline; l++)
        set->frequency_hz[l] = (work->lowest + l) * work->rate / n;
    if (o->exponential > 0)
        set->window_decay = window_decay(n, o->exponential, work->rate);
    window_exponential(n, set->window_decay, work->rate, work->exponential);
    return ROTID_OK;
}

static int open_worker(struct pool *pool, int n, int nline, int most, struct worker *worker)
{
    int status = fft_open(pool, n, &worker->fft);
    worker->force = POOL_ARRAY(pool, double, n);
    worker->response = POOL_ARRAY(pool, double, n);
    worker->forced = POOL_ARRAY(pool, double complex, n / 2 + 1);
    worker->responding = POOL_ARRAY(pool, double complex, n / 2 + 1);
    worker->sum = (struct spectra){POOL_ARRAY(pool, double, nline), POOL_ARRAY(pool, double, nline),
                                   POOL_ARRAY(pool, double complex, nline)};
    worker->part = POOL_ARRAY(pool, double complex, nline);
    worker->weight = POOL_ARRAY(pool, double, most);
    worker->smooth = POOL_ARRAY(pool, double, nline + 2 * ESTIMATOR_SMOOTH + 2);
    if (status)
        return status;
    return worker->force && worker->response && worker->forced && worker->responding && worker->sum.ff && worker->sum.xx &&
                   worker->sum.xf && worker->part && worker->weight && worker->smooth
               ? ROTID_OK
               : ROTID_ERROR_MEMORY;
}

/* Room for the results and for `threads` workers. */
static int reserve(struct pool *pool, int threads, struct work *work)
{
    struct transfer *out = work->out;
    int nline = out->set.nline, most = 0;
    size_t total = (size_t)nline * (size_t)out->first[out->set.nfrf];
    out->single = POOL_ARRAY(pool, double complex, total);
    out->single_force = POOL_ARRAY(pool, double, total);
    out->single_response = POOL_ARRAY(pool, double, total);
    work->worker = POOL_ARRAY(pool, struct worker, threads);
    if (!out->single || !out->single_force || !out->single_response || !work->worker)
        return ROTID_ERROR_MEMORY;
    for (int f = 0; f < out->set.nfrf; f++) {
        struct frf *frf = &out->set.frf[f];
        most = frf->averages > most ? frf->averages : most;
        frf->h = POOL_ARRAY(pool, double complex, nline);
        if (!frf->h)
            return ROTID_ERROR_MEMORY;
        if (frf->averages < 2)
            continue;
        frf->variance = POOL_ARRAY(pool, double, nline);
        frf->coherence = POOL_ARRAY(pool, double, nline);
        if (!frf->variance || !frf->coherence)
            return ROTID_ERROR_MEMORY;
    }
    for (int t = 0; t < threads; t++) {
        int status = open_worker(pool, work->plan.n, nline, most, &work->worker[t]);
        if (status)
            return status;
    }
    return ROTID_OK;
}

static double squares(int n, const double *x)
{
    double sum = 0;
    for (int j = 0; j < n; j++)
        sum += x[j] * x[j];
    return sum;
}

/* Column `column` of the single spectra from its impact. */
static void transform(const struct work *work, struct worker *worker, int column)
{
    int n = work->plan.n, nline = work->out->set.nline, at = work->member[column], begin = work->plan.begin[at];
    struct impact *impact = &work->out->impact[at];
    const double *force = work->record[impact->record].force + impact->onset - begin;
    const double *response = work->record[impact->record].response + impact->onset - begin;
    int quiet = block_quiet(begin, impact, work->rate);
    double force_mean = window_mean(quiet, force), response_mean = window_mean(quiet, response);
    for (int j = 0; j < n; j++) {
        worker->force[j] = force[j] - force_mean;
        worker->response[j] = response[j] - response_mean;
    }
    double keep =
        work->options->force_window > 0 ? work->options->force_window : fmax(10 * impact->width, RINGING_SAMPLES / work->rate);
    if (work->options->force_window >= 0 && !impact->is_double) /* a second hit that is kept belongs to the force */
        window_force(n, (int)fmin(n, begin + ceil(keep * work->rate)), (int)fmin(n, keep * work->rate / 4), worker->force);
    for (int j = 0; j < n; j++) {
        worker->force[j] *= work->exponential[j];
        worker->response[j] *= work->exponential[j];
    }
    int tenth = (n + 9) / 10;
    double whole = squares(n, worker->response) / n, tail = squares(tenth, worker->response + n - tenth) / tenth;
    impact->tail = whole > 0 ? sqrt(tail / whole) : 0;
    fft_real(&worker->fft, worker->force, worker->forced);
    fft_real(&worker->fft, worker->response, worker->responding);
    for (int l = 0; l < nline; l++) {
        size_t to = (size_t)column * (size_t)nline + (size_t)l;
        double complex f = worker->forced[work->lowest + l] / work->rate, x = worker->responding[work->lowest + l] / work->rate;
        work->out->single[to] = x * conj(f);
        work->out->single_force[to] = creal(f) * creal(f) + cimag(f) * cimag(f);
        work->out->single_response[to] = creal(x) * creal(x) + cimag(x) * cimag(x);
    }
}

static int estimate(void *context, int f, int thread)
{
    const struct work *work = context;
    struct worker *worker = &work->worker[thread];
    struct transfer *out = work->out;
    struct frf *frf = &out->set.frf[f];
    int nline = out->set.nline, estimator = work->options->estimator, count = frf->averages;
    size_t at = (size_t)nline * (size_t)out->first[f];
    struct spectra column = {out->single_force + at, out->single_response + at, out->single + at};
    for (int k = out->first[f]; k < out->first[f + 1]; k++)
        transform(work, worker, k);
    frf->single = out->single + at;
    frf->single_force = out->single_force + at;
    estimator_sum(nline, count, &column, NULL, &worker->sum);
    estimator_transfer(estimator, estimator_balance(nline, &worker->sum), nline, &worker->sum, frf->h);
    if (count < 2)
        return ROTID_OK;
    estimator_coherence(nline, &worker->sum, frf->coherence);
    estimator_jackknife(estimator, nline, count, &column, frf->h, frf->variance, &worker->sum, worker->part, worker->weight);
    estimator_sum(nline, count, &column, NULL, &worker->sum);
    estimator_smooth(nline, worker->sum.ff, frf->variance, worker->smooth);
    return ROTID_OK;
}

int transfer_compute(struct pool *pool, int nrecord, const struct time_record *record, double rate, enum frf_quantity quantity,
                     const struct transfer_options *options, int threads, struct transfer *out, int *bad_record)
{
    struct work work = {.record = record, .rate = rate, .options = options, .out = out};
    *out = (struct transfer){0};
    *bad_record = -1;
    if (nrecord < 1 || !in_range(rate, quantity, options, threads))
        return ROTID_ERROR_ARGUMENT;
    int status = block_plan(pool, nrecord, record, rate, options, &work.plan, bad_record);
    if (!status)
        status = group(pool, nrecord, &work, bad_record);
    if (!status)
        status = choose_lines(pool, quantity, &work);
    if (status)
        return status;
    threads = threads < out->set.nfrf ? threads : out->set.nfrf;
    threads = threads < PARALLEL_MOST ? threads : PARALLEL_MOST;
    status = reserve(pool, threads, &work);
    return status ? status : parallel_for(threads, out->set.nfrf, estimate, &work);
}
