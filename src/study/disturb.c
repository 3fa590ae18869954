/* What happens to data on their way: faults of the measurement chain, noise, sensors that are not there. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "diagnose/causes/catalogue.h"
#include "diagnose/causes/sensor.h"
#include "study/draw.h"
#include "study/experiment.h"

static int is_fault(const struct truth *truth, const char *id)
{
    return truth && truth->cause && !truth->effect && !strcmp(truth->cause->id, id);
}

void experiment_fault(const struct truth *truth, int behind, struct job *job)
{
    if (!truth->cause || truth->effect || !job->measurement.shape || !truth->fault.nsensor)
        return;
    int a = sensor_find(job, truth->fault.sensor[0]),
        b = truth->fault.nsensor > 1 ? sensor_find(job, truth->fault.sensor[1]) : -1;
    for (int k = 0; k < job->measurement.nmode && a >= 0; k++) {
        double *shape = job->measurement.shape + (ptrdiff_t)k * job->rotor.nsensor, kept = shape[a];
        if (is_fault(truth, "sensor_gain") && !behind) {
            shape[a] *= truth->fault.value;
        } else if (is_fault(truth, "sensor_sign") && !behind) {
            shape[a] = -shape[a];
        } else if (is_fault(truth, "sensor_swap") && !behind && b >= 0) {
            shape[a] = shape[b];
            shape[b] = kept;
        } else if (is_fault(truth, "duplicate_channel") && behind && b >= 0) { /* it repeats the noise as well */
            shape[a] = shape[b];
        }
    }
}

/* What noise_level hides: the factor on the noise that is stated. */
static double factor(const struct truth *truth, const char *block)
{
    return is_fault(truth, "noise_level") && truth->fault.block && !strcmp(truth->fault.block, block) ? truth->fault.value : 1;
}

#define STATE_NOISE 1000003u /* more than modes have numbers */

static double normal(const struct study *study, enum draw_purpose purpose, long replicate, int s, int mode, int sensor)
{
    struct random_stream stream =
        draw_stream(study->seed, purpose, replicate, (uint64_t)mode + STATE_NOISE * (uint64_t)s, (uint64_t)sensor);
    return random_normal(&stream);
}

/* Measured data have a noise already, to which this one is added. */
static double stated(int from_model, double std, double level)
{
    return from_model || !isfinite(std) ? level : hypot(std, level);
}

void experiment_noise(const struct study *study, const struct study_point *point, const struct truth *truth, int s,
                      struct job *job)
{
    const struct plan_noise *noise = &study->plan->noise[point->cell.noise];
    int from_model = truth != NULL, nsensor = job->rotor.nsensor;
    if (noise->frequency > 0 || noise->shape > 0) /* frequencies at single sensors would contradict the rest */
        job->measurement.point_frequency_hz = job->measurement.point_frequency_std = NULL;
    for (int k = 0; k < job->measurement.nmode && noise->frequency > 0; k++) {
        double level = noise->frequency * factor(truth, "FREQUENCY");
        job->measurement.frequency_hz[k] *=
            1 + level * normal(study, DRAW_FREQUENCY, point->replicate, s, job->measurement.number[k], 0);
        job->measurement.frequency_std[k] = stated(from_model, job->measurement.frequency_std[k], noise->frequency);
    }
    for (int k = 0; k < job->measurement.nmode && job->measurement.shape && noise->shape > 0; k++) {
        double *shape = job->measurement.shape + (ptrdiff_t)k * nsensor,
               *std = job->measurement.shape_std + (ptrdiff_t)k * nsensor, largest = 0;
        double level = noise->shape * factor(truth, "SHAPE");
        for (int i = 0; i < nsensor; i++)
            largest = isfinite(shape[i]) ? fmax(largest, fabs(shape[i])) : largest;
        for (int i = 0; i < nsensor; i++) {
            if (!isfinite(shape[i]))
                continue;
            shape[i] += level * largest *
                        normal(study, DRAW_SHAPE, point->replicate, s, job->measurement.number[k], job->rotor.sensor[i].id);
            std[i] = stated(from_model, std[i], noise->shape);
        }
    }
    if (truth)
        experiment_fault(truth, 1, job);
}

struct choice { /* a sensor with its lot */
    double lot;
    int sensor;
};

static int compare(const void *left, const void *right)
{
    const struct choice *a = left, *b = right;
    return (a->lot > b->lot) - (a->lot < b->lot);
}

/* A sensor that an effect or the hidden fault is about stays. */
static int must_stay(const struct job *job, const struct truth *truth, int s)
{
    for (int i = 0; i < job->rotor.neffect + job->unknowns.nsuspect; i++) {
        const struct effect *effect =
            i < job->rotor.neffect ? &job->rotor.effect[i] : &job->unknowns.suspect[i - job->rotor.neffect].effect;
        const struct cause_kind *cause = catalogue_of(effect);
        if (cause && cause->target == TARGET_SENSOR && effect->target == s)
            return 1;
    }
    if (truth && truth->effect && truth->cause->target == TARGET_SENSOR && truth->effect->target >= 0)
        return truth->job.rotor.sensor[truth->effect->target].id == job->rotor.sensor[s].id;
    for (int i = 0; truth && truth->cause && !truth->effect && i < truth->fault.nsensor; i++)
        if (truth->fault.sensor[i] == job->rotor.sensor[s].id)
            return 1;
    return 0;
}

/* keep [nsensor]: which stay. The lots of a replicate do not depend on how many are kept: fewer sensors are some of more. */
static int choose(struct pool *pool, const struct study *study, const struct study_point *point, const struct truth *truth,
                  const struct job *job, char *keep)
{
    const struct plan_sensors *sensors = &study->plan->sensors[point->cell.sensors];
    int nsensor = job->rotor.nsensor;
    struct choice *choice = POOL_ARRAY(pool, struct choice, nsensor);
    if (!choice)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < nsensor; s++) {
        struct random_stream stream =
            draw_stream(study->seed, DRAW_SENSOR, point->replicate, (uint64_t)job->rotor.sensor[s].id, 0);
        double lot = random_uniform(&stream);
        choice[s] = (struct choice){must_stay(job, truth, s) ? lot - 1 : lot, s};
        keep[s] = sensors->every && (s % sensors->every == 0 || choice[s].lot < 0);
    }
    if (sensors->keep) {
        qsort(choice, (size_t)nsensor, sizeof *choice, compare);
        for (int i = 0; i < sensors->keep && i < nsensor; i++)
            keep[choice[i].sensor] = 1;
    }
    return ROTID_OK;
}

static void follow(struct effect *effect, const int *new_index)
{
    const struct cause_kind *cause = catalogue_of(effect);
    if (cause && cause->target == TARGET_SENSOR && effect->target >= 0)
        effect->target = new_index[effect->target];
}

static int own_effects(struct pool *pool, struct job *job, const int *new_index)
{
    struct effect *effect = POOL_ARRAY(pool, struct effect, job->rotor.neffect);
    struct suspect *suspect = POOL_ARRAY(pool, struct suspect, job->unknowns.nsuspect);
    if (!effect || !suspect)
        return ROTID_ERROR_MEMORY;
    if (job->rotor.neffect)
        memcpy(effect, job->rotor.effect, (size_t)job->rotor.neffect * sizeof *effect);
    if (job->unknowns.nsuspect)
        memcpy(suspect, job->unknowns.suspect, (size_t)job->unknowns.nsuspect * sizeof *suspect);
    job->rotor.effect = effect;
    job->unknowns.suspect = suspect;
    for (int i = 0; i < job->rotor.neffect; i++)
        follow(&effect[i], new_index);
    for (int i = 0; i < job->unknowns.nsuspect; i++)
        follow(&suspect[i].effect, new_index);
    return ROTID_OK;
}

/* Rows of a matrix [n * nmode] that stay, in its place. */
static void leave_rows(int n, int nmode, const char *keep, double *matrix)
{
    ptrdiff_t next = 0;
    for (int k = 0; k < nmode && matrix; k++)
        for (int s = 0; s < n; s++)
            if (keep[s])
                matrix[next++] = matrix[s + (ptrdiff_t)k * n];
}

int experiment_sensors(struct pool *pool, const struct study *study, const struct study_point *point, const struct truth *truth,
                       struct job *job)
{
    const struct plan_sensors *sensors = &study->plan->sensors[point->cell.sensors];
    int n = job->rotor.nsensor, left = 0;
    if (!n || !(sensors->keep || sensors->every))
        return ROTID_OK;
    char *keep = POOL_ARRAY(pool, char, n);
    int *new_index = POOL_ARRAY(pool, int, n);
    int status = keep && new_index ? choose(pool, study, point, truth, job, keep) : ROTID_ERROR_MEMORY;
    for (int s = 0; s < n && !status; s++)
        new_index[s] = keep[s] ? left++ : -1;
    if (!status)
        status = own_effects(pool, job, new_index);
    if (status)
        return status;
    /* noise is relative to the largest component, which may be one of those that go: it stays what it is in absolute terms */
    if (job->measurement.shape)
        shapes_scale(job);
    leave_rows(n, job->measurement.nmode, keep, job->measurement.shape);
    leave_rows(n, job->measurement.nmode, keep, job->measurement.shape_std);
    leave_rows(n, job->measurement.nmode, keep, job->measurement.point_frequency_hz);
    leave_rows(n, job->measurement.nmode, keep, job->measurement.point_frequency_std);
    for (int s = 0; s < n; s++)
        if (keep[s])
            job->rotor.sensor[new_index[s]] = job->rotor.sensor[s];
    job->rotor.nsensor = left;
    if (job->measurement.shape)
        shapes_rescale(job);
    if (sensor_find(job, job->measurement.hammer) < 0)
        job->measurement.hammer = 0;
    job->measurement.ncorrection = 0; /* they are in the data already, and what the deck read is of all sensors */
    job->measurement.raw = NULL;
    return ROTID_OK;
}
