#include <lapacke.h>

#include "linalg/linalg.h"

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

int complex_factor(int n, double complex *a, int *pivot)
{
    for (ptrdiff_t i = 0; i < (ptrdiff_t)n * n; i++)
        if (!isfinite(creal(a[i])) || !isfinite(cimag(a[i])))
            return 1;
    return LAPACKE_zgetrf_work(LAPACK_COL_MAJOR, n, n, a, n, pivot) != 0;
}

void complex_solve(int n, int adjoint, const double complex *factor, const int *pivot, double complex *b)
{
    (void)LAPACKE_zgetrs_work(LAPACK_COL_MAJOR, adjoint ? 'C' : 'N', n, 1, factor, n, pivot, b, n);
}

size_t quadratic_workspace(int n)
{
    size_t two = 2 * (size_t)n;
    return 2 * two * two + 2 * two + 8 * two + 2 * (size_t)n * (size_t)n;
}

/* The eigenvalues of [0 1; -M^-1 K, -M^-1 C] on (u, lambda u), time in units of 1/rate: both blocks are then of one size, and
 * with them the rounding of the low pairs. */
int quadratic_pairs(int n, double rate, double *m, const double *c, const double *k, double complex *lambda, double complex *u,
                    double *work, int *pivot)
{
    int two = 2 * n;
    size_t square = (size_t)n * (size_t)n;
    double *a = work, *vector = a + 4 * square, *re = vector + 4 * square, *im = re + two, *kc = im + two,
           *lapack = kc + 2 * square;
    memcpy(kc, k, square * sizeof(double));
    memcpy(kc + square, c, square * sizeof(double));
    for (size_t i = 0; i < square; i++)
        if (!isfinite(m[i]) || !isfinite(k[i]) || !isfinite(c[i]))
            return 1;
    if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, m, n, pivot))
        return 1;
    (void)LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', n, two, m, n, pivot, kc, n);
    memset(a, 0, 4 * square * sizeof(double));
    for (int j = 0; j < n; j++) {
        a[j + (ptrdiff_t)two * (n + j)] = 1;
        for (int i = 0; i < n; i++) {
            a[n + i + (ptrdiff_t)two * j] = -kc[i + (ptrdiff_t)n * j] / (rate * rate);
            a[n + i + (ptrdiff_t)two * (n + j)] = -kc[square + (size_t)i + (size_t)n * (size_t)j] / rate;
        }
    }
    if (LAPACKE_dgeev_work(LAPACK_COL_MAJOR, 'N', 'V', two, a, two, re, im, NULL, 1, vector, two, lapack, 8 * two))
        return 1;
    for (int j = 0; j < two; j++) {
        double sign = im[j] < 0 ? -1 : 1;
        int from = im[j] < 0 ? j - 1 : j; /* pairs of conjugates: real and imaginary part of the first one */
        lambda[j] = rate * CMPLX(re[j], im[j]);
        for (int i = 0; i < n; i++)
            u[i + (ptrdiff_t)n * j] =
                CMPLX(vector[i + (ptrdiff_t)two * from], im[j] == 0 ? 0 : sign * vector[i + (ptrdiff_t)two * (from + 1)]);
    }
    return 0;
}
