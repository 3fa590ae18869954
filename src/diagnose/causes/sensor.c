#include "diagnose/causes/causes.h"

#include <math.h>
#include <string.h>

int sensor_find(const struct job *job, int id)
{
    for (int s = 0; s < job->rotor.nsensor; s++)
        if (job->rotor.sensor[s].id == id)
            return s;
    return -1;
}

#define BEYOND 0.02 /* of the length: so far a line may end beyond the rotor */
#define APART  5e-4 /* of the length: nearer than a hundredth of an element two would share a node */

double sensor_line_place(const struct sensor_line *line, double length, double z)
{
    double from = line->shift + line->scale * z;
    return line->flip ? length - from : from;
}

int sensor_line_fits(const struct sensor_line *line, double length, int n, const double *z)
{
    double before = -length;
    for (int i = 0; i < n; i++) { /* from left to right */
        double place = sensor_line_place(line, length, z[line->flip ? n - 1 - i : i]);
        if (!(place >= -BEYOND * length && place <= (1 + BEYOND) * length))
            return 0;
        place = fmin(fmax(place, 0), length);
        if (place - before < APART * length)
            return 0;
        before = place;
    }
    return 1;
}

static void divide_by_largest(struct job *job, int with_std)
{
    int n = job->rotor.nsensor;
    for (int k = 0; k < job->measurement.nmode && job->measurement.shape; k++) {
        double *shape = job->measurement.shape + (ptrdiff_t)k * n, *std = job->measurement.shape_std + (ptrdiff_t)k * n,
               largest = 0;
        for (int s = 0; s < n; s++)
            if (isfinite(shape[s]))
                largest = fmax(largest, fabs(shape[s]));
        for (int s = 0; s < n && largest > 0; s++) {
            shape[s] /= largest;
            if (with_std)
                std[s] /= largest;
        }
    }
}

void shapes_scale(struct job *job)
{
    divide_by_largest(job, 0);
}

void shapes_rescale(struct job *job)
{
    divide_by_largest(job, 1);
}

void shapes_multiply(struct job *job, int s, double factor)
{
    shapes_scale(job);
    for (int k = 0; k < job->measurement.nmode && job->measurement.shape; k++) {
        ptrdiff_t at = s + (ptrdiff_t)k * job->rotor.nsensor;
        job->measurement.shape[at] *= factor;
        job->measurement.shape_std[at] *= fabs(factor);
    }
    shapes_rescale(job);
}

static void exchange(double *a, double *b)
{
    double kept = *a;
    *a = *b;
    *b = kept;
}

void shapes_exchange(struct job *job, int a, int b)
{
    for (int k = 0; k < job->measurement.nmode && job->measurement.shape; k++) {
        ptrdiff_t mode = (ptrdiff_t)k * job->rotor.nsensor;
        exchange(&job->measurement.shape[a + mode], &job->measurement.shape[b + mode]);
        exchange(&job->measurement.shape_std[a + mode], &job->measurement.shape_std[b + mode]);
    }
    for (int k = 0; k < job->measurement.nmode && job->measurement.point_frequency_hz; k++) {
        ptrdiff_t mode = (ptrdiff_t)k * job->rotor.nsensor;
        exchange(&job->measurement.point_frequency_hz[a + mode], &job->measurement.point_frequency_hz[b + mode]);
        exchange(&job->measurement.point_frequency_std[a + mode], &job->measurement.point_frequency_std[b + mode]);
    }
}

static void exchange_target(struct effect *effect, int a, int b)
{
    if (effect->kind->at_sensor && (effect->target == a || effect->target == b))
        effect->target = effect->target == a ? b : a;
}

void sensors_exchange(struct job *job, int a, int b)
{
    struct sensor kept = job->rotor.sensor[a];
    job->rotor.sensor[a] = job->rotor.sensor[b];
    job->rotor.sensor[b] = kept;
    shapes_exchange(job, a, b);
    for (int i = 0; i < job->rotor.neffect; i++)
        exchange_target(&job->rotor.effect[i], a, b);
    for (int i = 0; i < job->unknowns.nsuspect; i++)
        exchange_target(&job->unknowns.suspect[i].effect, a, b);
}

/* NULL for NULL; *failed where memory is out */
static void *copy(struct pool *pool, const void *source, size_t count, size_t size, int *failed)
{
    void *target = source ? pool_get(pool, count, size) : NULL;
    if (target)
        memcpy(target, source, count * size);
    *failed |= source && !target;
    return target;
}

int corrections_keep_raw(struct pool *pool, struct job *job)
{
    int n = job->rotor.nsensor, failed = 0;
    size_t components = (size_t)n * (size_t)job->measurement.nmode;
    if (job->measurement.raw)
        return ROTID_OK;
    struct job_raw *raw = POOL_NEW(pool, struct job_raw);
    if (!raw)
        return ROTID_ERROR_MEMORY;
    *raw = (struct job_raw){.nsensor = n,
                            .sensor = copy(pool, job->rotor.sensor, (size_t)n, sizeof *raw->sensor, &failed),
                            .shape = copy(pool, job->measurement.shape, components, sizeof *raw->shape, &failed),
                            .shape_std = copy(pool, job->measurement.shape_std, components, sizeof *raw->shape_std, &failed),
                            .frequency_std = copy(pool, job->measurement.frequency_std, (size_t)job->measurement.nmode,
                                                  sizeof *raw->frequency_std, &failed),
                            .point_frequency_hz = copy(pool, job->measurement.point_frequency_hz, components,
                                                       sizeof *raw->point_frequency_hz, &failed),
                            .point_frequency_std = copy(pool, job->measurement.point_frequency_std, components,
                                                        sizeof *raw->point_frequency_std, &failed)};
    if (failed)
        return ROTID_ERROR_MEMORY;
    job->measurement.raw = raw;
    return ROTID_OK;
}
