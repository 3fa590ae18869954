#include "modal/modal.h"

/* Residuals of the pairs of wide bands, each step of which has its price. An eigenvalue is off by the square of its own. */
#define NEAR_VALUE  1e-7
#define NEAR_VECTOR 1e-9

int functional_fits(const rotid_measured *measured, int mode)
{
    return !measured->holdout || !measured->holdout[mode];
}

/* Each mode divided by its largest component: the stated noise is relative to it. */
static void scale_shapes(const rotid_measured *measured, int nmaster, double *shape)
{
    for (int k = 0; k < measured->nmode; k++) {
        const double *source = measured->shape + (ptrdiff_t)k * nmaster;
        double *target = shape + (ptrdiff_t)k * nmaster, largest = 0;
        for (int s = 0; s < nmaster; s++)
            if (isfinite(source[s]) && fabs(source[s]) > fabs(largest))
                largest = source[s];
        for (int s = 0; s < nmaster; s++)
            target[s] = largest != 0 ? source[s] / fabs(largest) : NAN;
    }
}

int functional_count_components(const struct functional *f, int mode)
{
    int nmaster = f->prediction.model->nmaster, count = 0;
    for (int s = 0; f->shape && s < nmaster; s++)
        count += isfinite(f->shape[s + (ptrdiff_t)mode * nmaster]);
    return count;
}

int functional_new(struct pool *pool, int kind, int reduction, int derivative, const rotid_model *model,
                   const rotid_measured *measured, struct functional *f)
{
    int nmode = measured->nmode, nmaster = model->nmaster, highest = 0, fitted = 0;
    *f = (struct functional){.kind = kind, .measured = measured};
    int status = measured_check(model, measured, kind, reduction, NULL);
    if (status)
        return status;
    for (int k = 0; k < nmode; k++)
        highest = measured->number[k] > highest ? measured->number[k] : highest;
    int count = model->nrigid + highest;
    /* condensed, the hybrid quotient is formed with the measured shape as (15) has it; of the full model no measured shape is
     * known at every degree of freedom, and the quotient is the eigenvalue either way */
    f->with_vectors = measured->shape && (kind == ROTID_LIKELIHOOD || reduction != ROTID_REDUCTION_NONE);
    status = prediction_new(pool, model, reduction, derivative, count, f->with_vectors, &f->prediction);
    f->wanted = POOL_ARRAY(pool, int, f->prediction.count);
    f->pair = POOL_ARRAY(pool, int, nmode);
    f->omega = POOL_ARRAY(pool, double, nmode);
    f->quotient = POOL_ARRAY(pool, double, nmode);
    f->work = POOL_ARRAY(pool, double, 2 * nmaster);
    f->shape = measured->shape ? POOL_ARRAY(pool, double, (size_t)nmaster *(size_t)nmode) : NULL;
    if (status)
        return status;
    if (!f->with_vectors && reduction == ROTID_REDUCTION_NONE) /* rigid motions have no number */
        eigen_full_want(&f->prediction.full, model->nrigid < count ? model->nrigid : 0, count);
    if (reduction == ROTID_REDUCTION_NONE && f->prediction.full.wide)
        eigen_full_within(&f->prediction.full, f->with_vectors ? NEAR_VECTOR : NEAR_VALUE);
    if (!f->wanted || !f->pair || !f->omega || !f->quotient || !f->work || (measured->shape && !f->shape))
        return ROTID_ERROR_MEMORY;
    if (measured->shape && f->shape)
        scale_shapes(measured, nmaster, f->shape);
    for (int k = 0; k < nmode; k++) {
        f->pair[k] = model->nrigid + measured->number[k] - 1;
        f->omega[k] = TWO_PI * measured->frequency_hz[k];
        if (!functional_fits(measured, k))
            continue;
        f->wanted[f->pair[k]] = 1;
        fitted++;
        f->nresidual += 1 + (kind == ROTID_LIKELIHOOD ? functional_count_components(f, k) : 0);
    }
    if (kind == ROTID_LIKELIHOOD && fitted)
        f->nwhole = (measured->mass_std > 0) + (measured->centre_std > 0);
    f->nresidual += f->nwhole;
    f->whole_work = f->nwhole ? POOL_ARRAY(pool, double, model->n) : NULL;
    return f->nwhole && !f->whole_work ? ROTID_ERROR_MEMORY : ROTID_OK;
}

static int uses_shape(const struct functional *f, int mode)
{
    return f->with_vectors && f->kind != ROTID_LIKELIHOOD && functional_count_components(f, mode) > 0;
}

/* R*_k = phi^' K~ phi~ / (phi^' M~ phi~) (15); where no shape was measured, the eigenvalue it equals */
static int hybrid_quotient(struct functional *f, int mode)
{
    const struct prediction *p = &f->prediction;
    int k = f->pair[mode], n = p->size;
    f->quotient[mode] = p->lambda[k];
    if (!uses_shape(f, mode))
        return ROTID_OK;
    const double *measured = f->shape + (ptrdiff_t)mode * n, *phi = p->phi + (ptrdiff_t)k * n;
    double numerator = 0, denominator = 0, own = 0;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            double left = isfinite(measured[i]) ? measured[i] : 0, *kc = p->condensed.kc, *mc = p->condensed.mc;
            numerator += left * kc[i + (ptrdiff_t)j * n] * phi[j];
            denominator += left * mc[i + (ptrdiff_t)j * n] * phi[j];
            own += left * mc[i + (ptrdiff_t)j * n] * (isfinite(measured[j]) ? measured[j] : 0);
        }
    /* a cross product this small next to phi^' M~ phi^ (phi~ has 1) would leave the quotient to rounding */
    if (!(fabs(denominator) > 1e-4 * sqrt(own)))
        return ROTID_ERROR_UNPAIRED;
    f->quotient[mode] = numerator / denominator;
    return ROTID_OK;
}

/* dR*_k/dx_q, the bracket of (43): [phi^' dK~ phi~ + phi^' K~ dphi~ - R* (phi^' dM~ phi~ + phi^' M~ dphi~)] / phi^' M~ phi~ */
static double hybrid_quotient_derivative(const struct functional *f, int mode, int q)
{
    const struct prediction *p = &f->prediction;
    int k = f->pair[mode], n = p->size, first;
    /* R* is the eigenvalue whatever the measured shape is; the bracket needs how phi~ turns in a cluster, which dphi~ leaves out
     */
    if (!uses_shape(f, mode) || eigenvalue_cluster(p->count, p->lambda, k, &first) > 1)
        return p->dlambda[k + (ptrdiff_t)q * p->count];
    ptrdiff_t place = prediction_place(p, k, q);
    const double *measured = f->shape + (ptrdiff_t)mode * n, *phi = p->phi + (ptrdiff_t)k * n, *dphi = p->dphi + place;
    double numerator = 0, denominator = 0;
    for (int i = 0; i < n; i++) {
        if (!isfinite(measured[i]))
            continue;
        double k_dphi = 0, m_dphi = 0, m_phi = 0;
        for (int j = 0; j < n; j++) {
            k_dphi += p->condensed.kc[i + (ptrdiff_t)j * n] * dphi[j];
            m_dphi += p->condensed.mc[i + (ptrdiff_t)j * n] * dphi[j];
            m_phi += p->condensed.mc[i + (ptrdiff_t)j * n] * phi[j];
        }
        numerator += measured[i] * (p->kx[place + i] + k_dphi - f->quotient[mode] * (p->mx[place + i] + m_dphi));
        denominator += measured[i] * m_phi;
    }
    return numerator / denominator;
}

double functional_mac(const struct functional *f, int mode)
{
    int nmaster = f->prediction.model->nmaster;
    for (int s = 0; s < nmaster && f->shape; s++)
        f->work[s] = prediction_at_sensor(&f->prediction, f->pair[mode], s);
    return f->shape ? rotid_mac(nmaster, f->work, f->shape + (ptrdiff_t)mode * nmaster) : (double)NAN;
}

double functional_frequency_residual(const struct functional *f, int mode)
{
    double omega = f->omega[mode], lambda = f->prediction.lambda[f->pair[mode]];
    switch (f->kind) {
    case ROTID_HYBRID:
        return 1 - f->quotient[mode] / (omega * omega);
    case ROTID_HYBRID_F:
        return 1 - f->quotient[mode] / (omega * sqrt(lambda));
    default:
        return (sqrt(lambda) / omega - 1) / f->measured->frequency_std[mode];
    }
}

static double frequency_residual_derivative(const struct functional *f, int mode, int q)
{
    const struct prediction *p = &f->prediction;
    int k = f->pair[mode];
    double omega = f->omega[mode], lambda = p->lambda[k], dlambda = p->dlambda[k + (ptrdiff_t)q * p->count];
    switch (f->kind) {
    case ROTID_HYBRID:
        return -hybrid_quotient_derivative(f, mode, q) / (omega * omega);
    case ROTID_HYBRID_F:
        return -hybrid_quotient_derivative(f, mode, q) / (omega * sqrt(lambda)) +
               0.5 * f->quotient[mode] * dlambda / (omega * lambda * sqrt(lambda));
    default:
        return 0.5 * dlambda / (sqrt(lambda) * omega) / f->measured->frequency_std[mode];
    }
}

/* Residuals (a phi_j - phi^_j)/s_j with the best scale a = b/c, b = sum phi_j phi^_j/s_j^2, c = sum phi_j^2/s_j^2. With q >= 0
 * their derivatives: a dphi_j + da phi_j, da = (db - a dc)/c. */
static void shape_residuals(const struct functional *f, int mode, int q, double *r)
{
    const struct prediction *p = &f->prediction;
    int nmaster = p->model->nmaster, k = f->pair[mode];
    const double *measured = f->shape + (ptrdiff_t)mode * nmaster, *std = f->measured->shape_std + (ptrdiff_t)mode * nmaster;
    double *phi = f->work, *dphi = f->work + nmaster, b = 0, c = 0, db = 0, dc = 0;
    for (int s = 0; s < nmaster; s++) {
        if (!isfinite(measured[s]))
            continue;
        phi[s] = prediction_at_sensor(p, k, s);
        dphi[s] = q < 0 ? 0 : prediction_derivative_at_sensor(p, k, q, s);
        double weight = 1 / (std[s] * std[s]);
        b += weight * phi[s] * measured[s];
        c += weight * phi[s] * phi[s];
        db += weight * dphi[s] * measured[s];
        dc += 2 * weight * dphi[s] * phi[s];
    }
    double a = c > 0 ? b / c : 0, da = c > 0 ? (db - a * dc) / c : 0;
    for (int s = 0; s < nmaster; s++)
        if (isfinite(measured[s]))
            *r++ = (q < 0 ? a * phi[s] - measured[s] : a * dphi[s] + da * phi[s]) / std[s];
}

/* r'A r and r'A s of the motions of the whole. */
static void whole_moments(struct functional *f, const rotid_matrix *a, double moment[2])
{
    const double *r = f->measured->whole, *s = r + f->prediction.model->n;
    moment[0] = matrix_product(a, r, r, f->whole_work);
    moment[1] = matrix_product(a, r, s, f->whole_work);
}

static void whole_residuals(struct functional *f, double *r)
{
    const rotid_measured *measured = f->measured;
    double moment[2];
    if (!f->nwhole)
        return;
    whole_moments(f, &f->prediction.m, moment);
    if (measured->mass_std > 0)
        *r++ = (moment[0] - measured->mass) / measured->mass_std;
    if (measured->centre_std > 0)
        *r = (moment[1] / moment[0] - measured->centre) / measured->centre_std;
}

void functional_whole_derivative(struct functional *f, const rotid_matrix *dm, double *r)
{
    const rotid_measured *measured = f->measured;
    double moment[2], change[2];
    if (!f->nwhole)
        return;
    whole_moments(f, &f->prediction.m, moment);
    whole_moments(f, dm, change);
    if (measured->mass_std > 0)
        *r++ = change[0] / measured->mass_std;
    if (measured->centre_std > 0)
        *r = (change[1] - moment[1] / moment[0] * change[0]) / moment[0] / measured->centre_std;
}

static int residuals(struct functional *f, double *r)
{
    const rotid_measured *measured = f->measured;
    double *shape_part;
    int status = ROTID_OK, row = 0;
    for (int k = 0; k < measured->nmode && !status; k++) {
        status = hybrid_quotient(f, k);
        if (functional_fits(measured, k))
            r[row++] = functional_frequency_residual(f, k);
        else
            status = ROTID_OK; /* a mode that is only compared may be compared badly */
    }
    shape_part = r + row;
    for (int k = 0; k < measured->nmode && !status && f->kind == ROTID_LIKELIHOOD; k++)
        if (functional_fits(measured, k) && f->shape) {
            shape_residuals(f, k, -1, shape_part);
            shape_part += functional_count_components(f, k);
        }
    if (!status)
        whole_residuals(f, shape_part);
    return status;
}

int functional_residual(struct functional *f, const double *x, double *r)
{
    struct prediction *p = &f->prediction;
    int status = prediction_compute(p, x);
    for (int k = 0; k < f->measured->nmode && !status; k++)
        if (!(p->lambda[f->pair[k]] > 0))
            status = ROTID_ERROR_STIFFNESS;
    return status ? status : residuals(f, r);
}

int functional_jacobian(struct functional *f, const double *x, double *jacobian)
{
    const rotid_measured *measured = f->measured;
    struct prediction *p = &f->prediction;
    int status = p->model->nparam ? prediction_differentiate(p, x, f->wanted, f->with_vectors) : ROTID_OK;
    for (int q = 0; q < p->model->nparam && !status; q++) {
        double *column = jacobian + (ptrdiff_t)q * f->nresidual;
        for (int k = 0; k < measured->nmode; k++)
            if (functional_fits(measured, k))
                *column++ = frequency_residual_derivative(f, k, q);
        for (int k = 0; k < measured->nmode && f->kind == ROTID_LIKELIHOOD && f->shape; k++)
            if (functional_fits(measured, k)) {
                shape_residuals(f, k, q, column);
                column += functional_count_components(f, k);
            }
        if (f->nwhole)
            status = prediction_matrix_derivatives(p, x, q);
        if (!status)
            functional_whole_derivative(f, &p->dm, column);
    }
    return status;
}
