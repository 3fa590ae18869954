/* Which candidates are modes. */
#ifndef ROTID_EMA_SELECTION_H
#define ROTID_EMA_SELECTION_H

#include "ema/band.h"
#include "rotid.h"

/* Lines that a fit uses: within 50 half-power bandwidths of a mode. Further away a mode is no more than a residual term, and
 * modes that were not picked bias less what does not try to explain them. Those more than three bandwidths away carry little of
 * what is known of a pole: they are thinned so that an evaluation takes no more than the given number of products, of a tenth of
 * a second. */
#define FIT_WIDTHS    50
#define FIT_PRODUCTS  3e8
#define EARN_PRODUCTS 5e7

/* That number of lines, at least 16 a mode and 400. */
int selection_lines(const struct ema_band *band, int nmode, double products);

/* Leaves out what is weaker than a fifth of what selection_earn asks for, with the poles as they are. Arguments and statuses of
 * selection_earn. */
int selection_screen(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                     int *count, double complex *pole, int *candidate);

/* Fits all candidates together and leaves out, worst first and fitting again, those that do not earn their place:
 *   - the pole grows, runs away, is damped above 0.2, leaves the band, or it is not known to a fifth of its half bandwidth;
 *   - sum over channels |A|^2/var(A) <= 2 n + 12 sqrt(n) + 30 for n channels: what the best of very many places in the noise
 *     reaches by chance; var from what is left around the mode where that is more than the noise;
 *   - of three channels or more, two at least show it, and with a phase in common (MPC 0.4 where it can be told);
 *   - not a peak below 5 % of the median mode's together with an MPC below 0.9: something attached to the rotor;
 *   - it is not the weaker of two within half a half-power bandwidth that have one shape (MAC above 0.9),
 *     or within a fifth;
 *   - at its frequency it is less than `least share` (0.05) of |H| in every channel: it corrects what others leave;
 *   - its half-power bandwidth is under a fifth of the line spacing: a single line (mains hum).
 * pole [*count] in, the refined ones out; candidate [*count] tells which of those that came in each was. ROTID_OK,
 * ROTID_ERROR_MEMORY or
 * ROTID_STOP_CANCELLED. */
int selection_earn(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                   int *count, double complex *pole, int *candidate);

#endif
