/* The modes of the model of a deck, for hosts. */
#include <limits.h>

#include "api/api.h"
#include "deck/deck.h"

/* What a deck says, for hosts. */

static rotid_check *make_check(struct call *call, const struct job *job, const struct spectrum *s)
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
    if (!(r.weighed = result_weighed(pool, job, &mass, &r.nweighed)))
        return NULL;
    meridian_count(s->model, &r.nodes, &r.elements);
    r.nsensors = r.geometry ? r.geometry->nsensors : 0;
    r.sensors = r.geometry ? r.geometry->sensors : NULL;
    r.nparameters = POOL_LIST(pool, r.parameters, job->unknowns.nparameter);
    for (int p = 0; p < r.nparameters; p++)
        r.parameters[p] = job->unknowns.bounds[p].name;
    int none;
    const rotid_message *unsaid; /* a check has no messages */
    return call_keep(call, &check_record, &r, &r.memory, &none, &unsaid);
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
        status = (*check = make_check(&call, job, &found)) ? ROTID_OK : ROTID_ERROR_MEMORY;
    return call_close(&call, status);
}

void rotid_check_free(rotid_check *check)
{
    pool_free(check ? check->memory : NULL);
}

#define MODES_SHOWN 6 /* at least, where the caller does not say how many */
#define MODES_DRAWN 6 /* of a solid on its meridian: two thousand numbers each */

static int compute(const struct job *job, const double *x, int nmode, struct entry *entry, double **values,
                   struct spectrum *spectrum)
{
    struct pool *scratch = &entry->scratch;
    double *at = POOL_ARRAY(scratch, double, job->unknowns.nparameter);
    *values = at;
    if (!at)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        at[p] = x ? x[p] : job->unknowns.bounds[p].start;
        if (!isfinite(at[p]))
            return refuse(entry->failure, "x[%d], the value of %s, is %g, expected a number", p, job->unknowns.bounds[p].name,
                          at[p]);
        const char *range = deck_outside_range(scratch, &job->rotor, job->unknowns.parameter[p], 1, &at[p]);
        if (range)
            return refuse(entry->failure, "x[%d], the value of %s, is %g, expected a value %s", p, job->unknowns.bounds[p].name,
                          at[p], range);
    }
    return job_spectrum(scratch, job, at, nmode, SPECTRUM_WHOLE, spectrum);
}

/* compared NULL: the measured modes could not be paired */
static rotid_spectrum *make_result(struct call *call, const struct job *job, const struct spectrum *s,
                                   const struct comparison *compared, rotid_beam_beside_solid *beside)
{
    struct pool *pool = &call->entry.scratch;
    rotid_spectrum r = {.type = mode_type_words[job->options.type],
                        .reduction = job->options.fit.reduction == ROTID_IRS ? "IRS" : "GUYAN",
                        .nrigid_hz = s->nrigid,
                        .rigid_hz = s->rigid_hz,
                        .nsensor_z_m = s->nmaster,
                        .sensor_z_m = s->master_z,
                        .geometry = result_geometry(pool, &job->rotor, s->model),
                        .meridian = meridian_mesh(pool, s->model),
                        .beside = beside,
                        .master_mass = s->mass};
    r.nmodes = POOL_LIST(pool, r.modes, s->count);
    for (int j = 0; j < r.nmodes; j++) {
        rotid_model_mode *mode = &r.modes[j];
        *mode = (rotid_model_mode){.mode = j + 1,
                                   .full_hz = s->full_hz[j],
                                   .reduced_hz = s->reduced_hz[j],
                                   .reduction_error_percent = s->reduction_error_percent[j],
                                   .mesh_error_percent = s->mesh_error_percent[j],
                                   .nshape = s->nmaster,
                                   .shape = s->shape + (ptrdiff_t)j * s->nmaster};
        if (j < MODES_DRAWN)
            mode->meridian = meridian_mode(pool, s->model, s->phi + (ptrdiff_t)j * s->model->equations.n);
        for (int k = 0; compared && k < compared->nmode; k++)
            if (compared->number[k] == j + 1 && (mode->measured = POOL_NEW(pool, rotid_compared_mode)))
                *mode->measured = result_compared_mode(job, compared, k, s->full_hz[j]);
    }
    return CALL_KEEP(call, &spectrum_whole_record, &r);
}

#define AS_STATED INT_MIN /* type of the modes: that of the deck */

static int run(struct call *call, const struct job *stated, int type, const double *x, int nmode, int with_other,
               rotid_spectrum **result)
{
    struct job of_type, *job = &of_type;
    if (type != AS_STATED && (type < ROTID_BENDING || type > ROTID_AXIAL))
        return refuse(call->entry.failure, "type is %d, expected ROTID_BENDING, ROTID_TORSION or ROTID_AXIAL", type);
    enum mode_type motion = type == AS_STATED ? stated->options.type : (enum mode_type)type;
    int status = job_of_type(&call->entry.scratch, stated, motion, job);
    if (status)
        return status;
    double *at;
    rotid_beam_beside_solid *beside = NULL;
    struct spectrum found = {0};
    struct comparison compared;
    int count = comparison_candidates(job);
    if (nmode < 0)
        return refuse(call->entry.failure, "nmode is %d, expected 0 or more", nmode);
    if (!nmode)
        nmode = count > MODES_SHOWN ? count : MODES_SHOWN;
    status = compute(job, x, nmode, &call->entry, &at, &found);
    int paired;
    if (status)
        return status;
    (void)check_units(job, &found, 0, &call->notes);
    paired = comparison_make(&call->entry.scratch, job, &found, &call->notes, &compared);
    if (paired && paired != ROTID_ERROR_UNPAIRED)
        return paired;
    if (!paired)
        comparison_warn_of_mesh(job, &found, &compared, &call->notes);
    if (with_other)
        status = beam_vs_solid_make(&call->entry.scratch, job, at, nmode, &call->environment, &call->notes, &beside);
    if (status)
        return status;
    *result = make_result(call, job, &found, paired ? NULL : &compared, beside);
    return *result ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int open_and_run(const rotid_deck *deck, int type, const double *x, int nmode, int with_other,
                        const rotid_environment *environment, char *failure, rotid_spectrum **spectrum)
{
    struct call call;
    int status = call_open(&call, environment, failure, spectrum, "spectrum");
    const struct job *job = status ? NULL : deck_job(deck, &call);
    if (!status)
        status = job ? run(&call, job, type, x, nmode, with_other, spectrum) : ROTID_ERROR_ARGUMENT;
    return call_close(&call, status);
}

int rotid_spectrum_compute(const rotid_deck *deck, const double *x, int nmode, const rotid_environment *environment,
                           char *failure, rotid_spectrum **spectrum)
{
    return open_and_run(deck, AS_STATED, x, nmode, 0, environment, failure, spectrum);
}

int rotid_spectrum_beside(const rotid_deck *deck, const double *x, int nmode, const rotid_environment *environment, char *failure,
                          rotid_spectrum **spectrum)
{
    return open_and_run(deck, ROTID_BENDING, x, nmode, 1, environment, failure, spectrum);
}

int rotid_spectrum_of_type(const rotid_deck *deck, int type, const double *x, int nmode, const rotid_environment *environment,
                           char *failure, rotid_spectrum **spectrum)
{
    return open_and_run(deck, type, x, nmode, 0, environment, failure, spectrum);
}

void rotid_spectrum_free(rotid_spectrum *spectrum)
{
    pool_free(spectrum ? spectrum->memory : NULL);
}
