/* The identification of a deck, for hosts. */
#include "api/call.h"
#include "api/deck_handle.h"
#include "api/result_geometry.h"
#include "api/result_identification.h"

static int make_result(struct result_memory *memory, const struct job *job, const struct message_list *notes,
                       struct identification *found, rotid_identification **result)
{
    rotid_identification *made = memory ? result_identification(memory, job, found) : NULL;
    if (!made)
        return ROTID_ERROR_MEMORY;
    made->noise = result_noise(memory, job, made->fit);
    made->geometry = result_geometry(memory, &job->rotor, found->spectrum.model);
    made->nmessage = (int)notes->count;
    made->message = result_messages(memory, notes);
    made->memory = memory;
    if (memory->missing)
        return ROTID_ERROR_MEMORY;
    *result = made;
    return ROTID_OK;
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
    identify_warn_of_mesh(job, &found, &call->notes);
    struct result_memory *memory = result_memory_new(&call->environment);
    status = make_result(memory, job, &call->notes, &found, result);
    if (status)
        result_memory_free(memory);
    rotid_fit_free(found.fit); /* NULL where the result has it */
    return status;
}

int rotid_identify(const rotid_deck *deck, int baseline, const rotid_environment *environment, char *failure,
                   rotid_identification **result)
{
    struct call call;
    int status = call_open(&call, environment, failure, result, "result");
    if (result)
        *result = NULL;
    if (!status)
        status = identify(&call, deck, baseline, result);
    return call_close(&call, status);
}

void rotid_identification_free(rotid_identification *result)
{
    if (result) /* one that belongs to a diagnosis has no memory of its own */
        result_memory_free(result->memory);
}
