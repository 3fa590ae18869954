/* Whether two jobs are the same: what a deck that is written and read back has to give. */
#ifndef ROTID_TESTS_SAME_JOB_H
#define ROTID_TESTS_SAME_JOB_H

#include "run/run.h"

/* What numbers may differ by, relative; 0 at first: to the last bit, standard deviations of frequencies within one unit of the
 * last place. */
extern double same_job_rounding;
void assert_same_job(const struct job *a, const struct job *b);

#endif
