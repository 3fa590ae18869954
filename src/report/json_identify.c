#include "report/json_identify.h"

#include <math.h>

#include "base/order.h"
#include "fit/baseline.h"
#include "report/json_geometry.h"
#include "report/json_shapes.h"

void json_measured_mode(struct json_tree *tree, cJSON *item, const struct job *job, const struct comparison *compared, int k,
                        double predicted)
{
    json_number(tree, item, "measured_mode", job->number[k]);
    json_number(tree, item, "measured_hz", job->frequency_hz[k]);
    json_number(tree, item, "frequency_std", job->frequency_std ? job->frequency_std[k] : NAN);
    json_number(tree, item, "predicted_hz", predicted);
    json_number(tree, item, "error_percent", 100 * (predicted / job->frequency_hz[k] - 1));
    json_number(tree, item, "mac", compared->mac[k]);
    json_number(tree, item, "nco", compared->nco[k]);
    json_text(tree, item, "paired_by", compared->basis[k] == PAIRED_BY_SHAPE ? "shape" : "number");
    json_flag(tree, item, "holdout", job->holdout && job->holdout[k]);
}

static void add_parameters(struct json_tree *tree, cJSON *object, const struct job *job, const rotid_fit_result *fit)
{
    cJSON *list = json_array(tree, object, "parameters");
    for (int p = 0; p < fit->n; p++) {
        const double interval[2] = {fit->ci_lower[p], fit->ci_upper[p]};
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "name", job->bounds[p].name);
        json_text(tree, item, "unit", job->bounds[p].unit);
        json_number(tree, item, "value", fit->x[p]);
        json_number(tree, item, "start", job->bounds[p].start);
        json_number(tree, item, "lower", job->bounds[p].lower);
        json_number(tree, item, "upper", job->bounds[p].upper);
        json_number(tree, item, "std", fit->std[p]);
        json_list(tree, item, "ci95", 2, interval);
        json_flag(tree, item, "at_bound", fit->at_bound[p]);
        json_flag(tree, item, "identifiable", fit->identifiable[p]);
    }
    json_matrix(tree, object, "correlation", fit->n, fit->n, fit->correlation);
    json_number(tree, object, "condition_number", fit->condition_number);
    cJSON *directions = json_array(tree, object, "undetermined_directions");
    for (int j = 0; j < fit->n; j++) {
        if (!fit->direction_undetermined[j])
            continue;
        cJSON *direction = json_object(tree, directions, NULL);
        for (int p = 0; p < fit->n; p++)
            json_number(tree, direction, job->bounds[p].name, fit->direction[p + (ptrdiff_t)j * fit->n]);
    }
}

static void add_fitted_modes(struct json_tree *tree, cJSON *object, const struct job *job, const struct identification *result)
{
    const rotid_fit_result *fit = result->fit;
    const struct spectrum *s = &result->spectrum;
    cJSON *modes = json_array(tree, object, "modes"), *reduction = json_array(tree, object, "reduction_error_percent"),
          *mesh = json_array(tree, object, "mesh_error_percent");
    for (int k = 0; k < fit->m; k++) {
        int j = result->compared.number[k] - 1;
        cJSON *item = json_object(tree, modes, NULL);
        json_number(tree, item, "mode", j + 1);
        json_measured_mode(tree, item, job, &result->compared, k, fit->predicted_hz[k]);
        json_number(tree, item, "residual", fit->residual[k]);
        json_number(tree, reduction, NULL, s->reduction_error_percent[j]);
        json_number(tree, mesh, NULL, s->mesh_error_percent[j]);
    }
}

static void add_history(struct json_tree *tree, cJSON *object, const struct identification *result)
{
    const rotid_fit_result *fit = result->fit;
    cJSON *history = json_array(tree, object, "history"), *baseline;
    for (int i = 0; i < fit->nhistory; i++) {
        const rotid_fit_iteration *now = &fit->history[i];
        cJSON *item = json_object(tree, history, NULL);
        json_number(tree, item, "iteration", now->iteration);
        json_number(tree, item, "objective", now->objective);
        json_number(tree, item, "gradient", now->gradient);
        json_number(tree, item, "mu", now->mu);
        json_number(tree, item, "gain_ratio", now->gain_ratio);
        json_number(tree, item, "step", now->step);
        json_number(tree, item, "seconds", now->seconds);
        json_list(tree, item, "x", fit->n, fit->history_x + (ptrdiff_t)i * fit->n);
    }
    json_flag(tree, object, "nlopt", baseline_exists());
    baseline = json_array(tree, object, "baseline");
    for (int i = 0; i < fit->nbaseline; i++) {
        const rotid_baseline *b = &fit->baseline[i];
        cJSON *item = json_object(tree, baseline, NULL);
        json_text(tree, item, "algorithm", b->algorithm);
        json_text(tree, item, "result", b->result);
        json_flag(tree, item, "usable", b->usable);
        json_number(tree, item, "objective", b->objective);
        json_number(tree, item, "gradient", b->gradient);
        json_number(tree, item, "evaluations", b->evaluations);
        json_number(tree, item, "seconds", b->seconds);
        json_list(tree, item, "x", fit->n, b->x);
        json_list(tree, item, "predicted_hz", fit->m, result->baseline_hz + (ptrdiff_t)i * fit->m);
    }
}

/* of (30), where the deck leaves it open */
static double bijection_chi(const struct job *job)
{
    rotid_fit_options standard;
    rotid_fit_defaults(sizeof standard, &standard);
    return job->fit.bijection_chi > 0 ? job->fit.bijection_chi : standard.bijection_chi;
}

void json_identification(struct json_tree *tree, cJSON *object, const struct job *job, const struct identification *result)
{
    const rotid_fit_result *fit = result->fit;
    json_text(tree, object, "status", !fit->converged ? "not_converged" : fit->any_at_bound ? "at_bound" : "converged");
    json_text(tree, object, "functional", functional_name(job->fit.functional));
    json_text(tree, object, "reduction", reduction_name(job->fit.reduction));
    json_text(tree, object, "derivative", derivative_name(job->fit.derivative));
    json_flag(tree, object, "shapes_fitted", result->shapes_fitted);
    json_number(tree, object, "bijection_chi", bijection_chi(job));
    json_number(tree, object, "objective", fit->objective);
    json_number(tree, object, "gradient", fit->gradient);
    json_number(tree, object, "chi2", fit->chi2);
    json_number(tree, object, "chi2_per_dof", fit->chi2_per_dof);
    json_number(tree, object, "dof", fit->dof);
    json_number(tree, object, "iterations", fit->iterations);
    json_number(tree, object, "evaluations", fit->evaluations);
    json_number(tree, object, "jacobians", fit->jacobians);
    json_text(tree, object, "stop_reason", rotid_status_text(fit->status));
    add_parameters(tree, object, job, fit);
    json_number(tree, object, "intervals_widened_by", fit->widened_by);
    add_fitted_modes(tree, object, job, result);
    json_number(tree, object, "mass_kg", result->mass.mass);
    json_number(tree, object, "center_of_mass_m", result->mass.center);
    json_shapes(tree, object, job, result);
    add_history(tree, object, result);
    json_number(tree, object, "seconds", fit->seconds);
}

/* The middle one of the deviations that are known of what was measured. */
static double typical(ptrdiff_t count, const double *measured, const double *std, double *known)
{
    size_t found = 0;
    for (ptrdiff_t i = 0; i < count; i++)
        if (isfinite(measured[i]) && isfinite(std[i]))
            known[found++] = std[i];
    return median_of(found, known);
}

static void add_noise(struct json_tree *tree, const struct job *job, const rotid_fit_result *fit)
{
    ptrdiff_t components = job->shape && job->shape_std ? (ptrdiff_t)job->rotor.nsensor * job->nmode : 0;
    struct pool pool;
    pool_open(&pool, NULL);
    double *work = POOL_ARRAY(&pool, double, components + job->nmode);
    cJSON *noise = json_object(tree, tree->root, "noise");
    tree->failed |= !work;
    json_number(tree, noise, "frequency", work ? typical(job->nmode, job->frequency_hz, job->frequency_std, work) : NAN);
    json_number(tree, noise, "shape", work ? typical(components, job->shape, job->shape_std, work) : NAN);
    json_flag(tree, noise, "frequency_assumed", 0);
    json_flag(tree, noise, "shape_assumed", 0);
    json_text(tree, noise, "intervals_from", fit->variance_from_residuals ? "residuals" : "noise");
    pool_close(&pool);
}

char *json_identify(const struct provenance *provenance, const struct job *job, const struct identification *result,
                    const struct message_list *notes)
{
    struct json_tree tree;
    json_begin(&tree, provenance, job);
    json_identification(&tree, tree.root, job, result);
    add_noise(&tree, job, result->fit);
    json_geometry(&tree, job, &result->spectrum);
    json_notes(&tree, notes);
    return json_close(&tree);
}
