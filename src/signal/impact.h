/* Where a hammer hit, from the force alone. */
#ifndef ROTID_SIGNAL_IMPACT_H
#define ROTID_SIGNAL_IMPACT_H

#include "signal/transfer.h"

#define IMPACT_LEAST_FORCE 1e-50 /* N: below it the squares of spectra underflow */

struct impact_list {
    struct impact *item;
    size_t count, capacity;
};

/* Appends the pulses of one record to the list. A pulse begins where the force, counted from its base line and with the sign of
 * its largest deviation P, reaches threshold * P, and the next one can begin after it fell below half of that: noise on a flank
 * is no second pulse, nor is what swings below the base line, beside it, by more than two thirds of its height: the ringing of a
 * filter. The base line is the mean of what stays within P/10 of it. A force that is further than P/10 from its base
 * line for half of the time is noise or a shaker: no pulse. force [count] finite, 0 < threshold < 1, rate > 0.
 * ROTID_OK, ROTID_ERROR_ARGUMENT (no pulse), ROTID_ERROR_MEMORY. */
int impact_find(struct pool *pool, int record, long long count, const double *force, double rate, double threshold,
                struct impact_list *list);

/* Upper quartile of the samples from each of npulse >= 1 pulses to the next one or to the end of the record: the usual spacing,
 * also where each impact has a second hit. work [npulse]. */
long long impact_spacing(int npulse, const struct impact *pulse, long long count, double *work);

/* A pulse that begins to rise no more than `reach` samples after the onset of an impact is its second hit: the impact is_double
 * and the pulse leaves the array. Returns how many impacts remain. */
int impact_merge(int npulse, struct impact *pulse, double rate, long long reach);

/* Samples from `start` to where impact k of n rises next, or to the end of the record: room for its block. */
long long impact_room(int n, const struct impact *impact, int k, double rate, long long start, long long count);

/* Whether x [count] stays at its value farthest from `base` where a smooth signal would turn back: three or more neighbours are
 * equal, and a half-sine as long as the swing around them would fall, over their number, by more than the finest step that x
 * makes. So a top that is only quantised is no overload. */
int impact_is_overload(int count, const double *x, double base);

#endif
