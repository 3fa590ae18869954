#include "run/run.h"

#include <math.h>

int mesh_is_held(const struct job *job)
{
    return job_discretisation(job) == AS_SOLID && job->options.fit.reduction == ROTID_REDUCTION_NONE;
}

int mesh_hold_as_it_is(struct pool *pool, const struct job *job, int count)
{
    double *ratio = POOL_ARRAY(pool, double, count);
    if (!ratio)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < count; j++)
        ratio[j] = 1;
    const struct held_modes modes = {.count = count, .ratio = ratio};
    return models_held(job->models, &job->rotor) ? ROTID_OK : models_hold(job->models, &job->rotor, &modes);
}

/* shift [n] = shape - a other, a the least-squares scale */
static void shape_shift(int n, const double *shape, const double *other, double *shift)
{
    double product = 0, square = 0;
    for (int i = 0; i < n; i++) {
        product += shape[i] * other[i];
        square += other[i] * other[i];
    }
    for (int i = 0; i < n; i++)
        shift[i] = shape[i] - (square > 0 ? product / square : 0) * other[i];
}

int mesh_hold(struct pool *pool, const struct job *job, const struct spectrum *s, double *moved)
{
    const struct held_modes *before = models_held(job->models, &job->rotor);
    int held = before ? before->count : 0;
    double *ratio = POOL_ARRAY(pool, double, s->count), *shift = POOL_ARRAY(pool, double, (size_t)s->nmaster *(size_t)s->count);
    if (!ratio || !shift)
        return ROTID_ERROR_MEMORY;
    *moved = held < s->count ? INFINITY : 0;
    for (int j = 0; j < s->count; j++) {
        ptrdiff_t at = (ptrdiff_t)j * s->nmaster;
        ratio[j] = s->full_hz[j] / s->other_hz[j];
        if (j < held)
            *moved = fmax(*moved, fabs(ratio[j] / before->ratio[j] - 1));
        if (s->other_shape)
            shape_shift(s->nmaster, s->shape + at, s->other_shape + at, shift + at);
    }
    const struct held_modes modes = {.count = s->count,
                                     .nmaster = s->nmaster,
                                     .ratio = ratio,
                                     .shape = s->other_shape ? s->shape : NULL,
                                     .shift = s->other_shape ? shift : NULL};
    return models_hold(job->models, &job->rotor, &modes);
}

/* The measured shape less the shift at its scale, by the components that are measured. */
static void take_shift(int n, const double *measured, const double *shape, const double *shift, double *out)
{
    double product = 0, square = 0;
    for (int i = 0; i < n; i++)
        if (isfinite(measured[i])) {
            product += measured[i] * shape[i];
            square += shape[i] * shape[i];
        }
    for (int i = 0; i < n; i++)
        out[i] = measured[i] - (square > 0 ? product / square : 0) * shift[i];
}

int mesh_of_fit(struct pool *pool, const struct job *job, const int *number, int *refine, double **frequency_hz,
                const double **shape)
{
    const struct job_measurement *measured = &job->measurement;
    int nmode = measured->nmode, n = job->rotor.nsensor;
    const struct held_modes *held = mesh_is_held(job) ? models_held(job->models, &job->rotor) : NULL;
    for (int k = 0; k < nmode && held; k++)
        if (number[k] > held->count)
            held = NULL;
    int shifts = held && held->shift && held->nmaster == n && measured->shape;
    double *shifted = shifts ? POOL_ARRAY(pool, double, (size_t)n *(size_t)nmode) : NULL;
    *frequency_hz = POOL_ARRAY(pool, double, nmode);
    *refine = held ? COARSE_MESH : 1;
    *shape = shifts ? shifted : measured->shape;
    if (!*frequency_hz || (shifts && !shifted))
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < nmode; k++) {
        ptrdiff_t at = (ptrdiff_t)k * n, of = held ? (ptrdiff_t)(number[k] - 1) * n : 0;
        (*frequency_hz)[k] = measured->frequency_hz[k] / (held ? held->ratio[number[k] - 1] : 1);
        if (shifts)
            take_shift(n, measured->shape + at, held->shape + of, held->shift + of, shifted + at);
    }
    return ROTID_OK;
}
