/* The lowest eigenpairs of a host's matrices. */
#include "linalg/linalg.h"

static int solve(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int count, double *lambda, double *phi)
{
    struct eigen_full e;
    int status = eigen_full_new(pool, k, count, &e);
    if (!status)
        status = eigen_full_solve(&e, k, m, lambda, phi);
    /* The block iteration cannot count eigenvalues where more are equal than it has vectors. The dense solver does not mind. */
    if ((status != ROTID_ERROR_STIFFNESS && status != ROTID_ERROR_EIGEN) || e.dense || k->n > EIGEN_DENSE_MOST)
        return status;
    status = eigen_full_new_dense(pool, k, count, &e);
    return status ? status : eigen_full_solve(&e, k, m, lambda, phi);
}

static int check(const rotid_matrix *k, const rotid_matrix *m, int count, const double *lambda, const double *phi, char *failure)
{
    const rotid_matrix *all[] = {k, m};
    int status = matrices_check(2, all, failure);
    if (status)
        return status;
    if (count < 1 || count > k->n)
        return refuse(failure, "count is %d, expected 1 ... %d (n)", count, k->n);
    if (!lambda || !phi)
        return refuse(failure, "%s is NULL, expected room for the result", lambda ? "phi" : "lambda");
    return ROTID_OK;
}

int rotid_eigenpairs(const rotid_matrix *k, const rotid_matrix *m, int count, const rotid_environment *environment, char *failure,
                     double *lambda, double *phi)
{
    struct entry entry;
    int status = entry_open(&entry, environment, failure);
    if (!status)
        status = check(k, m, count, lambda, phi, failure);
    if (!status)
        status = solve(&entry.scratch, k, m, count, lambda, phi);
    return entry_close(&entry, status);
}
