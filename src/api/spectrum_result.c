/* The modes of the model of a deck, for hosts. */
#include <math.h>

#include "api/deck_handle.h"
#include "api/holding.h"
#include "run/spectrum.h"

static int make_result(struct holding *holding, const struct spectrum *s, rotid_spectrum **result)
{
    rotid_spectrum *r = holding ? POOL_NEW(&holding->pool, rotid_spectrum) : NULL;
    if (!r)
        return ROTID_ERROR_MEMORY;
    ptrdiff_t masters = s->nmaster;
    *r = (rotid_spectrum){.nrigid = s->nrigid,
                          .nmode = s->count,
                          .nmaster = s->nmaster,
                          .rigid_hz = {s->nrigid > 0 ? s->rigid_hz[0] : NAN, s->nrigid > 1 ? s->rigid_hz[1] : NAN},
                          .hz = HOLDING_COPY(holding, s->full_hz, s->count),
                          .reduced_hz = HOLDING_COPY(holding, s->reduced_hz, s->count),
                          .reduction_error_percent = HOLDING_COPY(holding, s->reduction_error_percent, s->count),
                          .mesh_error_percent = HOLDING_COPY(holding, s->mesh_error_percent, s->count),
                          .shape = HOLDING_COPY(holding, s->shape, masters * s->count),
                          .master_z = HOLDING_COPY(holding, s->master_z, masters),
                          .master_mass = HOLDING_COPY(holding, s->mass, masters * masters),
                          .memory = holding};
    *result = r;
    return holding->missing ? ROTID_ERROR_MEMORY : ROTID_OK;
}

static int compute(const struct job *job, const double *x, int nmode, struct entry *entry, struct spectrum *spectrum)
{
    struct pool *scratch = &entry->scratch;
    if (nmode < 1)
        return refuse(entry->failure, "nmode is %d, expected 1 or more", nmode);
    int reduction = job->fit.reduction == ROTID_IRS ? ROTID_IRS : ROTID_GUYAN;
    double *at = POOL_ARRAY(scratch, double, job->nparameter);
    if (!at)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < job->nparameter; p++) {
        at[p] = x ? x[p] : job->bounds[p].start;
        if (!isfinite(at[p]))
            return refuse(entry->failure, "x[%d], the value of %s, is %g, expected a number", p, job->bounds[p].name, at[p]);
    }
    return spectrum_compute(scratch, &job->rotor, job->nparameter, job->parameter, at, reduction, nmode, spectrum);
}

int rotid_spectrum_compute(const rotid_deck *deck, const double *x, int nmode, const rotid_environment *environment,
                           char *failure, rotid_spectrum **spectrum)
{
    struct call call;
    struct spectrum found;
    int status = call_open(&call, environment, failure, spectrum, "spectrum");
    if (spectrum)
        *spectrum = NULL;
    const struct job *job = status ? NULL : deck_job(deck, &call);
    if (!status)
        status = job ? compute(job, x, nmode, &call.entry, &found) : ROTID_ERROR_ARGUMENT;
    if (!status) {
        struct holding *holding = holding_new(&call.environment);
        status = make_result(holding, &found, spectrum);
        if (status) {
            holding_free(holding);
            *spectrum = NULL;
        }
    }
    return call_close(&call, status);
}

void rotid_spectrum_free(rotid_spectrum *spectrum)
{
    if (spectrum)
        holding_free(spectrum->memory);
}
