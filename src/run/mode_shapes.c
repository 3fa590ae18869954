#include "run/mode_shapes.h"

#include <math.h>

#include "beam/deflection.h"

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
            m->measured[at + s] = job->shape ? job->shape[at + s] : NAN;
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
                 *std = job->shape_std ? job->shape_std + (ptrdiff_t)k * m->nsensor : NULL;
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

static double largest_of(int naxis, const double *u)
{
    double largest = 0;
    for (int i = 0; i < naxis; i++)
        if (fabs(u[2 * (ptrdiff_t)i]) > fabs(largest))
            largest = u[2 * (ptrdiff_t)i];
    return largest;
}

/* Mode k as its partner has it. */
static void keep_predicted(const struct job *job, const struct spectrum *s, int number, int k, struct mode_shapes *m)
{
    const struct mesh *mesh = &s->beam->mesh;
    int there = number >= 1 && number <= s->count;
    const double *u = s->phi + (ptrdiff_t)(there ? number - 1 : 0) * mesh->ndof;
    double *p = m->predicted + (ptrdiff_t)k * m->nsensor, *axis = m->axis + (ptrdiff_t)k * m->naxis;
    for (int i = 0; i < m->nsensor; i++)
        p[i] = u[2 * (ptrdiff_t)mesh->sensor_node[i]];
    for (int i = 0; i < m->naxis; i++)
        axis[i] = u[2 * (ptrdiff_t)((long long)i * (mesh->naxis - 1) / (m->naxis - 1))];
    double factor = there ? best_scale(job, m, k, p) : NAN;
    if (there && !isfinite(factor))
        factor = 1 / largest_of(mesh->naxis, u);
    scale(m->nsensor, factor, p);
    scale(m->naxis, factor, axis);
    for (int i = 0; i < m->nmember; i++) {
        struct member_shape *member = &m->member[i];
        double *shape = member->shape + (ptrdiff_t)k * member->npoint;
        if (member->is_bars)
            bars_deflection(s->beam, i - s->beam->rotor.ntierod, u, member->npoint, member->z, shape);
        else
            tierod_deflection(s->beam, i, u, member->npoint, member->z, shape);
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
            const double *shape = job->shape + (ptrdiff_t)k * s->nmaster, *mode = s->shape + (ptrdiff_t)j * s->nmaster;
            int usable = m->has_shape[k] && components(m, k) > 1;
            ptrdiff_t at = k + (ptrdiff_t)j * m->nmode;
            m->mac[at] = usable ? rotid_mac(s->nmaster, shape, mode) : NAN;
            if (m->nco)
                m->nco[at] = usable ? spectrum_correlation(s, shape, j, work) : NAN;
        }
    return ROTID_OK;
}

static int make_room(struct pool *pool, const struct beam *beam, struct mode_shapes *m)
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
        int bars = i - beam->rotor.ntierod;
        struct member_shape *member = &m->member[i];
        *member = (struct member_shape){.name = bars < 0 ? beam->rotor.tierod[i].name : beam->rotor.bars[bars].name,
                                        .is_bars = bars >= 0};
        int elements =
            bars < 0 ? chain_elements(&beam->mesh.tierod[i]) : 2 * chain_elements(&beam->mesh.bars[2 * (ptrdiff_t)bars]);
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
    const struct mesh *mesh = &s->beam->mesh;
    *m = (struct mode_shapes){.nmode = compared->nmode,
                              .nsensor = s->beam->rotor.nsensor,
                              .naxis = mesh->naxis <= AXIS_INTERVALS ? mesh->naxis : AXIS_INTERVALS + 1,
                              .nmember = s->beam->rotor.ntierod + s->beam->rotor.nbars};
    int status = make_room(pool, s->beam, m);
    if (status)
        return status;
    keep_measured(job, m);
    for (int i = 0; i < m->naxis; i++)
        m->axis_z[i] = mesh->z[(long long)i * (mesh->naxis - 1) / (m->naxis - 1)];
    for (int k = 0; k < m->nmode; k++)
        keep_predicted(job, s, compared->number[k], k, m);
    return correlate(pool, job, s, m);
}
