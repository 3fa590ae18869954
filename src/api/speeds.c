/* The machine in operation, for hosts. */
#include "api/api.h"
#include "running/running.h"

static int take_options(const rotid_speeds_options *given, char *failure, struct speeds_options *to, int *no_fit)
{
    rotid_speeds_options o = {.size = sizeof o};
    int status = given ? sized_take(SIZED_SPEEDS_OPTIONS, given, failure, &o) : ROTID_OK;
    if (status)
        return status;
    const struct {
        const char *name;
        double value, least, most; /* as of the options of the program */
    } number[] = {{"from_rpm", o.from_rpm, 0, 1e7}, {"to_rpm", o.to_rpm, 0, 1e7},  {"harmonic", o.harmonic, 0, 100},
                  {"count", o.count, 0, 10000},     {"draws", o.draws, -1e6, 1e6}, {"threads", o.threads, 0, 2147483647.0},
                  {"seed", (double)o.seed, 0, 1e12}};
    for (size_t i = 0; i < sizeof number / sizeof *number; i++)
        if (!(number[i].value >= number[i].least && number[i].value <= number[i].most))
            return refuse(failure, "options->%s is %.15g, expected %g ... %g", number[i].name, number[i].value, number[i].least,
                          number[i].most);
    if (o.to_rpm > 0 && !(o.from_rpm < o.to_rpm))
        return refuse(failure, "options->from_rpm is %.15g and to_rpm %.15g, expected the lower one first", o.from_rpm, o.to_rpm);
    if (o.from_rpm > 0 && !(o.to_rpm > 0))
        return refuse(failure, "options->from_rpm is %.15g without to_rpm, expected both", o.from_rpm);
    if (o.count == 1)
        return refuse(failure, "options->count is 1, expected 2 ... 10000");
    *no_fit = o.no_fit;
    *to = (struct speeds_options){.from = o.from_rpm * RPM,
                                  .to = o.to_rpm * RPM,
                                  .count = o.count ? o.count : SPEEDS_COUNT,
                                  .harmonic = o.harmonic > 0 ? o.harmonic : 1,
                                  .draws = o.draws > 0   ? o.draws
                                           : o.draws < 0 ? 0
                                                         : SPEEDS_DRAWS,
                                  .seed = (unsigned long)(o.seed ? o.seed : 1),
                                  .threads = o.threads < 1               ? 1
                                             : o.threads > PARALLEL_MOST ? PARALLEL_MOST
                                                                         : o.threads};
    return ROTID_OK;
}

int machine_refuse(const struct states *states, struct message_list *notes)
{
    if (states->machine)
        return ROTID_OK;
    return message_refuse(notes, ROTID_ERROR_ARGUMENT, states->state[0].job.deck, 1, 1,
                          "the deck has no *RUNNING, expected the machine in operation behind it, with its *BEARING cards");
}

int machine_fit_all(struct call *call, const struct states *states, rotid_fit_result **fit)
{
    struct pool *pool = &call->entry.scratch;
    struct identification *found = POOL_ARRAY(pool, struct identification, states->nstate);
    if (!states->nparameter && !states->machine->nunknown)
        return ROTID_OK;
    if (!states_modes(states, states->nstate)) {
        message_warn(&call->notes,
                     "no mode was measured: the model is taken as the deck states it, not at identified parameters");
        return ROTID_OK;
    }
    return found ? runup_identify(pool, states, &call->environment, &call->notes, found, fit) : ROTID_ERROR_MEMORY;
}

static int compute(struct call *call, const struct states *states, const rotid_fit_result *fit,
                   const struct speeds_options *options, rotid_speeds **result)
{
    struct pool *pool = &call->entry.scratch;
    const struct machine *machine = states->machine;
    const struct job *job = &states->state[0].job;
    rotid_speeds made = {.low_rpm = NAN};
    rotid_fit_result own;
    int status = machine_fit(pool, states, fit, &own);
    if (!status)
        status = speeds_run(pool, machine, job, own.x, fit ? &own : NULL, options, &call->environment, &call->notes, &made);
    if (status < 0)
        return status;
    *result = CALL_KEEP(call, &speeds_record, &made);
    return *result ? status : ROTID_ERROR_MEMORY;
}

static int speeds(struct call *call, const rotid_deck *deck, const rotid_speeds_options *given, rotid_speeds **result)
{
    const struct states *states = deck_states(deck, call);
    struct speeds_options options;
    rotid_fit_result *fit = NULL;
    int no_fit, status = states ? take_options(given, call->entry.failure, &options, &no_fit) : ROTID_ERROR_ARGUMENT;
    if (!status)
        status = machine_refuse(states, &call->notes);
    if (!status && !no_fit)
        status = machine_fit_all(call, states, &fit);
    if (!status)
        status = compute(call, states, fit, &options, result);
    rotid_fit_free(fit);
    return status;
}

int rotid_speeds_compute(const rotid_deck *deck, const rotid_speeds_options *options, const rotid_environment *environment,
                         char *failure, rotid_speeds **result)
{
    struct call call;
    int status = call_open(&call, environment, failure, result, "result");
    if (!status)
        status = speeds(&call, deck, options, result);
    return call_close(&call, status);
}

void rotid_speeds_free(rotid_speeds *result)
{
    pool_free(result ? result->memory : NULL);
}
