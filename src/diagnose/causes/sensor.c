#include "diagnose/causes/causes.h"

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
               largest = largest_magnitude(n, shape);
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
    struct job_measurement *m = &job->measurement;
    double *const rows[] = {m->shape, m->shape ? m->shape_std : NULL, m->point_frequency_hz,
                            m->point_frequency_hz ? m->point_frequency_std : NULL};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (ptrdiff_t k = 0; k < m->nmode && rows[i]; k++)
            exchange(&rows[i][a + k * job->rotor.nsensor], &rows[i][b + k * job->rotor.nsensor]);
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

static double *copy(struct pool *pool, const double *list, size_t count)
{
    return list ? POOL_COPY(pool, list, count, 0) : NULL;
}

int corrections_keep_raw(struct pool *pool, struct job *job)
{
    const struct job_measurement *m = &job->measurement;
    size_t modes = (size_t)m->nmode, components = (size_t)job->rotor.nsensor * modes;
    if (m->raw)
        return ROTID_OK;
    struct job_raw *raw = POOL_NEW(pool, struct job_raw);
    if (!raw)
        return ROTID_ERROR_MEMORY;
    *raw = (struct job_raw){.nsensor = job->rotor.nsensor,
                            .sensor = POOL_COPY(pool, job->rotor.sensor, job->rotor.nsensor, 0),
                            .shape = copy(pool, m->shape, components),
                            .shape_std = copy(pool, m->shape_std, components),
                            .frequency_std = copy(pool, m->frequency_std, modes),
                            .point_frequency_hz = copy(pool, m->point_frequency_hz, components),
                            .point_frequency_std = copy(pool, m->point_frequency_std, components)};
    if (pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    job->measurement.raw = raw;
    return ROTID_OK;
}
