/* Which candidates are modes. */
#ifndef ROTID_EMA_SELECTION_H
#define ROTID_EMA_SELECTION_H

#include "ema/band.h"
#include "rotid.h"

/* Lines that a fit uses: within 50 half-power bandwidths of a mode, 8192 at most. Further away a mode is no more than a residual
 * term, and modes that were not picked bias less what does not try to explain them. */
#define FIT_WIDTHS 50
#define FIT_LINES  8192

/* Fits all candidates together and leaves out, worst first and fitting again, those that do not earn their place:
 *   - the pole grows, runs away, is damped above 0.2, leaves the band, or it is not known to a fifth of its half bandwidth;
 *   - sum over channels |A|^2/var(A) <= 2 n + 12 sqrt(n) + 30 for n channels: what the best of very many places in the noise
 *     reaches by chance;
 *   - at its frequency it is less than `least share` (0.05) of |H| in every channel: it corrects what others leave;
 *   - its half-power bandwidth is under a fifth of the line spacing: a single line (mains hum).
 * pole [*count] in, the refined ones out; candidate [*count] tells which of those that came in each was. ROTID_OK,
 * ROTID_ERROR_MEMORY or
 * ROTID_STOP_CANCELLED. */
int selection_earn(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                   int *count, double complex *pole, int *candidate);

#endif
