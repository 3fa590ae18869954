#include "api/diagnosis_parts.h"

#include <math.h>

#include "diagnose/items.h"

static const char *or_empty(const char *text)
{
    return text ? text : "";
}

static const rotid_cause_value *values(struct holding *holding, const struct candidate *c, int *count)
{
    rotid_cause_value *list = POOL_ARRAY(&holding->pool, rotid_cause_value, EFFECT_MOST_PARAMETERS);
    const struct effect_parameter_name *parameter;
    holding->missing |= !list;
    *count = 0;
    for (int p = 0; list && (parameter = candidate_parameter(c, p)); p++)
        list[(*count)++] = (rotid_cause_value){.name = holding_text(holding, parameter->name),
                                               .unit = holding_text(holding, parameter->unit),
                                               .value = c->effect.value[p],
                                               .std = c->std[p],
                                               .ci_lower = c->ci_lower[p],
                                               .ci_upper = c->ci_upper[p],
                                               .fixed = c->fixed[p]};
    return list;
}

static double if_known(int known, double value)
{
    return known ? value : NAN;
}

static void fill_cause(struct holding *holding, const struct candidate *c, rotid_cause *out)
{
    *out = (rotid_cause){.id = holding_text(holding, c->cause->id),
                         .target = holding_text(holding, or_empty(c->target)),
                         .name = holding_text(holding, or_empty(c->effect.name)),
                         .variant = holding_text(holding, candidate_variant(c)),
                         .round = c->round,
                         .refitted = c->refitted,
                         .chi2 = if_known(c->refitted, c->chi2),
                         .chi2_drop = if_known(c->refitted, c->chi2_drop),
                         .bic = if_known(c->refitted, c->bic),
                         .holdout_rms = if_known(c->refitted, c->holdout_rms),
                         .mode_out_rms = if_known(c->refitted, c->mode_out_rms),
                         .sensor_out_rms = if_known(c->refitted, c->sensor_out_rms),
                         .predicted_drop = c->predicted_drop,
                         .p_value = c->p_value,
                         .at_bound = c->at_bound,
                         .collinear_with = holding_text(holding, c->collinear_with),
                         .cosine = if_known(c->collinear_with != NULL, c->cosine),
                         .rejected_because = holding_text(holding, c->rejected_because)};
    out->value = values(holding, c, &out->nvalue);
}

const rotid_cause *diagnosis_causes(struct holding *holding, int count, const struct candidate *candidate)
{
    rotid_cause *list = POOL_ARRAY(&holding->pool, rotid_cause, count);
    holding->missing |= !list;
    for (int i = 0; list && i < count; i++)
        fill_cause(holding, &candidate[i], &list[i]);
    return list;
}

const rotid_cause *diagnosis_candidates(struct holding *holding, const struct diagnosis *d, int *count)
{
    *count = 0;
    for (int r = 0; r < d->nround; r++)
        *count += d->round[r].ncandidate;
    rotid_cause *list = POOL_ARRAY(&holding->pool, rotid_cause, *count), *next = list;
    holding->missing |= !list;
    for (int r = 0; list && r < d->nround; r++)
        for (int i = 0; i < d->round[r].ncandidate; i++)
            fill_cause(holding, &d->round[r].candidate[i], next++);
    return list;
}

const rotid_finding *diagnosis_data_findings(struct holding *holding, const struct diagnosis *d)
{
    rotid_finding *list = POOL_ARRAY(&holding->pool, rotid_finding, d->ndata_finding);
    holding->missing |= !list;
    for (int i = 0; list && i < d->ndata_finding; i++) {
        const struct data_finding *f = &d->data_finding[i];
        list[i] = (rotid_finding){.id = holding_text(holding, f->cause->id),
                                  .nsensor = f->nsensor,
                                  .nmode = f->nmode,
                                  .sensor = HOLDING_COPY(holding, f->sensor, f->nsensor),
                                  .mode = HOLDING_COPY(holding, f->mode, f->nmode),
                                  .block = holding_text(holding, f->block),
                                  .value = f->value,
                                  .std = f->std,
                                  .chi2_drop = f->chi2_drop,
                                  .text = holding_text(holding, f->text)};
    }
    return list;
}

const rotid_finding *diagnosis_numerical_findings(struct holding *holding, const struct diagnosis *d)
{
    rotid_finding *list = POOL_ARRAY(&holding->pool, rotid_finding, d->nnumerical_finding);
    holding->missing |= !list;
    for (int i = 0; list && i < d->nnumerical_finding; i++) {
        const struct numerical_finding *f = &d->numerical_finding[i];
        list[i] = (rotid_finding){.id = holding_text(holding, f->cause->id),
                                  .nmode = f->nmode,
                                  .mode = HOLDING_COPY(holding, f->mode, f->nmode),
                                  .error_percent = HOLDING_COPY(holding, f->error_percent, f->nmode),
                                  .value = NAN,
                                  .std = NAN,
                                  .chi2_drop = NAN,
                                  .text = holding_text(holding, f->text)};
    }
    return list;
}

const rotid_detectable *diagnosis_detectable(struct holding *holding, const struct diagnosis *d)
{
    rotid_detectable *list = POOL_ARRAY(&holding->pool, rotid_detectable, d->ndetectable);
    holding->missing |= !list;
    for (int i = 0; list && i < d->ndetectable; i++) {
        const struct detectable *f = &d->detectable[i];
        list[i] = (rotid_detectable){.id = holding_text(holding, f->cause->id),
                                     .target = holding_text(holding, or_empty(f->target)),
                                     .parameter = holding_text(holding, f->parameter),
                                     .unit = holding_text(holding, f->unit),
                                     .smallest = f->smallest,
                                     .z = f->z,
                                     .worst = f->worst,
                                     .beyond = f->beyond};
    }
    return list;
}
