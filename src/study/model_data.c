/* Data that a model makes: its parameters and the hidden effect drawn, its modes at the sensors. */
#include <math.h>
#include <string.h>

#include "diagnose/causes/catalogue.h"
#include "modal/prediction.h"
#include "model/model.h"
#include "study/draw.h"
#include "study/experiment.h"

#define FINER 4 /* cuts of each element: leaves a sixteenth of the error of the mesh */

static double draw(const struct study *study, enum draw_purpose purpose, long replicate, const char *name, double lower,
                   double upper)
{
    struct random_stream stream = draw_stream(study->seed, purpose, replicate, digest_name(name), 0);
    double along = random_uniform(&stream);
    return upper > lower ? lower + along * (upper - lower) : lower;
}

static void set_parameter(struct rotor *rotor, struct parameter parameter, double value)
{
    if (parameter.kind == PARAMETER_G)
        rotor->group[parameter.index].material.isotropic = 0;
    *parameter_value(rotor, parameter) = value;
}

static void set(struct rotor *rotor, const char *names, double value)
{
    char name[PARAMETER_NAME];
    for (const char *next = names; next;) {
        struct parameter parameter;
        const char *unit;
        next = parameter_next_name(next, name);
        if (!parameter_find(rotor, name, &parameter, &unit))
            set_parameter(rotor, parameter, value);
    }
}

/* Every value is set in every run: the truth keeps nothing of the run before. */
static void draw_values(const struct study *study, long replicate, struct truth *truth)
{
    const struct plan *plan = study->plan;
    struct job *job = &truth->job;
    for (int p = 0; p < job->unknowns.nparameter; p++)
        set_parameter(&job->rotor, job->unknowns.parameter[p], job->unknowns.bounds[p].start);
    for (int t = 0; t < plan->ntruth; t++)
        set(&job->rotor, plan->truth[t].name,
            draw(study, DRAW_TRUTH, replicate, plan->truth[t].name, plan->truth[t].lower, plan->truth[t].upper));
    const struct effect_parameter_name *parameter;
    for (int p = 0; (parameter = truth_parameter(truth, p)); p++) {
        double value = draw(study, DRAW_HIDDEN, replicate, parameter->name, truth->lower[p], truth->upper[p]);
        if (truth->effect)
            truth->effect->value[p] = value;
        else
            *correction_value(&truth->fault, p) = value;
    }
}

/* Where the sensors really are. Own arrays: a correction changes the order of the sensors and what refers to them. */
static int place_sensors(struct pool *pool, const struct truth *truth, struct job *job)
{
    *job = truth->job;
    job->measurement.shape = job->measurement.shape_std = job->measurement.point_frequency_hz =
        job->measurement.point_frequency_std = NULL;
    if (!truth->cause || (strcmp(truth->cause->id, "sensor_position") != 0 && strcmp(truth->cause->id, "sensor_line") != 0))
        return ROTID_OK;
    job->rotor.sensor = POOL_ARRAY(pool, struct sensor, job->rotor.nsensor);
    job->rotor.effect = POOL_ARRAY(pool, struct effect, job->rotor.neffect);
    if (!job->rotor.sensor || !job->rotor.effect)
        return ROTID_ERROR_MEMORY;
    memcpy(job->rotor.sensor, truth->job.rotor.sensor, (size_t)job->rotor.nsensor * sizeof *job->rotor.sensor);
    if (job->rotor.neffect)
        memcpy(job->rotor.effect, truth->job.rotor.effect, (size_t)job->rotor.neffect * sizeof *job->rotor.effect);
    job->unknowns.nsuspect = 0;
    return correction_apply(pool, job, &truth->fault);
}

struct modes { /* elastic ones of a model at the sensors of its rotor */
    int count, nsensor;
    double *hz, *shape; /* [count], [nsensor * count] */
};

static int modes_new(struct pool *pool, int count, int nsensor, struct modes *modes)
{
    *modes =
        (struct modes){count, nsensor, POOL_ARRAY(pool, double, count), POOL_ARRAY(pool, double, (size_t)nsensor *(size_t)count)};
    return modes->hz && modes->shape ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Of the full model, discretised as `models` are. refine: cuts of each element. */
static int solve(struct models *models, const struct rotor *rotor, int refine, struct modes *modes)
{
    const double none = 0;
    struct pool scratch;
    struct prediction p;
    int failed, status = ROTID_ERROR_MEMORY;
    pool_open(&scratch, NULL);
    struct rotor_model *model = POOL_NEW(&scratch, struct rotor_model);
    if (model)
        status = model_open(&scratch, models, rotor, 0, NULL, refine, model, &failed);
    if (!status && model->equations.nrigid + modes->count > model->equations.n)
        status = ROTID_ERROR_ARGUMENT;
    if (!status)
        status = prediction_new(&scratch, &model->equations, ROTID_REDUCTION_NONE, ROTID_NELSON,
                                model->equations.nrigid + modes->count, 0, &p);
    if (!status)
        status = prediction_compute(&p, &none);
    for (int k = 0; k < modes->count && !status; k++) {
        modes->hz[k] = prediction_hz(&p, model->equations.nrigid + k);
        for (int s = 0; s < modes->nsensor; s++)
            modes->shape[s + (ptrdiff_t)k * modes->nsensor] = prediction_at_sensor(&p, model->equations.nrigid + k, s);
    }
    pool_close(&scratch);
    return status;
}

/* With an accelerometer that goes from sensor to sensor each records its own component as it is with the mass there, and the
 * frequency is the mean of all. The scale of a loaded mode is the one that brings it nearest to the one without that mass. */
static int solve_moving(struct pool *pool, struct models *models, const struct rotor *rotor, int refine, int effect,
                        struct modes *modes)
{
    int n = modes->nsensor, status;
    struct rotor with = *rotor;
    struct modes bare, loaded;
    with.effect = POOL_ARRAY(pool, struct effect, rotor->neffect);
    status = with.effect ? modes_new(pool, modes->count, n, &bare) : ROTID_ERROR_MEMORY;
    if (!status)
        status = modes_new(pool, modes->count, n, &loaded);
    if (status)
        return status;
    memcpy(with.effect, rotor->effect, (size_t)rotor->neffect * sizeof *with.effect);
    with.effect[effect].variant = 1; /* FIXED */
    with.effect[effect].target = -1; /* nowhere */
    status = solve(models, &with, refine, &bare);
    for (int k = 0; k < modes->count; k++)
        modes->hz[k] = 0;
    for (int s = 0; s < n && !status; s++) {
        with.effect[effect].target = s;
        status = solve(models, &with, refine, &loaded);
        for (int k = 0; k < modes->count && !status; k++) {
            const double *a = loaded.shape + (ptrdiff_t)k * n, *b = bare.shape + (ptrdiff_t)k * n;
            double across = 0, square = 0;
            for (int i = 0; i < n; i++) {
                across += a[i] * b[i];
                square += a[i] * a[i];
            }
            modes->shape[s + (ptrdiff_t)k * n] = across / square * a[s];
            modes->hz[k] += loaded.hz[k] / n;
        }
    }
    return status;
}

static void take_mode(const struct rotor *rotor, const struct modes *modes, int k, struct job *job)
{
    const double *made = modes->shape + (ptrdiff_t)(job->measurement.number[k] - 1) * modes->nsensor;
    double largest = 0;
    job->measurement.frequency_hz[k] = modes->hz[job->measurement.number[k] - 1];
    if (!job->measurement.shape)
        return;
    double *shape = job->measurement.shape + (ptrdiff_t)k * job->rotor.nsensor;
    for (int s = 0; s < modes->nsensor; s++)
        largest = fmax(largest, fabs(made[s]));
    for (int s = 0; s < job->rotor.nsensor; s++) {
        int there = 0;
        while (there < modes->nsensor && rotor->sensor[there].id != job->rotor.sensor[s].id)
            there++;
        if (isfinite(shape[s]))
            shape[s] = there < modes->nsensor && largest > 0 ? made[there] / largest : NAN;
    }
}

int experiment_model(struct pool *pool, const struct study *study, long replicate, struct truth *truth,
                     struct message_list *messages, struct job *job)
{
    struct modes modes;
    struct job source;
    int highest = 0;
    draw_values(study, replicate, truth);
    int status = place_sensors(pool, truth, &source), last = source.rotor.neffect - 1;
    if (status == ROTID_ERROR_ARGUMENT)
        message_add(messages, SEVERITY_ERROR, NULL, 0, 0, "the hidden shift leaves the sensor no place of its own");
    for (int k = 0; k < job->measurement.nmode; k++)
        highest = job->measurement.number[k] > highest ? job->measurement.number[k] : highest;
    if (!status)
        status = modes_new(pool, highest, source.rotor.nsensor, &modes);
    /* a diagnosis refines its mesh until the error is below the noise, and would find what a coarse one leaves in the data */
    int refine = study->plan->command == PLAN_DIAGNOSE ? FINER : 1;
    int moving = truth->effect && truth->cause->target == TARGET_SENSOR && truth->effect->target < 0;
    if (!status)
        status = moving ? solve_moving(pool, source.models, &source.rotor, refine, last, &modes)
                        : solve(source.models, &source.rotor, refine, &modes);
    for (int k = 0; k < job->measurement.nmode && !status; k++)
        take_mode(&source.rotor, &modes, k, job);
    /* what else was measured is not that of this model */
    job->measurement.point_frequency_hz = job->measurement.point_frequency_std = NULL;
    job->measurement.hammer = job->measurement.ncorrection = 0;
    job->measurement.raw = NULL;
    job->measurement.has_noise_floor = 0;
    if (!status)
        experiment_fault(truth, 0, job);
    return status;
}
