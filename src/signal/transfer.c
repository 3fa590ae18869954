#include "signal/signal.h"

#include <kiss_fftr.h>

/* Mean of x [n], n >= 1. */
static double window_mean(int n, const double *x)
{
    double sum = 0;
    for (int j = 0; j < n; j++)
        sum += x[j] - x[0]; /* the mean of equal values is that value, to the last bit */
    return x[0] + sum / n;
}

/* Force after its mean before the impact was taken off: kept for the first `keep` samples, then faded by
 * (1 + cos(pi j/(fade + 1)))/2, j = 1 ... fade, then zero: what the channel shows after the pulse is noise. x [n]; keep, fade >=
 * 0. */
static void window_force(int n, int keep, int fade, double *x)
{
    for (int j = keep; j < n; j++)
        x[j] *= j - keep < fade ? (1 + cos(PI * (j - keep + 1) / (fade + 1))) / 2 : 0;
}

double window_decay(int n, double end, double rate)
{
    return -log(end) * rate / n;
}

/* weight_j = exp(-decay j/rate), [n]. */
static void window_exponential(int n, double decay, double rate, double *weight)
{
    for (int j = 0; j < n; j++)
        weight[j] = exp(-decay * j / rate);
}

int fft_length(long long n)
{
    int best = 0;
    if (n > FFT_LONGEST)
        n = FFT_LONGEST;
    for (long long five = 2; five <= n; five *= 5)
        for (long long three = five; three <= n; three *= 3) {
            long long length = three;
            while (2 * length <= n)
                length *= 2;
            if (length > best)
                best = (int)length;
        }
    return best;
}

int fft_open(struct pool *pool, int n, struct fft *fft)
{
    size_t bytes = 0;
    if (n < 2 || n % 2 || n > FFT_LONGEST)
        return ROTID_ERROR_ARGUMENT;
    (void)kiss_fftr_alloc(n, 0, NULL, &bytes); /* only says how much it needs */
    *fft = (struct fft){.n = n, .plan = pool_get(pool, bytes, 1)};
    fft->time = POOL_ARRAY(pool, float, n);
    fft->line = POOL_ARRAY(pool, kiss_fft_cpx, n / 2 + 1);
    if (!fft->plan || !fft->time || !fft->line)
        return ROTID_ERROR_MEMORY;
    fft->plan = kiss_fftr_alloc(n, 0, fft->plan, &bytes);
    return fft->plan ? ROTID_OK : ROTID_ERROR_MEMORY;
}

void fft_real(struct fft *fft, const double *x, double complex *X)
{
    const kiss_fft_cpx *line = fft->line;
    int exponent = 0;
    (void)frexp(largest_magnitude(fft->n, x), &exponent);
    /* in two steps: the scale of the smallest numbers is itself too large for a double */
    double half = ldexp(1, -exponent / 2), other = ldexp(1, -exponent + exponent / 2);
    for (int j = 0; j < fft->n; j++)
        fft->time[j] = (float)(x[j] * half * other);
    kiss_fftr(fft->plan, fft->time, fft->line);
    for (int k = 0; k <= fft->n / 2; k++)
        X[k] = CMPLX((double)line[k].r / half / other, (double)line[k].i / half / other);
}

#define RINGING 1.5 /* of a pulse over the swing below the base line beside it */
#define RINGS   128 /* samples that a filter rings behind a pulse */

static double largest_deviation(long long count, const double *force, double base)
{
    double largest = 0;
    for (long long j = 0; j < count; j++)
        if (fabs(force[j] - base) > fabs(largest))
            largest = force[j] - base;
    return largest;
}

/* Mean of the samples within `reach` of `centre`, and how many they are. */
static long long mean_within(long long count, const double *force, double centre, double reach, double *mean)
{
    double sum = 0;
    long long inside = 0;
    for (long long j = 0; j < count; j++)
        if (fabs(force[j] - centre) <= reach) {
            sum += force[j] - centre;
            inside++;
        }
    *mean = inside ? centre + sum / (double)inside : centre;
    return inside;
}

/* Base line and largest deviation from it. Twice: the first mean still has the pulses in it. 0 if there is no pulse. */
static int measure_base(long long count, const double *force, double *base, double *peak)
{
    long long inside = mean_within(count, force, 0, INFINITY, base);
    for (int pass = 0; pass < 2; pass++) {
        double centre = *base;
        *peak = largest_deviation(count, force, centre);
        inside = mean_within(count, force, centre, fabs(*peak) / 10, base);
    }
    *peak = largest_deviation(count, force, *base);
    return inside > count / 2 && fabs(*peak) >= IMPACT_LEAST_FORCE;
}

/* A hammer only pushes: what swings below the base line about as far as above it is no pulse but the ringing of an anti-alias
 * filter behind one. The ringing of a steep filter swings back by 0.3 of the pulse. */
static int is_ringing(const struct impact *pulse, double rate, double sign, double base, long long count, const double *force)
{
    long long length = llround(pulse->width * rate), begin = pulse->onset - 2 * length, end = pulse->onset + 3 * length;
    double below = 0;
    for (long long j = begin < 0 ? 0 : begin; j < end && j < count; j++)
        below = fmax(below, sign * (base - force[j]));
    return fabs(pulse->peak) < RINGING * below;
}

/* Appends the pulses of one record to the list. A pulse begins where the force, counted from its base line and with the sign of
 * its largest deviation P, reaches threshold * P, and the next one can begin after it fell below half of that: noise on a flank
 * is no second pulse, nor is what swings below the base line, beside it, by more than two thirds of its height: the ringing of a
 * filter. The base line is the mean of what stays within P/10 of it. A force that is further than P/10 from its base
 * line for half of the time is noise or a shaker: no pulse. force [count] finite, 0 < threshold < 1, rate > 0.
 * ROTID_OK, ROTID_ERROR_ARGUMENT (no pulse), ROTID_ERROR_MEMORY. */
static int impact_find(struct pool *pool, int record, long long count, const double *force, double rate, double threshold,
                       struct impact_list *list)
{
    double base, largest;
    if (!measure_base(count, force, &base, &largest))
        return ROTID_ERROR_ARGUMENT;
    double sign = largest < 0 ? -1 : 1, level = threshold * fabs(largest);
    long long last = 0; /* sample of the open pulse above the level */
    struct impact *open = NULL;
    size_t kept = list->count, first = list->count;
    for (long long j = 0; j < count; j++) {
        double value = sign * (force[j] - base);
        if (!open && value >= level) {
            list->item = pool_grow(pool, list->item, list->count, &list->capacity, sizeof *list->item);
            if (!list->item)
                return ROTID_ERROR_MEMORY;
            open = &list->item[list->count++];
            *open = (struct impact){.record = record, .onset = j, .sample = j};
        }
        if (!open)
            continue;
        if (value > sign * open->peak) {
            open->peak = sign * value;
            open->sample = j;
        }
        if (value >= level)
            last = j;
        open->width = (double)(last - open->onset + 1) / rate;
        if (value < level / 2)
            open = NULL;
    }
    const struct impact *before = NULL; /* the last pulse that is one */
    for (size_t i = first; i < list->count; i++) {
        const struct impact *pulse = &list->item[i];
        if (before && pulse->onset < before->onset + RINGS && fabs(pulse->peak) < fabs(before->peak) &&
            is_ringing(pulse, rate, sign, base, count, force))
            continue;
        list->item[kept] = *pulse;
        before = &list->item[kept++];
    }
    list->count = kept;
    return kept > first ? ROTID_OK : ROTID_ERROR_ARGUMENT;
}

long long impact_spacing(int npulse, const struct impact *pulse, long long count, double *work)
{
    for (int k = 0; k < npulse; k++)
        work[k] = (double)((k + 1 < npulse ? pulse[k + 1].onset : count) - pulse[k].onset);
    sort_doubles((size_t)npulse, work);
    return (long long)work[(3 * (npulse - 1) + 3) / 4];
}

/* A pulse rises for no longer than it lasts. */
static long long rise_begin(const struct impact *impact, double rate)
{
    return impact->onset - llround(impact->width * rate);
}

int impact_merge(int npulse, struct impact *pulse, double rate, long long reach)
{
    int kept = 0;
    for (int k = 0; k < npulse; k++)
        if (kept && rise_begin(&pulse[k], rate) <= pulse[kept - 1].onset + reach)
            pulse[kept - 1].is_double = 1;
        else
            pulse[kept++] = pulse[k];
    return kept;
}

long long impact_room(int n, const struct impact *impact, int k, double rate, long long start, long long count)
{
    return (k + 1 < n ? rise_begin(&impact[k + 1], rate) : count) - start;
}

/* Whether x [count] stays at its value farthest from `base` where a smooth signal would turn back: three or more neighbours are
 * equal, and a half-sine as long as the swing around them would fall, over their number, by more than the finest step that x
 * makes. So a top that is only quantised is no overload. */
static int impact_is_overload(int count, const double *x, double base)
{
    double value = base + largest_deviation(count, x, base), deviation = fabs(value - base), step = INFINITY;
    int longest = 0, at = 0, begin, end;
    for (int j = 0, run = 0; j < count; j++) {
        run = fabs(x[j] - value) > 0 ? 0 : run + 1;
        if (run > longest) {
            longest = run;
            at = j;
        }
        if (j && fabs(x[j] - x[j - 1]) > 0)
            step = fmin(step, fabs(x[j] - x[j - 1]));
    }
    if (longest < 3 || !(deviation > 0))
        return 0;
    double sign = value < base ? -1 : 1;
    for (begin = at; begin > 0 && sign * (x[begin - 1] - base) > 0;)
        begin--;
    for (end = at; end + 1 < count && sign * (x[end + 1] - base) > 0;)
        end++;
    double fall = deviation * pow(PI * (longest - 1) / 2 / (end - begin + 1), 2) / 2;
    return step < fall || isinf(step);
}

/* A pulse within this part of the usual spacing, and within this time, is a second hit: hammers bounce within some hundredths of
 * a second, hands need half a second for the next blow. */
#define BOUNCE      10
#define BOUNCE_TIME 0.25
/* An impact with less room than this part of the usual spacing, such as the last one of a record that ends early, is left out
 * rather than shortening all blocks. */
#define HURRIED 2

/* Samples at the beginning of a block over which its means are taken: before the onset by the width of the pulse, which may rise
 * for that long, but at least the first half of what there is before the onset. >= 1. */
static int block_quiet(int begin, const struct impact *impact, double rate)
{
    double rise = impact->width * rate;
    int half = (begin + 1) / 2;
    return begin - half > rise ? begin - (int)lround(rise) : half;
}

static int is_sound(const struct time_record *record)
{
    if (record->count < 1 || !record->force || !record->response)
        return 0;
    for (long long j = 0; j < record->count; j++)
        if (!(fabs(record->force[j]) <= BLOCK_LARGEST && fabs(record->response[j]) <= BLOCK_LARGEST))
            return 0;
    return 1;
}

/* Room of impact k of a record for its block, which begins `pre` samples before the onset or with the record. Nothing is known of
 * the means before an impact that the record begins with. */
static long long room_of(int n, const struct impact *impact, int k, double rate, long long pre, long long count)
{
    long long begin = impact[k].onset < pre ? impact[k].onset : pre;
    return begin ? impact_room(n, impact, k, rate, impact[k].onset - begin, count) : 0;
}

/* Impacts of one record from the pulses at the end of the list, and in *shortest the length that the record leaves to a block. */
static int split(struct pool *pool, const struct time_record *record, double rate, long long pre, long long given,
                 struct impact_list *list, size_t first, long long *shortest)
{
    int n = (int)(list->count - first);
    struct impact *impact = list->item + first;
    double *work = POOL_ARRAY(pool, double, n);
    if (!work)
        return ROTID_ERROR_MEMORY;
    long long spacing = impact_spacing(n, impact, record->count, work);
    long long bounce = (long long)fmin((double)spacing / BOUNCE, BOUNCE_TIME * rate); /* and no pulse before the onset */
    n = impact_merge(n, impact, rate, given ? given - pre : bounce > pre ? bounce : pre);
    list->count = first + (size_t)n;
    *shortest = 0;
    for (int k = 0; k < n; k++) {
        long long room = room_of(n, impact, k, rate, pre, record->count);
        if (room >= spacing / HURRIED && room >= 2 && (!*shortest || room < *shortest))
            *shortest = room;
    }
    return given || *shortest ? ROTID_OK : ROTID_ERROR_ARGUMENT;
}

/* A channel that was not connected at this impact would halve the mean over two. */
static int is_dead(int n, const double *response)
{
    int j = 1;
    while (j < n && response[j] == response[0])
        j++;
    return j == n;
}

/* Which impacts of record `at` are used, once the length of the blocks is known. */
static void judge(const struct time_record *record, double rate, const struct transfer_options *options, long long pre, int at,
                  struct block_plan *plan)
{
    struct impact *impact = &plan->impact[plan->first[at]];
    int n = plan->first[at + 1] - plan->first[at];
    for (int k = 0; k < n; k++) {
        int begin = (int)(impact[k].onset < pre ? impact[k].onset : pre);
        plan->begin[plan->first[at] + k] = begin;
        impact[k].is_cut = room_of(n, impact, k, rate, pre, record->count) < plan->n;
        if (impact[k].is_cut)
            continue;
        const double *force = record->force + impact[k].onset - begin, *response = record->response + impact[k].onset - begin;
        int quiet = block_quiet(begin, &impact[k], rate);
        impact[k].is_clipped = impact_is_overload(plan->n, force, window_mean(quiet, force)) ||
                               impact_is_overload(plan->n, response, window_mean(quiet, response));
        impact[k].used = !impact[k].is_clipped && (!impact[k].is_double || options->double_hits) && !is_dead(plan->n, response);
    }
}

/* Finds the impacts of nrecord >= 1 records, tells second hits from the next impacts, chooses the length of the blocks and which
 * impacts are used; see struct transfer_options, whose ranges have been checked. Statuses and *bad_record as transfer_compute. */
static int block_plan(struct pool *pool, int nrecord, const struct time_record *record, double rate,
                      const struct transfer_options *options, struct block_plan *plan, int *bad_record)
{
    struct impact_list list = {0};
    double pretrigger = options->pretrigger > 0 ? options->pretrigger : 0.01;
    double threshold = options->threshold > 0 ? options->threshold : 0.1;
    long long pre = (long long)fmax(1, fmin(floor(pretrigger * rate + 0.5), FFT_LONGEST)), shortest = FFT_LONGEST;
    long long given = fft_length((long long)fmin(floor(options->block * rate + 0.5), FFT_LONGEST));
    *plan = (struct block_plan){.first = POOL_ARRAY(pool, int, nrecord + 1)};
    *bad_record = -1;
    if (options->block > 0 && (given <= pre + 1 || options->block * rate > FFT_LONGEST))
        return ROTID_ERROR_ARGUMENT;
    if (!plan->first)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < nrecord; r++) {
        size_t before = list.count;
        long long room = 0;
        *bad_record = r;
        if (!is_sound(&record[r]) || record[r].count < given)
            return ROTID_ERROR_ARGUMENT;
        int status = impact_find(pool, r, record[r].count, record[r].force, rate, threshold, &list);
        if (!status)
            status = split(pool, &record[r], rate, pre, given, &list, before, &room);
        if (status)
            return status;
        shortest = room < shortest ? room : shortest;
        plan->first[r + 1] = (int)list.count;
    }
    *bad_record = -1;
    plan->n = given ? (int)given : fft_length(shortest);
    plan->impact = list.item;
    plan->begin = POOL_ARRAY(pool, int, list.count);
    if (!plan->begin)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < nrecord; r++)
        judge(&record[r], rate, options, pre, r, plan);
    return ROTID_OK;
}

void estimator_sum(int nline, int count, const struct spectra *column, const double *weight, struct spectra *sum)
{
    memset(sum->ff, 0, (size_t)nline * sizeof *sum->ff);
    memset(sum->xx, 0, (size_t)nline * sizeof *sum->xx);
    for (int l = 0; l < nline; l++)
        sum->xf[l] = 0;
    for (int i = 0; i < count; i++) {
        double w = weight ? weight[i] : 1;
        size_t at = (size_t)i * (size_t)nline;
        for (int l = 0; l < nline && w > 0; l++) {
            sum->ff[l] += w * column->ff[at + (size_t)l];
            sum->xx[l] += w * column->xx[at + (size_t)l];
            sum->xf[l] += w * column->xf[at + (size_t)l];
        }
    }
}

double estimator_balance(int nline, const struct spectra *sum)
{
    double ff = 0, xx = 0;
    for (int l = 0; l < nline; l++) {
        ff += sum->ff[l];
        xx += sum->xx[l];
    }
    return ff > 0 ? xx / ff : 0;
}

static double complex total_least_squares(double balance, double ff, double xx, double complex xf)
{
    double cross = cabs(xf), difference = xx - balance * ff, root = hypot(difference, 2 * sqrt(balance) * cross);
    if (difference > 0)
        return xf / cross * ((difference + root) / (2 * cross));
    return xf * (2 * balance / (root - difference)); /* the same, without the difference of two large numbers */
}

void estimator_transfer(int estimator, double balance, int nline, const struct spectra *sum, double complex *h)
{
    for (int l = 0; l < nline; l++) {
        double ff = sum->ff[l], xx = sum->xx[l];
        double complex xf = sum->xf[l];
        if (!(ff > 0) || (fabs(creal(xf)) <= 0 && fabs(cimag(xf)) <= 0))
            h[l] = 0;
        else if (estimator == TRANSFER_H1)
            h[l] = xf / ff;
        else if (estimator == TRANSFER_H2)
            h[l] = xx / conj(xf);
        else
            h[l] = total_least_squares(balance, ff, xx, xf);
    }
}

void estimator_coherence(int nline, const struct spectra *sum, double *coherence)
{
    for (int l = 0; l < nline; l++) {
        double ratio = complex_square(sum->xf[l]) / sum->ff[l] / sum->xx[l];
        coherence[l] = sum->ff[l] > 0 && sum->xx[l] > 0 ? fmin(ratio, 1) : 0;
    }
}

void estimator_jackknife(int estimator, int nline, int count, const struct spectra *column, const double complex *h,
                         double *variance, struct spectra *sum, double complex *part, double *weight)
{
    for (int i = 0; i < count; i++)
        weight[i] = 1;
    estimator_sum(nline, count, column, weight, sum);
    double balance = estimator_balance(nline, sum);
    for (int l = 0; l < nline; l++)
        variance[l] = sum->ff[l] > 0 ? 0 : INFINITY;
    for (int i = 0; i < count; i++) {
        const double *own = column->ff + (size_t)i * (size_t)nline;
        weight[i] = 0;
        estimator_sum(nline, count, column, weight, sum);
        weight[i] = 1;
        estimator_transfer(estimator, balance, nline, sum, part);
        for (int l = 0; l < nline; l++) {
            if (own[l] > 0) /* (1 - w)/w */
                variance[l] += complex_square(h[l] - part[l]) * (sum->ff[l] / own[l]) / count;
        }
    }
}

/* The finite ones among the lines of a window, in order: a window that moves by one line changes by two values. */
struct window {
    double *value; /* [2 ESTIMATOR_SMOOTH + 2] rising */
    int count;
};

static void add(struct window *window, double value)
{
    int at = window->count;
    if (!isfinite(value))
        return;
    for (; at > 0 && window->value[at - 1] > value; at--)
        window->value[at] = window->value[at - 1];
    window->value[at] = value;
    window->count++;
}

static void take(struct window *window, double value)
{
    int at = 0;
    if (!isfinite(value))
        return;
    while (window->value[at] < value)
        at++;
    window->count--;
    for (; at < window->count; at++)
        window->value[at] = window->value[at + 1];
}

static double median(const struct window *window)
{
    int half = window->count / 2;
    return window->count % 2 ? window->value[half] : (window->value[half - 1] + window->value[half]) / 2;
}

void estimator_smooth(int nline, const double *force, double *variance, double *work)
{
    double *noise = work;
    struct window window = {.value = work + nline};
    for (int l = 0; l < nline; l++) {
        noise[l] = force[l] > 0 ? variance[l] * force[l] : INFINITY;
        if (l < ESTIMATOR_SMOOTH)
            add(&window, noise[l]);
    }
    for (int l = 0; l < nline; l++) {
        int from = l < ESTIMATOR_SMOOTH ? 0 : l - ESTIMATOR_SMOOTH;
        int to = l > nline - 1 - ESTIMATOR_SMOOTH ? nline : l + ESTIMATOR_SMOOTH + 1, count = 0;
        if (l + ESTIMATOR_SMOOTH < nline)
            add(&window, noise[l + ESTIMATOR_SMOOTH]);
        if (from > 0)
            take(&window, noise[from - 1]);
        if (!isfinite(noise[l]))
            continue;
        double limit = ESTIMATOR_OUTLIER * median(&window), sum = 0;
        for (int k = from; k < to; k++)
            if (isfinite(noise[k]) && (noise[k] > limit) == (noise[l] > limit)) {
                sum += noise[k];
                count++;
            }
        variance[l] = sum / count / force[l];
    }
}

#define HIGHEST 0.45 /* of the sampling rate: up to there the filters of a converter are flat */
#define RINGING_SAMPLES                                                                                                          \
    128 /* in which the steepest anti-alias filter of an analyser rings down; less cut off bends the lines below it */
#define QUIET_LEAST 5    /* samples before an impact that tell the noise of the force */
#define FASTEST     1e12 /* Hz, and its inverse the slowest sampling: spectra stay within the range of double */

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
    return status ? status : pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
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
    double needed = fmax(10 * impact->width, RINGING_SAMPLES / work->rate),
           keep = work->options->force_window > 0 ? work->options->force_window : needed;
    if (work->options->force_window >= 0 && !impact->is_double) { /* a second hit that is kept belongs to the force */
        int reach = (int)fmin(n, begin + ceil(needed * work->rate)), from = (int)fmin(reach, begin + ceil(keep * work->rate));
        double whole = squares(reach, worker->force), noise = squares(quiet, worker->force) / quiet * (reach - from);
        window_force(n, (int)fmin(n, begin + ceil(keep * work->rate)), (int)fmin(n, keep * work->rate / 4), worker->force);
        double gone = whole - squares(reach, worker->force) - (1 + 6 * sqrt(2. / quiet)) * noise; /* six deviations of it */
        impact->lost = quiet >= QUIET_LEAST && gone > 0 ? sqrt(gone / whole) : 0;
    }
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
        work->out->single_force[to] = complex_square(f);
        work->out->single_response[to] = complex_square(x);
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
