#include "linalg/linalg.h"

#include <lapacke.h>
#include <math.h>
#include <stddef.h>

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
