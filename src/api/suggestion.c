/* What to measure next, for hosts. */
#include <limits.h>

#include "api/api.h"
#include "deck/deck.h"
#include "running/running.h"

#define USUAL_NOISE 0.003 /* of a frequency of a hammer test */

static int take_options(const rotid_suggest_options *given, char *failure, rotid_suggest_options *o)
{
    *o = (rotid_suggest_options){.size = sizeof *o};
    int status = given ? sized_take(SIZED_SUGGEST_OPTIONS, given, failure, o) : ROTID_OK;
    if (status)
        return status;
    const struct {
        const char *name;
        double value, most; /* as of the options of the program */
    } number[] = {{"wanted_percent", o->wanted_percent, 1e12},
                  {"frequency_noise", o->frequency_noise, 1e12},
                  {"shape_noise", o->shape_noise, 1e12},
                  {"set_up_cost", o->set_up_cost, 1e12},
                  {"sensors", o->sensors, 1000},
                  {"modes", o->modes, 100},
                  {"threads", o->threads, INT_MAX},
                  {"seed", (double)o->seed, 1e12},
                  {"speed", o->speed, 100}};
    for (size_t i = 0; i < sizeof number / sizeof *number; i++)
        if (!(number[i].value >= 0 && number[i].value <= number[i].most))
            return refuse(failure, "options->%s is %.15g, expected 0 ... %g", number[i].name, number[i].value, number[i].most);
    if (o->modes == 1)
        return refuse(failure, "options->modes is 1, expected 2 ... 100");
    if (o->threads > PARALLEL_MOST)
        o->threads = PARALLEL_MOST;
    return ROTID_OK;
}

static rotid_suggestion *make_result(struct call *call, struct suggestion *s)
{
    struct pool *pool = &call->entry.scratch;
    rotid_suggestion *made = &s->result;
    made->speed_rpm = made->speed_std = made->speed_identified = NAN;
    made->geometry = result_geometry(pool, &s->job.rotor, s->spectrum.model);
    for (int i = 0; i < made->nrivals; i++) {
        const struct rival *rival = &s->rivals.rival[i];
        made->rivals[i].ncauses = result_causes(pool, rival->ncause, rival->cause, &made->rivals[i].causes);
    }
    for (int i = 0; i < made->ntests; i++) {
        char *cards = NULL;
        if (deck_write_test(pool, &s->rivals.rival[s->rivals.n - 1].job, &s->test[i], &cards) == ROTID_ERROR_MEMORY)
            return NULL;
        made->tests[i].cards = cards;
    }
    return CALL_KEEP(call, &suggestion_record, made);
}

/* Noise of the frequencies of a test: as stated, else that of the deck, else what its residuals show, else a usual one. */
static double noise_of(const struct job *job, const rotid_noise *noise, const rotid_fit_result *fit, double given, int *assumed)
{
    *assumed = 0;
    if (given > 0)
        return given;
    if (isfinite(noise->frequency))
        return noise->frequency * (fit ? fit->widened_by : 1);
    double square = 0;
    for (int k = 0; fit && k < fit->m; k++)
        square += pow(fit->predicted_hz[k] / job->measurement.frequency_hz[k] - 1, 2);
    *assumed = !fit || !(square > 0) || fit->dof < 1;
    return *assumed ? USUAL_NOISE : sqrt(square / fit->dof);
}

/* Which tests at rest narrow a critical speed: in place of sensors and rivals. */
static int suggest_for_speed(struct call *call, const struct states *states, const rotid_suggest_options *o,
                             rotid_fit_result **fit, rotid_suggestion **result)
{
    struct pool *pool = &call->entry.scratch;
    const struct job *job = &states->state[0].job;
    rotid_fit_result own;
    int status = machine_refuse(states, &call->notes), assumed;
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    if (!status)
        status = machine_fit_all(call, states, fit);
    if (!status)
        status = machine_fit(pool, states, *fit, &own);
    int failed;
    if (!status)
        status = model ? model_open(pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, 1, model,
                                    &failed)
                       : ROTID_ERROR_MEMORY;
    if (status)
        return status;
    discrete_set(&model->discrete, own.x);
    const rotid_fit_result none = {.variance_from_residuals = 1};
    rotid_noise *noise = result_noise(pool, job, *fit ? *fit : &none);
    rotid_suggestion made = {.wanted_percent = o->wanted_percent > 0 ? o->wanted_percent : 2,
                             .modes_needed = ROTID_NONE,
                             .sensors_needed = ROTID_NONE,
                             .plan_modes = job->measurement.nmode ? job->measurement.nmode : 1,
                             .among = NAN,
                             .geometry = result_geometry(pool, &job->rotor, model)};
    if (!noise || !made.geometry)
        return ROTID_ERROR_MEMORY;
    made.noise = *noise;
    made.noise.frequency = noise_of(job, noise, *fit, o->frequency_noise, &assumed);
    made.noise.frequency_assumed = assumed;
    const struct worth_options options = {o->speed, o->speed_backward != 0, made.noise.frequency};
    status = worth_run(pool, states->machine, job, own.x, *fit ? &own : NULL, &options, &call->notes, &made);
    if (status)
        return status;
    *result = CALL_KEEP(call, &suggestion_record, &made);
    return *result ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int suggest(struct call *call, const rotid_deck *deck, const rotid_suggest_options *given, rotid_suggestion **result)
{
    rotid_suggest_options options;
    const struct states *states = deck_states(deck, call);
    struct suggestion *s = POOL_NEW(&call->entry.scratch, struct suggestion);
    int status = states ? take_options(given, call->entry.failure, &options) : ROTID_ERROR_ARGUMENT;
    if (!status)
        status = states_refuse_types(states, "a suggestion", &call->notes);
    if (status || !s)
        return status ? status : ROTID_ERROR_MEMORY;
    if (options.speed) {
        rotid_fit_result *fit = NULL;
        status = suggest_for_speed(call, states, &options, &fit, result);
        rotid_fit_free(fit);
        return status;
    }
    status = suggest_states(&call->entry.scratch, states, &options, &call->environment, &call->notes, s);
    if (!status)
        *result = make_result(call, s);
    suggest_free(s);
    return status ? status : *result ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int rotid_suggest(const rotid_deck *deck, const rotid_suggest_options *options, const rotid_environment *environment,
                  char *failure, rotid_suggestion **result)
{
    struct call call;
    int status = call_open(&call, environment, failure, result, "result");
    if (!status)
        status = suggest(&call, deck, options, result);
    return call_close(&call, status);
}

void rotid_suggestion_free(rotid_suggestion *result)
{
    pool_free(result ? result->memory : NULL);
}
