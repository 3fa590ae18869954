#include "linalg/band.h"

#include <math.h>
#include <stddef.h>

#define INLINE static inline __attribute__((always_inline))

INLINE int least(int a, int b)
{
    return a < b ? a : b;
}

/* Every kernel is written once for any kd and number of lanes, and compiled also for the kd = 3 of a chain of beam elements and
 * for each number of lanes as constants. */
INLINE int cholesky(int n, int kd, double *band)
{
    int lda = kd + 1;
    for (int j = 0; j < n; j++) {
        double *l = band + (ptrdiff_t)j * lda;
        if (!(l[0] > 0) || !isfinite(l[0]))
            return 1;
        double root = sqrt(l[0]), inverse = 1 / root;
        int reach = least(kd, n - 1 - j);
        l[0] = root;
        for (int d = 1; d <= reach; d++)
            l[d] *= inverse;
        for (int d = 1; d <= reach; d++) {
            double *target = l + (ptrdiff_t)d * lda;
            for (int e = d; e <= reach; e++)
                target[e - d] -= l[d] * l[e];
        }
    }
    return 0;
}

int band_cholesky(int n, int kd, double *band)
{
    return kd == 3 ? cholesky(n, 3, band) : cholesky(n, kd, band);
}

INLINE void cholesky_solve(int n, int kd, int lanes, const double *restrict band, double *restrict b)
{
    for (int j = 0; j < n; j++) {
        const double *restrict l = band + (ptrdiff_t)j * (kd + 1);
        int reach = least(kd, n - 1 - j);
        double *restrict bj = b + (ptrdiff_t)j * lanes, inverse = 1 / l[0];
        for (int c = 0; c < lanes; c++)
            bj[c] *= inverse;
        for (int d = 1; d <= reach; d++)
            for (int c = 0; c < lanes; c++)
                bj[d * lanes + c] -= l[d] * bj[c];
    }
    for (int j = n - 1; j >= 0; j--) {
        const double *restrict l = band + (ptrdiff_t)j * (kd + 1);
        int reach = least(kd, n - 1 - j);
        double *restrict bj = b + (ptrdiff_t)j * lanes, inverse = 1 / l[0];
        for (int d = reach; d >= 1; d--) /* the one found last comes last: the others need not wait for it */
            for (int c = 0; c < lanes; c++)
                bj[c] -= l[d] * bj[d * lanes + c];
        for (int c = 0; c < lanes; c++)
            bj[c] *= inverse;
    }
}

void band_cholesky_solve(int n, int kd, const double *band, int lanes, double *b)
{
    if (lanes == 8)
        cholesky_solve(n, kd, 8, band, b);
    else if (lanes == 4)
        cholesky_solve(n, kd, 4, band, b);
    else if (lanes == 2)
        cholesky_solve(n, kd, 2, band, b);
    else
        cholesky_solve(n, kd, 1, band, b);
}

INLINE int lu(int n, int kd, double *band, int *pivot)
{
    int lda = 3 * kd + 1;
    for (int j = 0, last = 0; j < n; j++) {
        double *l = band + 2 * (ptrdiff_t)kd + (ptrdiff_t)j * lda, most = fabs(l[0]);
        int reach = least(kd, n - 1 - j), p = 0;
        for (int i = 1; i <= reach; i++)
            if (fabs(l[i]) > most) {
                most = fabs(l[i]);
                p = i;
            }
        pivot[j] = j + p + 1;
        if (!(most > 0))
            return 1;
        if (last < least(j + kd + p, n - 1))
            last = least(j + kd + p, n - 1);
        double swapped = l[p];
        l[p] = l[0];
        l[0] = swapped;
        double inverse = 1 / swapped;
        for (int i = 1; i <= reach; i++)
            l[i] *= inverse;
        for (int c = 1; c <= last - j; c++) {
            double *target = l + (ptrdiff_t)c * (lda - 1), u = target[p];
            target[p] = target[0];
            target[0] = u;
            for (int i = 1; i <= reach; i++)
                target[i] -= l[i] * u;
        }
    }
    return 0;
}

int band_lu(int n, int kd, double *band, int *pivot)
{
    return kd == 3 ? lu(n, 3, band, pivot) : lu(n, kd, band, pivot);
}

INLINE void lu_solve(int n, int kd, int lanes, const double *restrict band, const int *pivot, double *restrict b)
{
    int lda = 3 * kd + 1;
    for (int j = 0; j < n; j++) {
        const double *restrict l = band + 2 * (ptrdiff_t)kd + (ptrdiff_t)j * lda;
        int reach = least(kd, n - 1 - j), p = pivot[j] - 1;
        double *restrict bj = b + (ptrdiff_t)j * lanes;
        for (int c = 0; c < lanes && p != j; c++) {
            double swapped = b[(ptrdiff_t)p * lanes + c];
            b[(ptrdiff_t)p * lanes + c] = bj[c];
            bj[c] = swapped;
        }
        for (int d = 1; d <= reach; d++)
            for (int c = 0; c < lanes; c++)
                bj[d * lanes + c] -= l[d] * bj[c];
    }
    for (int j = n - 1; j >= 0; j--) {
        const double *restrict u = band + 2 * (ptrdiff_t)kd + (ptrdiff_t)j * lda;
        int reach = least(2 * kd, j);
        double *restrict bj = b + (ptrdiff_t)j * lanes, inverse = 1 / u[0];
        for (int c = 0; c < lanes; c++)
            bj[c] *= inverse;
        for (int d = 1; d <= reach; d++)
            for (int c = 0; c < lanes; c++)
                bj[c - d * lanes] -= u[-d] * bj[c];
    }
}

void band_lu_solve(int n, int kd, const double *band, const int *pivot, int lanes, double *b)
{
    if (lanes == 8)
        lu_solve(n, kd, 8, band, pivot, b);
    else if (lanes == 4)
        lu_solve(n, kd, 4, band, pivot, b);
    else if (lanes == 2)
        lu_solve(n, kd, 2, band, pivot, b);
    else
        lu_solve(n, kd, 1, band, pivot, b);
}
