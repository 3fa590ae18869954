/* Modes beyond the ends of the band, as far as the band feels them. */
#ifndef ROTID_EMA_GUARD_H
#define ROTID_EMA_GUARD_H

#include "ema/band.h"
#include "rotid.h"

#define GUARD_MOST 6 /* poles */

/* The residual terms L and U stand for modes far away; the flank of one close to the band is none of them, and bends the modes
 * next to it: on a rotor with a mode 5 % above the band by a percent of their half bandwidth, ten times what the noise does. So a
 * pole is put beyond an end of the band and fitted with the others, and stays where the fit gets better than chance allows: sum
 * chi2 falls by more than 2 n + 12 sqrt(n) + 30 for n channels. Again until none earns its place. Guards are no modes: where they
 * end is what suits the band best, and nothing is reported of them. pole [nmode + GUARD_MOST] in: nmode candidates; out: *nguard
 * more behind them. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_STOP_CANCELLED. */
int guard_poles(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                int nmode, double complex *pole, int *nguard);

/* Whether a guard is so far, an octave from the band, that the lines do not tell its place: they tell what it adds there. Refined
 * on, it would wander until its columns are those of L and U. */
int guard_is_far(const struct ema_band *band, double complex pole);

#endif
