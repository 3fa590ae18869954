#include "diagnose/explains.h"

#include <math.h>

#include "diagnose/bootstrap.h"
#include "fit/quantile.h"

/* Share of the variance of a residual that is its noise. */
static double share(double std, double discrepancy)
{
    return std * std / (std * std + discrepancy * discrepancy);
}

int fit_explains(const struct refit *refit, const struct scan *scan, const struct scan_set *set, const int *holdout)
{
    const struct job *job = &refit->job;
    const double *r = refit->fit->r;
    double by_frequency = 0, by_shape = 0, frequency = 0, shape = 0;
    int free = refit->fit->n - scan->nfree, row = 0;
    for (int m = 0; m < set->count; m++) {
        const struct cause_kind *cause = scan->candidate[set->candidate[m]].cause;
        by_frequency = hypot(by_frequency, cause->discrepancy_frequency);
        by_shape = hypot(by_shape, cause->discrepancy_shape);
    }
    for (int k = 0; k < job->measurement.nmode; k++)
        if (!holdout[k]) {
            frequency += r[row] * r[row] * share(job->measurement.frequency_std[k], by_frequency);
            row++;
        }
    for (int k = 0; k < job->measurement.nmode; k++)
        for (int s = 0; s < job->rotor.nsensor && row < refit->fit->nresidual && !holdout[k]; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * job->rotor.nsensor;
            if (!isfinite(job->measurement.shape[at]))
                continue;
            shape += r[row] * r[row] * share(job->measurement.shape_std[at], by_shape);
            row++;
        }
    return chi_square_tail(frequency, scan->nfrequency) > BLOCK_LEVEL && scan->dof > free &&
           chi_square_tail(frequency + shape, scan->dof - free) > BLOCK_LEVEL;
}
