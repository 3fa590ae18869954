#include <lapacke.h>

#include "linalg/linalg.h"

int cholesky_factor(int n, double *a)
{
    return n && LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, a, n) != 0;
}

void cholesky_solve(int n, const double *factor, int columns, double *b)
{
    if (n && columns)
        (void)LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', n, columns, factor, n, b, n);
}

void cholesky_forward(int n, const double *factor, int columns, double *b)
{
    if (n && columns)
        (void)LAPACKE_dtrtrs_work(LAPACK_COL_MAJOR, 'L', 'N', 'N', n, columns, factor, n, b, n);
}

void cholesky_backward_leading(int m, int n, const double *factor, double *b)
{
    if (m)
        (void)LAPACKE_dtrtrs_work(LAPACK_COL_MAJOR, 'L', 'T', 'N', m, 1, factor, n, b, n);
}

int positive_invert(int n, double *a, double *log_determinant)
{
    *log_determinant = 0;
    if (n == 0)
        return 0;
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, a, n))
        return 1;
    for (int i = 0; i < n; i++)
        *log_determinant += 2 * log(a[i + (ptrdiff_t)i * n]);
    if (LAPACKE_dpotri_work(LAPACK_COL_MAJOR, 'L', n, a, n))
        return 1;
    for (int j = 0; j < n; j++)
        for (int i = j + 1; i < n; i++)
            a[j + (ptrdiff_t)i * n] = a[i + (ptrdiff_t)j * n];
    return 0;
}

int positive_spectrum(int n, double *a, double *value, double *work)
{
    return n && LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', n, a, n, value, work, 3 * n) != 0;
}

int symmetric_new(struct pool *pool, int n, struct symmetric *s)
{
    *s = (struct symmetric){.n = n, .lwork = 32 * n};
    s->a = POOL_ARRAY(pool, double, (size_t)n *(size_t)n);
    s->work = POOL_ARRAY(pool, double, s->lwork);
    s->pivot = POOL_ARRAY(pool, int, n);
    return s->a && s->work && s->pivot ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int symmetric_factor(struct symmetric *s, int size)
{
    return size && LAPACKE_dsytrf_work(LAPACK_COL_MAJOR, 'L', size, s->a, size, s->pivot, s->work, s->lwork) != 0;
}

int symmetric_negative(const struct symmetric *s, int size)
{
    int negative = 0;
    for (int i = 0; i < size; i++)
        if (s->pivot[i] < 0) { /* a block of two, which is chosen where it is indefinite */
            negative++;
            i++;
        } else {
            negative += s->a[i + (ptrdiff_t)i * size] < 0;
        }
    return negative;
}

void symmetric_solve(struct symmetric *s, int size, double *b)
{
    if (size)
        (void)LAPACKE_dsytrs_work(LAPACK_COL_MAJOR, 'L', size, 1, s->a, size, s->pivot, b, size);
}
