#include "linalg/linalg.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

/* dhseqr asks for n at least and does best with some more */
#define LWORK(n) (12 * (n))

size_t polynomial_roots_workspace(int n)
{
    return (size_t)n * (size_t)n + 3 * (size_t)n + (size_t)LWORK(n);
}

int polynomial_roots(int n, const double *c, double complex *root, double *work)
{
    double *a = work, *scale = a + (ptrdiff_t)n * n, *re = scale + n, *im = re + n, *lapack = im + n;
    memset(a, 0, (size_t)n * (size_t)n * sizeof(double));
    for (int j = 0; j < n; j++) {
        if (!isfinite(c[j]))
            return 1;
        a[(ptrdiff_t)j * n] = -c[j];
        if (j + 1 < n)
            a[j + 1 + (ptrdiff_t)j * n] = 1;
    }
    /* scaled only: a permutation would leave the Hessenberg form */
    lapack_int low = 1, high = n;
    if (LAPACKE_dgebal_work(LAPACK_COL_MAJOR, 'S', n, a, n, &low, &high, scale) ||
        LAPACKE_dhseqr_work(LAPACK_COL_MAJOR, 'E', 'N', n, low, high, a, n, re, im, NULL, 1, lapack, LWORK(n)))
        return 1;
    for (int j = 0; j < n; j++)
        root[j] = CMPLX(re[j], im[j]);
    return 0;
}
