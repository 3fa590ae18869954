/* The lowest eigenpairs of a host's matrices. */
#include "linalg/eigen.h"
#include "linalg/matrix_check.h"

#define DENSE_MOST 2000 /* degrees of freedom: 150 MB, and seconds */

static int solve(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int count, double *lambda, double *phi)
{
    struct eigen_full e;
    int status = eigen_full_new(pool, k, count, &e);
    if (!status)
        status = eigen_full_solve(&e, k, m, lambda, phi);
    /* The block iteration takes K for indefinite where more eigenvalues are zero than it has vectors, and cannot count them where
     * as many others are equal. The dense solver does not mind. */
    if ((status != ROTID_ERROR_STIFFNESS && status != ROTID_ERROR_EIGEN) || e.dense || k->n > DENSE_MOST)
        return status;
    status = eigen_full_new_dense(pool, k, count, &e);
    return status ? status : eigen_full_solve(&e, k, m, lambda, phi);
}

int rotid_eigenpairs(const rotid_matrix *k, const rotid_matrix *m, int count, const rotid_environment *environment,
                     double *lambda, double *phi)
{
    const rotid_matrix *all[] = {k, m};
    struct pool pool;
    int status = matrices_check(2, all);
    if (status == ROTID_ERROR_ARGUMENT || count < 1 || count > k->n || !lambda || !phi)
        return ROTID_ERROR_ARGUMENT;
    if (status)
        return status;
    pool_open(&pool, environment ? environment->allocator : NULL);
    status = solve(&pool, k, m, count, lambda, phi);
    pool_close(&pool);
    return status;
}
