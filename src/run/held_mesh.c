#include "run/held_mesh.h"

#include <math.h>

int mesh_is_held(const struct job *job)
{
    return job->options.solid && job->options.fit.reduction == ROTID_REDUCTION_NONE;
}

int mesh_hold_as_it_is(struct pool *pool, const struct job *job, int count)
{
    int known;
    double *ratio = POOL_ARRAY(pool, double, count);
    if (!ratio)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < count; j++)
        ratio[j] = 1;
    return models_held(job->models, &job->rotor, &known) ? ROTID_OK : models_hold(job->models, &job->rotor, count, ratio);
}

int mesh_hold(struct pool *pool, const struct job *job, const struct spectrum *spectrum, double *moved)
{
    int count;
    const double *before = models_held(job->models, &job->rotor, &count);
    double *ratio = POOL_ARRAY(pool, double, spectrum->count);
    if (!ratio)
        return ROTID_ERROR_MEMORY;
    *moved = count < spectrum->count ? INFINITY : 0;
    for (int j = 0; j < spectrum->count; j++) {
        ratio[j] = spectrum->full_hz[j] / spectrum->other_hz[j];
        if (j < count)
            *moved = fmax(*moved, fabs(ratio[j] / before[j] - 1));
    }
    return models_hold(job->models, &job->rotor, spectrum->count, ratio);
}

int mesh_of_fit(struct pool *pool, const struct job *job, const int *number, int *refine, double **frequency_hz)
{
    int count, nmode = job->measurement.nmode;
    const double *ratio = mesh_is_held(job) ? models_held(job->models, &job->rotor, &count) : NULL;
    *frequency_hz = POOL_ARRAY(pool, double, nmode);
    *refine = 1;
    if (!*frequency_hz)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < nmode && ratio; k++)
        if (number[k] > count)
            ratio = NULL;
    for (int k = 0; k < nmode; k++)
        (*frequency_hz)[k] = job->measurement.frequency_hz[k] / (ratio ? ratio[number[k] - 1] : 1);
    if (ratio)
        *refine = COARSE_MESH;
    return ROTID_OK;
}
