/* Frequencies of each point, and their consequences for the modes. */
#ifndef ROTID_EMA_PER_POINT_H
#define ROTID_EMA_PER_POINT_H

#include "ema/band.h"
#include "ema/ema.h"

/* For each mode with suspect [nmode] nonzero (all with point_frequency_hz asked for): the pole of every channel alone. Where they
 * scatter beyond three times their standard deviations and a fiftieth of the half bandwidth, and leave less than two thirds of
 * the variance common [nmode * nchannel] (mode by mode) that the common poles leave near the mode, and no other mode lies within
 * three half-power bandwidths, the mode is EMA_DOUBLE_PEAK; where the widths agree local_pole is set, residues of the channels
 * that know their pole come from their own fits, frequency and damping are the means of the channels with the standard deviation
 * of a mean, and gain [nmode] (impacts_spread) in the standard deviations of the residues; where they do not, the pole is
 * local_common's. point_frequency: mean of the channels of the point. out holds the
 * modes of the common fit. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_STOP_CANCELLED. */
int per_point_frequencies(struct pool *pool, const struct ema_band *band, double decay, const int *suspect, const double *common,
                          const double *gain, const rotid_environment *environment, struct ema *out);

#endif
