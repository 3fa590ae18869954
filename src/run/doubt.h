/* Doubts about a measurement that only the model can raise. */
#ifndef ROTID_RUN_DOUBT_H
#define ROTID_RUN_DOUBT_H

#include "base/message.h"
#include "run/job.h"
#include "run/spectrum.h"

#define DOUBT_RADIANS 6.283185307179586

/* Whether the measured frequencies are all the same number times those of the model at its stated values, by mode numbers, and
 * that number is one of a mistaken unit: 2 pi (DOUBT_RADIANS), 1000, the root of 1000, or one over these. Returns it, 0 where
 * there is none. What is said of it goes to notes, as an error at the deck's first line where it is `refused`, else as a warning.
 */
double doubt_units(const struct job *job, const struct spectrum *spectrum, double refused, struct message_list *notes);

#endif
