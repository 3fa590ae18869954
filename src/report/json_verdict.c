#include "report/json_diagnose.h"

#include "diagnose/items.h"

static void add_values(struct json_tree *tree, cJSON *object, const struct candidate *candidate)
{
    const struct effect_parameter_name *parameter;
    cJSON *list = json_array(tree, object, "parameters");
    for (int p = 0; (parameter = candidate_parameter(candidate, p)); p++) {
        const double interval[2] = {candidate->ci_lower[p], candidate->ci_upper[p]};
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "name", parameter->name);
        json_text(tree, item, "unit", parameter->unit);
        json_number(tree, item, "value", candidate->effect.value[p]);
        json_number(tree, item, "std", candidate->std[p]);
        json_list(tree, item, "ci95", 2, interval);
        json_flag(tree, item, "fixed", candidate->fixed[p]);
    }
}

static void add_cause(struct json_tree *tree, cJSON *object, const struct candidate *candidate)
{
    json_text(tree, object, "id", candidate->cause->id);
    json_text(tree, object, "target", candidate->target ? candidate->target : "");
    json_text(tree, object, "name", candidate->effect.name);
    json_text(tree, object, "variant", candidate_variant(candidate));
    add_values(tree, object, candidate);
}

static void add_causes(struct json_tree *tree, cJSON *verdict, const char *key, int count, const struct candidate *candidate)
{
    cJSON *list = json_array(tree, verdict, key);
    for (int i = 0; i < count; i++)
        add_cause(tree, json_object(tree, list, NULL), &candidate[i]);
}

void json_verdict(struct json_tree *tree, const struct diagnosis *d)
{
    cJSON *verdict = json_object(tree, tree->root, "verdict");
    json_text(tree, verdict, "kind", d->sentence ? verdict_name(d->kind) : NULL);
    json_flag(tree, verdict, "adequate_after", d->adequate_after);
    json_number(tree, verdict, "p_value", d->p_value);
    add_causes(tree, verdict, "causes", d->ncause, d->cause);
    cJSON *list = json_array(tree, verdict, "alternatives");
    for (int i = 0; i < d->nalternative; i++)
        json_text(tree, list, NULL, d->alternative[i].cause->id);
    add_causes(tree, verdict, "alternative_causes", d->nalternative, d->alternative);
    json_text(tree, verdict, "next_measurement", d->next_measurement);
    json_text(tree, verdict, "sentence", d->sentence);
    json_number(tree, verdict, "undetermined_parameters", d->undetermined);
}

static void add_candidate(struct json_tree *tree, cJSON *object, int round, const struct candidate *c)
{
    json_number(tree, object, "round", round);
    add_cause(tree, object, c);
    json_flag(tree, object, "suspect", c->suspect);
    json_flag(tree, object, "refitted", c->refitted);
    json_number(tree, object, "predicted_drop", c->predicted_drop);
    if (c->refitted) {
        json_number(tree, object, "chi2", c->chi2);
        json_number(tree, object, "chi2_frequency", c->chi2_frequency);
        json_number(tree, object, "chi2_drop", c->chi2_drop);
        json_number(tree, object, "bic", c->bic);
        json_number(tree, object, "holdout_rms", c->holdout_rms);
        json_number(tree, object, "mode_out_rms", c->mode_out_rms);
        json_number(tree, object, "sensor_out_rms", c->sensor_out_rms);
    } else {
        static const char *const keys[] = {"chi2",        "chi2_frequency", "chi2_drop",     "bic",
                                           "holdout_rms", "mode_out_rms",   "sensor_out_rms"};
        for (int i = 0; i < 7; i++)
            json_null(tree, object, keys[i]);
    }
    json_number(tree, object, "p_value", c->p_value);
    json_flag(tree, object, "at_bound", c->at_bound);
    json_text(tree, object, "collinear_with", c->collinear_with);
    json_text(tree, object, "collinear_target", c->collinear_target);
    if (c->collinear_with)
        json_number(tree, object, "cosine", c->cosine);
    else
        json_null(tree, object, "cosine");
    json_text(tree, object, "rejected_because", c->rejected_because);
}

void json_rounds(struct json_tree *tree, const struct diagnosis *d)
{
    cJSON *rounds = json_array(tree, tree->root, "rounds"), *candidates = json_array(tree, tree->root, "candidates");
    for (int i = 0; i < d->nround; i++) {
        const struct diagnosis_round *round = &d->round[i];
        cJSON *item = json_object(tree, rounds, NULL);
        json_number(tree, item, "round", i + 1);
        json_text(tree, item, "kind", verdict_name(round->kind));
        json_number(tree, item, "chi2", round->chi2);
        json_number(tree, item, "chi2_frequency", round->chi2_frequency);
        json_number(tree, item, "dof", round->dof);
        json_number(tree, item, "frequencies", round->nfrequency);
        json_number(tree, item, "largest", round->largest);
        json_number(tree, item, "threshold", round->threshold);
        json_number(tree, item, "p_scan", round->p_scan);
        json_number(tree, item, "p_frequency", round->p_frequency);
        json_number(tree, item, "p_total", round->p_total);
        json_number(tree, item, "required_margin", round->required_margin);
        json_number(tree, item, "set", round->nset);
        for (int k = 0; k < round->ncandidate; k++)
            add_candidate(tree, json_object(tree, candidates, NULL), i + 1, &round->candidate[k]);
    }
}
