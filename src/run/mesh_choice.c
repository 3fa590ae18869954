#include "run/run.h"

#include <math.h>

#define FIRST_PER_WAVE 8   /* elements for half a wave of the highest mode */
#define ROUNDS         4   /* the second one mostly ends it */
#define MARGIN         0.9 /* of h: what h^2 leaves out */

/* Elements no longer than h. Returns their number. */
static int divide(struct rotor *rotor, int count, const int *section, double h)
{
    int elements = 0;
    for (int i = 0; i < count; i++) {
        struct segment *s = &rotor->segment[section[i]];
        s->elements = (int)fmin(fmax(ceil(s->length / h - 1e-9), 1), MESH_CHOICE_LARGEST);
        elements += s->elements;
    }
    return elements;
}

/* The largest error of modes 1 to `mode`; NaN where there is no telling. */
static int mesh_error(struct pool *pool, const struct job *job, int mode, double *error)
{
    struct spectrum s;
    struct pool scratch;
    enum discretisation as = job->options.type == MODE_BENDING ? AS_BEAM : job_discretisation(job);
    *error = NAN;
    pool_open(&scratch, pool->allocator);
    int status = spectrum_compute_parts(&scratch, models_as(&scratch, as), &job->rotor, 0, NULL, NULL, ROTID_GUYAN, mode,
                                        SPECTRUM_MESH, &s);
    for (int j = 0; !status && j < s.count; j++)
        *error = fmax(isnan(*error) ? 0 : *error, fabs(s.mesh_error_percent[j]) / 100);
    pool_close(&scratch);
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
}

int mesh_choose(struct pool *pool, struct job *job, int count, const int *section, struct mesh_choice *choice)
{
    const struct job_measurement *m = &job->measurement;
    double length = rotor_length(&job->rotor), free = 0, noise = INFINITY;
    *choice = (struct mesh_choice){.mode = m->nmode ? 1 : MESH_CHOICE_MODES};
    for (int k = 0; k < m->nmode; k++) {
        choice->mode = m->number[k] > choice->mode ? m->number[k] : choice->mode;
        noise = m->frequency_std[k] > 0 ? fmin(noise, m->frequency_std[k]) : noise;
    }
    for (int i = 0; i < count; i++)
        free += job->rotor.segment[section[i]].length;
    choice->is_noise_known = isfinite(noise);
    choice->wanted = choice->is_noise_known ? MESH_CHOICE_SHARE * noise : MESH_CHOICE_ERROR;
    double h = length / (FIRST_PER_WAVE * (choice->mode + 1)), least = free / MESH_CHOICE_LARGEST;
    for (int round = 0; round < ROUNDS; round++) {
        h = fmax(h, least);
        choice->elements = divide(&job->rotor, count, section, h);
        int status = mesh_error(pool, job, choice->mode, &choice->error);
        if (status)
            return status;
        if (!(choice->error > choice->wanted) || h <= least)
            break;
        h *= MARGIN * sqrt(choice->wanted / choice->error);
    }
    for (int i = 0; i < count; i++) {
        const struct segment *s = &job->rotor.segment[section[i]];
        choice->length_m = fmax(choice->length_m, s->length / s->elements);
    }
    return ROTID_OK;
}
