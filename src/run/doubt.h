/* Doubts about a measurement that only the model can raise. */
#ifndef ROTID_RUN_DOUBT_H
#define ROTID_RUN_DOUBT_H

#include "base/message.h"
#include "run/job.h"
#include "run/spectrum.h"

/* Says where the measured frequencies are all the same number times those of the model at its stated values, by mode numbers, and
 * that number is one of a mistaken unit: 2 pi, 1000, the root of 1000, or one over these. Returns nonzero then. */
int doubt_units(const struct job *job, const struct spectrum *spectrum, enum severity severity, struct message_list *notes);

#endif
