/* Whether two jobs are the same: what a deck that is written and read back has to give. */
#ifndef ROTID_TESTS_SAME_JOB_H
#define ROTID_TESTS_SAME_JOB_H

#include "run/run.h"

/* All numbers to the last bit, but standard deviations of frequencies within one unit of the last place. */
void assert_same_job(const struct job *a, const struct job *b);

#endif
