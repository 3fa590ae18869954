#include "diagnose/settle_states.h"

#include <string.h>

#include "diagnose/base.h"
#include "diagnose/data.h"
#include "diagnose/round.h"

/* The findings about a state behind those of the states before it. */
static int take_findings(struct engine *engine, const rotid_diagnosis *found)
{
    rotid_diagnosis *out = &engine->out->result;
    for (int i = 0; i < found->ndata_findings; i++) {
        int status = data_add_finding(engine, &found->data_findings[i]);
        if (status)
            return status;
    }
    for (int i = 0; i < found->nnumerical_findings; i++) {
        rotid_numerical_finding *finding = &out->numerical_findings[out->nnumerical_findings++];
        *finding = found->numerical_findings[i];
        finding->state = engine->state;
    }
    return ROTID_OK;
}

/* The state that the engine looks at, by an engine of its own. */
static int settle(struct engine *engine)
{
    struct diagnosis *out = engine->out, alone = {.result.steps = out->result.steps, .result.nsteps = out->result.nsteps};
    struct engine own = *engine;
    struct message_list quiet;
    struct state state;
    const struct states only = states_of(engine->job, &state);
    message_open(&quiet, engine->pool);
    own.out = &alone;
    own.notes = &quiet;
    own.nown = only.nparameter;
    own.nprepared = own.coloured = 0;
    own.fit = NULL;
    own.deck_start = POOL_ARRAY(engine->pool, double, only.nparameter);
    alone.result.numerical_findings = POOL_ARRAY(engine->pool, rotid_numerical_finding, NUMERICAL_FINDINGS);
    if (!own.deck_start || !alone.result.numerical_findings)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < only.nparameter; p++)
        own.deck_start[p] = only.bounds[p].start;
    int status = engine_take_states(&own, &only);
    if (!status)
        status = base_prepare(&own);
    if (!status)
        status = round_settle(&own);
    if (own.fit != alone.base.fit)
        rotid_fit_free(own.fit);
    rotid_fit_free(alone.base.fit);
    out->result.nsteps = alone.result.nsteps;
    engine->clock = own.clock;
    if (status)
        return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
    engine->job->rotor = own.job->rotor;
    engine->job->measurement = own.job->measurement;
    engine->coloured |= own.coloured;
    return take_findings(engine, &alone.result);
}

int settle_states(struct engine *engine)
{
    int status = ROTID_OK;
    for (int s = 0; s < engine->states.nstate && !status; s++) {
        engine_look_at(engine, s);
        status = settle(engine);
    }
    engine_look_at(engine, 0);
    return status;
}
