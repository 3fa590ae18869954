#include "linalg/linalg.h"

#include <lapacke.h>

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
