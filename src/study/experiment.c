#include "study/experiment.h"

#include <math.h>
#include <string.h>

#include "diagnose/data.h"
#include "study/draw.h"

/* The value of a parameter of the model that made the data, of a shared one the first; NaN where it has none of that name. */
static double true_value(struct rotor *rotor, const char *names)
{
    struct parameter parameter;
    const char *unit;
    char name[PARAMETER_NAME];
    (void)parameter_next_name(names, name);
    if (parameter_find(rotor, name, &parameter, &unit))
        return NAN;
    const struct material *material = parameter.kind == PARAMETER_G ? &rotor->group[parameter.index].material : NULL;
    return material ? material_shear_modulus(material) : *parameter_value(rotor, parameter);
}

/* Room for shapes where the deck has sensors and the plan a noise of shapes. */
static int add_shapes(struct pool *pool, const struct plan_noise *noise, struct job *job)
{
    size_t components = (size_t)job->rotor.nsensor * (size_t)job->measurement.nmode;
    if (job->measurement.shape || !job->rotor.nsensor || isnan(noise->shape))
        return ROTID_OK;
    job->measurement.shape = POOL_ARRAY(pool, double, components); /* zeros: measured, and to be filled in */
    job->measurement.shape_std = POOL_ARRAY(pool, double, components);
    if (!job->measurement.shape || !job->measurement.shape_std)
        return ROTID_ERROR_MEMORY;
    for (size_t i = 0; i < components; i++)
        job->measurement.shape_std[i] = NAN;
    return ROTID_OK;
}

/* The data belong to this run from now on. */
static int own_data(struct pool *pool, const struct plan *plan, struct job *job)
{
    int status = data_copy(pool, job);
    if (!status && plan->no_shapes) {
        job->measurement.shape = job->measurement.shape_std = job->measurement.point_frequency_hz =
            job->measurement.point_frequency_std = NULL;
        job->measurement.ncorrection = 0;
        job->measurement.raw = NULL;
    }
    return status;
}

/* States and unknowns of this run alone. */
static int own_states(struct pool *pool, const struct plan *plan, const struct states *fitted, struct states *out)
{
    int status = ROTID_OK;
    *out = *fitted;
    out->state = POOL_ARRAY(pool, struct state, fitted->nstate);
    out->bounds = POOL_ARRAY(pool, rotid_parameter, fitted->nparameter);
    if (!out->state || !out->bounds)
        return ROTID_ERROR_MEMORY;
    if (fitted->nparameter)
        memcpy(out->bounds, fitted->bounds, (size_t)fitted->nparameter * sizeof *out->bounds);
    for (int s = 0; s < fitted->nstate && !status; s++) {
        struct job *job = &out->state[s].job;
        out->state[s] = fitted->state[s];
        status = own_data(pool, plan, job);
        rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, job->unknowns.nparameter);
        if (!bounds)
            return ROTID_ERROR_MEMORY;
        if (job->unknowns.nparameter)
            memcpy(bounds, job->unknowns.bounds, (size_t)job->unknowns.nparameter * sizeof *bounds);
        job->unknowns.bounds = bounds;
    }
    return status;
}

static int from_model(struct pool *pool, struct jobs *jobs, const struct study_point *point, struct message_list *messages,
                      struct experiment *out)
{
    const struct plan *plan = jobs->study->plan;
    struct truth *truth;
    int status = jobs_truth(jobs, &point->cell, &truth);
    if (status) {
        for (size_t i = 0; i < jobs->truth_messages.count; i++)
            message_add(messages, jobs->truth_messages.item[i].severity, NULL, 0, 0, "%s", jobs->truth_messages.item[i].text);
        return status;
    }
    out->made_by = truth;
    out->truth = POOL_ARRAY(pool, double, out->states.nparameter);
    if (!out->truth)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < out->states.nstate && !status; s++) {
        const struct state *state = &out->states.state[s];
        struct job *job = &out->states.state[s].job;
        if (!plan->no_shapes)
            status = add_shapes(pool, &plan->noise[point->cell.noise], job);
        if (!status)
            status = experiment_model(pool, jobs->study, point->replicate, &truth[s], messages, job);
        for (int p = 0; p < job->unknowns.nparameter && !status; p++) {
            const char *name = job->unknowns.bounds[p].name;
            size_t length = state->name ? strlen(state->name) : 0;
            int own = p >= state->ncommon && length && !strncmp(name, state->name, length) && name[length] == ':';
            out->truth[state->unknown[p]] = true_value(&truth[s].job.rotor, own ? name + length + 1 : name);
        }
    }
    return status;
}

/* The start of this run; bounds are the job's own. */
static void experiment_starts(const struct study *study, const struct study_point *point, struct states *states)
{
    const struct plan *plan = study->plan;
    long digits = point->start;
    for (int p = 0; p < states->nparameter && plan->spread > 0; p++) {
        rotid_parameter *bounds = &states->bounds[p];
        double inside = 1e-6 * (bounds->upper - bounds->lower), reach = plan->spread * fabs(bounds->start);
        double lower = fmax(bounds->start - reach, bounds->lower + inside),
               upper = fmin(bounds->start + reach, bounds->upper - inside);
        double along;
        if (plan->grid) {
            along = (double)(digits % plan->grid) / (plan->grid - 1);
            digits /= plan->grid;
        } else {
            struct random_stream stream =
                draw_stream(study->seed, DRAW_START, point->replicate, (uint64_t)point->start, digest_name(bounds->name));
            along = random_uniform(&stream);
        }
        double start = lower + along * (upper - lower);
        bounds->start = start != 0 ? start : inside; /* a start of zero is no scale */
    }
}

int experiment_make(struct pool *pool, struct jobs *jobs, const struct study_point *point, struct message_list *messages,
                    struct experiment *out)
{
    const struct study *study = jobs->study;
    const struct states *fitted;
    *out = (struct experiment){0};
    int status = jobs_fitted(jobs, &point->cell, &fitted);
    if (status) {
        for (size_t i = 0; i < jobs->fitted_messages.count; i++)
            message_add(messages, jobs->fitted_messages.item[i].severity, NULL, 0, 0, "%s", jobs->fitted_messages.item[i].text);
        return status;
    }
    status = own_states(pool, study->plan, fitted, &out->states);
    if (!status && study->plan->from_model)
        status = from_model(pool, jobs, point, messages, out);
    if (status)
        return status;
    out->job = &out->states.state[0].job;
    out->length = rotor_length(&out->job->rotor);
    for (int s = 0; s < out->states.nstate && !status; s++) {
        const struct truth *truth = out->made_by ? &out->made_by[s] : NULL;
        experiment_noise(study, point, truth, s, &out->states.state[s].job);
        status = experiment_sensors(pool, study, point, truth, &out->states.state[s].job);
    }
    if (status)
        return status;
    experiment_starts(study, point, &out->states);
    for (int s = 0; s < out->states.nstate; s++)
        for (int p = 0; p < out->states.state[s].job.unknowns.nparameter; p++)
            out->states.state[s].job.unknowns.bounds[p].start = out->states.bounds[out->states.state[s].unknown[p]].start;
    return ROTID_OK;
}
