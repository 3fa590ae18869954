#include "run/mode_shapes.h"

#include <math.h>

#include "model/deflection.h"

#define AXIS_INTERVALS   400 /* at most: 40 a half wave of a tenth mode, and no picture has many more dots across */
#define MEMBER_INTERVALS 20  /* at least */

/* Measured ones of mode k: a comparison needs two. */
static int components(const struct mode_shapes *m, int k)
{
    int count = 0;
    for (int s = 0; s < m->nsensor; s++)
        count += isfinite(m->measured[s + (ptrdiff_t)k * m->nsensor]);
    return count;
}

static void keep_measured(const struct job *job, struct mode_shapes *m)
{
    for (int k = 0; k < m->nmode; k++) {
        ptrdiff_t at = (ptrdiff_t)k * m->nsensor;
        double largest = 0;
        for (int s = 0; s < m->nsensor; s++) {
            m->measured[at + s] = job->measurement.shape ? job->measurement.shape[at + s] : NAN;
            if (fabs(m->measured[at + s]) > fabs(largest))
                largest = m->measured[at + s];
        }
        m->has_shape[k] = largest != 0;
        for (int s = 0; s < m->nsensor; s++)
            m->measured[at + s] = largest != 0 ? m->measured[at + s] / largest : NAN;
    }
}

/* a of the deflections p [nsensor] to measured mode k; NaN where nothing says it */
static double best_scale(const struct job *job, const struct mode_shapes *m, int k, const double *p)
{
    const double *measured = m->measured + (ptrdiff_t)k * m->nsensor,
                 *std = job->measurement.shape_std ? job->measurement.shape_std + (ptrdiff_t)k * m->nsensor : NULL;
    double product = 0, square = 0;
    int weighted = std != NULL;
    for (int s = 0; s < m->nsensor && weighted; s++)
        weighted = !isfinite(measured[s]) || std[s] > 0;
    for (int s = 0; s < m->nsensor; s++) {
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

/* Mode k as its partner has it. */
static void keep_predicted(const struct job *job, const struct spectrum *s, int number, int k, struct mode_shapes *m)
{
    const struct rotor_model *model = s->model;
    int there = number >= 1 && number <= s->count;
    const double *u = s->phi + (ptrdiff_t)(there ? number - 1 : 0) * model->equations.n;
    double *p = m->predicted + (ptrdiff_t)k * m->nsensor, *axis = m->axis + (ptrdiff_t)k * m->naxis;
    for (int i = 0; i < m->nsensor; i++)
        p[i] = model_sensor_deflection(model, i, u);
    for (int i = 0; i < m->naxis; i++)
        axis[i] = model_deflection(model, (int)((long long)i * (model->naxis - 1) / (m->naxis - 1)), u);
    double factor = there ? best_scale(job, m, k, p) : NAN;
    if (there && !isfinite(factor))
        factor = 1 / largest_of(model, u);
    scale(m->nsensor, factor, p);
    scale(m->naxis, factor, axis);
    for (int i = 0; i < m->nmember; i++) {
        struct member_shape *member = &m->member[i];
        double *shape = member->shape + (ptrdiff_t)k * member->npoint;
        model_member_deflection(model, i, u, member->npoint, member->z, shape);
        scale(member->npoint, factor, shape);
    }
}

static int correlate(struct pool *pool, const struct job *job, const struct spectrum *s, struct mode_shapes *m)
{
    int any = 0;
    double *work = POOL_ARRAY(pool, double, s->nmaster);
    for (int k = 0; k < m->nmode; k++)
        any |= m->has_shape[k] && components(m, k) > 1;
    m->ncolumn = s->count;
    if (!work || !any)
        return work ? ROTID_OK : ROTID_ERROR_MEMORY;
    m->mac = POOL_ARRAY(pool, double, (size_t)m->nmode *(size_t)m->ncolumn);
    m->nco = s->mass ? POOL_ARRAY(pool, double, (size_t)m->nmode *(size_t)m->ncolumn) : NULL;
    if (!m->mac || (s->mass && !m->nco))
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < m->nmode; k++)
        for (int j = 0; j < m->ncolumn; j++) {
            const double *shape = job->measurement.shape + (ptrdiff_t)k * s->nmaster,
                         *mode = s->shape + (ptrdiff_t)j * s->nmaster;
            int usable = m->has_shape[k] && components(m, k) > 1;
            ptrdiff_t at = k + (ptrdiff_t)j * m->nmode;
            m->mac[at] = usable ? rotid_mac(s->nmaster, shape, mode) : NAN;
            if (m->nco)
                m->nco[at] = usable ? spectrum_correlation(s, shape, j, work) : NAN;
        }
    return ROTID_OK;
}

static int make_room(struct pool *pool, const struct rotor_model *model, struct mode_shapes *m)
{
    size_t nmode = (size_t)m->nmode;
    m->has_shape = POOL_ARRAY(pool, int, m->nmode);
    m->measured = POOL_ARRAY(pool, double, nmode *(size_t)m->nsensor);
    m->predicted = POOL_ARRAY(pool, double, nmode *(size_t)m->nsensor);
    m->axis_z = POOL_ARRAY(pool, double, m->naxis);
    m->axis = POOL_ARRAY(pool, double, nmode *(size_t)m->naxis);
    m->member = POOL_ARRAY(pool, struct member_shape, m->nmember);
    if (!m->has_shape || !m->measured || !m->predicted || !m->axis_z || !m->axis || !m->member)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < m->nmember; i++) {
        struct model_member of = model_member(model, i);
        struct member_shape *member = &m->member[i];
        int elements = of.elements;
        *member = (struct member_shape){.name = of.name, .is_bars = of.is_bars};
        elements = elements < MEMBER_INTERVALS ? MEMBER_INTERVALS : elements < AXIS_INTERVALS ? elements : AXIS_INTERVALS;
        member->npoint = elements + 1;
        member->z = POOL_ARRAY(pool, double, member->npoint);
        member->shape = POOL_ARRAY(pool, double, nmode *(size_t)member->npoint);
        if (!member->z || !member->shape)
            return ROTID_ERROR_MEMORY;
    }
    return ROTID_OK;
}

int mode_shapes_make(struct pool *pool, const struct job *job, const struct spectrum *s, const struct comparison *compared,
                     struct mode_shapes *m)
{
    const struct rotor_model *model = s->model;
    *m = (struct mode_shapes){.nmode = compared->nmode,
                              .nsensor = model->rotor->nsensor,
                              .naxis = model->naxis <= AXIS_INTERVALS ? model->naxis : AXIS_INTERVALS + 1,
                              .nmember = model_members(model)};
    int status = make_room(pool, model, m);
    if (status)
        return status;
    keep_measured(job, m);
    for (int i = 0; i < m->naxis; i++)
        m->axis_z[i] = model->z[(long long)i * (model->naxis - 1) / (m->naxis - 1)];
    for (int k = 0; k < m->nmode; k++)
        keep_predicted(job, s, compared->number[k], k, m);
    return correlate(pool, job, s, m);
}
