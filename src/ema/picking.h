/* Quadrature picking: the way of the paper that the program follows, kept for comparison with it. */
#ifndef ROTID_EMA_PICKING_H
#define ROTID_EMA_PICKING_H

#include "ema/band.h"
#include "ema/ema.h"

/* Frequencies are the local maxima of sum_c |Im H_c| (accelerance; Re of mobility is the same up to omega), parabola through the
 * three highest lines: above four times the median of the sum, and above all others within `apart` of it. shape is the imaginary
 * part at the peak, damping (f_b - f_a)/(2 f) from the half-power points of sum |H_c|^2, NaN where they lie outside the band.
 * With picks, the largest line within 2 % of each. Residues: A = Im H/(i omega^2) zeta omega, as if the mode stood alone.
 * Standard deviations from the variance: of the shape sqrt(variance/2) at the line; of the frequency (line spacing)/sqrt(12),
 * what a line spectrum resolves. out->mode is made here. ROTID_OK or ROTID_ERROR_MEMORY. */
int picking_compute(struct pool *pool, const struct ema_band *band, const struct ema_options *options, double decay,
                    struct ema *out);

#endif
