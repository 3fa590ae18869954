#include "signal/block.h"

#include <math.h>

#include "signal/fft.h"
#include "signal/impact.h"
#include "signal/window.h"

/* A pulse within this part of the usual spacing, and within this time, is a second hit: hammers bounce within some hundredths of
 * a second, hands need half a second for the next blow. */
#define BOUNCE      10
#define BOUNCE_TIME 0.25
/* An impact with less room than this part of the usual spacing, such as the last one of a record that ends early, is left out
 * rather than shortening all blocks. */
#define HURRIED 2

int block_quiet(int begin, const struct impact *impact, double rate)
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
        impact[k].used = !impact[k].is_clipped && (!impact[k].is_double || options->double_hits);
    }
}

int block_plan(struct pool *pool, int nrecord, const struct time_record *record, double rate,
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
