/* Tests that nobody has made yet: a job with sensors where they could stand, and with the modes of a model as measurements. */
#ifndef ROTID_SUGGEST_PLANNED_H
#define ROTID_SUGGEST_PLANNED_H

#include "run/job.h"

/* What is measured in a test. */
struct planned {
    int modes;
    const int *number;               /* [modes] elastic modes, from 1 */
    double frequency_std, shape_std; /* relative, > 0; shape_std 0: no shapes */
};

/* *to := the job `from` with sensors at z [n], increasing, and without measurements. Where the job has a sensor its id stays;
 * others get ids behind the largest. An effect at a sensor that is gone acts nowhere. `to` may be the job itself. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int planned_sensors(struct pool *pool, const struct job *from, int n, const double *z, struct job *to);

/* The measurements of *to := the modes of `source` at the values x [nparameter] of its parameters, without noise, to be weighed
 * by the noise of the plan: frequencies, and shapes at the sensors of `source`, largest component 1; *to has sensors at the same
 * places. All modes are fitted, by the likelihood of the full model. Statuses of spectrum_compute; ROTID_ERROR_ARGUMENT where
 * the model has fewer modes. */
int planned_measure(struct pool *pool, const struct job *source, const double *x, const struct planned *plan, struct job *to);

#endif
