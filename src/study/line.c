#include "study/line.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "diagnose/items.h"
#include "result/json_tree.h"
#include "study/score.h"

/* Which run it is. */
static void begin(struct json_tree *tree, const struct line *line)
{
    const struct plan *plan = line->study->plan;
    const struct study_cell *cell = &line->point.cell;
    const struct plan_noise *noise = &plan->noise[cell->noise];
    json_open(tree);
    json_number(tree, tree->root, "run", (double)line->run);
    cJSON *object = json_object(tree, tree->root, "cell");
    json_text(tree, object, "deck", plan->deck[cell->deck].name);
    json_text(tree, object, "variant", plan->variant[cell->variant].name);
    json_text(tree, object, "modes", plan->modes[cell->modes].text);
    json_text(tree, object, "sensors", plan->sensors[cell->sensors].text);
    json_number(tree, object, "noise_frequency", plan->has_noise ? noise->frequency : NAN);
    json_number(tree, object, "noise_shape", plan->has_noise ? noise->shape : NAN);
    json_text(tree, object, "hide", plan->hide[cell->hide].name);
    json_number(tree, tree->root, "replicate", (double)line->point.replicate);
    json_number(tree, tree->root, "start", (double)line->point.start);
}

/* seconds stand last, before the stamp: so two lines can be compared without them */
static char *end(struct json_tree *tree, double seconds)
{
    json_number(tree, tree->root, "seconds", round(seconds * 1e6) / 1e6);
    return json_close_line(tree);
}

char *line_failed(const struct line *line, const char *error, double seconds)
{
    struct json_tree tree;
    begin(&tree, line);
    json_text(&tree, tree.root, "status", "failed");
    json_text(&tree, tree.root, "error", error);
    return end(&tree, seconds);
}

static void add_parameters(struct json_tree *tree, const struct job *job, const rotid_fit_result *fit, const double *truth)
{
    cJSON *list = json_array(tree, tree->root, "parameters");
    for (int p = 0; p < fit->n; p++) {
        const double interval[2] = {fit->ci_lower[p], fit->ci_upper[p]};
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "name", job->bounds[p].name);
        json_text(tree, item, "unit", job->bounds[p].unit);
        json_number(tree, item, "value", fit->x[p]);
        json_number(tree, item, "start", job->bounds[p].start);
        json_number(tree, item, "std", fit->std[p]);
        json_list(tree, item, "ci95", 2, interval);
        json_flag(tree, item, "at_bound", fit->at_bound[p]);
        json_flag(tree, item, "identifiable", fit->identifiable[p]);
        json_number(tree, item, "truth", truth ? truth[p] : NAN);
    }
}

static void add_modes(struct json_tree *tree, const struct job *job, const struct comparison *compared,
                      const rotid_fit_result *fit)
{
    cJSON *list = json_array(tree, tree->root, "modes");
    for (int k = 0; k < fit->m; k++) {
        cJSON *item = json_object(tree, list, NULL);
        json_number(tree, item, "mode", compared->number[k]);
        json_number(tree, item, "measured_hz", job->frequency_hz[k]);
        json_number(tree, item, "predicted_hz", fit->predicted_hz[k]);
        json_number(tree, item, "error_percent", 100 * (fit->predicted_hz[k] / job->frequency_hz[k] - 1));
        json_number(tree, item, "nco", compared->nco[k]);
        json_flag(tree, item, "holdout", job->holdout && job->holdout[k]);
    }
}

static void add_fit(struct json_tree *tree, const struct job *job, const struct comparison *compared, const rotid_fit_result *fit,
                    const double *truth)
{
    json_text(tree, tree->root, "status", !fit->converged ? "not_converged" : fit->any_at_bound ? "at_bound" : "converged");
    json_null(tree, tree->root, "error");
    json_text(tree, tree->root, "functional", functional_name(job->fit.functional));
    json_text(tree, tree->root, "reduction", reduction_name(job->fit.reduction));
    json_number(tree, tree->root, "objective", fit->objective);
    json_number(tree, tree->root, "chi2_per_dof", fit->chi2_per_dof);
    json_number(tree, tree->root, "dof", fit->dof);
    json_number(tree, tree->root, "iterations", fit->iterations);
    json_number(tree, tree->root, "evaluations", fit->evaluations);
    json_text(tree, tree->root, "stop_reason", rotid_status_text(fit->status));
    json_number(tree, tree->root, "sensors", job->rotor.nsensor);
    add_parameters(tree, job, fit, truth);
    add_modes(tree, job, compared, fit);
}

/* What acts in the data and not in the fitted model, with the values drawn for it. */
static void add_hidden(struct json_tree *tree, const struct experiment *experiment)
{
    const struct truth *truth = experiment->made_by;
    const struct effect_parameter_name *parameter;
    if (!truth || !truth->cause) {
        json_null(tree, tree->root, "hidden");
        return;
    }
    cJSON *object = json_object(tree, tree->root, "hidden");
    json_text(tree, object, "id", truth->cause->id);
    cJSON *list = json_array(tree, object, "parameters");
    for (int p = 0; (parameter = truth_parameter(truth, p)); p++) {
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "name", parameter->name);
        json_text(tree, item, "unit", parameter->unit);
        json_number(tree, item, "value", truth->effect ? truth->effect->value[p] : truth->fault.value);
    }
}

static void add_baseline(struct json_tree *tree, const rotid_fit_result *fit)
{
    cJSON *list = json_array(tree, tree->root, "baseline");
    for (int i = 0; i < fit->nbaseline; i++) {
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "algorithm", fit->baseline[i].algorithm);
        json_flag(tree, item, "usable", fit->baseline[i].usable);
        json_number(tree, item, "objective", fit->baseline[i].objective);
        json_number(tree, item, "evaluations", fit->baseline[i].evaluations);
        json_list(tree, item, "x", fit->n, fit->baseline[i].x);
    }
}

char *line_identified(const struct line *line, const struct experiment *experiment, const struct identification *result,
                      const struct message_list *notes)
{
    struct json_tree tree;
    begin(&tree, line);
    add_fit(&tree, &experiment->job, &result->compared, result->fit, experiment->truth);
    add_hidden(&tree, experiment);
    if (line->study->plan->spread > 0) /* the way from each start is what such a plan is about */
        json_digits(&tree, tree.root, "iterates", result->fit->n * result->fit->nhistory, result->fit->history_x);
    if (line->study->plan->baseline)
        add_baseline(&tree, result->fit);
    json_notes(&tree, notes);
    return end(&tree, clock_seconds() - line->begin);
}

static void add_cause(struct json_tree *tree, cJSON *list, const struct candidate *candidate)
{
    const struct effect_parameter_name *parameter;
    cJSON *object = json_object(tree, list, NULL), *values;
    json_text(tree, object, "id", candidate->cause->id);
    json_text(tree, object, "target", candidate->target ? candidate->target : "");
    values = json_array(tree, object, "parameters");
    for (int p = 0; (parameter = candidate_parameter(candidate, p)); p++) {
        cJSON *item = json_object(tree, values, NULL);
        json_text(tree, item, "name", parameter->name);
        json_text(tree, item, "unit", parameter->unit);
        json_number(tree, item, "value", candidate->effect.value[p]);
        json_number(tree, item, "std", candidate->std[p]);
    }
}

static void add_verdict(struct json_tree *tree, const struct diagnosis *d)
{
    cJSON *verdict = json_object(tree, tree->root, "verdict"), *list;
    json_text(tree, verdict, "kind", verdict_name(d->kind));
    json_flag(tree, verdict, "adequate_after", d->adequate_after);
    json_number(tree, verdict, "p_value", d->p_value);
    list = json_array(tree, verdict, "causes");
    for (int i = 0; i < d->ncause; i++)
        add_cause(tree, list, &d->cause[i]);
    list = json_array(tree, verdict, "alternatives");
    for (int i = 0; i < d->nalternative; i++)
        add_cause(tree, list, &d->alternative[i]);
    list = json_array(tree, tree->root, "data_findings");
    for (int i = 0; i < d->ndata_finding; i++) {
        const struct data_finding *finding = &d->data_finding[i];
        cJSON *item = json_object(tree, list, NULL), *sensors;
        json_text(tree, item, "id", finding->cause->id);
        sensors = json_array(tree, item, "sensors");
        for (int s = 0; s < finding->nsensor; s++)
            json_number(tree, sensors, NULL, finding->sensor[s]);
        json_text(tree, item, "block", finding->block);
        json_number(tree, item, "value", finding->value);
    }
}

/* What a parameter of the extended model is in truth: one of the experiment, or one of the hidden effect where it was named. */
static double extended_truth(const struct experiment *experiment, const struct diagnosis *d, const char *name)
{
    const struct truth *truth = experiment->made_by;
    const char *dot = strrchr(name, '.');
    for (int p = 0; p < experiment->job.nparameter; p++)
        if (same_text(name, experiment->job.bounds[p].name))
            return experiment->truth[p];
    for (int i = 0; i < d->ncause && dot; i++) {
        const struct candidate *c = &d->cause[i];
        size_t length = strlen(c->effect.name);
        if (c->cause != truth->cause || c->effect.variant != truth->effect->variant || !score_is_hidden(experiment, d, c) ||
            (size_t)(dot - name) != length || strncmp(name, c->effect.name, length) != 0)
            continue;
        for (int p = 0; truth_parameter(truth, p); p++)
            if (same_text(dot + 1, truth_parameter(truth, p)->name))
                return truth->effect->value[p];
    }
    return NAN;
}

char *line_diagnosed(const struct line *line, const struct experiment *experiment, const struct diagnosis *d,
                     const struct message_list *notes)
{
    const struct job *job = d->extended.fit ? &d->extended_job : &d->job;
    const struct identification *final = d->extended.fit ? &d->extended : &d->base;
    struct json_tree tree;
    struct pool pool;
    pool_open(&pool, NULL);
    begin(&tree, line);
    double *truth = POOL_ARRAY(&pool, double, job->nparameter);
    for (int p = 0; p < job->nparameter && truth && experiment->made_by; p++)
        truth[p] = extended_truth(experiment, d, job->bounds[p].name);
    if (final->fit && truth)
        add_fit(&tree, job, &final->compared, final->fit, experiment->made_by ? truth : NULL);
    else
        tree.failed = 1;
    add_hidden(&tree, experiment);
    add_verdict(&tree, d);
    json_text(&tree, tree.root, "score", experiment->made_by ? score_name(score_make(experiment, d)) : NULL);
    json_number(&tree, tree.root, "false_findings", experiment->made_by ? (double)score_false_findings(experiment, d) : NAN);
    json_notes(&tree, notes);
    pool_close(&pool);
    return end(&tree, clock_seconds() - line->begin);
}
