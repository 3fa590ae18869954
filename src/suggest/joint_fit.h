/* A rival fitted to what was measured and to a test at once: what the linear margins are compared with. */
#ifndef ROTID_SUGGEST_JOINT_FIT_H
#define ROTID_SUGGEST_JOINT_FIT_H

#include "suggest/rivals.h"
#include "suggest/tests.h"

/* *measured := what rival a at the values x [job.unknowns.nparameter] of the parameters of its home would give in the test,
 * without noise. Statuses of planned_measure. */
int joint_measurement(struct pool *pool, const struct rival *a, const double *x, const struct test *test,
                      struct job_measurement *measured);

/* *chi2 of rival b fitted to its measurements in all states and to `measured` of the test together, from where it stands; what
 * has a value of its own in the test is an unknown of that state alone. Statuses of identify_states. */
int joint_chi2(struct pool *pool, const struct rival *b, const struct test *test, const struct job_measurement *measured,
               const rotid_environment *environment, double *chi2);

#endif
