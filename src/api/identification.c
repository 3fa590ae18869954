#include "api/identification.h"

#include <math.h>

#include "api/call.h"
#include "api/deck_handle.h"

/* Of the partner of each measured mode; the spectrum may end below it. */
static const double *of_partners(struct holding *holding, const struct identification *found, int nmode, const double *percent)
{
    double *copy = POOL_ARRAY(&holding->pool, double, nmode);
    holding->missing |= !copy;
    for (int k = 0; copy && k < nmode; k++) {
        int mode = found->compared.number[k] - 1;
        copy[k] = mode < found->spectrum.count ? percent[mode] : NAN;
    }
    return copy;
}

rotid_identification *identification_new(struct holding *holding, int number, const struct job *job, struct identification *found)
{
    rotid_identification *r = POOL_NEW(&holding->pool, rotid_identification);
    holding->fit[number] = found->fit;
    found->fit = NULL;
    holding->missing |= !r;
    if (!r)
        return NULL;
    *r = (rotid_identification){.fit = holding->fit[number],
                                .nparameter = job->nparameter,
                                .parameter = holding_parameters(holding, job->nparameter, job->bounds),
                                .nmode = job->nmode,
                                .number = HOLDING_COPY(holding, found->compared.number, job->nmode),
                                .measured_hz = HOLDING_COPY(holding, job->frequency_hz, job->nmode),
                                .nco = HOLDING_COPY(holding, found->compared.nco, job->nmode),
                                .reduction_error_percent =
                                    of_partners(holding, found, job->nmode, found->spectrum.reduction_error_percent),
                                .mesh_error_percent = of_partners(holding, found, job->nmode, found->spectrum.mesh_error_percent),
                                .mass = found->mass.mass,
                                .centre = found->mass.center};
    return r;
}

static int make_result(struct holding *holding, const struct job *job, const struct message_list *notes,
                       struct identification *found, rotid_identification **result)
{
    rotid_identification *made = holding ? identification_new(holding, 0, job, found) : NULL;
    if (!made)
        return ROTID_ERROR_MEMORY;
    made->nmessage = (int)notes->count;
    made->message = holding_messages(holding, notes);
    made->memory = holding;
    if (holding->missing)
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
    struct holding *holding = holding_new(&call->environment);
    status = make_result(holding, job, &call->notes, &found, result);
    if (status)
        holding_free(holding);
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
        holding_free(result->memory);
}
