#include "modal/modal.h"

#define LEAST 1e-6 /* of a vector's length, that it has to have beside the ones before */

/* Where vectors are differentiated: dphi/dx_q of the wanted pairs. */
static int derivatives(struct prediction *p, const double *x, const int *wanted, double *out)
{
    size_t length = (size_t)p->size * (size_t)p->model->nparam;
    int status = prediction_differentiate(p, x, wanted, 1);
    for (int k = 0; k < p->count && !status; k++)
        if (wanted[k]) {
            memcpy(out, p->dphi + prediction_place(p, k, 0), length * sizeof *out);
            out += length;
        }
    return status;
}

/* Where they are not: (K + s M)^-1 (dK_q - lambda dM_q) phi, with one factor, s half of the lowest eigenvalue that is wanted. */
static int corrections(struct prediction *p, const double *x, const int *wanted, int columns, double *out)
{
    int n = p->size, lowest = 0, status = ROTID_OK;
    double *column = out;
    while (!wanted[lowest])
        lowest++;
    for (int q = 0; q < p->model->nparam && !status; q++) {
        const double *dk_phi, *dm_phi;
        status = prediction_images(p, x, q, wanted, &dk_phi, &dm_phi);
        for (int k = 0; k < p->count && !status; k++)
            for (int i = 0; i < n && wanted[k]; i++)
                *column++ = dk_phi[i + (ptrdiff_t)k * n] - p->lambda[k] * dm_phi[i + (ptrdiff_t)k * n];
    }
    return status ? status : eigen_full_correct(&p->full, &p->k, &p->m, -p->lambda[lowest] / 2, columns, out);
}

/* V := V (I - 2 w w'), w = (1, ..., 1)/sqrt(count): each column has a part of all. Of one that were a rigid motion, K would have
 * nothing but rounding on the diagonal, which solvers begin with. */
static void mix(int n, int count, double *v)
{
    for (int i = 0; i < n; i++) {
        double sum = 0;
        for (int j = 0; j < count; j++)
            sum += v[i + (ptrdiff_t)j * n];
        for (int j = 0; j < count; j++)
            v[i + (ptrdiff_t)j * n] -= 2 * sum / count;
    }
}

int prediction_basis(struct pool *pool, struct prediction *p, const double *x, int given, const double *first, const int *wanted,
                     int *count, double **v)
{
    int n = p->size, nwanted = 0, begun = given + p->count;
    for (int k = 0; k < p->count; k++)
        nwanted += wanted[k] != 0;
    int columns = nwanted * p->model->nparam;
    size_t length = (size_t)n;
    double *all = *v = POOL_ARRAY(pool, double, length *((size_t)begun + (size_t)columns));
    if (!all)
        return ROTID_ERROR_MEMORY;
    memcpy(all, first, length * (size_t)given * sizeof *all);
    memcpy(all + length * (size_t)given, p->phi, length * (size_t)p->count * sizeof *all);
    double *more = all + length * (size_t)begun;
    int status = !columns          ? ROTID_OK
                 : p->with_vectors ? derivatives(p, x, wanted, more)
                                   : corrections(p, x, wanted, columns, more);
    *count = given;
    for (int j = given; j < begun + columns && !status; j++) {
        memmove(all + (ptrdiff_t)*count * n, all + (ptrdiff_t)j * n, length * sizeof *all);
        *count = basis_extend(n, *count, LEAST, all);
    }
    mix(n, *count, all);
    return status;
}

void prediction_begin(struct prediction *p, int size, const double *v, const struct prediction *near)
{
    memset(p->turned, 0, (size_t)p->count * sizeof *p->turned);
    for (int k = 0; k < p->count; k++)
        product_combine(p->size, size, 1, v, near->phi + (ptrdiff_t)k * size, p->phi + (ptrdiff_t)k * p->size);
    eigen_full_begin(&p->full, p->phi);
}
