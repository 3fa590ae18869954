#include "modal/condensed_pairs.h"

#include <string.h>

#include "linalg/matrix.h"
#include "linalg/product.h"

int condensed_new(struct pool *pool, struct prediction *p)
{
    const rotid_model *model = p->model;
    int from = model->nrigid < p->count ? model->nrigid : 0, status = ROTID_OK;
    if (p->reduction == ROTID_GUYAN)
        status = eigen_guyan_new(pool, &p->k, model->nmaster, model->master, p->count, from, &p->guyan);
    size_t vectors = p->guyan.applies ? (size_t)p->count * (size_t)model->n : 0;
    p->full_phi = POOL_ARRAY(pool, double, vectors);
    p->adjoint = POOL_ARRAY(pool, double, vectors);
    p->image = POOL_ARRAY(pool, double, 2 * vectors);
    if (status || !p->full_phi || !p->adjoint || !p->image)
        return status ? status : ROTID_ERROR_MEMORY;
    if (p->guyan.applies && model->modes && model->nmodes >= p->count)
        eigen_guyan_begin(&p->guyan, model->modes);
    return ROTID_OK;
}

/* lambda := lambda + sum dlambda_q (x_q - here_q), where that is known and no leap */
static void extrapolate_eigenvalues(struct prediction *p, const double *x)
{
    for (int k = 0; k < p->count; k++) {
        double here = p->lambda[k], there = here;
        for (int q = 0; q < p->model->nparam && p->turned[k]; q++)
            there += p->dlambda[k + (ptrdiff_t)q * p->count] * (x[q] - p->here[q]);
        p->turned[k] = 0;
        if (there > here / 2 && there < 2 * here)
            p->lambda[k] = there;
    }
}

int condensed_compute(struct prediction *p, const double *x)
{
    int n = p->model->n, status = ROTID_OK;
    extrapolate_eigenvalues(p, x);
    p->by_bands = !eigen_guyan_solve(&p->guyan, &p->k, &p->m, p->begun ? p->lambda : NULL, p->lambda, p->phi);
    if (!p->by_bands) {
        status = reduction_compute(&p->condensed, &p->k, &p->m);
        if (!status)
            status = eigen_dense_solve(&p->dense, p->condensed.kc, p->condensed.mc, p->lambda, p->phi);
        if (!status && p->guyan.applies) {
            for (int k = 0; k < p->count; k++)
                reduction_expand(&p->condensed, p->phi + (ptrdiff_t)k * p->size, p->full_phi + (ptrdiff_t)k * n);
            eigen_guyan_begin(&p->guyan, p->full_phi);
        }
    }
    p->begun = !status;
    if (p->model->nparam)
        memcpy(p->here, x, (size_t)p->model->nparam * sizeof *x);
    return status;
}

/* The pairs from the first to the last that is wanted: first ... *end - 1 */
static int range_of(int count, const int *wanted, int *end)
{
    int first = 0;
    while (first < count && !wanted[first])
        first++;
    for (*end = count; *end > first && !wanted[*end - 1];)
        --*end;
    return first;
}

/* dlambda = u' (dK - lambda dM) u - 2 (S (K - lambda M) u)' dK u, u = T x: (36) */
int condensed_differentiate(struct prediction *p, const double *x, const int *wanted)
{
    int n = p->model->n, end, first = range_of(p->count, wanted, &end), columns = end - first;
    ptrdiff_t at = (ptrdiff_t)first * n;
    double *u = p->full_phi + at, *adjoint = p->adjoint + at, *dk_u = p->image, *dm_u = dk_u + (ptrdiff_t)columns * n;
    int status = reduction_begin(&p->condensed, &p->k, &p->m);
    if (status || !columns)
        return status;
    for (int k = first; k < end; k++)
        eigen_guyan_expand(&p->guyan, k, p->full_phi + (ptrdiff_t)k * n);
    reduction_adjoint(&p->condensed, columns, p->lambda + first, u, adjoint, dk_u);
    for (int q = 0; q < p->model->nparam; q++) {
        status = prediction_matrix_derivatives(p, x, q);
        if (status)
            return status;
        matrix_multiply(&p->dk, columns, u, dk_u);
        if (!p->dm_is_zero)
            matrix_multiply(&p->dm, columns, u, dm_u);
        for (int j = 0; j < columns; j++) {
            const double *uj = u + (ptrdiff_t)j * n, *dk_uj = dk_u + (ptrdiff_t)j * n;
            double slope = product_dot(n, uj, dk_uj) - 2 * product_dot(n, adjoint + (ptrdiff_t)j * n, dk_uj);
            if (!p->dm_is_zero)
                slope -= p->lambda[first + j] * product_dot(n, uj, dm_u + (ptrdiff_t)j * n);
            p->dlambda[first + j + (ptrdiff_t)q * p->count] = slope;
        }
    }
    for (int k = 0; k < p->count; k++)
        p->turned[k] = wanted[k];
    return ROTID_OK;
}
