/* Prediction of what was not fitted: modes left out in turn (fitted again without each), sensors left out in turn (one
 * Gauss-Newton step, exact where the model is linear), modes the deck holds out. Modes are those of all states: k, number,
 * holdout. */
#ifndef ROTID_DIAGNOSE_LEAVE_OUT_H
#define ROTID_DIAGNOSE_LEAVE_OUT_H

#include "base/pool.h"
#include "run/states.h"

/* Predicts mode k by a fit of all fitted modes but it: error of its frequency and rms difference of its shape, NaN where there is
 * no such fit. May run in several threads. Statuses of memory and cancellation only. */
int mode_out_fit(const struct states *states, const int *number, const int *holdout, int k, const rotid_environment *environment,
                 const rotid_allocator *allocator, double *error_percent, double *shape);

/* From the fit of the job: rms over the sensors of the standardised residual that each has when it is not fitted, and of the
 * difference of shapes; NaN without shapes. ROTID_OK, ROTID_ERROR_MEMORY. */
int sensor_out(struct pool *pool, const struct states *states, const int *holdout, const rotid_fit_result *fit,
               double *standardised, double *shape_rms);

/* Frequency and shape errors of the modes that are (held = 1) or are not (0) held out. NaN where there are none. */
void fitted_errors(const struct states *states, const int *holdout, const rotid_fit_result *fit, int held, double *rms_percent,
                   double *max_percent, double *shape_rms);

/* rms difference of a measured shape [nsensor] to the model's, from their MAC: sqrt((1 - MAC) mean of squares), the largest
 * component being 1. NaN without a shape. */
double shape_difference(const struct job *job, int k, double mac);

#endif
