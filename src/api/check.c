/* What a deck says, for hosts. */
#include "api/api.h"

static rotid_check *make_result(struct call *call, const struct job *job, const struct spectrum *s)
{
    struct pool *pool = &call->entry.scratch;
    struct mass_properties mass;
    model_mass_properties(s->model, &mass);
    rotid_check r = {.length_m = rotor_length(&job->rotor),
                     .mass_kg = mass.mass,
                     .center_of_mass_m = mass.center,
                     .inertia_kg_m2 = mass.inertia,
                     .nodes = s->nnode,
                     .elements = s->nnode - 1,
                     .solid = meridian_size(pool, s->model),
                     .rigid_modes = s->nrigid,
                     .nrigid_hz = s->nrigid,
                     .rigid_hz = s->rigid_hz,
                     .measured_modes = job->measurement.nmode,
                     .functional = functional_words[job->options.fit.functional],
                     .reduction = reduction_words[job->options.fit.reduction],
                     .geometry = result_geometry(pool, &job->rotor, s->model)};
    if (!(r.weighed = result_weighed(pool, job, NULL, &mass, &r.nweighed)))
        return NULL;
    meridian_count(s->model, &r.nodes, &r.elements);
    r.nsensors = r.geometry ? r.geometry->nsensors : 0;
    r.sensors = r.geometry ? r.geometry->sensors : NULL;
    r.nparameters = POOL_LIST(pool, r.parameters, job->unknowns.nparameter);
    for (int p = 0; p < r.nparameters; p++)
        r.parameters[p] = job->unknowns.bounds[p].name;
    return call_keep(call, &check_record, &r, &r.memory);
}

int rotid_deck_check(const rotid_deck *deck, const rotid_environment *environment, char *failure, rotid_check **check)
{
    struct call call;
    struct spectrum found;
    int status = call_open(&call, environment, failure, check, "check");
    const struct job *job = status ? NULL : deck_job(deck, &call);
    if (!status)
        status = job ? spectrum_compute(&call.entry.scratch, job->models, &job->rotor, 0, NULL, NULL, ROTID_GUYAN, 1, &found)
                     : ROTID_ERROR_ARGUMENT;
    if (!status)
        status = (*check = make_result(&call, job, &found)) ? ROTID_OK : ROTID_ERROR_MEMORY;
    return call_close(&call, status);
}

void rotid_check_free(rotid_check *check)
{
    if (check)
        pool_free(check->memory);
}
