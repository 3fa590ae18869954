#include "api/api.h"
#include "fit/fit.h"

static void fill_parameters(struct pool *pool, const rotid_parameter *list, const rotid_fit_result *fit,
                            rotid_identification *out)
{
    int undetermined = 0;
    out->nparameters = POOL_LIST(pool, out->parameters, fit->n);
    for (int p = 0; p < out->nparameters; p++) {
        const rotid_parameter *bounds = &list[p];
        out->parameters[p] = (rotid_fitted_parameter){.name = bounds->name,
                                                      .unit = bounds->unit,
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
    out->correlation = fit->correlation;
    out->condition_number = fit->condition_number;
    rotid_component *next = POOL_ARRAY(pool, rotid_component, undetermined * fit->n);
    out->undetermined_directions = next;
    out->nundetermined_directions = next ? undetermined : 0;
    for (int j = 0; j < out->nparameters && next; j++)
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
                                 .paired_by = compared->basis[k] == PAIRED_BY_SHAPE ? "shape" : "number",
                                 .holdout = job->measurement.holdout && job->measurement.holdout[k],
                                 .residual = NAN,
                                 .type = mode_type_words[job->options.type]};
}

static void fill_modes(struct pool *pool, const struct job *job, const struct identification *found, rotid_identification *out)
{
    const rotid_fit_result *fit = found->fit;
    const struct comparison *compared = &found->compared;
    const struct spectrum *s = &found->spectrum;
    out->reduction_error_percent = POOL_ARRAY(pool, double, fit->m);
    out->mesh_error_percent = POOL_ARRAY(pool, double, fit->m);
    out->nmodes = out->reduction_error_percent && out->mesh_error_percent ? POOL_LIST(pool, out->modes, fit->m) : 0;
    for (int k = 0; k < out->nmodes; k++) {
        int j = compared->number[k] - 1, is_known = j < s->count; /* the spectrum may end below it */
        out->modes[k] = result_compared_mode(job, compared, k, fit->predicted_hz[k]);
        out->modes[k].residual = fit->residual[k];
        out->reduction_error_percent[k] = is_known ? s->reduction_error_percent[j] : (double)NAN;
        out->mesh_error_percent[k] = is_known ? s->mesh_error_percent[j] : (double)NAN;
    }
}

static void fill_history(struct pool *pool, const struct identification *found, rotid_identification *out)
{
    const rotid_fit_result *fit = found->fit;
    out->nhistory = POOL_LIST(pool, out->history, fit->nhistory);
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
    out->nbaseline = POOL_LIST(pool, out->baseline, fit->nbaseline);
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
                                             .npredicted_hz = fit->m,
                                             .predicted_hz = found->baseline_hz + (ptrdiff_t)i * fit->m};
    }
}

/* of (30), where the deck leaves it open */
static double bijection_chi(const struct job *job)
{
    rotid_fit_options standard;
    rotid_fit_defaults(sizeof standard, &standard);
    return job->options.fit.bijection_chi > 0 ? job->options.fit.bijection_chi : standard.bijection_chi;
}

/* Of a deck that is one state, or of one of several. */
static rotid_identification *of_state(struct pool *pool, const struct job *job, const rotid_parameter *bounds,
                                      const struct identification *found)
{
    const rotid_fit_result *fit = found->fit;
    rotid_identification *out = fit ? POOL_NEW(pool, rotid_identification) : NULL;
    if (!out)
        return NULL;
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
    out->weighed = result_weighed(pool, job, &found->mass, &out->nweighed);
    out->noise = result_noise(pool, job, fit);
    out->geometry = result_geometry(pool, &job->rotor, found->spectrum.model);
    fill_parameters(pool, bounds, fit, out);
    fill_modes(pool, job, found, out);
    fill_history(pool, found, out);
    if (found->spectrum.model && mode_shapes_make(pool, job, &found->spectrum, &found->compared, out))
        return NULL;
    return pool->out_of_memory ? NULL : out;
}

/* The modes of all states, in the order of the fit. */
static int join_modes(struct pool *pool, const struct identification *found, const rotid_fit_result *fit,
                      rotid_identification *out)
{
    out->reduction_error_percent = POOL_ARRAY(pool, double, fit->m);
    out->mesh_error_percent = POOL_ARRAY(pool, double, fit->m);
    out->nmodes = POOL_LIST(pool, out->modes, fit->m);
    int short_of = !out->nmodes || !out->reduction_error_percent || !out->mesh_error_percent;
    for (int b = 0; b < out->nbaseline && !short_of; b++) {
        out->baseline[b].npredicted_hz = POOL_LIST(pool, out->baseline[b].predicted_hz, fit->m);
        short_of = !out->baseline[b].predicted_hz;
    }
    for (int s = 0, mode = 0; s < out->nstates && !short_of; s++)
        for (int k = 0; k < out->states[s].nmodes; k++, mode++) {
            out->modes[mode] = out->states[s].modes[k];
            out->reduction_error_percent[mode] = out->states[s].reduction_error_percent[k];
            out->mesh_error_percent[mode] = out->states[s].mesh_error_percent[k];
            for (int b = 0; b < out->nbaseline; b++)
                out->baseline[b].predicted_hz[mode] = found[s].baseline_hz[k + (ptrdiff_t)b * out->states[s].nmodes];
        }
    return short_of;
}

rotid_identification *result_identification(struct pool *pool, const struct states *states, const struct identification *found,
                                            const rotid_fit_result *fit)
{
    rotid_identification *out = of_state(pool, &states->state[0].job, states->bounds, &found[0]);
    if (!out || states->nstate == 1)
        return out;
    out->nstates = POOL_LIST(pool, out->states, states->nstate);
    out->nweighed = 0;
    out->weighed = POOL_ARRAY(pool, rotid_weighed, 2 * (size_t)states->nstate);
    for (int s = 0; s < out->nstates && out->weighed; s++) {
        const struct state *state = &states->state[s];
        const rotid_identification *part = of_state(pool, &state->job, states->bounds, &found[s]);
        if (!part)
            return NULL;
        out->states[s].name = state->name;
        out->states[s].fitted_residuals = found[s].fit->nresidual;
        STATE_COPY(&out->states[s], part);
        out->shapes_fitted |= part->shapes_fitted;
        for (int i = 0; i < part->nweighed; i++) {
            out->weighed[out->nweighed] = part->weighed[i];
            out->weighed[out->nweighed++].state = state->name;
        }
    }
    out->objective = fit->objective;
    out->chi2 = fit->chi2;
    out->fit = fit;
    out->shapes = NULL;
    out->nco_matrix = out->mac_matrix = NULL;
    out->matrix_rows = out->matrix_columns = NULL;
    out->nmatrix_rows = out->nmatrix_columns = 0;
    return pool->out_of_memory || join_modes(pool, found, fit, out) ? NULL : out;
}

rotid_weighed *result_weighed(struct pool *pool, const struct job *job, const struct mass_properties *mass, int *count)
{
    const struct weighed *w = &job->measurement.weighed;
    rotid_weighed *list = POOL_ARRAY(pool, rotid_weighed, 2);
    *count = 0;
    for (int i = 0; i < 2 && list; i++) {
        double std = i ? w->centre_std : w->mass_std, measured = i ? w->centre : w->mass,
               predicted = i ? mass->center : mass->mass;
        if (std > 0)
            list[(*count)++] = (rotid_weighed){.quantity = i ? "centre" : "mass",
                                               .unit = i ? "m" : "kg",
                                               .measured = measured,
                                               .std = std,
                                               .predicted = predicted,
                                               .z = (measured - predicted) / std};
    }
    return list;
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

rotid_noise *result_noise(struct pool *pool, const struct job *job, const rotid_fit_result *fit)
{
    ptrdiff_t components =
        job->measurement.shape && job->measurement.shape_std ? (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode : 0;
    double *work = POOL_ARRAY(pool, double, components + job->measurement.nmode);
    rotid_noise *out = work ? POOL_NEW(pool, rotid_noise) : NULL;
    if (out)
        *out = (rotid_noise){.frequency = typical(job->measurement.frequency_std ? job->measurement.nmode : 0,
                                                  job->measurement.frequency_hz, job->measurement.frequency_std, work),
                             .shape = typical(components, job->measurement.shape, job->measurement.shape_std, work),
                             .intervals_from = fit->variance_from_residuals ? "residuals" : "noise"};
    return out;
}
