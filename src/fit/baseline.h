/* The same problem given to NLopt: an independent minimiser from the same start to the same tolerance. */
#ifndef ROTID_FIT_BASELINE_H
#define ROTID_FIT_BASELINE_H

#include "base/pool.h"
#include "modal/joint.h"
#include "rotid.h"

/* 0 where this is built without NLopt. */
int baseline_exists(void);

/* Algorithms: BOBYQA (from two parameters on), Sbplx, and SLSQP with the gradient. 0 where built without NLopt. */
int baseline_count(int nparam);

/* Minimises the objective with each algorithm in x/|start| within the bounds. out [baseline_count(n)], x of each on `keep`;
 * *count of them are filled: where a model has a wide band, a solid, Sbplx is left out, which takes four times the evaluations of
 * BOBYQA, 0.1 s each. work [nresidual * (n + 1)]. ROTID_OK, MEMORY, or CANCELLED as soon as the environment says so. */
int baseline_run(struct pool *keep, struct joint *joint, const rotid_parameter *parameter, const rotid_environment *environment,
                 double *work, rotid_baseline *out, int *count);

#endif
