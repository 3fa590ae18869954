#include "suggest/joint_fit.h"

#include <math.h>

#include "run/identify.h"

#define OWN_RANGE 1e3 /* bounds of what has a value of its own in a state, from its start */

int joint_measurement(struct pool *pool, const struct rival *a, const double *x, const struct test *test,
                      struct job_measurement *measured)
{
    int n = a->job.unknowns.nparameter;
    const struct planned plan = {test->modes, test->number, test->frequency_std, test->nsensor ? test->shape_std : 0};
    double *x_test = POOL_ARRAY(pool, double, n);
    int *own = POOL_ARRAY(pool, int, n);
    struct job job;
    int status = x_test && own ? test_apply(pool, test, &a->job, x, &job, x_test, own) : ROTID_ERROR_MEMORY;
    if (!status)
        status = planned_measure(pool, &job, x_test, &plan, &job);
    if (!status)
        *measured = job.measurement;
    return status;
}

/* The state of the test behind those of the rival, its unknowns those of the rival's home but for the ones of its own, which
 * follow in states->bounds. */
static int open_state(struct pool *pool, const struct rival *b, const struct test *test, const struct job_measurement *measured,
                      struct states *states)
{
    const struct state *home = &b->states.state[b->home];
    struct state *state = &states->state[states->nstate - 1];
    int n = b->job.unknowns.nparameter, *own = POOL_ARRAY(pool, int, n);
    double *x = POOL_ARRAY(pool, double, n);
    *state = (struct state){.name = "test", .ncommon = n, .unknown = POOL_ARRAY(pool, int, n)};
    int status = own && x && state->unknown ? test_apply(pool, test, &b->job, b->x, &state->job, x, own) : ROTID_ERROR_MEMORY;
    rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, n);
    if (status || !bounds)
        return status ? status : ROTID_ERROR_MEMORY;
    state->job.measurement = *measured;
    for (int p = 0; p < n; p++) {
        bounds[p] = b->job.unknowns.bounds[p];
        state->unknown[p] = state_unknown(home, p);
        if (!own[p])
            continue;
        bounds[p] = (rotid_parameter){.name = pool_format(pool, "test:%s", bounds[p].name),
                                      .unit = bounds[p].unit,
                                      .lower = x[p] / OWN_RANGE,
                                      .upper = x[p] * OWN_RANGE,
                                      .start = x[p]};
        if (!bounds[p].name)
            return ROTID_ERROR_MEMORY;
        state->unknown[p] = states->nparameter;
        states->bounds[states->nparameter++] = bounds[p];
    }
    state->job.unknowns.bounds = bounds;
    return ROTID_OK;
}

int joint_chi2(struct pool *pool, const struct rival *b, const struct test *test, const struct job_measurement *measured,
               const rotid_environment *environment, double *chi2)
{
    int n = b->states.nparameter, count = b->states.nstate + 1;
    struct states states = {count, POOL_ARRAY(pool, struct state, count), n, POOL_ARRAY(pool, rotid_parameter, 2 * n)};
    struct identification *out = POOL_ARRAY(pool, struct identification, count);
    rotid_fit_result *fit = NULL;
    struct message_list quiet;
    message_open(&quiet, pool);
    if (!states.state || !states.bounds || !out)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s + 1 < count; s++) {
        states.state[s] = b->states.state[s];
        states.state[s].name = states.state[s].name ? states.state[s].name : "measured";
    }
    for (int p = 0; p < n; p++)
        states.bounds[p] = b->states.bounds[p];
    int status = open_state(pool, b, test, measured, &states);
    if (!status)
        status = identify_states(pool, &states, 0, environment, &quiet, out, &fit);
    if (status)
        return status;
    if (fit->status == ROTID_STOP_CANCELLED)
        status = ROTID_STOP_CANCELLED;
    *chi2 = fit->chi2;
    rotid_fit_free(fit);
    return status;
}
