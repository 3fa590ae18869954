/* The diagnosis of a deck, for hosts. */
#include "api/api.h"
#include "deck/deck.h"
#include "running/running.h"

/* Measured critical speeds beside the model without and with its causes; none where the machine cannot be computed. */
static int compare_runup(struct call *call, const struct states *deck, const struct states *own, rotid_identification *made)
{
    if (!deck->machine || !deck->machine->nrunup || !made || !made->fit)
        return ROTID_OK;
    int status = runup_explain(&call->entry.scratch, deck, own, made->fit, &call->notes, &made->nrunup, &made->runup);
    if (status)
        made->nrunup = 0;
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
}

static rotid_diagnosis *make_result(struct call *call, const struct states *states, struct diagnosis *d)
{
    struct pool *pool = &call->entry.scratch;
    char *text = NULL;
    struct message_list refusals;
    message_open(&refusals, pool);
    if (d->result.verdict.sentence && d->base.fit && !d->result.before &&
        deck_write_extended(pool, d, &refusals, &text) == ROTID_ERROR_MEMORY)
        return NULL;
    /* the diagnosis stands without a deck; notes with a place are taken for those of reading, which were said before */
    for (size_t i = 0; i < refusals.count && !text; i++)
        message_warn(&call->notes, "%s", refusals.item[i].text);
    rotid_diagnosis *made = result_diagnosis(pool, d->given.nstate ? &d->given : states, d);
    made->extended_deck = text;
    /* what changed between two states is judged in the rotor of the second one, which is not that of the machine */
    if (!d->result.before &&
        (compare_runup(call, states, &d->judged, made->base) || compare_runup(call, states, &d->extended_states, made->extended)))
        return NULL;
    return CALL_KEEP(call, &diagnosis_whole_record, made);
}

/* 0 takes the default. */
static int take_options(const rotid_diagnose_options *given, char *failure, struct diagnose_options *options)
{
    rotid_diagnose_options o = {0};
    int status = given ? sized_take(SIZED_DIAGNOSE_OPTIONS, given, failure, &o) : ROTID_OK;
    if (status)
        return status;
    if (o.threads < 0)
        return refuse(failure, "options->threads is %d, expected 0 or more", o.threads);
    if (!o.before != !o.after)
        return refuse(failure, "options->%s is NULL, expected the name of a state as well as in options->%s",
                      o.before ? "after" : "before", o.before ? "before" : "after");
    *options = (struct diagnose_options){.threads = o.threads ? o.threads : 1, .before = o.before, .after = o.after};
    if (options->threads > PARALLEL_MOST)
        options->threads = PARALLEL_MOST;
    return ROTID_OK;
}

static int diagnose(struct call *call, const rotid_deck *deck, const rotid_diagnose_options *given, rotid_diagnosis **result)
{
    struct diagnose_options options;
    struct diagnosis d;
    const struct states *states = deck_states(deck, call);
    int status = states ? take_options(given, call->entry.failure, &options) : ROTID_ERROR_ARGUMENT;
    if (!status)
        status = states_refuse_types(states, "a diagnosis", &call->notes);
    if (status)
        return status;
    struct state only;
    struct states alone = states_of(&states->state->job, &only);
    alone.machine = states->machine;
    status = diagnose_states(&call->entry.scratch, states->nstate == 1 && !options.before ? &alone : states, &options,
                             &call->environment, &call->notes, &d);
    if (status)
        return status;
    *result = make_result(call, states, &d); /* which takes the three fits over */
    if (*result)
        round_free(d.last);
    else
        diagnose_free(&d);
    return *result ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int rotid_diagnose(const rotid_deck *deck, const rotid_diagnose_options *options, const rotid_environment *environment,
                   char *failure, rotid_diagnosis **result)
{
    struct call call;
    int status = call_open(&call, environment, failure, result, "result");
    if (!status)
        status = diagnose(&call, deck, options, result);
    return call_close(&call, status);
}

void rotid_diagnosis_free(rotid_diagnosis *result)
{
    if (!result)
        return;
    const rotid_identification *fits[] = {result->today, result->base, result->extended};
    for (size_t i = 0; i < sizeof fits / sizeof *fits; i++)
        if (fits[i])
            rotid_fit_free((rotid_fit_result *)fits[i]->fit);
    pool_free(result->memory);
}
