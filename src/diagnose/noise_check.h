/* Is the noise of the shapes as stated? From the part of the residual that no cause of the catalogue can produce. */
#ifndef ROTID_DIAGNOSE_NOISE_CHECK_H
#define ROTID_DIAGNOSE_NOISE_CHECK_H

#include "base/pool.h"

struct noise_estimate {
    int usable;           /* enough rows for an estimate: 60 beside the directions of physics */
    double factor;        /* estimated over stated standard deviation */
    double std;           /* of that factor */
    int misstated;        /* it differs from 1 beyond chance (two-sided 0.001) and by more than 15 % */
    int coloured;         /* the smooth part is noisier than the rest: neighbouring sensors share their noise */
    double smooth_factor; /* level of the smooth part alone over the stated one, real effects taken out; NaN without columns */
};

/* residual [nrow]: whitened shape residuals of the fit, NaN never. column [nrow * ncolumn]: whitened columns of every cause and
 * of the free parameters, any scale (they span what physics can do to the shapes). Robust against some sensors with faults and
 * against one or two real effects hidden in the residual. work on `pool`. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_ERROR_LIBRARY. */
int noise_check(struct pool *pool, int nrow, int ncolumn, const double *residual, const double *column,
                struct noise_estimate *estimate);

#endif
