/* What is wrong with a transfer function, before and after the modes are known. */
#ifndef ROTID_EMA_CHANNELS_H
#define ROTID_EMA_CHANNELS_H

#include "ema/ema.h"

/* Flags of channel [nfrf] from the lines first ... last - 1: NOT_FINITE, DEAD, DUPLICATE (the same to 1e-6 of the largest, or
 * FRAC above 0.99999 where the stated noise of both, above half a percent, forbids that of separate measurements), NOISY,
 * LOW_COHERENCE (mean weighted by |H|^2 below 0.8); twin, noise. usable [nfrf] := neither of the first two. Duplicates stay in:
 * what they add is a point of the shape. ROTID_OK or ROTID_ERROR_MEMORY. */
int channels_check(struct pool *pool, const struct frf_set *set, int first, int last, struct ema_channel *channel, int *usable);

/* fit and MISFIT of the usable channels over the same lines, from the modes in out. ROTID_OK or ROTID_ERROR_MEMORY. */
int channels_compare(struct pool *pool, const struct frf_set *set, int first, int last, const int *usable, struct ema *out);

#endif
