#include "api/result_diagnosis.h"

#include <math.h>

#include "api/result_geometry.h"
#include "api/result_identification.h"
#include "diagnose/items.h"

_Static_assert((int)VERDICT_ADEQUATE == ROTID_ADEQUATE && (int)VERDICT_NAMED == ROTID_NAMED &&
                   (int)VERDICT_AMBIGUOUS == ROTID_AMBIGUOUS && (int)VERDICT_UNEXPLAINED == ROTID_UNEXPLAINED,
               "verdicts of the header");

static double if_known(int known, double value)
{
    return known ? value : (double)NAN;
}

static rotid_cause cause_of(struct pool *pool, const struct candidate *c)
{
    const struct effect_parameter_name *parameter;
    rotid_cause out = {.id = c->cause->id, .target = c->target, .name = c->effect.name, .variant = candidate_variant(c)};
    int room = POOL_LIST(pool, out.parameters, EFFECT_MOST_PARAMETERS);
    for (int p = 0; p < room && (parameter = candidate_parameter(c, p)); p++)
        out.parameters[out.nparameters++] = (rotid_cause_value){.name = parameter->name,
                                                                .unit = parameter->unit,
                                                                .value = c->effect.value[p],
                                                                .std = c->std[p],
                                                                .ci95 = {c->ci_lower[p], c->ci_upper[p]},
                                                                .fixed = c->fixed[p]};
    return out;
}

static int fill_causes(struct pool *pool, int count, const struct candidate *candidate, rotid_cause **list)
{
    int room = POOL_LIST(pool, *list, count);
    for (int i = 0; i < room; i++)
        (*list)[i] = cause_of(pool, &candidate[i]);
    return room;
}

/* Nothing of it is known before the diagnosis has a sentence. */
static void fill_verdict(struct pool *pool, const struct diagnosis *d, rotid_verdict *out)
{
    *out = (rotid_verdict){.kind = d->sentence ? (int)d->kind : -1,
                           .adequate_after = d->adequate_after,
                           .p_value = if_known(d->sentence != NULL, d->p_value),
                           .next_measurement = d->next_measurement,
                           .sentence = d->sentence,
                           .undetermined_parameters = d->undetermined};
    out->ncauses = fill_causes(pool, d->ncause, d->cause, &out->causes);
    out->nalternative_causes = fill_causes(pool, d->nalternative, d->alternative, &out->alternative_causes);
    out->nalternatives = POOL_LIST(pool, out->alternatives, d->nalternative);
    for (int i = 0; i < out->nalternatives; i++)
        out->alternatives[i] = d->alternative[i].cause->id;
}

static void fill_findings(struct pool *pool, const struct diagnosis *d, rotid_diagnosis *out)
{
    out->ndata_findings = POOL_LIST(pool, out->data_findings, d->ndata_finding);
    for (int i = 0; i < out->ndata_findings; i++) {
        const struct data_finding *f = &d->data_finding[i];
        out->data_findings[i] = (rotid_data_finding){.id = f->cause->id,
                                                     .nsensors = f->nsensor,
                                                     .sensors = (int *)f->sensor,
                                                     .nmodes = f->nmode,
                                                     .modes = (int *)f->mode,
                                                     .block = f->block,
                                                     .value = f->value,
                                                     .unit = f->cause->value.unit,
                                                     .std = f->std,
                                                     .chi2_drop = f->chi2_drop,
                                                     .text = f->text};
    }
    out->nnumerical_findings = POOL_LIST(pool, out->numerical_findings, d->nnumerical_finding);
    for (int i = 0; i < out->nnumerical_findings; i++) {
        const struct numerical_finding *f = &d->numerical_finding[i];
        out->numerical_findings[i] = (rotid_numerical_finding){.id = f->cause->id,
                                                               .nmodes = f->nmode,
                                                               .modes = (int *)f->mode,
                                                               .error_percent = (double *)f->error_percent,
                                                               .text = f->text};
    }
}

static rotid_candidate candidate_of(struct pool *pool, int round, const struct candidate *c)
{
    int is_fitted = c->refitted;
    return (rotid_candidate){.round = round,
                             .cause = cause_of(pool, c),
                             .suspect = c->suspect,
                             .refitted = is_fitted,
                             .predicted_drop = c->predicted_drop,
                             .chi2 = if_known(is_fitted, c->chi2),
                             .chi2_frequency = if_known(is_fitted, c->chi2_frequency),
                             .chi2_drop = if_known(is_fitted, c->chi2_drop),
                             .bic = if_known(is_fitted, c->bic),
                             .holdout_rms = if_known(is_fitted, c->holdout_rms),
                             .mode_out_rms = if_known(is_fitted, c->mode_out_rms),
                             .sensor_out_rms = if_known(is_fitted, c->sensor_out_rms),
                             .p_value = c->p_value,
                             .at_bound = c->at_bound,
                             .collinear_with = c->collinear_with,
                             .collinear_target = c->collinear_target,
                             .cosine = if_known(c->collinear_with != NULL, c->cosine),
                             .rejected_because = c->rejected_because};
}

static void fill_rounds(struct pool *pool, const struct diagnosis *d, rotid_diagnosis *out)
{
    int count = 0;
    for (int i = 0; i < d->nround; i++)
        count += d->round[i].ncandidate;
    if (!POOL_LIST(pool, out->candidates, count) && count)
        return;
    out->nrounds = POOL_LIST(pool, out->rounds, d->nround);
    for (int i = 0; i < out->nrounds; i++) {
        const struct diagnosis_round *round = &d->round[i];
        out->rounds[i] = (rotid_round){.round = i + 1,
                                       .kind = (int)round->kind,
                                       .chi2 = round->chi2,
                                       .chi2_frequency = round->chi2_frequency,
                                       .dof = round->dof,
                                       .frequencies = round->nfrequency,
                                       .largest = round->largest,
                                       .threshold = round->threshold,
                                       .p_scan = round->p_scan,
                                       .p_frequency = round->p_frequency,
                                       .p_total = round->p_total,
                                       .required_margin = round->required_margin,
                                       .set = round->nset};
        for (int k = 0; k < round->ncandidate; k++)
            out->candidates[out->ncandidates++] = candidate_of(pool, i + 1, &round->candidate[k]);
    }
}

static rotid_changed_parameter changed_parameter(struct pool *pool, const rotid_parameter *name, const rotid_fit_result *base,
                                                 int before, const rotid_fit_result *extended, int after)
{
    int was = base && before >= 0, is = extended && after >= 0;
    return (rotid_changed_parameter){
        .name = name->name,
        .unit = name->unit,
        .before = was ? base->x[before] : (double)NAN,
        .after = is ? extended->x[after] : (double)NAN,
        .before_ci95 = {was ? base->ci_lower[before] : (double)NAN, was ? base->ci_upper[before] : (double)NAN},
        .after_ci95 = {is ? extended->ci_lower[after] : (double)NAN, is ? extended->ci_upper[after] : (double)NAN}};
}

/* Parameters of the base model, then those that the extended one has besides. */
static void fill_changes(struct pool *pool, const struct diagnosis *d, rotid_gain *out)
{
    const rotid_fit_result *base = d->base.fit, *extended = d->extended.fit;
    int nbase = base ? base->n : 0, nextended = extended ? extended->n : 0,
        room = POOL_LIST(pool, out->parameters, nbase + nextended);
    for (int p = 0; p < nbase && room; p++)
        out->parameters[out->nparameters++] =
            changed_parameter(pool, &d->job.unknowns.bounds[p], base, p, extended,
                              fitted_parameter(&d->extended_job, extended, d->job.unknowns.bounds[p].name));
    for (int p = 0; p < nextended && room; p++)
        if (fitted_parameter(&d->job, base, d->extended_job.unknowns.bounds[p].name) < 0)
            out->parameters[out->nparameters++] =
                changed_parameter(pool, &d->extended_job.unknowns.bounds[p], base, -1, extended, p);
}

static void fill_gain(struct pool *pool, const struct diagnosis *d, rotid_gain *out)
{
    static const struct fit_quality nothing = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    const struct fit_quality *b = d->base.fit && d->sentence ? &d->before : &nothing,
                             *a = d->extended.fit && d->sentence ? &d->after : &nothing;
    *out = (rotid_gain){
        .frequency_rms_percent = {b->frequency_rms_percent, a->frequency_rms_percent},
        .frequency_max_percent = {b->frequency_max_percent, a->frequency_max_percent},
        .shape_rms = {b->shape_rms, a->shape_rms},
        .chi2_per_dof = {b->chi2_per_dof, a->chi2_per_dof},
        .nco_min = {b->nco_min, a->nco_min},
        .holdout_frequency_rms_percent = {b->holdout_frequency_rms_percent, a->holdout_frequency_rms_percent},
        .holdout_shape_rms = {b->holdout_shape_rms, a->holdout_shape_rms},
        .mode_out_frequency_rms_percent = {b->mode_out_frequency_rms_percent, a->mode_out_frequency_rms_percent},
        .mode_out_shape_rms = {b->mode_out_shape_rms, a->mode_out_shape_rms},
        .sensor_out_shape_rms = {b->sensor_out_shape_rms, a->sensor_out_shape_rms},
    };
    fill_changes(pool, d, out);
}

static void fill_misfit(struct pool *pool, const struct diagnosis *d, rotid_diagnosis *out)
{
    const struct rotor *rotor = &d->job.rotor;
    out->modes_standardised = d->mode_z;
    out->nmodes_standardised = out->modes_standardised ? d->job.measurement.nmode : 0;
    out->nsensors = POOL_LIST(pool, out->sensors, rotor->nsensor);
    for (int s = 0; s < out->nsensors; s++)
        out->sensors[s] = (rotid_sensor_residual){rotor->sensor[s].id, rotor->sensor[s].position,
                                                  d->sensor_rms ? d->sensor_rms[s] : (double)NAN};
    out->nlocalisation = POOL_LIST(pool, out->localisation, d->nlocal);
    for (int i = 0; i < out->nlocalisation; i++)
        out->localisation[i] = (rotid_localisation){d->local_z[i], d->local[i]};
}

static void fill_detectable(struct pool *pool, const struct diagnosis *d, rotid_diagnosis *out)
{
    out->ndetectable = POOL_LIST(pool, out->detectable, d->ndetectable);
    for (int i = 0; i < out->ndetectable; i++) {
        const struct detectable *f = &d->detectable[i];
        out->detectable[i] = (rotid_detectable){.id = f->cause->id,
                                                .target = f->target,
                                                .parameter = f->parameter,
                                                .smallest = f->smallest,
                                                .unit = f->unit,
                                                .z_m = f->z,
                                                .worst = f->worst,
                                                .beyond = f->beyond};
    }
}

rotid_diagnosis *result_diagnosis(struct pool *pool, const struct job *deck, struct diagnosis *d)
{
    rotid_diagnosis *out = POOL_NEW(pool, rotid_diagnosis);
    if (!out)
        return NULL;
    out->interrupted = d->interrupted;
    fill_verdict(pool, d, &out->verdict);
    fill_findings(pool, d, out);
    fill_rounds(pool, d, out);
    fill_gain(pool, d, &out->gain);
    fill_misfit(pool, d, out);
    fill_detectable(pool, d, out);
    out->noise = (rotid_noise){.frequency = if_known(d->frequency_noise > 0, d->frequency_noise),
                               .shape = if_known(d->shape_noise > 0, d->shape_noise),
                               .frequency_assumed = d->frequency_noise_assumed,
                               .shape_assumed = d->shape_noise_assumed};
    out->geometry = result_geometry(pool, d->job.deck ? &d->job.rotor : &deck->rotor, d->base.spectrum.model);
    out->nsteps = POOL_LIST(pool, out->steps, d->nstep);
    for (int i = 0; i < out->nsteps; i++)
        out->steps[i] = (rotid_step){d->step[i].name, d->step[i].seconds};
    out->today = result_identification(pool, deck, &d->today);
    out->base = result_identification(pool, &d->job, &d->base);
    out->extended = result_identification(pool, &d->extended_job, &d->extended);
    return out;
}
