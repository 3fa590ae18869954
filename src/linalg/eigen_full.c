#include <math.h>
#include <string.h>

#include "linalg/eigen.h"
#include "linalg/matrix.h"
#include "linalg/ritz.h"

#define SMALL 8 /* no difference in time; and any number of eigenvalues may be zero */

/* Fitted to times of both, one cold and three warm solutions with one thread, n = 42 to 1200, of any kd and count: it takes 2.5
 * times as long as the better one at worst, where both take a millisecond. */
static int is_dense(const rotid_matrix *structure, int count)
{
    double n = structure->n;
    return n <= SMALL || count == structure->n || 2.5 * structure->kd + 0.15 * count * sqrt(n) >= n;
}

int eigen_full_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_full *e)
{
    *e = (struct eigen_full){0};
    if (is_dense(structure, count))
        return eigen_full_new_dense(pool, structure, count, e);
    e->wide = factor_is_wide(structure);
    return e->wide ? eigen_wide_new(pool, structure, count, &e->panels) : eigen_band_new(pool, structure, count, &e->band);
}

int eigen_full_new_dense(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_full *e)
{
    size_t n = (size_t)structure->n, columns = (size_t)count;
    *e = (struct eigen_full){.dense = 1};
    e->k = POOL_ARRAY(pool, double, n *n);
    e->m = POOL_ARRAY(pool, double, n *n);
    e->image = POOL_ARRAY(pool, double, n *columns);
    e->product = POOL_ARRAY(pool, double, n *columns);
    e->squares = POOL_ARRAY(pool, double, 2 * columns * columns);
    e->work = POOL_ARRAY(pool, double, RITZ_WORK *columns);
    if (!e->k || !e->m || !e->image || !e->product || !e->squares || !e->work)
        return ROTID_ERROR_MEMORY;
    return eigen_dense_new(pool, structure->n, count, &e->solver);
}

void eigen_full_want(struct eigen_full *e, int from, int to)
{
    if (e->wide)
        eigen_wide_want(&e->panels, from, to);
    else if (!e->dense)
        eigen_band_want(&e->band, from, to);
}

void eigen_full_within(struct eigen_full *e, double residual)
{
    if (e->wide)
        eigen_wide_within(&e->panels, residual);
    else if (!e->dense)
        eigen_band_within(&e->band, residual);
}

void eigen_full_vouch(struct eigen_full *e)
{
    if (e->wide)
        eigen_wide_vouch(&e->panels);
}

void eigen_full_begin(struct eigen_full *e, const double *phi)
{
    if (e->wide)
        eigen_wide_begin(&e->panels, phi);
    else if (!e->dense)
        eigen_band_begin(&e->band, phi);
}

int eigen_full_solve(struct eigen_full *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi)
{
    int n = k->n, count = e->solver.count;
    if (e->wide)
        return eigen_wide_solve(&e->panels, k, m, lambda, phi);
    if (!e->dense)
        return eigen_band_solve(&e->band, k, m, lambda, phi);
    matrix_to_dense(k, n, e->k);
    matrix_to_dense(m, n, e->m);
    int status = eigen_dense_solve(&e->solver, e->k, e->m, lambda, phi);
    if (status)
        return status;
    matrix_multiply(m, count, phi, e->image);
    eigen_dense_inverse(&e->solver, count, e->image);
    double *value = e->k, *vector = e->m; /* not needed any more */
    if (!ritz_pairs(n, count, k, m, e->image, value, vector, e->product, e->squares, e->work)) {
        memcpy(lambda, value, (size_t)count * sizeof *lambda);
        memcpy(phi, vector, (size_t)n * (size_t)count * sizeof *phi);
    }
    return ROTID_OK;
}
