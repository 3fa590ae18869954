#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "diagnose/base.h"
#include "diagnose/changed.h"
#include "diagnose/data.h"
#include "diagnose/detectable.h"
#include "diagnose/finalise.h"
#include "diagnose/round.h"
#include "diagnose/settle_states.h"
#include "diagnose/verdict.h"

#define REPLICATES 1000

static int run_rounds(struct engine *engine, struct round_result *last)
{
    struct diagnosis *out = engine->out;
    out->round = POOL_ARRAY(engine->pool, struct diagnosis_round, DIAGNOSE_MOST_CAUSES + 1);
    out->cause = POOL_ARRAY(engine->pool, struct candidate, DIAGNOSE_MOST_CAUSES + 1);
    if (!out->round || !out->cause)
        return ROTID_ERROR_MEMORY;
    for (;;) {
        struct diagnosis_round *round = &out->round[out->nround];
        round_free(last);
        int status = round_run(engine, round, last);
        if (status)
            return status;
        round->result.round = ++out->nround;
        for (int i = 0; i < round->ncandidate; i++)
            round->candidate[i].result.round = out->nround;
        if (out->nround == 1)
            status = localise(engine, &last->scan);
        if (status || round->result.kind != ROTID_NAMED || out->ncause >= DIAGNOSE_MOST_CAUSES)
            return status;
        status = accept_cause(engine, round, last);
        if (status)
            return status;
    }
}

/* What the user does today; should that fail, there is still the judged model. */
static int fit_today(struct engine *engine, const struct states *states)
{
    struct diagnosis *out = engine->out;
    struct message_list quiet;
    message_open(&quiet, engine->pool);
    int today = base_identify(engine, states, &quiet, &out->state_today, &out->today);
    int ends = today == ROTID_ERROR_MEMORY || (!today && out->today.fit->status == ROTID_STOP_CANCELLED);
    return !ends ? ROTID_OK : today ? today : ROTID_STOP_CANCELLED;
}

static int run(struct engine *engine, const struct states *states, struct round_result *last)
{
    int status = data_prepare(engine, states);
    engine_step(engine, "data");
    if (!status)
        status = engine_stage(engine, "fit as the deck states it", 1);
    if (!status && states->nparameter)
        status = fit_today(engine, states);
    engine_step(engine, "fit of today");
    if (!status && states->nstate > 1)
        status = settle_states(engine);
    if (!status)
        status = base_prepare(engine);
    if (!status)
        status = base_note_reduction(engine);
    if (!status)
        status = base_residuals(engine);
    engine_step(engine, "base");
    if (!status)
        status = run_rounds(engine, last);
    if (!status)
        status = reach_verdict(engine, last);
    return status ? status : finalise(engine, last);
}

/* The same with models for the run. */
static int run_with_models(struct engine *engine, const struct states *given, struct round_result *last)
{
    struct states states;
    int begun = 0, status = states_copy(engine->pool, given, &states);
    for (; begun < given->nstate && !status; begun++) {
        struct job *job = &states.state[begun].job;
        job->models = models_for_run(engine->pool, job->models);
        status = job->models ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    if (!status)
        status = run(engine, &states, last);
    for (int s = 0; s < begun; s++)
        if (states.state[s].job.models)
            models_end_run(engine->pool, states.state[s].job.models, given->state[s].job.models);
    return status;
}

/* Before a verdict. */
static const rotid_diagnosis nothing = {
    .verdict = {.kind = -1, .p_value = NAN},
    .gain =
        {{NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}, {NAN, NAN}},
    .noise = {.frequency = NAN, .shape = NAN}};

static int diagnose(struct pool *pool, const struct states *states, const struct diagnose_options *options,
                    const rotid_environment *environment, struct message_list *notes, struct diagnosis *out)
{
    struct engine engine = {.pool = pool,
                            .threads = options->threads > 0 ? options->threads : 1,
                            .replicates = options->replicates > 0 ? options->replicates : REPLICATES,
                            .seed = options->seed,
                            .environment = environment,
                            .notes = notes,
                            .before = options->before,
                            .after = options->after,
                            .out = out,
                            .mode_out_rms = NAN,
                            .mode_out_shape = NAN,
                            .clock = clock_seconds()};
    struct round_result last = {0};
    engine.user_reduction = states->state->job.options.fit.reduction;
    *out = (struct diagnosis){.result = nothing};
    out->result.before = options->before;
    out->result.after = options->after;
    out->result.steps = POOL_ARRAY(pool, rotid_step, MOST_STEPS);
    out->result.numerical_findings = POOL_ARRAY(pool, rotid_numerical_finding, NUMERICAL_FINDINGS * states->nstate);
    if (!out->result.steps || !out->result.numerical_findings)
        return ROTID_ERROR_MEMORY;
    int status = states_copy(pool, states, &out->given);
    if (!status)
        status = run_with_models(&engine, states, &last);
    round_free(&last);
    if (engine.fit != out->base.fit)
        rotid_fit_free(engine.fit);
    if (out->judged.nstate)
        out->job = out->judged.state->job;
    if (out->extended_states.nstate)
        out->extended_job = out->extended_states.state->job;
    if (status == ROTID_STOP_CANCELLED) {
        out->result.interrupted = 1;
        out->result.verdict.kind = nothing.verdict.kind;
        out->result.verdict.p_value = nothing.verdict.p_value;
        out->result.gain = nothing.gain;
        return ROTID_OK;
    }
    if (status)
        diagnose_free(out);
    return status;
}

int diagnose_states(struct pool *pool, const struct states *states, const struct diagnose_options *options,
                    const rotid_environment *environment, struct message_list *notes, struct diagnosis *out)
{
    struct job job;
    struct state state;
    if (!options->before)
        return diagnose(pool, states, options, environment, notes, out);
    *out = (struct diagnosis){.result = nothing};
    int status = changed_job(pool, states, options->before, options->after, options, environment, notes, &job);
    if (status == ROTID_STOP_CANCELLED) {
        out->result.interrupted = 1;
        return ROTID_OK;
    }
    const struct states only = states_of(&job, &state);
    return status ? status : diagnose(pool, &only, options, environment, notes, out);
}

int diagnose_run(struct pool *pool, const struct job *job, const struct diagnose_options *options,
                 const rotid_environment *environment, struct message_list *notes, struct diagnosis *out)
{
    struct state state;
    const struct states states = states_of(job, &state);
    return diagnose_states(pool, &states, options, environment, notes, out);
}

void diagnose_free(struct diagnosis *out)
{
    rotid_fit_free(out->today.fit);
    rotid_fit_free(out->base.fit);
    rotid_fit_free(out->extended.fit);
    out->today.fit = out->base.fit = out->extended.fit = NULL;
}
