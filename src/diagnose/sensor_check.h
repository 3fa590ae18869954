/* Faults of the measurement chain, found from the shapes alone: physics moves a shape smoothly along the axis, a bad channel
 * makes a spike. A sensor is compared with what its neighbours say it should read, prediction plus the smooth part of the
 * residual. */
#ifndef ROTID_DIAGNOSE_SENSOR_CHECK_H
#define ROTID_DIAGNOSE_SENSOR_CHECK_H

#include "base/pool.h"

struct shape_data {
    int nsensor, nmode;
    const double *z;     /* [nsensor] positions, increasing [m] */
    const double *shape; /* [nsensor * nmode] measured, NaN where not measured */
    const double *std;   /* [nsensor * nmode] of the same scale */
    const double *read;  /* [nsensor * nmode] the shape with the digits it was read with, of any scale */
    int naxis;
    const double *axis_z;     /* [naxis] nodes of the model, increasing */
    const double *axis_shape; /* [naxis * nmode] deflection of the model's modes there, times the best scale to the measured */
};

/* Mode k of the model at z [m], from the first node to the last, cubic between the nodes (Lagrange, on the four around z). */
double shape_data_model(const struct shape_data *data, int k, double z);

enum sensor_fault_kind { FAULT_GAIN, FAULT_SIGN, FAULT_SWAP, FAULT_POSITION, FAULT_DUPLICATE, FAULT_DEAD };

struct sensor_fault {
    enum sensor_fault_kind kind;
    int sensor, other;  /* indices; other: the partner of a swap, the source of a copy; else -1 */
    double value, std;  /* gain, or shift [m] (true place = stated place + shift); NaN elsewhere */
    double chi2_drop;   /* twice the gain in log likelihood of all sensors over this one being sound */
};

/* Finds up to `most` faults, the worst first, each judged with all others taken out. `false_alarm`: family-wise probability of
 * any fault in sound data, about 0.005. A fault also has to beat a joint or a soft zone at that place, so small ones go unnamed
 * where the model is badly wrong. Noise up to five times the stated one is allowed for. Below 8 sensors only
 * copies are found: FAULT_DUPLICATE is a channel that agrees with another one to the last digit, whatever the model is. fault [most], *nfault. ROTID_OK or ROTID_ERROR_MEMORY. */
int sensor_check(struct pool *pool, const struct shape_data *data, double false_alarm, int most, struct sensor_fault *fault,
                 int *nfault);

#endif
