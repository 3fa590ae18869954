/* Measured shapes beside those of the full model, as a picture of them needs it: on one scale, the model's along the whole axis
 * and along the members beside it, and which measured shape looks like which mode. */
#ifndef ROTID_RUN_MODE_SHAPES_H
#define ROTID_RUN_MODE_SHAPES_H

#include "run/compare.h"

/* Fills `shapes` and, where a measured shape has two components, the matrices of the MAC and, with a mass matrix of the masters,
 * of the NCO with their rows and columns; zeros before. The best scale of a shape of the model to the measured one is
 * a = sum p m/s^2/sum p^2/s^2 with the stated noise s, 1 where it is not known of all; NaN without a partner. Leans on the job
 * and the spectrum, which is that of spectrum_compute at the model that `compared` paired. ROTID_OK or ROTID_ERROR_MEMORY. */
int mode_shapes_make(struct pool *pool, const struct job *job, const struct spectrum *spectrum, const struct comparison *compared,
                     rotid_identification *out);

#endif
