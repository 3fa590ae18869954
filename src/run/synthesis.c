#include "run/synthesis.h"

#include <math.h>
#include <string.h>

#include "linalg/factor.h"
#include "linalg/matrix.h"
#include "linalg/product.h"
#include "modal/prediction.h"

#define TWO_PI 6.28318530717958647692

struct solver { /* on a pool of its own, which goes before the result is used */
    struct pool pool;
    const rotid_model *model;
    struct prediction prediction;
    rotid_matrix shifted;
    struct factor factor;
    int *all;
};

static int new_solver(struct solver *v, int count)
{
    const rotid_model *model = v->model;
    int status = prediction_new(&v->pool, model, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 0, &v->prediction);
    v->all = POOL_ARRAY(&v->pool, int, model->n);
    if (status || !v->all)
        return status ? status : ROTID_ERROR_MEMORY;
    for (int i = 0; i < model->n; i++)
        v->all[i] = i;
    status = matrix_new(&v->pool, model->n, model->kd, model->nfar, model->far, &v->shifted);
    return status ? status : factor_new(&v->pool, FACTOR_CHOLESKY, &v->shifted, model->n, v->all, &v->factor);
}

/* How many modes lie below: the Sturm count of K - lambda M. The matrices of a solver that seeks one pair serve for it. */
static int count_modes(const rotid_model *model, const rotid_allocator *allocator, const double *x, double hz, int *count)
{
    struct solver v = {.model = model};
    double omega = TWO_PI * hz;
    pool_open(&v.pool, allocator);
    int status = new_solver(&v, 1);
    if (!status)
        status = prediction_compute(&v.prediction, x);
    if (!status) {
        matrix_combine(1, &v.prediction.k, -omega * omega, &v.prediction.m, &v.shifted);
        *count = factor_negative_count(&v.factor, &v.shifted);
        status = *count < 0 ? ROTID_ERROR_EIGEN : ROTID_OK;
    }
    pool_close(&v.pool);
    return status;
}

/* What the modes leave of x = (K + c M)^-1 e_j and of (K + c M)^-1 M x at the responses of the pairs with this reference. */
static void reference_residuals(struct solver *v, const struct synthesis *s, const int *dof, int reference, double *x)
{
    int n = v->model->n;
    double *y = x + n;
    memset(x, 0, (size_t)n * sizeof *x);
    x[dof[reference]] = 1;
    factor_solve(&v->factor, 1, x);
    matrix_multiply(&v->prediction.m, 1, x, y);
    factor_solve(&v->factor, 1, y);
    for (int p = 0; p < s->npair; p++) {
        struct synthesis_pair *pair = &s->pair[p];
        if (pair->reference != reference)
            continue;
        const double *a = s->shape + (ptrdiff_t)pair->response * s->nmode, *b = s->shape + (ptrdiff_t)reference * s->nmode;
        pair->residual = x[dof[pair->response]];
        pair->slope = y[dof[pair->response]];
        for (int r = 0; r < s->nmode; r++) {
            double distance = s->lambda[r] + s->shift;
            pair->residual -= a[r] * b[r] / distance;
            pair->slope -= a[r] * b[r] / (distance * distance);
        }
    }
}

/* The shift is of the size of the first elastic eigenvalue: K itself is singular for a free rotor, and with a much smaller one
 * the rigid-body modes, which are taken off again, would drown the rest in rounding. */
static int residuals(struct solver *v, const int *dof, struct synthesis *s)
{
    double *x = POOL_ARRAY(&v->pool, double, 2 * (size_t)v->model->n);
    int *done = POOL_ARRAY(&v->pool, int, s->npoint);
    if (!x || !done)
        return ROTID_ERROR_MEMORY;
    s->shift = fabs(s->lambda[s->nrigid < s->nmode ? s->nrigid : s->nmode - 1]);
    matrix_combine(1, &v->prediction.k, s->shift, &v->prediction.m, &v->shifted);
    if (factor_compute(&v->factor, &v->shifted))
        return ROTID_ERROR_STIFFNESS;
    for (int p = 0; p < s->npair; p++)
        if (!done[s->pair[p].reference]++)
            reference_residuals(v, s, dof, s->pair[p].reference, x);
    return ROTID_OK;
}

static int keep_modes(struct pool *pool, const struct prediction *p, const int *dof, struct synthesis *s)
{
    s->lambda = POOL_ARRAY(pool, double, s->nmode);
    s->shape = POOL_ARRAY(pool, double, (size_t)s->nmode *(size_t)s->npoint);
    if (!s->lambda || !s->shape)
        return ROTID_ERROR_MEMORY;
    memcpy(s->lambda, p->lambda, (size_t)s->nmode * sizeof *s->lambda);
    for (int i = 0; i < s->npoint; i++)
        for (int r = 0; r < s->nmode; r++)
            s->shape[r + (ptrdiff_t)i * s->nmode] = p->phi[dof[i] + (ptrdiff_t)r * p->size];
    return ROTID_OK;
}

int synthesis_open(struct pool *pool, const rotid_model *model, const double *x, double up_to_hz, int least, int npoint,
                   const int *dof, int npair, struct synthesis_pair *pair, struct synthesis *s)
{
    struct solver v = {.model = model};
    int count = 0, status = count_modes(model, pool->allocator, x, up_to_hz, &count);
    if (status)
        return status;
    least = least > model->nrigid ? least : model->nrigid + 1; /* the shift of the residuals is the first elastic one */
    count = count > least ? count : least;
    count = count < 1 ? 1 : count < model->n ? count : model->n;
    if (count > SYNTHESIS_MOST_MODES)
        return ROTID_ERROR_ARGUMENT;
    *s = (struct synthesis){.npoint = npoint, .nmode = count, .nrigid = model->nrigid, .npair = npair, .pair = pair};
    pool_open(&v.pool, pool->allocator);
    status = new_solver(&v, count);
    if (!status)
        status = prediction_compute(&v.prediction, x);
    if (!status)
        status = keep_modes(pool, &v.prediction, dof, s);
    if (!status)
        status = residuals(&v, dof, s);
    pool_close(&v.pool);
    return status;
}

/* ------------------------------------------------------------------------------------------------ evaluation */

/* 1/(lambda + s^2 + 2 zeta w s) */
static void mode_factor(const struct synthesis_lines *lines, double lambda, double zeta, double complex *factor)
{
    double w = lambda > 0 ? sqrt(lambda) : 0, decay = lines->decay, constant = lambda + decay * decay + 2 * zeta * w * decay,
           loss = 2 * (decay + zeta * w);
    double *out = (double *)factor;
    for (int l = 0; l < lines->nline; l++) {
        double omega = TWO_PI * lines->frequency_hz[l], re = constant - omega * omega, im = loss * omega,
               inverse = 1 / (re * re + im * im);
        *out++ = re * inverse;
        *out++ = -im * inverse;
    }
}

static void add_scaled(int n, double scale, const double complex *x, double complex *y)
{
    const double *restrict from = (const double *)x;
    double *restrict to = (double *)y;
    for (int i = 0; i < 2 * n; i++) /* a real factor: parts are alike, and the loop runs in vectors */
        to[i] += scale * from[i];
}

static void finish(const struct synthesis *s, const struct synthesis_lines *lines, int p, double complex *h)
{
    const struct synthesis_pair *pair = &s->pair[p];
    for (int l = 0; l < lines->nline; l++) {
        double complex at = lines->decay + I * (TWO_PI * lines->frequency_hz[l]), square = at * at;
        if (!lines->without_residual)
            h[l] += pair->residual + (s->shift - square) * pair->slope;
        if (lines->quantity != FRF_DISPLACEMENT)
            h[l] *= lines->quantity == FRF_VELOCITY ? at : square;
    }
}

void synthesis_evaluate(const struct synthesis *s, const struct synthesis_lines *lines, const double *lambda, const double *zeta,
                        int first, int count, double complex *h, double complex *work)
{
    memset(h, 0, (size_t)count * (size_t)lines->nline * sizeof *h);
    for (int r = 0; r < s->nmode; r++) {
        mode_factor(lines, lambda[r], zeta[r], work);
        for (int c = 0; c < count; c++) {
            const struct synthesis_pair *pair = &s->pair[first + c];
            double product =
                s->shape[r + (ptrdiff_t)pair->response * s->nmode] * s->shape[r + (ptrdiff_t)pair->reference * s->nmode];
            add_scaled(lines->nline, product, work, h + (ptrdiff_t)c * lines->nline);
        }
    }
    for (int c = 0; c < count; c++)
        finish(s, lines, first + c, h + (ptrdiff_t)c * lines->nline);
}
