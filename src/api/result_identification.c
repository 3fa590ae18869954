#include "api/result_identification.h"

#include <math.h>

#include "base/order.h"
#include "fit/baseline.h"
#include "run/mode_shapes.h"

static void fill_parameters(struct result_memory *memory, const struct job *job, const rotid_fit_result *fit,
                            rotid_identification *out)
{
    int undetermined = 0;
    out->nparameters = RESULT_LIST(memory, out->parameters, fit->n);
    for (int p = 0; p < out->nparameters; p++) {
        const rotid_parameter *bounds = &job->unknowns.bounds[p];
        out->parameters[p] = (rotid_fitted_parameter){.name = result_text(memory, bounds->name),
                                                      .unit = result_text(memory, bounds->unit),
                                                      .value = fit->x[p],
                                                      .start = bounds->start,
                                                      .lower = bounds->lower,
                                                      .upper = bounds->upper,
                                                      .std = fit->std[p],
                                                      .ci95 = {fit->ci_lower[p], fit->ci_upper[p]},
                                                      .at_bound = fit->at_bound[p],
                                                      .identifiable = fit->identifiable[p]};
        undetermined += fit->direction_undetermined[p] != 0;
    }
    out->correlation = RESULT_COPY(memory, fit->correlation, (ptrdiff_t)fit->n * fit->n);
    out->condition_number = fit->condition_number;
    rotid_component *next = result_room(memory, (ptrdiff_t)undetermined * fit->n, sizeof *next);
    out->undetermined_directions = next;
    out->nundetermined_directions = next ? undetermined : 0;
    for (int j = 0; j < fit->n && next; j++)
        for (int p = 0; p < fit->n && fit->direction_undetermined[j]; p++)
            *next++ = (rotid_component){out->parameters[p].name, fit->direction[p + (ptrdiff_t)j * fit->n]};
    out->intervals_widened_by = fit->widened_by;
}

rotid_compared_mode result_compared_mode(const struct job *job, const struct comparison *compared, int k, double predicted_hz)
{
    return (rotid_compared_mode){.mode = compared->number[k],
                                 .measured_mode = job->measurement.number[k],
                                 .measured_hz = job->measurement.frequency_hz[k],
                                 .frequency_std =
                                     job->measurement.frequency_std ? job->measurement.frequency_std[k] : (double)NAN,
                                 .predicted_hz = predicted_hz,
                                 .error_percent = 100 * (predicted_hz / job->measurement.frequency_hz[k] - 1),
                                 .mac = compared->mac[k],
                                 .nco = compared->nco[k],
                                 .paired_by = pairing_basis_name(compared->basis[k]),
                                 .holdout = job->measurement.holdout && job->measurement.holdout[k],
                                 .residual = NAN};
}

static void fill_modes(struct result_memory *memory, const struct job *job, const struct identification *found,
                       rotid_identification *out)
{
    const rotid_fit_result *fit = found->fit;
    const struct comparison *compared = &found->compared;
    const struct spectrum *s = &found->spectrum;
    out->reduction_error_percent = result_room(memory, fit->m, sizeof *out->reduction_error_percent);
    out->mesh_error_percent = result_room(memory, fit->m, sizeof *out->mesh_error_percent);
    out->nmodes = RESULT_LIST(memory, out->modes, fit->m);
    if (memory->missing)
        return;
    for (int k = 0; k < out->nmodes; k++) {
        int j = compared->number[k] - 1, is_known = j < s->count; /* the spectrum may end below it */
        out->modes[k] = result_compared_mode(job, compared, k, fit->predicted_hz[k]);
        out->modes[k].residual = fit->residual[k];
        out->reduction_error_percent[k] = is_known ? s->reduction_error_percent[j] : (double)NAN;
        out->mesh_error_percent[k] = is_known ? s->mesh_error_percent[j] : (double)NAN;
    }
}

static void fill_history(struct result_memory *memory, const struct identification *found, rotid_identification *out)
{
    const rotid_fit_result *fit = found->fit;
    out->nhistory = RESULT_LIST(memory, out->history, fit->nhistory);
    for (int i = 0; i < out->nhistory; i++) {
        const rotid_fit_iteration *now = &fit->history[i];
        out->history[i] = (rotid_history_entry){.iteration = now->iteration,
                                                .objective = now->objective,
                                                .gradient = now->gradient,
                                                .mu = now->mu,
                                                .gain_ratio = now->gain_ratio,
                                                .step = now->step,
                                                .seconds = now->seconds,
                                                .nx = fit->n,
                                                .x = fit->history_x + (ptrdiff_t)i * fit->n};
    }
    out->nbaseline = RESULT_LIST(memory, out->baseline, fit->nbaseline);
    for (int i = 0; i < out->nbaseline; i++) {
        const rotid_baseline *b = &fit->baseline[i];
        out->baseline[i] = (rotid_minimiser){.algorithm = b->algorithm,
                                             .result = b->result,
                                             .usable = b->usable,
                                             .objective = b->objective,
                                             .gradient = b->gradient,
                                             .evaluations = b->evaluations,
                                             .seconds = b->seconds,
                                             .nx = fit->n,
                                             .x = b->x,
                                             .npredicted_hz = fit->m};
        out->baseline[i].predicted_hz = RESULT_COPY(memory, found->baseline_hz + (ptrdiff_t)i * fit->m, fit->m);
    }
}

static int knows_noise(const struct job *job, int nsensor, int k)
{
    int known = 0;
    for (int i = 0; i < nsensor && job->measurement.shape_std && !known; i++)
        known = isfinite(job->measurement.shape_std[i + (ptrdiff_t)k * nsensor]);
    return known;
}

static int fill_members(struct result_memory *memory, const struct mode_shapes *shapes, int is_bars, int k,
                        rotid_member_shape **list)
{
    int count = 0;
    if (!RESULT_LIST(memory, *list, shapes->nmember))
        return 0;
    for (int i = 0; i < shapes->nmember; i++) {
        const struct member_shape *member = &shapes->member[i];
        if (member->is_bars == is_bars)
            (*list)[count++] = (rotid_member_shape){.name = result_text(memory, member->name),
                                                    .nz_m = member->npoint,
                                                    .z_m = member->z,
                                                    .shape = member->shape + (ptrdiff_t)k * member->npoint};
    }
    return count;
}

static void fill_mode_shapes(struct result_memory *memory, const struct job *job, const struct mode_shapes *shapes, int k,
                             rotid_mode_shapes *out)
{
    ptrdiff_t at = (ptrdiff_t)k * shapes->nsensor;
    if (shapes->has_shape[k]) {
        out->nmeasured = shapes->nsensor;
        out->measured = shapes->measured + at;
    }
    if (shapes->has_shape[k] && knows_noise(job, shapes->nsensor, k)) {
        out->nmeasured_std = shapes->nsensor;
        out->measured_std = RESULT_COPY(memory, job->measurement.shape_std + at, shapes->nsensor);
    }
    out->npredicted = shapes->nsensor;
    out->predicted = shapes->predicted + at;
    out->npredicted_axis = shapes->naxis;
    out->predicted_axis = shapes->axis + (ptrdiff_t)k * shapes->naxis;
    out->ntierods = fill_members(memory, shapes, 0, k, &out->tierods);
    out->nbars = fill_members(memory, shapes, 1, k, &out->bars);
}

/* The arrays of `shapes` are in the memory of the result. */
static void fill_shapes(struct result_memory *memory, const struct job *job, const struct identification *found,
                        rotid_identification *out)
{
    struct mode_shapes shapes;
    const struct rotor *rotor = found->spectrum.model->rotor;
    if (mode_shapes_make(&memory->pool, job, &found->spectrum, &found->compared, &shapes) ||
        !(out->shapes = RESULT_NEW(memory, rotid_shapes))) {
        memory->missing = 1;
        return;
    }
    rotid_shapes *to = out->shapes;
    to->z_m = result_room(memory, shapes.nsensor, sizeof *to->z_m);
    to->nsensor_id = to->z_m ? RESULT_LIST(memory, to->sensor_id, shapes.nsensor) : 0;
    for (int s = 0; s < to->nsensor_id; s++) {
        to->sensor_id[s] = rotor->sensor[s].id;
        to->z_m[s] = rotor->sensor[s].position;
    }
    to->naxis_z_m = shapes.naxis;
    to->axis_z_m = shapes.axis_z;
    to->nmodes = RESULT_LIST(memory, to->modes, shapes.nmode);
    for (int k = 0; k < to->nmodes; k++) {
        to->modes[k] = (rotid_mode_shapes){.mode = found->compared.number[k], .measured_mode = job->measurement.number[k]};
        fill_mode_shapes(memory, job, &shapes, k, &to->modes[k]);
    }
    if (!shapes.mac)
        return;
    out->nco_matrix = shapes.nco;
    out->mac_matrix = shapes.mac;
    out->matrix_rows = RESULT_COPY(memory, job->measurement.number, shapes.nmode);
    out->nmatrix_rows = out->matrix_rows ? shapes.nmode : 0;
    out->nmatrix_columns = RESULT_LIST(memory, out->matrix_columns, shapes.ncolumn);
    for (int j = 0; j < out->nmatrix_columns; j++)
        out->matrix_columns[j] = j + 1;
}

/* of (30), where the deck leaves it open */
static double bijection_chi(const struct job *job)
{
    rotid_fit_options standard;
    rotid_fit_defaults(sizeof standard, &standard);
    return job->options.fit.bijection_chi > 0 ? job->options.fit.bijection_chi : standard.bijection_chi;
}

rotid_identification *result_identification(struct result_memory *memory, const struct job *job, struct identification *found)
{
    const rotid_fit_result *fit = found->fit;
    if (!fit)
        return NULL;
    memory->fit[memory->nfit++] = found->fit;
    rotid_identification *out = RESULT_NEW(memory, rotid_identification);
    if (out) {
        *out = (rotid_identification){.status = !fit->converged     ? "not_converged"
                                                : fit->any_at_bound ? "at_bound"
                                                                    : "converged",
                                      .functional = functional_words[job->options.fit.functional],
                                      .reduction = reduction_words[job->options.fit.reduction],
                                      .derivative = derivative_words[job->options.fit.derivative],
                                      .shapes_fitted = found->shapes_fitted,
                                      .bijection_chi = bijection_chi(job),
                                      .objective = fit->objective,
                                      .gradient = fit->gradient,
                                      .chi2 = fit->chi2,
                                      .chi2_per_dof = fit->chi2_per_dof,
                                      .dof = fit->dof,
                                      .iterations = fit->iterations,
                                      .evaluations = fit->evaluations,
                                      .jacobians = fit->jacobians,
                                      .stop_reason = rotid_status_text(fit->status),
                                      .mass_kg = found->mass.mass,
                                      .center_of_mass_m = found->mass.center,
                                      .nlopt = baseline_exists(),
                                      .seconds = fit->seconds,
                                      .fit = fit};
        fill_parameters(memory, job, fit, out);
        fill_modes(memory, job, found, out);
        fill_history(memory, found, out);
        if (found->spectrum.model)
            fill_shapes(memory, job, found, out);
    }
    found->fit = NULL;
    return memory->missing ? NULL : out;
}

/* The middle one of the deviations that are known of what was measured. */
static double typical(ptrdiff_t count, const double *measured, const double *std, double *work)
{
    size_t found = 0;
    for (ptrdiff_t i = 0; i < count; i++)
        if (isfinite(measured[i]) && isfinite(std[i]))
            work[found++] = std[i];
    return median_of(found, work);
}

rotid_noise *result_noise(struct result_memory *memory, const struct job *job, const rotid_fit_result *fit)
{
    ptrdiff_t components =
        job->measurement.shape && job->measurement.shape_std ? (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode : 0;
    double *work = result_room(memory, components + job->measurement.nmode, sizeof *work);
    rotid_noise *out = work ? RESULT_NEW(memory, rotid_noise) : NULL;
    if (out)
        *out = (rotid_noise){
            .frequency = typical(job->measurement.nmode, job->measurement.frequency_hz, job->measurement.frequency_std, work),
            .shape = typical(components, job->measurement.shape, job->measurement.shape_std, work),
            .intervals_from = fit->variance_from_residuals ? "residuals" : "noise"};
    return out;
}
