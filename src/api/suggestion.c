/* What to measure next, for hosts. */
#include <limits.h>

#include "api/api.h"
#include "base/base.h"
#include "deck/deck.h"

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
                  {"replicates", o->replicates, 1e6},
                  {"seed", (double)o->seed, 1e12}};
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
    made->geometry = result_geometry(pool, &s->job.rotor, s->spectrum.model);
    for (int i = 0; i < made->nrivals; i++) {
        const struct rival *rival = &s->rivals.rival[i];
        made->rivals[i].ncauses = POOL_LIST(pool, made->rivals[i].causes, rival->ncause);
        for (int c = 0; c < made->rivals[i].ncauses; c++)
            made->rivals[i].causes[c] = result_cause(pool, &rival->cause[c]);
    }
    for (int i = 0; i < made->ntests; i++) {
        char *cards = NULL;
        (void)deck_write_test(pool, &s->rivals.rival[s->rivals.n - 1].job, &s->test[i], &cards);
        made->tests[i].cards = cards;
    }
    made->nmessage = (int)call->notes.count;
    made->message = call->notes.item;
    return call_keep(call, &suggestion_whole_record, made, &made->memory);
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
    if (!result)
        return call_close(&call, status);
    *result = NULL;
    if (!status)
        status = suggest(&call, deck, options, result);
    return call_close(&call, status);
}

void rotid_suggestion_free(rotid_suggestion *result)
{
    if (result)
        pool_free(result->memory);
}
