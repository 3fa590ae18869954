/* An identification as hosts and files have it. */
#ifndef ROTID_API_RESULT_IDENTIFICATION_H
#define ROTID_API_RESULT_IDENTIFICATION_H

#include "run/identify.h"

/* Leans on the job and on what was found. Without noise, geometry and messages. NULL where there is no fit, or memory is out. */
rotid_identification *result_identification(struct pool *pool, const struct job *job, const struct identification *found);

/* The same of all states together, with noise and geometry and those of each in `states`; found [nstate], fit: of all. */
rotid_identification *result_identification_states(struct pool *pool, const struct states *states,
                                                   const struct identification *found, const rotid_fit_result *fit);

/* Measured mode k beside the frequency predicted for its partner. Without residual, which is NaN. */
rotid_compared_mode result_compared_mode(const struct job *job, const struct comparison *compared, int k, double predicted_hz);

/* Typical noise of the data of a job, and what the intervals of the fit rest on. NULL where memory is out. */
rotid_noise *result_noise(struct pool *pool, const struct job *job, const rotid_fit_result *fit);

#endif
