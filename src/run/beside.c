#include "run/run.h"

#define MOST_PLACES  41   /* of the shapes, where the deck has no sensors */
#define FITTED_MODES 6    /* where nothing was measured */
#define SAME_STD     1e-3 /* of every frequency: all weigh the same */
#define RANGE        20   /* times its value, up and down: where a modulus is searched */

/* One rotor, as both. The job of the beam has the modes of the solid for its measurement. */
struct both {
    struct job beam, solid;
    struct spectrum beam_modes, solid_modes;
    struct comparison compared;
};

/* ------------------------------------------------------------------------------------------------ two models */

static int begin_as(struct pool *pool, enum discretisation as, struct job *job, struct message_list *notes)
{
    struct model_size size;
    int failed, status = models_begin(pool, as, &job->rotor, &job->models, &size, &failed);
    job->options.solid = as == AS_SOLID;
    if (status == ROTID_ERROR_SECTION) {
        struct place place = job_part_place(job, failed);
        message_at(notes, SEVERITY_ERROR, place, "the rotor cannot be compared as a %s: %s", as == AS_SOLID ? "solid" : "beam",
                   discrete_refusal(as, &job->rotor, failed));
    }
    return status;
}

/* Sensors at nodes of the beam, evenly by number. */
static int place_sensors(struct pool *pool, struct rotor *rotor)
{
    struct rotor_model beam;
    int failed, status = model_open(pool, NULL, rotor, 0, NULL, 1, &beam, &failed);
    if (status)
        return status;
    int count = beam.naxis < MOST_PLACES ? beam.naxis : MOST_PLACES;
    rotor->nsensor = POOL_LIST(pool, rotor->sensor, count);
    for (int s = 0; s < rotor->nsensor; s++)
        rotor->sensor[s] = (struct sensor){s + 1, beam.z[(long long)s * (beam.naxis - 1) / (count - 1)]};
    return rotor->nsensor ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The rotor of the job at x; what was measured on it is left out. */
static int state(struct pool *pool, const struct job *job, const double *x, struct job *out)
{
    *out = *job;
    out->measurement = (struct job_measurement){0};
    int status = rotor_copy(pool, &job->rotor, &out->rotor);
    if (status)
        return status;
    out->rotor.nspring = job->rotor.nspring; /* without those of the sling */
    parameters_set(&out->rotor, job->unknowns.nparameter, job->unknowns.parameter, x);
    out->unknowns = (struct job_unknowns){0};
    rotid_fit_defaults(sizeof out->options.fit, &out->options.fit);
    return out->rotor.nsensor ? ROTID_OK : place_sensors(pool, &out->rotor);
}

/* The first `count` modes of the solid, as if they had been measured. */
static int measure(struct pool *pool, const struct spectrum *s, int count, const int *number, struct job_measurement *out)
{
    *out = (struct job_measurement){.nmode = count};
    out->number = POOL_ARRAY(pool, int, count);
    out->frequency_hz = POOL_ARRAY(pool, double, count);
    out->frequency_std = POOL_ARRAY(pool, double, count);
    out->holdout = POOL_ARRAY(pool, int, count);
    out->shape = POOL_ARRAY(pool, double, (size_t)count *(size_t)s->nmaster);
    out->shape_std = pool_unknown(pool, (size_t)count * (size_t)s->nmaster); /* the shapes pair and are not fitted */
    if (!out->number || !out->frequency_hz || !out->frequency_std || !out->holdout || !out->shape || !out->shape_std)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < count; k++) {
        int j = number ? number[k] - 1 : k;
        out->number[k] = j + 1;
        out->frequency_hz[k] = s->full_hz[j];
        out->frequency_std[k] = SAME_STD;
        memcpy(out->shape + (ptrdiff_t)k * s->nmaster, s->shape + (ptrdiff_t)j * s->nmaster,
               (size_t)s->nmaster * sizeof *out->shape);
    }
    return ROTID_OK;
}

static int solve(struct pool *pool, int nmode, struct both *both)
{
    int status = spectrum_compute_parts(pool, both->solid.models, &both->solid.rotor, 0, NULL, NULL, ROTID_GUYAN, nmode,
                                        SPECTRUM_MESH, &both->solid_modes);
    if (!status)
        status =
            spectrum_compute(pool, both->beam.models, &both->beam.rotor, 0, NULL, NULL, ROTID_GUYAN, nmode, &both->beam_modes);
    if (status)
        return status;
    int count = both->solid_modes.count < both->beam_modes.count ? both->solid_modes.count : both->beam_modes.count;
    struct message_list quiet;
    message_open(&quiet, pool);
    status = measure(pool, &both->solid_modes, count, NULL, &both->beam.measurement);
    if (!status)
        status = comparison_make(pool, &both->beam, &both->beam_modes, &quiet, &both->compared);
    if (status == ROTID_ERROR_UNPAIRED) { /* too few sensors tell them apart: by number */
        both->beam.measurement.shape = NULL;
        status = comparison_make(pool, &both->beam, &both->beam_modes, &quiet, &both->compared);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------ what a beam would find */

static int add_modulus(struct pool *pool, const struct rotor *rotor, struct parameter parameter, const char *name,
                       struct job_unknowns *unknowns)
{
    double value = *parameter_value(rotor, parameter);
    if (!name)
        name = pool_format(pool, "%s.%c", rotor->group[parameter.index].name, parameter.kind == PARAMETER_E ? 'E' : 'G');
    unknowns->parameter[unknowns->nparameter] = parameter;
    unknowns->bounds[unknowns->nparameter++] = (rotid_parameter){name, "Pa", value / RANGE, value * RANGE, value};
    return name ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The longest group of sheets, else the first whose G is its own, else -1. */
static int orthotropic_group(const struct rotor *rotor)
{
    int found = -1, sheets = 0;
    double longest = 0, from, to;
    for (int g = 0; g < rotor->ngroup; g++) {
        const struct material *material = &rotor->group[g].material;
        rotor_group_span(rotor, g, &from, &to);
        if (material->laminated && to - from > longest) {
            found = g;
            sheets = 1;
            longest = to - from;
        } else if (!sheets && found < 0 && !material->isotropic) {
            found = g;
        }
    }
    return found;
}

static int choose_moduli(struct pool *pool, const struct job *job, const struct rotor *rotor, struct job_unknowns *unknowns)
{
    const struct job_unknowns *own = &job->unknowns;
    int most = own->nparameter + 2, status = ROTID_OK;
    *unknowns = (struct job_unknowns){.parameter = POOL_ARRAY(pool, struct parameter, most),
                                      .bounds = POOL_ARRAY(pool, rotid_parameter, most)};
    if (!unknowns->parameter || !unknowns->bounds)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < own->nparameter && !status; p++)
        if (own->parameter[p].kind == PARAMETER_E || own->parameter[p].kind == PARAMETER_G)
            status = add_modulus(pool, rotor, own->parameter[p], own->bounds[p].name, unknowns);
    int group = unknowns->nparameter ? -1 : orthotropic_group(rotor);
    for (int kind = PARAMETER_E; kind <= PARAMETER_G && group >= 0 && !status; kind++)
        status = add_modulus(pool, rotor, (struct parameter){(enum parameter_kind)kind, group, 0, 0, NULL}, NULL, unknowns);
    return status;
}

static const char *sentence_of(struct pool *pool, const rotid_beam_beside_solid *beside)
{
    const char *text = "a beam fitted to this solid would find";
    for (int p = 0; p < beside->nmoduli && text; p++)
        text =
            pool_format(pool, "%s%s %s %+.0f %%", text, p ? "," : "", beside->moduli[p].name, beside->moduli[p].change_percent);
    return text ? pool_format(pool, "%s, and leave %.2f %% in its frequencies", text, beside->fitted_rms_percent) : NULL;
}

static int keep_moduli(struct pool *pool, const struct job *fitted, const struct identification *found,
                       rotid_beam_beside_solid *out)
{
    const rotid_fit_result *fit = found->fit;
    double sum = 0;
    out->nmoduli = POOL_LIST(pool, out->moduli, fit->n);
    out->nfitted_modes = POOL_LIST(pool, out->fitted_modes, fitted->measurement.nmode);
    for (int p = 0; p < out->nmoduli; p++) {
        const rotid_parameter *modulus = &fitted->unknowns.bounds[p];
        out->moduli[p] = (rotid_beside_modulus){modulus->name, modulus->start, fit->x[p], 100 * (fit->x[p] / modulus->start - 1)};
    }
    for (int k = 0; k < out->nfitted_modes; k++) {
        double hz = fitted->measurement.frequency_hz[k], error = found->spectrum.full_hz[found->compared.number[k] - 1] / hz - 1;
        out->fitted_modes[k] = fitted->measurement.number[k];
        sum += error * error;
    }
    out->fitted_rms_percent = 100 * sqrt(sum / fitted->measurement.nmode);
    out->sentence = sentence_of(pool, out);
    return out->sentence ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The modes that are fitted: those that were measured, as far as they are among those of both, else the first ones. */
static int choose_modes(struct pool *pool, const struct job *job, const struct both *both, struct job *fitted)
{
    int count = both->compared.nmode, n = 0, *number = POOL_ARRAY(pool, int, job->measurement.nmode + FITTED_MODES);
    if (!number)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < job->measurement.nmode; k++)
        if (job->measurement.number[k] <= count)
            number[n++] = job->measurement.number[k];
    for (int k = 0; k < count && k < FITTED_MODES && !job->measurement.nmode; k++)
        number[n++] = k + 1;
    return measure(pool, &both->solid_modes, n, number, &fitted->measurement);
}

/* fit NULL: there was none */
static void say_why_not(const struct job *fitted, const rotid_fit_result *fit, struct message_list *notes)
{
    int at = fit && fit->any_at_bound ? 0 : -1;
    while (at >= 0 && !fit->at_bound[at])
        at++;
    if (at >= 0)
        message_warn(notes, "no moduli make a beam follow this solid: fitted to %d frequencies, %s ends at %.3g times its value",
                     fitted->measurement.nmode, fitted->unknowns.bounds[at].name, fit->x[at] / fitted->unknowns.bounds[at].start);
    else
        message_warn(notes, "the moduli of an equivalent beam are not determined: %d frequencies of the solid for %d moduli",
                     fitted->measurement.nmode, fitted->unknowns.nparameter);
}

/* Nothing where there are no moduli, or fewer modes than moduli. */
static int fit_beam(struct pool *pool, const struct job *job, const struct both *both, const rotid_environment *environment,
                    struct message_list *notes, rotid_beam_beside_solid *out)
{
    struct job fitted = both->beam;
    struct identification found = {0};
    struct message_list quiet;
    message_open(&quiet, pool);
    out->fitted_rms_percent = NAN;
    int status = choose_moduli(pool, job, &both->beam.rotor, &fitted.unknowns);
    if (!status)
        status = choose_modes(pool, job, both, &fitted);
    if (status || !fitted.unknowns.nparameter)
        return status;
    if (!both->beam.measurement.shape)
        fitted.measurement.shape = NULL;
    status = fitted.measurement.nmode < fitted.unknowns.nparameter
                 ? ROTID_ERROR_RANK
                 : identify_run(pool, &fitted, IDENTIFY_BARE, environment, &quiet, &found);
    if (!status && found.fit->status == ROTID_STOP_CANCELLED)
        status = ROTID_STOP_CANCELLED;
    if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED) {
        rotid_fit_free(found.fit);
        return status;
    }
    /* the frequencies have no noise: intervals, which the misfit widens, and what they call undetermined, say nothing here */
    if (status || !found.fit->converged || found.fit->any_at_bound || !isfinite(found.fit->condition_number))
        say_why_not(&fitted, status ? NULL : found.fit, notes);
    else
        status = keep_moduli(pool, &fitted, &found, out);
    rotid_fit_free(found.fit);
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
}

int beam_vs_solid_make(struct pool *pool, const struct job *job, const double *x, int nmode, const rotid_environment *environment,
                       struct message_list *notes, rotid_beam_beside_solid **beside)
{
    struct both *both = POOL_NEW(pool, struct both);
    rotid_beam_beside_solid *out = *beside = POOL_NEW(pool, rotid_beam_beside_solid);
    int status = both && out ? state(pool, job, x, &both->beam) : ROTID_ERROR_MEMORY;
    if (status)
        return status;
    both->solid = both->beam;
    status = begin_as(pool, AS_BEAM, &both->beam, notes);
    if (!status)
        status = begin_as(pool, AS_SOLID, &both->solid, notes);
    if (!status)
        status = solve(pool, nmode, both);
    if (status)
        return status;
    out->nmodes = POOL_LIST(pool, out->modes, both->compared.nmode);
    for (int j = 0; j < out->nmodes; j++) {
        int partner = both->compared.number[j] - 1;
        double solid = both->solid_modes.full_hz[j], beam = both->beam_modes.full_hz[partner];
        out->modes[j] = (rotid_beside_mode){.mode = j + 1,
                                            .beam_mode = partner + 1,
                                            .solid_hz = solid,
                                            .beam_hz = beam,
                                            .difference_percent = 100 * (beam / solid - 1),
                                            .nco = both->compared.nco[j],
                                            .mac = both->compared.mac[j],
                                            .solid_mesh_error_percent = both->solid_modes.mesh_error_percent[j],
                                            .beam_mesh_error_percent = both->beam_modes.mesh_error_percent[partner]};
    }
    return out->nmodes ? fit_beam(pool, job, both, environment, notes, out) : ROTID_ERROR_MEMORY;
}
