#include "report/json.h"

#include <cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void add_number(cJSON *object, const char *key, double value)
{
    if (isfinite(value))
        (void)cJSON_AddNumberToObject(object, key, value);
    else
        (void)cJSON_AddNullToObject(object, key);
}

static void append(cJSON *array, double value)
{
    (void)cJSON_AddItemToArray(array, isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull());
}

/* Bytes of the UTF-8 character that begins here, 0 where there is none (RFC 3629). */
static size_t utf8_bytes(const unsigned char *c)
{
    size_t bytes = *c < 0x80 ? 1 : *c < 0xc2 ? 0 : *c < 0xe0 ? 2 : *c < 0xf0 ? 3 : *c < 0xf5 ? 4 : 0;
    for (size_t i = 1; i < bytes; i++)
        if ((c[i] & 0xc0) != 0x80)
            return 0;
    if ((*c == 0xe0 && c[1] < 0xa0) || (*c == 0xed && c[1] > 0x9f) || (*c == 0xf0 && c[1] < 0x90) || (*c == 0xf4 && c[1] > 0x8f))
        return 0;
    return bytes;
}

/* A text of the user, in whatever encoding: what is not UTF-8 becomes U+FFFD. */
static cJSON *user_text(const char *text)
{
    char *clean = malloc(3 * strlen(text) + 1), *end = clean;
    while (clean && *text) {
        size_t bytes = utf8_bytes((const unsigned char *)text);
        memcpy(end, bytes ? text : "\xef\xbf\xbd", bytes ? bytes : 3);
        end += bytes ? bytes : 3;
        text += bytes ? bytes : 1;
    }
    if (clean)
        *end = 0;
    cJSON *item = clean ? cJSON_CreateString(clean) : NULL;
    free(clean);
    return item;
}

static void add_list(cJSON *object, const char *key, int count, const double *value)
{
    cJSON *array = cJSON_AddArrayToObject(object, key);
    for (int i = 0; i < count && array; i++)
        append(array, value[i]);
}

/* rows of a column-major matrix */
static void add_matrix(cJSON *object, const char *key, int rows, int columns, const double *value)
{
    cJSON *array = cJSON_AddArrayToObject(object, key);
    for (int i = 0; i < rows && array; i++) {
        cJSON *row = cJSON_CreateArray();
        for (int j = 0; j < columns && row; j++)
            append(row, value[i + (ptrdiff_t)j * rows]);
        (void)cJSON_AddItemToArray(array, row);
    }
}

static cJSON *begin(const struct provenance *provenance, const struct job *job)
{
    cJSON *root = cJSON_CreateObject();
    (void)cJSON_AddNumberToObject(root, "schema", 1);
    (void)cJSON_AddStringToObject(root, "rotid", provenance->version);
    (void)cJSON_AddStringToObject(root, "commit", provenance->commit);
    (void)cJSON_AddStringToObject(root, "blas", provenance->blas);
    (void)cJSON_AddNumberToObject(root, "seed", (double)provenance->seed);
    (void)cJSON_AddNumberToObject(root, "threads", provenance->threads);
    (void)cJSON_AddStringToObject(root, "command", provenance->command);
    (void)cJSON_AddItemToObject(root, "deck", user_text(job->deck));
    cJSON *heading = cJSON_AddArrayToObject(root, "heading");
    for (int i = 0; i < job->nheading; i++)
        (void)cJSON_AddItemToArray(heading, user_text(job->heading[i]));
    return root;
}

static void add_notes(cJSON *root, const struct message_list *notes)
{
    cJSON *array = cJSON_AddArrayToObject(root, "warnings");
    for (size_t i = 0; i < notes->count; i++)
        if (notes->item[i].severity == SEVERITY_WARNING)
            (void)cJSON_AddItemToArray(array, user_text(notes->item[i].text));
}

static char *finish(cJSON *root)
{
    char *text = cJSON_Print(root);
    cJSON_Delete(root);
    return text;
}

void json_free(char *text)
{
    cJSON_free(text);
}

char *json_check(const struct provenance *provenance, const struct job *job, const struct mass_properties *mass,
                 const struct spectrum *spectrum, const struct message_list *notes)
{
    const struct rotor *rotor = &job->rotor;
    cJSON *root = begin(provenance, job), *sensors, *parameters;
    add_number(root, "length_m", rotor_length(rotor));
    add_number(root, "mass_kg", mass->mass);
    add_number(root, "center_of_mass_m", mass->center);
    add_number(root, "inertia_kg_m2", mass->inertia);
    add_number(root, "nodes", spectrum->nnode);
    add_number(root, "elements", spectrum->nnode - 1);
    add_number(root, "rigid_modes", spectrum->nrigid);
    add_list(root, "rigid_hz", spectrum->nrigid, spectrum->rigid_hz);
    add_number(root, "measured_modes", job->nmode);
    (void)cJSON_AddStringToObject(root, "functional", functional_name(job->fit.functional));
    (void)cJSON_AddStringToObject(root, "reduction", reduction_name(job->fit.reduction));
    sensors = cJSON_AddArrayToObject(root, "sensors");
    for (int s = 0; s < rotor->nsensor; s++) {
        cJSON *item = cJSON_CreateObject();
        add_number(item, "id", rotor->sensor[s].id);
        add_number(item, "z_m", rotor->sensor[s].position);
        (void)cJSON_AddItemToArray(sensors, item);
    }
    parameters = cJSON_AddArrayToObject(root, "parameters");
    for (int p = 0; p < job->nparameter; p++)
        (void)cJSON_AddItemToArray(parameters, user_text(job->bounds[p].name));
    add_notes(root, notes);
    return finish(root);
}

static void add_measured_mode(cJSON *item, const struct job *job, const struct comparison *compared, int k, double predicted)
{
    add_number(item, "measured_hz", job->frequency_hz[k]);
    add_number(item, "predicted_hz", predicted);
    add_number(item, "error_percent", 100 * (predicted / job->frequency_hz[k] - 1));
    add_number(item, "mac", compared->mac[k]);
    add_number(item, "nco", compared->nco[k]);
    (void)cJSON_AddStringToObject(item, "paired_by", compared->basis[k] == PAIRED_BY_SHAPE ? "shape" : "number");
    (void)cJSON_AddBoolToObject(item, "holdout", job->holdout && job->holdout[k]);
}

char *json_modes(const struct provenance *provenance, const struct job *job, const struct spectrum *s,
                 const struct comparison *compared, const struct message_list *notes)
{
    cJSON *root = begin(provenance, job), *modes;
    (void)cJSON_AddStringToObject(root, "reduction", job->fit.reduction == ROTID_IRS ? "IRS" : "GUYAN");
    add_list(root, "rigid_hz", s->nrigid, s->rigid_hz);
    add_list(root, "sensor_z_m", s->nmaster, s->master_z);
    modes = cJSON_AddArrayToObject(root, "modes");
    for (int j = 0; j < s->count; j++) {
        cJSON *item = cJSON_CreateObject();
        add_number(item, "mode", j + 1);
        add_number(item, "full_hz", s->full_hz[j]);
        add_number(item, "reduced_hz", s->reduced_hz[j]);
        add_number(item, "reduction_error_percent", s->reduction_error_percent[j]);
        add_number(item, "mesh_error_percent", s->mesh_error_percent[j]);
        add_list(item, "shape", s->nmaster, s->shape + (ptrdiff_t)j * s->nmaster);
        for (int k = 0; k < compared->nmode; k++)
            if (compared->number[k] == j + 1)
                add_measured_mode(item, job, compared, k, s->full_hz[j]);
        (void)cJSON_AddItemToArray(modes, item);
    }
    add_notes(root, notes);
    return finish(root);
}

char *json_sensitivity(const struct provenance *provenance, const struct job *job, const rotid_parameter *parameter,
                       const struct sensitivity_options *options, const struct sensitivity *result)
{
    cJSON *root = begin(provenance, job), *list;
    (void)cJSON_AddStringToObject(root, "reduction", reduction_name(job->fit.reduction));
    add_number(root, "step", options->step);
    add_list(root, "frequency_hz", result->m, result->hz);
    add_list(root, "relative_value", result->points, result->relative);
    list = cJSON_AddArrayToObject(root, "parameters");
    for (int p = 0; p < result->n; p++) {
        cJSON *item = cJSON_CreateObject();
        (void)cJSON_AddItemToObject(item, "name", user_text(parameter[p].name));
        (void)cJSON_AddStringToObject(item, "unit", parameter[p].unit);
        add_number(item, "reference", result->reference[p]);
        add_list(item, "sensitivity", result->m, result->difference + (ptrdiff_t)p * result->m);
        add_list(item, "derivative", result->m, result->derivative + (ptrdiff_t)p * result->m);
        add_matrix(item, "curves", result->m, result->points, result->curve + (ptrdiff_t)p * result->m * result->points);
        (void)cJSON_AddItemToArray(list, item);
    }
    return finish(root);
}

static void add_parameters(cJSON *root, const struct job *job, const rotid_fit_result *fit)
{
    cJSON *list = cJSON_AddArrayToObject(root, "parameters");
    for (int p = 0; p < fit->n; p++) {
        const double interval[2] = {fit->ci_lower[p], fit->ci_upper[p]};
        cJSON *item = cJSON_CreateObject();
        (void)cJSON_AddItemToObject(item, "name", user_text(job->bounds[p].name));
        (void)cJSON_AddStringToObject(item, "unit", job->bounds[p].unit);
        add_number(item, "value", fit->x[p]);
        add_number(item, "start", job->bounds[p].start);
        add_number(item, "lower", job->bounds[p].lower);
        add_number(item, "upper", job->bounds[p].upper);
        add_number(item, "std", fit->std[p]);
        add_list(item, "ci95", 2, interval);
        (void)cJSON_AddBoolToObject(item, "at_bound", fit->at_bound[p]);
        (void)cJSON_AddBoolToObject(item, "identifiable", fit->identifiable[p]);
        (void)cJSON_AddItemToArray(list, item);
    }
    add_matrix(root, "correlation", fit->n, fit->n, fit->correlation);
    add_number(root, "condition_number", fit->condition_number);
    cJSON *directions = cJSON_AddArrayToObject(root, "undetermined_directions");
    for (int j = 0; j < fit->n; j++) {
        if (!fit->direction_undetermined[j])
            continue;
        cJSON *direction = cJSON_CreateObject();
        for (int p = 0; p < fit->n; p++)
            add_number(direction, job->bounds[p].name, fit->direction[p + (ptrdiff_t)j * fit->n]);
        (void)cJSON_AddItemToArray(directions, direction);
    }
}

static void add_fitted_modes(cJSON *root, const struct job *job, const struct identification *result)
{
    const rotid_fit_result *fit = result->fit;
    const struct spectrum *s = &result->spectrum;
    cJSON *modes = cJSON_AddArrayToObject(root, "modes"), *reduction = cJSON_AddArrayToObject(root, "reduction_error_percent"),
          *mesh = cJSON_AddArrayToObject(root, "mesh_error_percent");
    for (int k = 0; k < fit->m; k++) {
        int j = result->compared.number[k] - 1;
        cJSON *item = cJSON_CreateObject();
        add_number(item, "mode", j + 1);
        add_measured_mode(item, job, &result->compared, k, fit->predicted_hz[k]);
        add_number(item, "residual", fit->residual[k]);
        (void)cJSON_AddItemToArray(modes, item);
        append(reduction, s->reduction_error_percent[j]);
        append(mesh, s->mesh_error_percent[j]);
    }
}

static void add_history(cJSON *root, const rotid_fit_result *fit)
{
    cJSON *history = cJSON_AddArrayToObject(root, "history"), *baseline;
    for (int i = 0; i < fit->nhistory; i++) {
        const rotid_fit_iteration *now = &fit->history[i];
        cJSON *item = cJSON_CreateObject();
        add_number(item, "iteration", now->iteration);
        add_number(item, "objective", now->objective);
        add_number(item, "gradient", now->gradient);
        add_number(item, "mu", now->mu);
        add_number(item, "gain_ratio", now->gain_ratio);
        add_number(item, "step", now->step);
        add_list(item, "x", fit->n, fit->history_x + (ptrdiff_t)i * fit->n);
        (void)cJSON_AddItemToArray(history, item);
    }
    baseline = cJSON_AddArrayToObject(root, "baseline");
    for (int i = 0; i < fit->nbaseline; i++) {
        const rotid_baseline *b = &fit->baseline[i];
        cJSON *item = cJSON_CreateObject();
        (void)cJSON_AddStringToObject(item, "algorithm", b->algorithm);
        (void)cJSON_AddStringToObject(item, "result", b->result);
        (void)cJSON_AddBoolToObject(item, "usable", b->usable);
        add_number(item, "objective", b->objective);
        add_number(item, "gradient", b->gradient);
        add_number(item, "evaluations", b->evaluations);
        add_number(item, "seconds", b->seconds);
        add_list(item, "x", fit->n, b->x);
        (void)cJSON_AddItemToArray(baseline, item);
    }
}

char *json_identify(const struct provenance *provenance, const struct job *job, const struct identification *result,
                    const struct message_list *notes)
{
    const rotid_fit_result *fit = result->fit;
    cJSON *root = begin(provenance, job);
    (void)cJSON_AddStringToObject(root, "status",
                                  !fit->converged     ? "not_converged"
                                  : fit->any_at_bound ? "at_bound"
                                                      : "converged");
    (void)cJSON_AddStringToObject(root, "functional", functional_name(job->fit.functional));
    (void)cJSON_AddStringToObject(root, "reduction", reduction_name(job->fit.reduction));
    (void)cJSON_AddStringToObject(root, "derivative", derivative_name(job->fit.derivative));
    add_number(root, "objective", fit->objective);
    add_number(root, "gradient", fit->gradient);
    add_number(root, "chi2", fit->chi2);
    add_number(root, "chi2_per_dof", fit->chi2_per_dof);
    add_number(root, "dof", fit->dof);
    add_number(root, "iterations", fit->iterations);
    add_number(root, "evaluations", fit->evaluations);
    add_number(root, "jacobians", fit->jacobians);
    (void)cJSON_AddStringToObject(root, "stop_reason", rotid_status_text(fit->status));
    add_parameters(root, job, fit);
    add_number(root, "intervals_widened_by", fit->widened_by);
    add_fitted_modes(root, job, result);
    add_number(root, "mass_kg", result->mass.mass);
    add_number(root, "center_of_mass_m", result->mass.center);
    add_history(root, fit);
    add_number(root, "seconds", fit->seconds);
    add_notes(root, notes);
    return finish(root);
}
