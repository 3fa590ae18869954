/* Data that a model makes: its parameters and the hidden effect drawn, its modes at the sensors. */
#include <math.h>
#include <string.h>

#include "diagnose/causes/sensor.h"
#include "modal/prediction.h"
#include "run/client.h"
#include "study/draw.h"
#include "study/experiment.h"

static double draw(const struct study *study, enum draw_purpose purpose, long replicate, const char *name, double lower,
                   double upper)
{
    struct random_stream stream = draw_stream(study->seed, purpose, replicate, digest_name(name), 0);
    double along = random_uniform(&stream);
    return upper > lower ? lower + along * (upper - lower) : lower;
}

static void set(struct rotor *rotor, const char *name, double value)
{
    struct parameter parameter;
    const char *unit;
    if (parameter_find(rotor, name, &parameter, &unit))
        return;
    if (parameter.kind == PARAMETER_G)
        rotor->group[parameter.index].material.isotropic = 0;
    *parameter_value(rotor, parameter) = value;
}

/* Every value is set in every run: the truth keeps nothing of the run before. */
static void draw_values(const struct study *study, long replicate, struct truth *truth)
{
    const struct plan *plan = study->plan;
    struct job *job = &truth->job;
    for (int p = 0; p < job->nparameter; p++)
        set(&job->rotor, job->bounds[p].name, job->bounds[p].start);
    for (int t = 0; t < plan->ntruth; t++)
        set(&job->rotor, plan->truth[t].name,
            draw(study, DRAW_TRUTH, replicate, plan->truth[t].name, plan->truth[t].lower, plan->truth[t].upper));
    const struct effect_parameter_name *parameter;
    for (int p = 0; (parameter = truth_parameter(truth, p)); p++) {
        double value = draw(study, DRAW_HIDDEN, replicate, parameter->name, truth->lower[p], truth->upper[p]);
        if (truth->effect)
            truth->effect->value[p] = value;
        else
            truth->fault.value = value;
    }
}

/* Where the sensors really are. Own arrays: a correction changes the order of the sensors and what refers to them. */
static int place_sensors(struct pool *pool, const struct truth *truth, struct job *job)
{
    *job = truth->job;
    job->shape = job->shape_std = job->point_frequency_hz = job->point_frequency_std = NULL;
    if (!truth->cause || strcmp(truth->cause->id, "sensor_position") != 0)
        return ROTID_OK;
    job->rotor.sensor = POOL_ARRAY(pool, struct sensor, job->rotor.nsensor);
    job->rotor.effect = POOL_ARRAY(pool, struct effect, job->rotor.neffect);
    if (!job->rotor.sensor || !job->rotor.effect)
        return ROTID_ERROR_MEMORY;
    memcpy(job->rotor.sensor, truth->job.rotor.sensor, (size_t)job->rotor.nsensor * sizeof *job->rotor.sensor);
    if (job->rotor.neffect)
        memcpy(job->rotor.effect, truth->job.rotor.effect, (size_t)job->rotor.neffect * sizeof *job->rotor.effect);
    job->nsuspect = 0;
    return correction_apply(pool, job, &truth->fault);
}

/* Modes of the full model at the sensors of the rotor. */
static int solve(struct pool *pool, const struct rotor *rotor, int count, struct client *client, struct prediction *prediction)
{
    const double none = 0;
    int failed, status = client_open(pool, rotor, 0, NULL, 1, client, &failed);
    if (!status && client->model.nrigid + count > client->model.n)
        status = ROTID_ERROR_ARGUMENT;
    if (!status)
        status =
            prediction_new(pool, &client->model, ROTID_REDUCTION_NONE, ROTID_NELSON, client->model.nrigid + count, 0, prediction);
    return status ? status : prediction_compute(prediction, &none);
}

static void take_mode(const struct rotor *rotor, const struct client *client, const struct prediction *p, int k, struct job *job)
{
    int mode = client->model.nrigid + job->number[k] - 1;
    double largest = 0;
    job->frequency_hz[k] = prediction_hz(p, mode);
    if (!job->shape)
        return;
    double *shape = job->shape + (ptrdiff_t)k * job->rotor.nsensor;
    for (int s = 0; s < rotor->nsensor; s++)
        largest = fmax(largest, fabs(prediction_at_sensor(p, mode, s)));
    for (int s = 0; s < job->rotor.nsensor; s++) {
        int there = 0;
        while (there < rotor->nsensor && rotor->sensor[there].id != job->rotor.sensor[s].id)
            there++;
        if (isfinite(shape[s]))
            shape[s] = there < rotor->nsensor && largest > 0 ? prediction_at_sensor(p, mode, there) / largest : NAN;
    }
}

int experiment_model(struct pool *pool, const struct study *study, long replicate, struct truth *truth,
                     struct message_list *messages, struct job *job)
{
    struct client *client = POOL_NEW(pool, struct client);
    struct prediction prediction;
    struct job source;
    int highest = 0;
    draw_values(study, replicate, truth);
    int status = client ? place_sensors(pool, truth, &source) : ROTID_ERROR_MEMORY;
    if (status == ROTID_ERROR_ARGUMENT)
        message_add(messages, SEVERITY_ERROR, NULL, 0, 0, "the hidden shift leaves the sensor no place of its own");
    for (int k = 0; k < job->nmode; k++)
        highest = job->number[k] > highest ? job->number[k] : highest;
    if (!status)
        status = solve(pool, &source.rotor, highest, client, &prediction);
    for (int k = 0; k < job->nmode && !status; k++)
        take_mode(&source.rotor, client, &prediction, k, job);
    /* what else was measured is not that of this model */
    job->point_frequency_hz = job->point_frequency_std = NULL;
    job->hammer = job->ncorrection = 0;
    job->raw = NULL;
    job->has_noise_floor = 0;
    experiment_fault(truth, 0, job);
    return status;
}
