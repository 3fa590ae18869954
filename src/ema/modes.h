/* The modes of the result from a fit: frequencies, residues, quality flags. */
#ifndef ROTID_EMA_MODES_H
#define ROTID_EMA_MODES_H

#include "ema/ema.h"
#include "ema/refine.h"

/* out->mode [nmode] with arrays to be filled, out->lower, upper, channel: everything NaN or 0. out->nfrf, npoint and the number
 * of modes are known. ROTID_OK or ROTID_ERROR_MEMORY. */
int modes_new(struct pool *pool, int nmode, int per_point, struct ema *out);

/* Frequency and damping of a pole, lambda = -zeta w + i w sqrt(1 - zeta^2), w = |lambda|, with their standard deviations from the
 * covariance [2 * 2] of (Re, Im lambda): dw = (Re dRe + Im dIm)/w, dzeta = (-dRe - zeta dw)/w. */
void modes_of_pole(double complex pole, const double *covariance, struct ema_mode *mode);

/* From a fit evaluated with spread and the covariance of its poles: poles (decay taken off), residues, lower and upper. Channels
 * without a fit stay NaN. */
void modes_from_fit(const struct ema_band *band, const struct modal_fit *fit, const struct refinement *refinement, double decay,
                    struct ema *out);

/* nearest_hz, peak_signal_to_noise, mac, and the quality flags CLOSE, COMPLEX, WEAK, NEGATIVE_DAMPING, EDGE from what the modes
 * hold. */
int modes_judge(struct pool *pool, const struct ema_band *band, double decay, struct ema *out);

#endif
