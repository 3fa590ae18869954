/* What a deck says, for hosts. */
#include "api/deck_handle.h"
#include "api/result_geometry.h"
#include "run/spectrum.h"

static int make_result(struct result_memory *memory, const struct job *job, const struct spectrum *s, rotid_check **result)
{
    struct mass_properties mass;
    rotid_check *r = memory ? RESULT_NEW(memory, rotid_check) : NULL;
    if (!r)
        return ROTID_ERROR_MEMORY;
    model_mass_properties(s->model, &mass);
    *r = (rotid_check){.length_m = rotor_length(&job->rotor),
                       .mass_kg = mass.mass,
                       .center_of_mass_m = mass.center,
                       .inertia_kg_m2 = mass.inertia,
                       .nodes = s->nnode,
                       .elements = s->nnode - 1,
                       .rigid_modes = s->nrigid,
                       .nrigid_hz = s->nrigid,
                       .rigid_hz = RESULT_COPY(memory, s->rigid_hz, s->nrigid),
                       .measured_modes = job->measurement.nmode,
                       .functional = functional_words[job->options.fit.functional],
                       .reduction = reduction_words[job->options.fit.reduction],
                       .geometry = result_geometry(memory, &job->rotor, s->model),
                       .memory = memory};
    r->nsensors = RESULT_LIST(memory, r->sensors, job->rotor.nsensor);
    for (int i = 0; i < r->nsensors; i++)
        r->sensors[i] = (rotid_sensor){job->rotor.sensor[i].id, job->rotor.sensor[i].position};
    r->nparameters = RESULT_LIST(memory, r->parameters, job->unknowns.nparameter);
    for (int p = 0; p < r->nparameters; p++)
        r->parameters[p] = result_text(memory, job->unknowns.bounds[p].name);
    *result = r;
    return memory->missing ? ROTID_ERROR_MEMORY : ROTID_OK;
}

int rotid_deck_check(const rotid_deck *deck, const rotid_environment *environment, char *failure, rotid_check **check)
{
    struct call call;
    struct spectrum found;
    int status = call_open(&call, environment, failure, check, "check");
    if (check)
        *check = NULL;
    const struct job *job = status ? NULL : deck_job(deck, &call);
    if (!status)
        status = job ? spectrum_compute(&call.entry.scratch, job->models, &job->rotor, 0, NULL, NULL, ROTID_GUYAN, 1, &found)
                     : ROTID_ERROR_ARGUMENT;
    if (!status) {
        struct result_memory *memory = result_memory_new(&call.environment);
        status = make_result(memory, job, &found, check);
        if (status) {
            result_memory_free(memory);
            *check = NULL;
        }
    }
    return call_close(&call, status);
}

void rotid_check_free(rotid_check *check)
{
    if (check)
        result_memory_free(check->memory);
}
