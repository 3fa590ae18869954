#include "linalg/linalg.h"
#include "linalg/machine.h"

#define INLINE static inline __attribute__((always_inline))

INLINE int least(int a, int b)
{
    return a < b ? a : b;
}

/* Every kernel is written once for any kd, and compiled also for the kd = 3 of a chain of beam elements as a constant. */
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

/* Column `target` of the rows that step j takes: row p comes up, and l times it is taken off the `reach` rows below. */
INLINE void lu_column(int reach, const double *restrict l, int p, double *restrict target)
{
    double u = target[p];
    target[p] = target[0];
    target[0] = u;
#pragma GCC unroll 8
    for (int i = 1; i <= reach; i++)
        target[i] -= l[i] * u;
}

/* One step: returns the row of the pivot, or -1 where the column is zero. *last: the last column with entries in the rows so far,
 * from this one; it moves with the pivots. */
INLINE int lu_step(int kd, int reach, int columns, ptrdiff_t stride, double *restrict l, int *last)
{
    double most = fabs(l[0]);
    int p = 0;
#pragma GCC unroll 8
    for (int i = 1; i <= reach; i++) {
        double size = fabs(l[i]);
        p = size > most ? i : p;
        most = size > most ? size : most;
    }
    if (!(most > 0))
        return -1;
    double swapped = l[p];
    l[p] = l[0];
    l[0] = swapped;
    double inverse = 1 / swapped;
#pragma GCC unroll 8
    for (int i = 1; i <= reach; i++)
        l[i] *= inverse;
    *last = *last - 1 > kd + p ? *last - 1 : kd + p;
    for (int c = 1; c <= least(*last, columns); c++)
        lu_column(reach, l, p, l + c * stride);
    return p;
}

INLINE int lu(int n, int kd, double *band, int *pivot)
{
    const ptrdiff_t lda = 3 * kd + 1;
    for (int j = 0, last = 0; j < n; j++) {
        double *l = band + 2 * (ptrdiff_t)kd + j * lda;
        int p = j < n - 2 * kd ? lu_step(kd, kd, 2 * kd, lda - 1, l, &last)
                               : lu_step(kd, least(kd, n - 1 - j), n - 1 - j, lda - 1, l, &last);
        if (p < 0)
            return 1;
        pivot[j] = j + p + 1;
    }
    return 0;
}

int band_lu(int n, int kd, double *band, int *pivot)
{
    return kd == 3 ? lu(n, 3, band, pivot) : lu(n, kd, band, pivot);
}

/* as many right-hand sides as a vector has components, at any address of a double */
typedef double lanes2 __attribute__((vector_size(16), aligned(8), may_alias));
typedef four lanes4;

#define LANES       double
#define NAMED(name) name##_1
#include "linalg/band_lanes.h"
#undef LANES
#undef NAMED
#define LANES       lanes2
#define NAMED(name) name##_2
#include "linalg/band_lanes.h"
#undef LANES
#undef NAMED
#define LANES       lanes4
#define NAMED(name) name##_4
#include "linalg/band_lanes.h"
#undef LANES
#undef NAMED

/* of any kd, or of 3 as a constant */
INLINE void cholesky_lanes(int n, int kd, const double *band, int lanes, double *b)
{
    if (lanes == 4)
        cholesky_solve_4(n, kd, band, (lanes4 *)b);
    else if (lanes == 2)
        cholesky_solve_2(n, kd, band, (lanes2 *)b);
    else
        cholesky_solve_1(n, kd, band, b);
}

EACH_MACHINE static void cholesky_solve_here(int n, int kd, const double *band, int lanes, double *b)
{
    if (kd == 3)
        cholesky_lanes(n, 3, band, lanes, b);
    else
        cholesky_lanes(n, kd, band, lanes, b);
}

void band_cholesky_solve(int n, int kd, const double *band, int lanes, double *b)
{
    cholesky_solve_here(n, kd, band, lanes, b);
}

INLINE void lu_solve(int n, int kd, const double *band, const int *pivot, int lanes, double *b)
{
    if (lanes == 4)
        lu_solve_4(n, kd, band, pivot, (lanes4 *)b);
    else if (lanes == 2)
        lu_solve_2(n, kd, band, pivot, (lanes2 *)b);
    else
        lu_solve_1(n, kd, band, pivot, b);
}

EACH_MACHINE static void lu_solve_here(int n, int kd, const double *band, const int *pivot, int lanes, double *b)
{
    if (kd == 3)
        lu_solve(n, 3, band, pivot, lanes, b);
    else
        lu_solve(n, kd, band, pivot, lanes, b);
}

void band_lu_solve(int n, int kd, const double *band, const int *pivot, int lanes, double *b)
{
    lu_solve_here(n, kd, band, pivot, lanes, b);
}

EACH_MACHINE static void subtract_here(int n, int count, const double *x, int lanes, const double *r, double *b)
{
    if (lanes == 4)
        subtract_4(n, count, x, (const lanes4 *)r, (lanes4 *)b);
    else if (lanes == 2)
        subtract_2(n, count, x, (const lanes2 *)r, (lanes2 *)b);
    else
        subtract_1(n, count, x, r, b);
}

void band_subtract(int n, int count, const double *x, int lanes, const double *r, double *b)
{
    subtract_here(n, count, x, lanes, r, b);
}

void band_gather(int n, const int *row, int columns, int length, const double *x, int lanes, double *b)
{
    if (lanes == 4 && columns == 4)
        gather_4(n, row, 4, length, x, b);
    else if (lanes == 4)
        gather_4(n, row, columns, length, x, b);
    else if (lanes == 2)
        gather_2(n, row, 2, length, x, b);
    else
        gather_1(n, row, 1, length, x, b);
}

void band_scatter(int n, const int *row, int columns, int length, int lanes, const double *b, double *x)
{
    if (lanes == 4 && columns == 4)
        scatter_4(n, row, 4, length, b, x);
    else if (lanes == 4)
        scatter_4(n, row, columns, length, b, x);
    else if (lanes == 2)
        scatter_2(n, row, 2, length, b, x);
    else
        scatter_1(n, row, 1, length, b, x);
}
