/* Modes that differ from channel to channel: a roving accelerometer, a support that slips, temperature. */
#ifndef ROTID_EMA_LOCAL_H
#define ROTID_EMA_LOCAL_H

#include "base/complex.h"
#include "base/pool.h"
#include "ema/band.h"

struct local_pole {
    int known;                    /* 0: the channel sits on a node, or no pole was found; the rest is NaN then */
    double complex pole, residue; /* as measured */
    double covariance[4];         /* of (Re, Im pole) */
    double residue_std;
    double chi2;  /* sum of squared residuals over the stated variance; without one as they are */
    double noise; /* that over the degrees of freedom */
};

/* The pole of channel k of the band alone near pole[which], the modes pole [nmode] being all that there are: modes within twice
 * the window are fitted along with it. residue [nmode] of that channel: what the modes further away add is taken off first; NULL:
 * it is left to the residual terms, which bends the residue by parts in a thousand. Where no mode is near, every place within
 * local_reach is tried first, in steps of half a bandwidth. known needs |A| above 4 standard deviations where the place was
 * searched for, 3 where not. ROTID_OK or ROTID_ERROR_MEMORY. */
int local_fit(const struct pool *pool, const struct ema_band *band, int k, int nmode, const double complex *pole,
              const double complex *residue, int which, struct local_pole *out);

/* The common pole of all channels near pole[which], all weighted alike, so that those that respond most decide: where the model
 * is wrong, noise does not tell what to trust. *common := NaN where that fails. ROTID_OK or ROTID_ERROR_MEMORY. */
int local_common(const struct pool *pool, const struct ema_band *band, int nmode, const double complex *pole, int which,
                 double complex *common);

/* Replaces modes that lie within 2 % of each other by one wherever each channel shows one peak only: one pole a channel against
 * common poles leaves less (log-likelihood of the residuals; both have as many unknowns where two become one). The pole that
 * stays is the median of the channels' own; none stays where their residues have no phase in common (MPC below 0.4). pole
 * [*count] in and out; ROTID_OK or ROTID_ERROR_MEMORY. */
int local_merge(const struct pool *pool, const struct ema_band *band, int *count, double complex *pole);

#endif
