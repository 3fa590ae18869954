#include "linalg/linalg.h"

#include <lapacke.h>

#define FAR   1e9  /* times the shift: of larger eigenvalues mu has less than seven digits */
#define APART 1e-4 /* of an eigenvalue: no partner of the one before */

int eigen_dense_new(struct pool *pool, int n, int count, struct eigen_dense *e)
{
    *e = (struct eigen_dense){.n = n, .count = count};
    size_t square = (size_t)n * (size_t)n;
    double best = 0, none = 0;
    lapack_int ibest = 0, found = 0;
    if (count == n) {
        (void)LAPACKE_dsygvd_work(LAPACK_COL_MAJOR, 1, 'V', 'L', n, &none, n, &none, n, &none, &best, -1, &ibest, -1);
        e->liwork = (int)ibest;
    } else {
        (void)LAPACKE_dsygvx_work(LAPACK_COL_MAJOR, 1, 'V', 'I', 'L', n, &none, n, &none, n, 0, 0, 1, count, 0, &found, &none,
                                  &none, n, &best, -1, &ibest, &ibest);
        e->liwork = 5 * n;
    }
    e->lwork = (int)best;
    e->a = POOL_ARRAY(pool, double, square);
    e->b = POOL_ARRAY(pool, double, square);
    e->values = POOL_ARRAY(pool, double, n);
    e->vectors = POOL_ARRAY(pool, double, (size_t)n *(size_t)count);
    e->work = POOL_ARRAY(pool, double, e->lwork);
    e->iwork = POOL_ARRAY(pool, int, e->liwork);
    e->ifail = POOL_ARRAY(pool, int, n);
    return e->a && e->b && e->values && e->vectors && e->work && e->iwork && e->ifail ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static void put_matrices(struct eigen_dense *e, const double *k, const double *m)
{
    size_t square = (size_t)e->n * (size_t)e->n;
    memcpy(e->a, m, square * sizeof(double));
    for (size_t i = 0; i < square; i++)
        e->b[i] = k[i] - e->shift * m[i];
}

/* The `count` largest mu, ascending, and their vectors with phi' (K - s M) phi = 1. */
static int solve_inverse(struct eigen_dense *e, const double *k, const double *m)
{
    int n = e->n;
    size_t square = (size_t)n * (size_t)n;
    lapack_int info, found = e->count;
    put_matrices(e, k, m);
    if (e->count == n) {
        info = LAPACKE_dsygvd_work(LAPACK_COL_MAJOR, 1, 'V', 'L', n, e->a, n, e->b, n, e->values, e->work, e->lwork, e->iwork,
                                   e->liwork);
        memcpy(e->vectors, e->a, square * sizeof(double));
    } else {
        double abstol = 2 * LAPACKE_dlamch_work('S'); /* eigenvalues to full accuracy want this (LAPACK Users' Guide, dsygvx) */
        info = LAPACKE_dsygvx_work(LAPACK_COL_MAJOR, 1, 'V', 'I', 'L', n, e->a, n, e->b, n, 0, 0, n - e->count + 1, n, abstol,
                                   &found, e->values, e->vectors, n, e->work, e->lwork, e->iwork, e->ifail);
        if (info <= n && (info || found != e->count)) { /* bisection cannot part eigenvalues that rounding alone tells apart */
            put_matrices(e, k, m);
            info = LAPACKE_dsygv_work(LAPACK_COL_MAJOR, 1, 'V', 'L', n, e->a, n, e->b, n, e->values, e->work, e->lwork);
            found = e->count;
            memmove(e->values, e->values + n - e->count, (size_t)e->count * sizeof(double));
            memcpy(e->vectors, e->a + (ptrdiff_t)n * (n - e->count), (size_t)n * (size_t)e->count * sizeof(double));
        }
    }
    if (info > n)
        return ROTID_ERROR_STIFFNESS;
    return info || found != e->count ? ROTID_ERROR_EIGEN : ROTID_OK;
}

/* The solver above sees M through the wanted pairs alone, and they may be positive where M is not. */
static int mass_is_definite(struct eigen_dense *e, const double *m)
{
    memcpy(e->a, m, (size_t)e->n * (size_t)e->n * sizeof(double));
    return LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', e->n, e->a, e->n) == 0;
}

/* Of eigenvalues far above the shift, mu says as little as of the lowest ones K x = lambda M x itself: pairs above the geometric
 * mean of both ends come from that. Partners of one eigenvalue come from one of the two. */
static int solve_highest(struct eigen_dense *e, const double *k, const double *m, double *lambda, double *phi)
{
    int n = e->n, j = 0;
    size_t square = (size_t)n * (size_t)n;
    memcpy(e->a, k, square * sizeof(double));
    memcpy(e->b, m, square * sizeof(double));
    if (LAPACKE_dsygv_work(LAPACK_COL_MAJOR, 1, 'V', 'L', n, e->a, n, e->b, n, e->values, e->work, e->lwork))
        return ROTID_ERROR_EIGEN;
    double split = sqrt(-e->shift) * sqrt(e->values[n - 1]);
    while (j < e->count && !(e->values[j] > split && (j == 0 || e->values[j] > (1 + APART) * e->values[j - 1])))
        j++;
    if (j > 0 && !isfinite(lambda[j - 1]))
        return ROTID_ERROR_EIGEN;
    for (; j < e->count; j++) {
        lambda[j] = e->values[j];
        memcpy(phi + (ptrdiff_t)j * n, e->a + (ptrdiff_t)j * n, (size_t)n * sizeof *phi);
    }
    put_matrices(e, k, m); /* for eigen_full_solve */
    return LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, e->b, n) ? ROTID_ERROR_STIFFNESS : ROTID_OK;
}

int eigen_dense_solve(struct eigen_dense *e, const double *k, const double *m, double *lambda, double *phi)
{
    int n = e->n, passes = e->shift < 0 ? 1 : 2;
    double least = INFINITY,
           most = 0; /* K_ii/M_ii: the lowest eigenvalue is below the one, the highest of the size of the other */
    if (!mass_is_definite(e, m))
        return ROTID_ERROR_MASS;
    for (int i = 0; i < n; i++) {
        double ratio = k[i + (ptrdiff_t)i * n] / m[i + (ptrdiff_t)i * n];
        least = fmin(least, ratio);
        most = fmax(most, ratio);
    }
    if (passes == 2) /* a diagonal element of zero belongs to a row of zeros */
        e->shift = least == 0 ? -1e-10 * (most > 0 ? most : 1) : -1e-4 * least;
    if (!(e->shift < 0) || !isfinite(e->shift)) {
        e->shift = 0;
        return ROTID_ERROR_STIFFNESS;
    }
    for (int pass = 0; pass < passes; pass++) {
        int status = solve_inverse(e, k, m);
        for (int j = 0; j < e->count && !status; j++) {
            int source = e->count - 1 - j;
            double mu = e->values[source], scale = 1 / sqrt(mu); /* M is positive: below zero by rounding */
            lambda[j] = mu > 0 ? 1 / mu + e->shift : (double)INFINITY;
            for (int i = 0; i < n; i++)
                phi[i + (ptrdiff_t)j * n] = scale * e->vectors[i + (ptrdiff_t)source * n];
        }
        if (!status && lambda[0] < -1e-10 * fmax(most, -e->shift))
            status = ROTID_ERROR_STIFFNESS; /* a shift of before may hide what a first one shows */
        if (status)
            return status;
        int reference = e->count < 4 ? e->count - 1 : 3; /* past two rigid modes; past more of them where there are more */
        while (reference > 0 && !isfinite(lambda[reference]))
            reference--;
        while (reference + 1 < e->count && lambda[reference] < 1e-13 * most && isfinite(lambda[reference + 1]))
            reference++;
        if (most > 0 && lambda[reference] >= 1e-13 * most)
            e->shift = -lambda[reference];
    }
    return lambda[e->count - 1] < FAR * -e->shift ? ROTID_OK : solve_highest(e, k, m, lambda, phi);
}
