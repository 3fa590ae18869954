/* The identification of a deck, for hosts. */
#include "api/deck_handle.h"
#include "api/keep.h"
#include "api/result_geometry.h"
#include "api/result_identification.h"

static rotid_identification *make_result(struct call *call, const struct job *job, const struct identification *found)
{
    struct pool *pool = &call->entry.scratch;
    rotid_identification *made = result_identification(pool, job, found);
    if (!made)
        return NULL;
    made->noise = result_noise(pool, job, found->fit);
    made->geometry = result_geometry(pool, &job->rotor, found->spectrum.model);
    made->nmessage = (int)call->notes.count;
    made->message = call->notes.item;
    return call_keep(call, &identification_whole_record, made, &made->memory);
}

static int identify(struct call *call, const rotid_deck *deck, int baseline, rotid_identification **result)
{
    struct identification found = {0};
    const struct job *job = deck_job(deck, call);
    if (!job)
        return ROTID_ERROR_ARGUMENT;
    int status = identify_run(&call->entry.scratch, job, baseline, &call->environment, &call->notes, &found);
    if (status)
        return status;
    comparison_warn_of_mesh(job, &found.spectrum, &found.compared, &call->notes);
    *result = make_result(call, job, &found);
    if (*result)
        return ROTID_OK;
    rotid_fit_free(found.fit);
    return ROTID_ERROR_MEMORY;
}

int rotid_identify(const rotid_deck *deck, int baseline, const rotid_environment *environment, char *failure,
                   rotid_identification **result)
{
    struct call call;
    int status = call_open(&call, environment, failure, result, "result");
    if (!result)
        return call_close(&call, status);
    *result = NULL;
    if (!status)
        status = identify(&call, deck, baseline, result);
    return call_close(&call, status);
}

void rotid_identification_free(rotid_identification *result)
{
    if (!result || !result->memory) /* one that belongs to a diagnosis */
        return;
    rotid_fit_free((rotid_fit_result *)result->fit);
    pool_free(result->memory);
}
