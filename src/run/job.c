#include "run/run.h"

#include <math.h>

struct job_place job_part_place(const struct job *job, int failed)
{
    const struct rotor *rotor = &job->rotor;
    if (!job->part)
        return (struct job_place){job->deck, 1, 1};
    return job->part[failed < rotor->ngroup + rotor->ntierod + rotor->nbars ? failed : 0];
}

struct job_place job_sensor_place(const struct job *job, int sensor)
{
    const struct rotor *rotor = &job->rotor;
    return job->part ? job->part[rotor->ngroup + rotor->ntierod + rotor->nbars + sensor] : (struct job_place){job->deck, 1, 1};
}

int job_knows_frequency_noise(const struct job *job)
{
    for (int k = 0; k < job->measurement.nmode; k++)
        if (!isfinite(job->measurement.frequency_std[k]))
            return 0;
    return job->measurement.nmode > 0;
}

int job_knows_shape_noise(const struct job *job)
{
    ptrdiff_t components = (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode;
    if (!job->measurement.shape)
        return 0;
    for (ptrdiff_t i = 0; i < components; i++)
        if (isfinite(job->measurement.shape[i]) && !isfinite(job->measurement.shape_std[i]))
            return 0;
    return 1;
}

int job_fits_shapes(const struct job *job)
{
    return job->measurement.shape && job_knows_shape_noise(job);
}

enum discretisation job_discretisation(const struct job *job)
{
    const enum discretisation in_bending = job->options.solid ? AS_SOLID : AS_BEAM;
    return job->options.type == MODE_BENDING ? in_bending : job->options.type == MODE_TORSION ? AS_TORSION : AS_AXIAL;
}

int job_of_type(struct pool *pool, const struct job *job, enum mode_type type, struct job *other)
{
    *other = *job;
    if (type == job->options.type)
        return ROTID_OK;
    other->options.type = type;
    other->measurement = (struct job_measurement){0};
    other->rotor.settled_rigid = other->rotor.count_all = 0;
    other->models = models_as(pool, job_discretisation(other));
    return other->models ? ROTID_OK : ROTID_ERROR_MEMORY;
}
