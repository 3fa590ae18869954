#include "report/json_diagnose.h"

#include <math.h>

#include "diagnose/items.h"
#include "report/json_geometry.h"
#include "report/json_identify.h"

static void add_fit(struct json_tree *tree, const char *key, const struct job *job, const struct identification *result)
{
    if (result->fit)
        json_identification(tree, json_object(tree, tree->root, key), job, result);
    else
        json_null(tree, tree->root, key);
}

static void add_findings(struct json_tree *tree, const struct diagnosis *d)
{
    cJSON *data = json_array(tree, tree->root, "data_findings"), *numerical = json_array(tree, tree->root, "numerical_findings");
    for (int i = 0; i < d->ndata_finding; i++) {
        const struct data_finding *finding = &d->data_finding[i];
        cJSON *item = json_object(tree, data, NULL), *sensors, *modes;
        json_text(tree, item, "id", finding->cause->id);
        sensors = json_array(tree, item, "sensors");
        for (int s = 0; s < finding->nsensor; s++)
            json_number(tree, sensors, NULL, finding->sensor[s]);
        modes = json_array(tree, item, "modes");
        for (int k = 0; k < finding->nmode; k++)
            json_number(tree, modes, NULL, finding->mode[k]);
        json_text(tree, item, "block", finding->block);
        json_number(tree, item, "value", finding->value);
        json_text(tree, item, "unit", finding->cause->value.unit);
        json_number(tree, item, "std", finding->std);
        json_number(tree, item, "chi2_drop", finding->chi2_drop);
        json_text(tree, item, "text", finding->text);
    }
    for (int i = 0; i < d->nnumerical_finding; i++) {
        const struct numerical_finding *finding = &d->numerical_finding[i];
        cJSON *item = json_object(tree, numerical, NULL), *modes;
        json_text(tree, item, "id", finding->cause->id);
        modes = json_array(tree, item, "modes");
        for (int k = 0; k < finding->nmode; k++)
            json_number(tree, modes, NULL, finding->mode[k]);
        json_list(tree, item, "error_percent", finding->nmode, finding->error_percent);
        json_text(tree, item, "text", finding->text);
    }
}

static void add_pair(struct json_tree *tree, cJSON *object, const char *key, double before, double after)
{
    cJSON *pair = json_object(tree, object, key);
    json_number(tree, pair, "before", before);
    json_number(tree, pair, "after", after);
}

static void add_parameter(struct json_tree *tree, cJSON *list, const rotid_parameter *name, const rotid_fit_result *base,
                          int before, const rotid_fit_result *extended, int after)
{
    const double first[2] = {base && before >= 0 ? base->ci_lower[before] : NAN,
                             base && before >= 0 ? base->ci_upper[before] : NAN},
                 last[2] = {extended && after >= 0 ? extended->ci_lower[after] : NAN,
                            extended && after >= 0 ? extended->ci_upper[after] : NAN};
    cJSON *item = json_object(tree, list, NULL);
    json_text(tree, item, "name", name->name);
    json_text(tree, item, "unit", name->unit);
    json_number(tree, item, "before", base && before >= 0 ? base->x[before] : NAN);
    json_number(tree, item, "after", extended && after >= 0 ? extended->x[after] : NAN);
    json_list(tree, item, "before_ci95", 2, first);
    json_list(tree, item, "after_ci95", 2, last);
}

static void add_gain(struct json_tree *tree, const struct diagnosis *d)
{
    static const struct fit_quality nothing = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    const rotid_fit_result *base = d->base.fit, *extended = d->extended.fit;
    const struct fit_quality *b = base && d->sentence ? &d->before : &nothing,
                             *a = extended && d->sentence ? &d->after : &nothing; /* without a verdict they are not there yet */
    cJSON *gain = json_object(tree, tree->root, "gain"), *list;
    add_pair(tree, gain, "frequency_rms_percent", b->frequency_rms_percent, a->frequency_rms_percent);
    add_pair(tree, gain, "frequency_max_percent", b->frequency_max_percent, a->frequency_max_percent);
    add_pair(tree, gain, "shape_rms", b->shape_rms, a->shape_rms);
    add_pair(tree, gain, "chi2_per_dof", b->chi2_per_dof, a->chi2_per_dof);
    add_pair(tree, gain, "nco_min", b->nco_min, a->nco_min);
    add_pair(tree, gain, "holdout_frequency_rms_percent", b->holdout_frequency_rms_percent, a->holdout_frequency_rms_percent);
    add_pair(tree, gain, "holdout_shape_rms", b->holdout_shape_rms, a->holdout_shape_rms);
    add_pair(tree, gain, "mode_out_frequency_rms_percent", b->mode_out_frequency_rms_percent, a->mode_out_frequency_rms_percent);
    add_pair(tree, gain, "mode_out_shape_rms", b->mode_out_shape_rms, a->mode_out_shape_rms);
    add_pair(tree, gain, "sensor_out_shape_rms", b->sensor_out_shape_rms, a->sensor_out_shape_rms);
    list = json_array(tree, gain, "parameters");
    for (int p = 0; base && p < base->n; p++)
        add_parameter(tree, list, &d->job.bounds[p], base, p, extended,
                      fitted_parameter(&d->extended_job, extended, d->job.bounds[p].name));
    for (int p = 0; extended && p < extended->n; p++)
        if (fitted_parameter(&d->job, base, d->extended_job.bounds[p].name) < 0)
            add_parameter(tree, list, &d->extended_job.bounds[p], base, -1, extended, p);
}

static void add_misfit(struct json_tree *tree, const struct diagnosis *d)
{
    cJSON *list = json_array(tree, tree->root, "modes_standardised");
    for (int k = 0; d->mode_z && k < d->job.nmode; k++)
        json_number(tree, list, NULL, d->mode_z[k]);
    list = json_array(tree, tree->root, "sensors");
    for (int s = 0; s < d->job.rotor.nsensor; s++) {
        cJSON *item = json_object(tree, list, NULL);
        json_number(tree, item, "id", d->job.rotor.sensor[s].id);
        json_number(tree, item, "z_m", d->job.rotor.sensor[s].position);
        json_number(tree, item, "rms", d->sensor_rms ? d->sensor_rms[s] : NAN);
    }
    list = json_array(tree, tree->root, "localisation");
    for (int i = 0; i < d->nlocal; i++) {
        cJSON *item = json_object(tree, list, NULL);
        json_number(tree, item, "z_m", d->local_z[i]);
        json_number(tree, item, "indicator", d->local[i]);
    }
}

static void add_detectable(struct json_tree *tree, const struct diagnosis *d)
{
    cJSON *list = json_array(tree, tree->root, "detectable");
    for (int i = 0; i < d->ndetectable; i++) {
        const struct detectable *found = &d->detectable[i];
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "id", found->cause->id);
        json_text(tree, item, "target", found->target ? found->target : "");
        json_text(tree, item, "parameter", found->parameter);
        json_number(tree, item, "smallest", found->smallest);
        json_text(tree, item, "unit", found->unit);
        json_number(tree, item, "z_m", found->z);
        json_number(tree, item, "worst", found->worst);
        json_flag(tree, item, "beyond", found->beyond);
    }
}

char *json_diagnose(const struct provenance *provenance, const struct job *deck, const struct diagnosis *d,
                    const struct message_list *notes)
{
    struct json_tree tree;
    json_begin(&tree, provenance, deck);
    json_flag(&tree, tree.root, "interrupted", d->interrupted);
    json_verdict(&tree, d);
    add_findings(&tree, d);
    json_rounds(&tree, d);
    add_gain(&tree, d);
    add_misfit(&tree, d);
    add_detectable(&tree, d);
    cJSON *noise = json_object(&tree, tree.root, "noise");
    json_number(&tree, noise, "frequency", d->frequency_noise);
    json_number(&tree, noise, "shape", d->shape_noise);
    json_flag(&tree, noise, "frequency_assumed", d->frequency_noise_assumed);
    json_flag(&tree, noise, "shape_assumed", d->shape_noise_assumed);
    json_geometry(&tree, d->job.deck ? &d->job : deck, &d->base.spectrum);
    add_fit(&tree, "today", deck, &d->today);
    add_fit(&tree, "base", &d->job, &d->base);
    add_fit(&tree, "extended", &d->extended_job, &d->extended);
    cJSON *steps = json_array(&tree, tree.root, "steps");
    for (int i = 0; i < d->nstep; i++) {
        cJSON *item = json_object(&tree, steps, NULL);
        json_text(&tree, item, "name", d->step[i].name);
        json_number(&tree, item, "seconds", d->step[i].seconds);
    }
    json_notes(&tree, notes);
    return json_close(&tree);
}
