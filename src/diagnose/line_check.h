/* Positions of all sensors at once, from the shapes: counted from the other end (flip), from a wrong origin (shift), with a wrong
 * length (scale). */
#ifndef ROTID_DIAGNOSE_LINE_CHECK_H
#define ROTID_DIAGNOSE_LINE_CHECK_H

#include "diagnose/causes/sensor.h"
#include "diagnose/sensor_check.h"

struct line_fault {
    struct sensor_line line;
    double shift_std, scale_std; /* NaN where as stated */
    double chi2_drop;            /* of the shapes beside the model as it is */
};

/* What of flip, shift and scale is not neutral. */
int line_parameters(const struct sensor_line *line);

/* The line that explains the shapes best beside this model: for both flips, and shift and scale free or as stated,
 *
 *     chi2 = sum_k min_a |a P_k(z') - m_k|^2/s_k^2
 *
 * is minimised from a grid by Gauss-Newton; the one of the least chi2 + 12 a parameter counts, so that nothing is off by what the
 * model or noise may do. *found nonzero where it gains as much, in units of what is left for a degree of freedom where noise does
 * not explain that, and moves a sensor by half a millimetre. Where turning the line alone gains as much it is turned alone: shift
 * and scale are for a model that was fitted to shapes the right way round. Copies and other faults of channels are not looked at.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
int line_check(struct pool *pool, const struct shape_data *data, double length, struct line_fault *fault, int *found);

#endif
