#include "diagnose/imitate.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "diagnose/base.h"
#include "diagnose/data.h"
#include "diagnose/decide.h"
#include "diagnose/round.h"

#define MOST       3
#define REPLICATES 200 /* of a threshold that names nothing */

int effect_can_stay(const struct effect *effect)
{
    const struct effect_kind *kind = effect->kind;
    return (kind->field || kind->point) && !kind->section && !kind->tierod && !kind->spring && !kind->joint && !kind->at_sensor;
}

/* before: number of effects without the set of the fit */
static int can_stay(const struct refit *refit, int before)
{
    const struct rotor *rotor = &refit->states.state->job.rotor;
    int all = rotor->neffect > before; /* a beam that became a solid has none more */
    for (int e = before; e < rotor->neffect && all; e++)
        all = effect_can_stay(&rotor->effect[e]);
    return all;
}

/* The best fit of the round among those, NULL where none gains what a name has to. */
static struct refit *best_of(const struct engine *engine, struct round_result *result)
{
    struct refit *best = NULL;
    double least = engine->fit->chi2 - LEAST_MARGIN;
    for (int i = 0; i < result->nrefit; i++) {
        struct refit *refit = &result->refit[i];
        if (!refit->fit)
            continue;
        double score = refit->chi2 + PARAMETER_PENALTY * (refit->fit->n - engine->fit->n);
        if (score >= least || !can_stay(refit, engine->job->rotor.neffect))
            continue;
        least = score;
        best = refit;
    }
    return best;
}

/* One effect more, *done: or none. */
static int take_one(struct engine *engine, int *done)
{
    struct diagnosis_round round;
    struct round_result result = {0};
    int status = round_fit(engine, &round, &result);
    struct refit *best = status || round.result.kind == ROTID_ADEQUATE ? NULL : best_of(engine, &result);
    *done = !best;
    if (best) {
        if (engine->fit != engine->out->base.fit)
            rotid_fit_free(engine->fit);
        engine->fit = best->fit;
        best->fit = NULL;
        status = engine_take_states(engine, &best->states);
    }
    round_free(&result);
    return status;
}

int imitate(struct pool *pool, const struct job *job, const struct diagnose_options *options,
            const rotid_environment *environment, struct job *out)
{
    struct state state;
    struct message_list quiet;
    struct job judged = *job;
    judged.models = models_for_run(pool, job->models);
    if (!judged.models)
        return ROTID_ERROR_MEMORY;
    const struct states only = states_of(&judged, &state);
    struct diagnosis scratch = {.result.steps = POOL_ARRAY(pool, rotid_step, MOST_STEPS),
                                .result.numerical_findings = POOL_ARRAY(pool, rotid_numerical_finding, NUMERICAL_FINDINGS)};
    struct engine engine = {.pool = pool,
                            .threads = options->threads > 0 ? options->threads : 1,
                            .replicates = REPLICATES,
                            .seed = options->seed,
                            .environment = environment,
                            .notes = &quiet,
                            .out = &scratch,
                            .clock = clock_seconds()};
    int done = 0, status = scratch.result.steps && scratch.result.numerical_findings ? ROTID_OK : ROTID_ERROR_MEMORY;
    message_open(&quiet, pool);
    if (!status)
        status = data_prepare(&engine, &only);
    if (!status)
        status = base_prepare(&engine);
    for (int i = 0; i < MOST && !status && !done; i++)
        status = take_one(&engine, &done);
    *out = *job;
    if (!status) {
        struct rotor rotor = engine.job->rotor;
        rotor.segment = job->rotor.segment; /* as fine as the whole needs it, which is seen later */
        out->rotor = rotor;
        out->unknowns = engine.job->unknowns;
    }
    models_end_run(pool, judged.models, job->models);
    if (engine.fit != scratch.base.fit)
        rotid_fit_free(engine.fit);
    rotid_fit_free(scratch.base.fit);
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}
