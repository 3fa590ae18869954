/* What the estimators work on: the usable channels of a set as accelerance, on the lines of a band. Accelerance because its peaks
 * are of one size for modes of one damping and mass, whatever their frequency; and off its peaks it is real, which the basis of
 * lscf.h wants. */
#ifndef ROTID_EMA_BAND_H
#define ROTID_EMA_BAND_H

#include "base/complex.h"
#include "base/pool.h"
#include "signal/frf.h"

struct ema_band {
    int nline;
    double low, high; /* rad/s, of the first and last line */
    double *omega;    /* [nline] rising, > 0 */
    int nchannel;
    int *channel;      /* [nchannel] index of the transfer function in the set */
    double complex *h; /* [nline * nchannel] accelerance, channel by channel */
    double *variance;  /* [nline * nchannel] of it, smoothed and > 0; NULL unless most channels have one */
};

/* What brings a line of the set to accelerance of i omega: (i omega)^2/(i omega + window_decay)^q, since behind an exponential
 * window the set is the transfer function at i omega + window_decay. */
double complex ema_band_factor(const struct frf_set *set, double omega);

/* Takes the lines first ... last - 1 of the set, all above 0 Hz, of the transfer functions with usable [nfrf] nonzero, times
 * ema_band_factor. A variance estimated from n averages scatters by sqrt(2/(2 n - 2)); as weight it would prefer lines that came
 * out too small. So one that is not from records, where that has been done, is averaged over neighbouring lines up to 20 degrees
 * of freedom, and kept above 1e-10 of its mean over the band, where the running sum rounds. ROTID_OK or ROTID_ERROR_MEMORY. */
int ema_band_new(struct pool *pool, const struct frf_set *set, int first, int last, const int *usable, struct ema_band *band);

/* Its lines first ... first + nline - 1, copied. ROTID_OK or ROTID_ERROR_MEMORY. */
int ema_band_part(struct pool *pool, const struct ema_band *band, int first, int nline, struct ema_band *part);

/* First line with omega >= value; nline where there is none. */
int ema_band_line(const struct ema_band *band, double value);

#endif
