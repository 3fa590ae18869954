#include "run/run.h"

#define AXIS_INTERVALS   400 /* at most: 40 a half wave of a tenth mode, and no picture has many more dots across */
#define MEMBER_INTERVALS 20  /* at least */

/* A comparison needs two components. */
static int is_comparable(const rotid_mode_shapes *mode)
{
    int count = 0;
    for (int s = 0; s < mode->nmeasured; s++)
        count += isfinite(mode->measured[s]);
    return count > 1;
}

/* Nothing where no component of measured mode k is other than zero. out: zeroed */
static void put_measured(struct pool *pool, const struct job *job, int nsensor, int k, rotid_mode_shapes *out)
{
    if (!job->measurement.shape)
        return;
    ptrdiff_t at = (ptrdiff_t)k * nsensor;
    const double *shape = job->measurement.shape + at;
    double largest = 0, *std = job->measurement.shape_std ? job->measurement.shape_std + at : NULL;
    int is_known = 0;
    for (int s = 0; s < nsensor; s++) {
        if (fabs(shape[s]) > fabs(largest))
            largest = shape[s];
        is_known |= std && isfinite(std[s]);
    }
    out->nmeasured = largest != 0 ? POOL_LIST(pool, out->measured, nsensor) : 0;
    for (int s = 0; s < out->nmeasured; s++)
        out->measured[s] = shape[s] / largest;
    out->measured_std = out->nmeasured && is_known ? std : NULL;
    out->nmeasured_std = out->measured_std ? nsensor : 0;
}

/* a of the predicted shape to the measured one; NaN where nothing says it */
static double best_scale(const rotid_mode_shapes *mode)
{
    const double *p = mode->predicted, *measured = mode->measured, *std = mode->measured_std;
    double product = 0, square = 0;
    int weighted = std != NULL;
    for (int s = 0; s < mode->nmeasured && weighted; s++)
        weighted = !isfinite(measured[s]) || std[s] > 0;
    for (int s = 0; s < mode->nmeasured; s++) {
        double weight = weighted ? 1 / (std[s] * std[s]) : 1;
        if (!isfinite(measured[s]))
            continue;
        product += weight * p[s] * measured[s];
        square += weight * p[s] * p[s];
    }
    return product != 0 && square > 0 ? product / square : NAN;
}

static void scale(ptrdiff_t count, double factor, double *x)
{
    for (ptrdiff_t i = 0; i < count; i++)
        x[i] *= factor;
}

static double largest_of(const struct rotor_model *model, const double *u)
{
    double largest = 0;
    for (int i = 0; i < model->naxis; i++)
        if (fabs(model_deflection(model, i, u)) > fabs(largest))
            largest = model_deflection(model, i, u);
    return largest;
}

/* Node i of those that are shown. */
static int shown(const struct rotor_model *model, int i, int naxis)
{
    return (int)((long long)i * (model->naxis - 1) / (naxis - 1));
}

static void put_member(struct pool *pool, const struct rotor_model *model, int i, const double *u, double factor,
                       rotid_mode_shapes *out)
{
    struct model_member of = model_member(model, i);
    int elements = of.elements < MEMBER_INTERVALS ? MEMBER_INTERVALS
                   : of.elements < AXIS_INTERVALS ? of.elements
                                                  : AXIS_INTERVALS;
    rotid_member_shape *member = of.is_bars ? &out->bars[out->nbars++] : &out->tierods[out->ntierods++];
    *member = (rotid_member_shape){.name = of.name,
                                   .nz_m = elements + 1,
                                   .z_m = POOL_ARRAY(pool, double, elements + 1),
                                   .shape = POOL_ARRAY(pool, double, elements + 1)};
    if (!member->z_m || !member->shape)
        return;
    discrete_member_deflection(&model->discrete, i, u, member->nz_m, member->z_m, member->shape);
    scale(member->nz_m, factor, member->shape);
}

/* As the partner of the measured mode has it. */
static void put_predicted(struct pool *pool, const struct spectrum *s, int naxis, rotid_mode_shapes *out)
{
    const struct rotor_model *model = s->model;
    int there = out->mode >= 1 && out->mode <= s->count, nmember = model->rotor->ntierod + model->rotor->nbars;
    const double *u = s->phi + (ptrdiff_t)(there ? out->mode - 1 : 0) * model->equations.n;
    out->npredicted = POOL_LIST(pool, out->predicted, model->rotor->nsensor);
    out->npredicted_axis = POOL_LIST(pool, out->predicted_axis, naxis);
    if (!POOL_LIST(pool, out->tierods, nmember) || !POOL_LIST(pool, out->bars, nmember))
        nmember = 0;
    for (int i = 0; i < out->npredicted; i++)
        out->predicted[i] = u[discrete_sensor_dof(&model->discrete, i)];
    for (int i = 0; i < out->npredicted_axis; i++)
        out->predicted_axis[i] = model_deflection(model, shown(model, i, naxis), u);
    double factor = there && out->predicted ? best_scale(out) : NAN;
    if (there && !isfinite(factor))
        factor = 1 / largest_of(model, u);
    scale(out->npredicted, factor, out->predicted);
    scale(out->npredicted_axis, factor, out->predicted_axis);
    for (int i = 0; i < nmember; i++)
        put_member(pool, model, i, u, factor, out);
}

static void correlate(struct pool *pool, const struct job *job, const struct spectrum *s, rotid_identification *out)
{
    const rotid_shapes *shapes = out->shapes;
    ptrdiff_t nmode = shapes->nmodes;
    double *work = POOL_ARRAY(pool, double, s->nmaster);
    int any = 0;
    for (int k = 0; k < nmode; k++)
        any |= is_comparable(&shapes->modes[k]);
    if (!work || !any)
        return;
    out->mac_matrix = POOL_ARRAY(pool, double, nmode * s->count);
    out->nco_matrix = s->mass ? POOL_ARRAY(pool, double, nmode * s->count) : NULL;
    out->matrix_rows = job->measurement.number;
    out->nmatrix_rows = shapes->nmodes;
    out->nmatrix_columns = POOL_LIST(pool, out->matrix_columns, s->count);
    for (int j = 0; j < out->nmatrix_columns && !pool->out_of_memory; j++) {
        out->matrix_columns[j] = j + 1;
        for (int k = 0; k < nmode; k++) {
            const double *shape = job->measurement.shape + (ptrdiff_t)k * s->nmaster,
                         *mode = s->shape + (ptrdiff_t)j * s->nmaster;
            int usable = is_comparable(&shapes->modes[k]);
            out->mac_matrix[k + j * nmode] = usable ? rotid_mac(s->nmaster, shape, mode) : NAN;
            if (s->mass)
                out->nco_matrix[k + j * nmode] = usable ? spectrum_correlation(s, shape, j, work) : NAN;
        }
    }
}

int mode_shapes_make(struct pool *pool, const struct job *job, const struct spectrum *s, const struct comparison *compared,
                     rotid_identification *out)
{
    const struct rotor_model *model = s->model;
    rotid_shapes *to = out->shapes = POOL_NEW(pool, rotid_shapes);
    if (!to)
        return ROTID_ERROR_MEMORY;
    to->z_m = POOL_ARRAY(pool, double, model->rotor->nsensor);
    to->nsensor_id = to->z_m ? POOL_LIST(pool, to->sensor_id, model->rotor->nsensor) : 0;
    for (int i = 0; i < to->nsensor_id; i++) {
        to->sensor_id[i] = model->rotor->sensor[i].id;
        to->z_m[i] = model->rotor->sensor[i].position;
    }
    to->naxis_z_m = POOL_LIST(pool, to->axis_z_m, model->naxis <= AXIS_INTERVALS ? model->naxis : AXIS_INTERVALS + 1);
    for (int i = 0; i < to->naxis_z_m; i++)
        to->axis_z_m[i] = model->z[shown(model, i, to->naxis_z_m)];
    to->nmodes = POOL_LIST(pool, to->modes, compared->nmode);
    for (int k = 0; k < to->nmodes; k++) {
        to->modes[k] = (rotid_mode_shapes){.mode = compared->number[k], .measured_mode = job->measurement.number[k]};
        put_measured(pool, job, model->rotor->nsensor, k, &to->modes[k]);
        put_predicted(pool, s, to->naxis_z_m, &to->modes[k]);
    }
    correlate(pool, job, s, out);
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}
