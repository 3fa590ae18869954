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
    rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, job->unknowns.nparameter);
    if (status || !bounds)
        return status ? status : ROTID_ERROR_MEMORY;
    if (job->unknowns.nparameter)
        memcpy(bounds, job->unknowns.bounds, (size_t)job->unknowns.nparameter * sizeof *bounds);
    job->unknowns.bounds = bounds;
    if (plan->no_shapes) {
        job->measurement.shape = job->measurement.shape_std = job->measurement.point_frequency_hz =
            job->measurement.point_frequency_std = NULL;
        job->measurement.ncorrection = 0;
        job->measurement.raw = NULL;
    }
    return ROTID_OK;
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
    if (!plan->no_shapes)
        status = add_shapes(pool, &plan->noise[point->cell.noise], &out->job);
    if (!status)
        status = experiment_model(pool, jobs->study, point->replicate, truth, messages, &out->job);
    out->made_by = truth;
    out->truth = POOL_ARRAY(pool, double, out->job.unknowns.nparameter);
    if (!status && !out->truth)
        status = ROTID_ERROR_MEMORY;
    for (int p = 0; p < out->job.unknowns.nparameter && !status; p++)
        out->truth[p] = true_value(&truth->job.rotor, out->job.unknowns.bounds[p].name);
    return status;
}

/* The start of this run; bounds are the job's own. */
static void experiment_starts(const struct study *study, const struct study_point *point, struct job *job)
{
    const struct plan *plan = study->plan;
    long digits = point->start;
    for (int p = 0; p < job->unknowns.nparameter && plan->spread > 0; p++) {
        rotid_parameter *bounds = &job->unknowns.bounds[p];
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
    const struct job *fitted;
    *out = (struct experiment){0};
    int status = jobs_fitted(jobs, &point->cell, &fitted);
    if (status) {
        for (size_t i = 0; i < jobs->fitted_messages.count; i++)
            message_add(messages, jobs->fitted_messages.item[i].severity, NULL, 0, 0, "%s", jobs->fitted_messages.item[i].text);
        return status;
    }
    out->job = *fitted;
    out->length = rotor_length(&fitted->rotor);
    status = own_data(pool, study->plan, &out->job);
    if (!status && study->plan->from_model)
        status = from_model(pool, jobs, point, messages, out);
    if (status)
        return status;
    experiment_noise(study, point, out->made_by, &out->job);
    status = experiment_sensors(pool, study, point, out->made_by, &out->job);
    if (!status)
        experiment_starts(study, point, &out->job);
    return status;
}
