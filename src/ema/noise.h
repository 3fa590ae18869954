/* The noise of each line where none is stated. */
#ifndef ROTID_EMA_NOISE_H
#define ROTID_EMA_NOISE_H

#include "ema/band.h"
#include "rotid.h"

/* band->variance := |H - model|^2 averaged (in the logarithm) over 30 lines on each side, the model fitted with the poles pole
 * [n] as start (which stay): flat weights where there is no variance yet, else those. One number a channel would let the worst
 * misfit of the band decide on the weakest mode of it. Nothing is done for n = 0. ROTID_OK, ROTID_ERROR_MEMORY or
 * ROTID_STOP_CANCELLED. */
int noise_from_residual(struct pool *pool, struct ema_band *band, int threads, const rotid_environment *environment, int n,
                        const double complex *pole);

#endif
