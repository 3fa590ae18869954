#include "diagnose/diagnose.h"

const char *candidate_label(struct pool *pool, const struct candidate *c)
{
    const char *text = c->result.suspect ? pool_text(pool, "%s, a %s", c->effect.name, c->cause->id)
                                         : pool_text(pool, "%s%s%s", c->cause->id, c->target[0] ? " of " : "", c->target);
    return c->state_name ? pool_text(pool, "%s in state %s", text, c->state_name) : text;
}

struct candidate candidate_blank(const struct cause_kind *cause, const char *target)
{
    struct candidate c = {
        .result = {.chi2 = NAN, .chi2_drop = NAN, .chi2_frequency = NAN, .holdout_rms = NAN, .sensor_out_rms = NAN},
        .cause = cause,
        .target = target,
        .state = -1};
    for (int p = 0; p < EFFECT_MOST_PARAMETERS; p++)
        c.std[p] = c.ci_lower[p] = c.ci_upper[p] = NAN;
    return c;
}

int engine_take_states(struct engine *engine, const struct states *states)
{
    int status = states_copy(engine->pool, states, &engine->states);
    if (!status)
        engine_look_at(engine, 0);
    return status;
}

void engine_look_at(struct engine *engine, int s)
{
    engine->job = &engine->states.state[s].job;
    engine->state = engine->states.state[s].name;
}

void engine_take_job(struct engine *engine, const struct job *job)
{
    *engine->job = *job;
    engine->states.nparameter = job->unknowns.nparameter;
    engine->states.bounds = job->unknowns.bounds;
}

const char *rotid_verdict_name(int kind)
{
    static const char *const names[] = {"adequate", "named", "ambiguous", "unexplained"};
    return kind >= ROTID_ADEQUATE && kind <= ROTID_UNEXPLAINED ? names[kind] : "unknown verdict";
}

void engine_step(struct engine *engine, const char *name)
{
    struct diagnosis *out = engine->out;
    double now = clock_seconds();
    int i = 0;
    while (i < out->result.nsteps && strcmp(out->result.steps[i].name, name) != 0)
        i++;
    if (i == out->result.nsteps && out->result.nsteps < MOST_STEPS)
        out->result.steps[out->result.nsteps++] = (rotid_step){name, 0};
    if (i < MOST_STEPS)
        out->result.steps[i].seconds += now - engine->clock;
    engine->clock = now;
}

int engine_stage(const struct engine *engine, const char *stage, int step)
{
    environment_progress(engine->environment, stage, step);
    return environment_cancelled(engine->environment) ? ROTID_STOP_CANCELLED : ROTID_OK;
}
