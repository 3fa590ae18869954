/* The identification of a deck, for hosts. */
#include "api/api.h"
#include "running/running.h"

/* Possible bias of the parameters, where the fit is one that a diagnosis makes too. Without it there is still a result, but where
 * memory is out. */
static int find_hidden(struct call *call, const struct states *states, const struct identification *found,
                       const rotid_fit_result *fit, rotid_identification *out)
{
    struct pool *pool = &call->entry.scratch;
    int *number = POOL_ARRAY(pool, int, states_modes(states, states->nstate)), usable = fit->n && fit->converged;
    if (!number || !out)
        return ROTID_ERROR_MEMORY;
    for (int s = 0, at = 0; s < states->nstate && usable; s++) {
        const struct job *job = &states->state[s].job;
        usable = job->options.fit.functional == ROTID_LIKELIHOOD && job->options.fit.reduction == ROTID_REDUCTION_NONE &&
                 job_knows_frequency_noise(job);
        for (int k = 0; k < job->measurement.nmode && usable; k++)
            number[at++] = found[s].compared.number[k];
    }
    int status = usable ? hidden_of_fit(pool, states, found, number, fit, &out->nhidden, &out->hidden) : ROTID_OK;
    if (status)
        out->nhidden = 0;
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
}

/* The measured critical speeds of the machine beside those at the fitted values. */
static int compare_runup(struct call *call, const struct states *states, const rotid_fit_result *fit, rotid_identification *made)
{
    struct pool *pool = &call->entry.scratch;
    rotid_fit_result own;
    if (!states->machine || !states->machine->nrunup || !made)
        return ROTID_OK;
    int status = machine_fit(pool, states, fit, &own);
    return status ? status
                  : runup_compare(pool, states->machine, &states->state[0].job, own.x, &own, &call->notes, &made->nrunup,
                                  &made->runup);
}

/* given: as the deck has them; states: with the run-up of the machine where it is fitted */
static int identify(struct call *call, const struct states *given, const struct states *states, int baseline,
                    rotid_identification **result)
{
    struct pool *pool = &call->entry.scratch;
    struct identification *found = POOL_ARRAY(pool, struct identification, states->nstate);
    rotid_fit_result *fit = NULL;
    int one = states->nstate == 1, status = ROTID_ERROR_MEMORY;
    if (found && one && !states->more) {
        status =
            identify_run(pool, &states->state[0].job, baseline ? IDENTIFY_BASELINE : 0, &call->environment, &call->notes, found);
        fit = found->fit;
    } else if (found) {
        status = identify_states(pool, states, baseline ? IDENTIFY_BASELINE : 0, &call->environment, &call->notes, found, &fit);
    }
    if (status)
        return status;
    for (int s = 0; s < states->nstate; s++)
        comparison_warn_of_mesh(&states->state[s].job, &found[s].spectrum, &found[s].compared, &call->notes);
    status = numbering_warn(pool, states, found, fit, &call->environment, &call->notes);
    if (!status)
        status = exchange_warn(pool, states, found, fit, &call->environment, &call->notes);
    if (status && status != ROTID_STOP_CANCELLED) {
        rotid_fit_free(fit);
        return status;
    }
    if (one) /* a state with a name sees but its share of the fit */
        found->fit = fit;
    rotid_identification *made = result_identification(pool, states, found, fit);
    status = compare_runup(call, given, fit, made);
    if (!status && baseline && !states->more) /* the scan behind it knows modes alone */
        status = find_hidden(call, states, found, fit, made);
    if (!status && made)
        *result = CALL_KEEP(call, &identification_whole_record, made);
    if (*result)
        return ROTID_OK;
    rotid_fit_free(fit);
    return status ? status : ROTID_ERROR_MEMORY;
}

static int identify_deck(struct call *call, const rotid_deck *deck, int baseline, rotid_identification **result)
{
    const struct states *states = deck_states(deck, call);
    struct states joined;
    struct runup *runup = NULL;
    int status = states ? runup_join(&call->entry.scratch, states, &call->notes, &joined, &runup) : ROTID_ERROR_ARGUMENT;
    if (!status)
        status = identify(call, states, &joined, baseline, result);
    int lost = runup_close(runup);
    if (lost) {
        rotid_identification_free(*result);
        *result = NULL;
    }
    return lost ? lost : status;
}

int rotid_identify(const rotid_deck *deck, int baseline, const rotid_environment *environment, char *failure,
                   rotid_identification **result)
{
    struct call call;
    int status = call_open(&call, environment, failure, result, "result");
    if (!status)
        status = identify_deck(&call, deck, baseline, result);
    return call_close(&call, status);
}

void rotid_identification_free(rotid_identification *result)
{
    if (!result || !result->memory) /* one that belongs to a diagnosis */
        return;
    rotid_fit_free((rotid_fit_result *)result->fit);
    pool_free(result->memory);
}
