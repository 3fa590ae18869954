/* What the impacts say about the residues, line by line independent or not. */
#ifndef ROTID_EMA_IMPACTS_H
#define ROTID_EMA_IMPACTS_H

#include "ema/modal_fit.h"
#include "signal/frf.h"

/* The covariance `spread` of the residues takes the noise of neighbouring lines for independent. That of the force is not: behind
 * the window of the force its spectrum is smooth, and moves a whole peak up or down, as a gain would. So the residues are fitted
 * again without each impact in turn, the poles known; the jackknife of impacts of unequal weight (Busing, Meijer, van der Leeden
 * 1999) gives the variance of each, and stated + g |A|^2 = variance over the channels of a mode the relative variance g of that
 * gain, which is added to `spread`. fit: refined, with spread, on the lines line [fit->nline] of the band, which begins at line
 * `first` of the set. gain [fit->nmode] out: g, 0 where fewer than two impacts are known. ROTID_OK or ROTID_ERROR_MEMORY. */
int impacts_spread(const struct pool *pool, const struct frf_set *set, int first, const struct ema_band *band, const int *line,
                   struct modal_fit *fit, double *gain);

#endif
