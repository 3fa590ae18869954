#include "run/spectrum.h"

#include <math.h>
#include <string.h>

#include "modal/prediction.h"
#include "model/model.h"

#define MOST_MASTERS 1000 /* more cost seconds and gigabytes to condense onto, the cube and the square of their number */

struct solved { /* a model, and its modes */
    struct rotor_model *model;
    struct prediction prediction;
};

/* Full model on a mesh `refine` times as fine; *count is lowered to the modes it has. scratch: for what its solution takes;
 * coarse: what has been solved on a coarser mesh, or NULL */
static int full_model(struct pool *pool, struct pool *scratch, struct models *models, const struct rotor *rotor, int nparameter,
                      const struct parameter *parameter, const double *x, int refine, const struct solved *coarse, int *count,
                      struct solved *solved)
{
    struct rotor_model *model = solved->model;
    struct prediction *prediction = &solved->prediction;
    int failed, status = model_open(pool, models, rotor, nparameter, parameter, refine, model, &failed);
    int most = status ? 0 : model->equations.n - model->equations.nrigid;
    *count = *count < most ? *count : most;
    if (!status && coarse)
        status = model_begin_with(scratch, model, coarse->model, coarse->prediction.count, coarse->prediction.phi);
    if (!status)
        status = prediction_new(scratch, &model->equations, ROTID_REDUCTION_NONE, ROTID_NELSON, model->equations.nrigid + *count,
                                0, prediction);
    if (!status)
        status = prediction_compute(prediction, x);
    if (!status && !rotor->neffect) /* before candidates are tried, one after the other */
        status = models_keep_modes(models, model->equations.n, prediction->count, prediction->phi);
    return status;
}

static void keep_shapes(const struct rotor_model *model, const struct prediction *p, int count, double *shapes)
{
    int nmaster = model->equations.nmaster;
    for (int j = 0; j < count; j++) {
        double *shape = shapes + (ptrdiff_t)j * nmaster, largest = 0;
        for (int i = 0; i < nmaster; i++) {
            shape[i] = prediction_at_sensor(p, model->equations.nrigid + j, i);
            if (fabs(shape[i]) > fabs(largest))
                largest = shape[i];
        }
        for (int i = 0; i < nmaster && largest != 0; i++)
            shape[i] /= largest;
    }
}

static double *copy(struct pool *pool, const double *from, int rows, int columns)
{
    size_t count = (size_t)rows * (size_t)columns;
    double *to = POOL_ARRAY(pool, double, count);
    if (to && count)
        memcpy(to, from, count * sizeof *to);
    return to;
}

/* Nothing to condense onto, with one sensor, say, and nothing to report */
static int is_impossible(int status)
{
    return status == ROTID_ERROR_SLAVE || status == ROTID_ERROR_MASS || status == ROTID_ERROR_STIFFNESS;
}

/* Guyan's mass for the NCO */
static int condensed_mass(struct pool *pool, struct pool *scratch, const struct solved *full, struct spectrum *s)
{
    struct reduction r;
    const struct prediction *p = &full->prediction;
    int status = reduction_new(scratch, ROTID_GUYAN, &p->k, s->nmaster, full->model->equations.master, &r);
    if (!status)
        status = reduction_compute(&r, &p->k, &p->m);
    if (!status && !(s->mass = copy(pool, r.mc, s->nmaster, s->nmaster)))
        status = ROTID_ERROR_MEMORY;
    return is_impossible(status) ? ROTID_OK : status;
}

/* Frequencies of the condensed model as far as it has any, beginning with the modes of the full one; full_hz: of the same mesh in
 * full */
static int condensed_model(struct pool *scratch, const struct solved *full, const double *x, int reduction, const double *full_hz,
                           struct spectrum *s)
{
    int wanted = s->nrigid + s->count, count = wanted < s->nmaster ? wanted : s->nmaster;
    rotid_model model = full->model->equations;
    struct prediction p;
    model.modes = full->prediction.phi;
    model.nmodes = full->prediction.count;
    int status = prediction_new(scratch, &model, reduction, ROTID_NELSON, count, 0, &p);
    if (!status)
        status = prediction_compute(&p, x);
    for (int j = 0; j < s->count && !status; j++)
        s->reduced_hz[j] = s->nrigid + j < count ? prediction_hz(&p, s->nrigid + j) * s->full_hz[j] / full_hz[j] : NAN;
    return is_impossible(status) ? ROTID_OK : status;
}

int spectrum_compute(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                     const struct parameter *parameter, const double *x, int reduction, int count, struct spectrum *spectrum)
{
    return spectrum_compute_parts(pool, models, rotor, nparameter, parameter, x, reduction, count,
                                  SPECTRUM_MESH | SPECTRUM_REDUCED | SPECTRUM_MASS, spectrum);
}

/* The matrices and factors of a solution, ten times what is kept of it, are in the scratch. */
static int compute(struct pool *pool, struct pool *scratch, struct models *models, const struct rotor *rotor, int nparameter,
                   const struct parameter *parameter, const double *x, int reduction, int count, int parts, struct spectrum *s)
{
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model), *other = POOL_NEW(pool, struct rotor_model);
    struct solved here = {.model = model}, there = {.model = other};
    const struct prediction *p = &here.prediction, *q = &there.prediction;
    if (!model || !other)
        return ROTID_ERROR_MEMORY;
    int refine = parts & SPECTRUM_COARSE ? COARSE_MESH : 1;
    int status = full_model(pool, scratch, models, rotor, nparameter, parameter, x, refine, NULL, &count, &here);
    if (status)
        return status;
    const struct mesh_limit limit = model_mesh_limit(model);
    if (parts & SPECTRUM_MESH)
        status = full_model(pool, scratch, models, rotor, nparameter, parameter, x, limit.refine,
                            limit.refine > refine ? &here : NULL, &count, &there);
    double *meshed_hz = POOL_ARRAY(scratch, double, count);
    if (status || !meshed_hz)
        return status ? status : ROTID_ERROR_MEMORY;
    *s = (struct spectrum){.nrigid = model->equations.nrigid,
                           .count = count,
                           .nmaster = model->equations.nmaster,
                           .nnode = model->naxis,
                           .model = model,
                           .phi = copy(pool, p->phi + (ptrdiff_t)model->equations.nrigid * p->size, p->size, count)};
    double **arrays[] = {&s->full_hz, &s->other_hz, &s->reduced_hz, &s->reduction_error_percent, &s->mesh_error_percent};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        if (!(*arrays[i] = POOL_ARRAY(pool, double, count)))
            return ROTID_ERROR_MEMORY;
    s->shape = POOL_ARRAY(pool, double, (size_t)s->nmaster *(size_t)count);
    int alike = parts & SPECTRUM_MESH && other->equations.nmaster == s->nmaster;
    s->other_shape = alike ? POOL_ARRAY(pool, double, (size_t)s->nmaster *(size_t)count) : NULL;
    s->master_z = POOL_ARRAY(pool, double, s->nmaster);
    s->rigid_hz = POOL_ARRAY(pool, double, s->nrigid);
    if (!s->phi || !s->shape || (alike && !s->other_shape) || !s->master_z || !s->rigid_hz)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < s->nrigid; j++)
        s->rigid_hz[j] = prediction_hz(p, j);
    for (int i = 0; i < s->nmaster; i++)
        s->master_z[i] = model_master_z(model, i);
    keep_shapes(model, p, count, s->shape);
    if (alike)
        keep_shapes(other, q, count, s->other_shape);
    for (int j = 0; j < count; j++) {
        double hz = prediction_hz(p, s->nrigid + j);
        s->reduced_hz[j] = s->other_hz[j] = s->mesh_error_percent[j] = NAN;
        s->full_hz[j] = meshed_hz[j] = hz;
        if (!(parts & SPECTRUM_MESH))
            continue;
        s->other_hz[j] = prediction_hz(q, other->equations.nrigid + j);
        double led_to = hz - limit.share * (s->other_hz[j] - hz);
        s->full_hz[j] = limit.counts ? led_to : hz;
        s->mesh_error_percent[j] = 100 * (hz / led_to - 1);
    }
    /* what a condensation costs is seen on a coarse mesh as well */
    int on_other = alike && other->equations.n < model->equations.n;
    const struct solved *cheap = on_other ? &there : &here;
    if (parts & SPECTRUM_MASS && s->nmaster <= MOST_MASTERS)
        status = condensed_mass(pool, scratch, cheap, s);
    if (parts & SPECTRUM_REDUCED && s->nmaster <= MOST_MASTERS && !status)
        status = condensed_model(scratch, cheap, x, reduction, on_other ? s->other_hz : meshed_hz, s);
    for (int j = 0; j < count && !status; j++)
        s->reduction_error_percent[j] = 100 * (s->reduced_hz[j] / s->full_hz[j] - 1);
    return status;
}

int spectrum_compute_parts(struct pool *pool, struct models *models, const struct rotor *rotor, int nparameter,
                           const struct parameter *parameter, const double *x, int reduction, int count, int parts,
                           struct spectrum *s)
{
    struct pool scratch;
    pool_open(&scratch, pool->allocator);
    int status = compute(pool, &scratch, models, rotor, nparameter, parameter, x, reduction, count, parts, s);
    pool_close(&scratch);
    return status;
}

double spectrum_correlation(const struct spectrum *s, const double *shape, int j, double *work)
{
    const double *mode = s->shape + (ptrdiff_t)j * s->nmaster;
    return s->mass ? rotid_nco(s->nmaster, s->mass, shape, mode, work) : rotid_mac(s->nmaster, shape, mode);
}
