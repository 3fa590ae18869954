/* How an eigenpair of a host's matrices changes with them. */
#include "modal/modal.h"

#define NORMALISED 1e-6  /* of phi' M phi from 1: what is farther off is no vector of rotid_eigenpairs */
#define RIGID      1e-13 /* of the highest eigenvalue: below this, rounding of a rigid motion */

struct pair {
    const rotid_matrix *k, *m, *dk, *dm;
    int n, count, j;
    const double *lambda, *phi; /* [count], [n] */
};

/* Is there a neighbour that a change of the matrices may mix with it? Of those that the caller knows, and of the one above them.
 */
static int is_close(struct pool *pool, const struct pair *pair, int *close)
{
    int n = pair->n, stride = pair->k->kd + 1;
    double here = pair->lambda[pair->j], largest = 0;
    for (int i = 0; i < n; i++)
        largest = fmax(largest, fabs(pair->k->band[(ptrdiff_t)i * stride] / pair->m->band[(ptrdiff_t)i * stride]));
    double zero = RIGID * largest;
    int first;
    *close = eigenvalue_cluster(pair->count, pair->lambda, pair->j, &first) > 1;
    for (int i = 0; i < pair->count; i++) /* both are zero, and their distance is nothing but rounding */
        *close |= i != pair->j && fabs(pair->lambda[i]) < zero && fabs(here) < zero;
    if (*close || pair->j + 1 < pair->count || pair->count == n)
        return ROTID_OK;
    struct factor factor;
    rotid_matrix shifted;
    int *all = POOL_ARRAY(pool, int, n);
    for (int i = 0; all && i < n; i++)
        all[i] = i;
    if (!all || matrix_like(pool, pair->k, &shifted) || factor_new(pool, FACTOR_CHOLESKY, pair->k, n, all, &factor))
        return ROTID_ERROR_MEMORY;
    matrix_combine(1, pair->k, -(here + fmax(CLOSE_EIGENVALUES * fabs(here), zero)), pair->m, &shifted);
    *close = factor_negative_count(&factor, &shifted) > pair->count;
    return ROTID_OK;
}

static int differentiate(struct pool *pool, const struct pair *pair, char *failure, double *dlambda, double *dphi)
{
    int n = pair->n, close;
    struct nelson_band nelson;
    double *vectors = POOL_ARRAY(pool, double, 4 * (size_t)n), q = 0;
    if (!vectors)
        return ROTID_ERROR_MEMORY;
    double *m_phi = vectors, *dk_phi = m_phi + n, *dm_phi = dk_phi + n, *p = dm_phi + n;
    matrix_multiply(pair->m, 1, pair->phi, m_phi);
    matrix_multiply(pair->dk, 1, pair->phi, dk_phi);
    matrix_multiply(pair->dm, 1, pair->phi, dm_phi);
    double norm = product_dot(n, pair->phi, m_phi);
    if (!(fabs(norm - 1) < NORMALISED))
        return refuse(failure, "phi' M phi of column %d of phi is %.10g, expected 1, as rotid_eigenpairs gives it", pair->j,
                      norm);
    double slope = nelson_right_side(n, pair->lambda[pair->j], pair->phi, m_phi, dk_phi, dm_phi, p, &q);
    if (dphi) {
        int status = is_close(pool, pair, &close);
        if (!status && close)
            status = ROTID_ERROR_CLOSE;
        if (!status)
            status = nelson_band_new(pool, pair->k, 1, &nelson);
        if (!status)
            nelson_band_begin(&nelson, pair->k, pair->m);
        if (!status)
            status = nelson_band_prepare(&nelson, pair->lambda[pair->j], 1, pair->phi);
        if (status)
            return status;
        nelson_band_solve(&nelson, 1, 1, pair->phi, m_phi, p, &q, dphi);
    }
    *dlambda = slope;
    return ROTID_OK;
}

static int check(int n, int count, const double *lambda, const double *phi, int j, const double *dlambda, char *failure)
{
    if (count < 1 || count > n)
        return refuse(failure, "count is %d, expected 1 ... %d (n)", count, n);
    if (j < 0 || j >= count)
        return refuse(failure, "j is %d, expected 0 ... %d (count - 1)", j, count - 1);
    if (!lambda || !phi || !dlambda)
        return refuse(failure, "%s is NULL, expected an array", !lambda ? "lambda" : !phi ? "phi" : "dlambda");
    for (int i = 0; i < count; i++)
        if (!isfinite(lambda[i]))
            return failure_say(failure, ROTID_ERROR_FINITE, "lambda[%d] is %g, expected a number", i, lambda[i]);
    for (int i = 0; i < n; i++)
        if (!isfinite(phi[i + (ptrdiff_t)j * n]))
            return failure_say(failure, ROTID_ERROR_FINITE, "component %d of column %d of phi is %g, expected a number", i, j,
                               phi[i + (ptrdiff_t)j * n]);
    for (int i = 1; i < count; i++)
        if (lambda[i] < lambda[i - 1])
            return refuse(failure, "lambda[%d] is %g behind %g, expected ascending values", i, lambda[i], lambda[i - 1]);
    return ROTID_OK;
}

int rotid_eigenpair_derivative(const rotid_matrix *k, const rotid_matrix *m, const rotid_matrix *dk, const rotid_matrix *dm,
                               int count, const double *lambda, const double *phi, int j, const rotid_environment *environment,
                               char *failure, double *dlambda, double *dphi)
{
    const rotid_matrix *all[] = {k, m, dk, dm};
    struct entry entry;
    int status = entry_open(&entry, environment, failure);
    if (!status)
        status = matrices_check(4, all, failure);
    if (!status)
        status = check(k->n, count, lambda, phi, j, dlambda, failure);
    if (!status) {
        const struct pair pair = {k, m, dk, dm, k->n, count, j, lambda, phi + (ptrdiff_t)j * k->n};
        status = differentiate(&entry.scratch, &pair, failure, dlambda, dphi);
    }
    return entry_close(&entry, status);
}
