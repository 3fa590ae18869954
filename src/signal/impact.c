#include "signal/impact.h"

#include <math.h>

#include "base/order.h"

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

int impact_find(struct pool *pool, int record, long long count, const double *force, double rate, double threshold,
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

int impact_is_overload(int count, const double *x, double base)
{
    static const double pi = 3.14159265358979323846;
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
    double fall = deviation * pow(pi * (longest - 1) / 2 / (end - begin + 1), 2) / 2;
    return step < fall || isinf(step);
}
