#include "linalg/linalg.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stddef.h>

#define INDEPENDENT 1e-3 /* least sine between a vector and those before it */

int ritz_pairs(int n, int count, const rotid_matrix *k, const rotid_matrix *m, double *y, double *value, double *vector,
               double *product, double *squares, double *work)
{
    double *a = squares, *b = a + (ptrdiff_t)count * count;
    for (int j = 0; j < count; j++) { /* solutions near an eigenvalue are of any size */
        double size = cblas_dnrm2(n, y + (ptrdiff_t)j * n, 1);
        if (!(size > 0) || !isfinite(size))
            return 1;
        cblas_dscal(n, 1 / size, y + (ptrdiff_t)j * n, 1);
    }
    matrix_multiply(m, count, y, product);
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, count, count, n, 1, y, n, product, n, 0, b, count);
    for (int j = 0; j < count; j++) {
        double square = b[j + (ptrdiff_t)j * count], inverse = 1 / sqrt(square);
        if (!(square > 0))
            return 1;
        cblas_dscal(n, inverse, y + (ptrdiff_t)j * n, 1);
        cblas_dscal(count, inverse, b + (ptrdiff_t)j * count, 1);
        cblas_dscal(count, inverse, b + j, count);
    }
    matrix_multiply(k, count, y, product);
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, count, count, n, 1, y, n, product, n, 0, a, count);
    /* y ascends, so that a support by a penalty of 1e18 stands last in A: reduced from there on, by the upper triangle, A leaves
     * its rounding to its own eigenvalue. From the first row on all of them would get it. */
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'U', count, b, count))
        return 1;
    for (int j = 0; j < count; j++)
        if (!(b[j + (ptrdiff_t)j * count] > INDEPENDENT))
            return 1;
    if (LAPACKE_dsygst_work(LAPACK_COL_MAJOR, 1, 'U', count, a, count, b, count) ||
        LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'U', count, a, count, value, work, RITZ_WORK * count))
        return 1;
    for (int j = 0; j < count; j++) /* a vector keeps the sign of y: rounding would choose it */
        if (a[j + (ptrdiff_t)j * count] < 0)
            cblas_dscal(count, -1, a + (ptrdiff_t)j * count, 1);
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans, CblasNonUnit, count, count, 1, b, count, a, count);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, count, count, 1, y, n, a, count, 0, vector, n);
    return 0;
}
