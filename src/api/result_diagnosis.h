/* A diagnosis as hosts and files have it. */
#ifndef ROTID_API_RESULT_DIAGNOSIS_H
#define ROTID_API_RESULT_DIAGNOSIS_H

#include "api/result_memory.h"
#include "diagnose/diagnose.h"

/* deck: the job as the user states it, whose FIT `today` was fitted with. The fits of `d` go over into the memory of the result.
 * Without messages and the extended deck. NULL where memory is out. */
rotid_diagnosis *result_diagnosis(struct result_memory *memory, const struct job *deck, struct diagnosis *d);

#endif
