#include "linalg/arrow.h"

#include <math.h>
#include <string.h>

#include "linalg/machine.h"

#define INLINE static inline __attribute__((always_inline))
#define LOST   1e-7 /* of what was added up: a smaller pivot leaves nine digits or less to the solution */
#define CHAIN  3    /* half band of a chain of elements */
#define FORCES 5    /* and with a force beside every rotation */

static int new_matrix(struct pool *pool, const struct arrow *a, struct arrow_matrix *matrix)
{
    size_t n = (size_t)a->n, stride = (size_t)a->stride;
    matrix->band = POOL_ARRAY(pool, double, n *(size_t)(a->kd + 1));
    matrix->border = POOL_ARRAY(pool, double, n *stride);
    matrix->corner = POOL_ARRAY(pool, double, stride *stride);
    return matrix->band && matrix->border && matrix->corner ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int arrow_new(struct pool *pool, int n, int kd, int full, struct arrow *a)
{
    *a = (struct arrow){.n = n, .kd = kd, .full = full, .stride = (full + 3) / 4 * 4, .first = n};
    a->magnitude = POOL_ARRAY(pool, double, n + a->stride);
    int status = a->magnitude ? new_matrix(pool, a, &a->k) : ROTID_ERROR_MEMORY;
    if (!status)
        status = new_matrix(pool, a, &a->m);
    return status ? status : new_matrix(pool, a, &a->factor);
}

void arrow_zero(struct arrow *a, struct arrow_matrix *matrix)
{
    memset(matrix->band, 0, (size_t)a->n * (size_t)(a->kd + 1) * sizeof(double));
    if (!a->full)
        return;
    memset(matrix->border, 0, (size_t)a->n * (size_t)a->stride * sizeof(double));
    memset(matrix->corner, 0, (size_t)a->stride * (size_t)a->stride * sizeof(double));
}

void arrow_add(struct arrow *a, struct arrow_matrix *matrix, int i, int j, double value)
{
    int low = i < j ? i : j, high = i < j ? j : i;
    if (high < a->n) {
        matrix->band[(high - low) + (ptrdiff_t)low * (a->kd + 1)] += value;
        return;
    }
    high -= a->n;
    if (low < a->n) {
        matrix->border[high + (ptrdiff_t)low * a->stride] += value;
        a->first = low < a->first ? low : a->first;
        return;
    }
    low -= a->n;
    matrix->corner[high + low * a->stride] += value;
    if (high != low)
        matrix->corner[low + high * a->stride] += value;
}

void arrow_take(struct arrow *a, struct arrow_matrix *matrix, const rotid_matrix *from, const int *row)
{
    int n = from->n, kd = from->kd;
    arrow_zero(a, matrix);
    for (int j = 0; j < n; j++) {
        int reach = kd < n - 1 - j ? kd : n - 1 - j;
        const double *column = from->band + (ptrdiff_t)j * (kd + 1);
        if (row[j] < a->n && row[j + reach] == row[j] + reach) { /* none of them far */
            memcpy(matrix->band + (ptrdiff_t)row[j] * (kd + 1), column, (size_t)(reach + 1) * sizeof *column);
            continue;
        }
        for (int d = 0; d <= reach; d++)
            if (column[d] != 0)
                arrow_add(a, matrix, row[j + d], row[j], column[d]);
    }
    for (int q = 0; q < from->nfar; q++)
        for (int p = q; p < from->nfar; p++)
            arrow_add(a, matrix, row[from->far[p]], row[from->far[q]], from->block[p + q * from->nfar]);
}

INLINE void combine(int count, const double *restrict k, double sigma, const double *restrict m, double *restrict out)
{
    for (int i = 0; i < count; i++)
        out[i] = k[i] - sigma * m[i];
}

/* row -= part times other, from place `from` on */
INLINE void subtract(int from, int stride, double part, const double *restrict other, double *restrict row)
{
    for (int p = from; p < stride; p += 4)
        *(four *)(row + p) -= part * FOUR(other + p);
}

/* A last pivot may be anything but zero: that of a matrix that is nearly singular, as for inverse iteration. */
INLINE int is_lost(double pivot, double magnitude, int last)
{
    return !(fabs(pivot) > (last ? 0 : LOST) * magnitude);
}

/* Takes a column of the band, l [reach + 1], off those behind it, and its part of the full rows, border [stride], off theirs. */
INLINE void eliminate(int kd, int reach, int stride, double *restrict l, double *restrict border, double *restrict corner,
                      double *restrict magnitude, double *restrict corner_magnitude)
{
    const ptrdiff_t lda = kd + 1;
    double inverse = 1 / l[0];
#pragma GCC unroll 8
    for (int i = 1; i <= reach; i++) {
        double part = l[i] * inverse, *target = l + i * lda - i;
        magnitude[i] += fabs(part * l[i]);
#pragma GCC unroll 8
        for (int e = i; e <= reach; e++)
            target[e] -= part * l[e];
        subtract(0, stride, part, border, border + (ptrdiff_t)i * stride);
    }
#pragma GCC unroll 8
    for (int i = 1; i <= reach; i++)
        l[i] *= inverse;
    for (int p = 0; p < stride; p++) {
        double part = border[p] * inverse;
        corner_magnitude[p] += fabs(part * border[p]);
        subtract(p / 4 * 4, stride, part, border, corner + (ptrdiff_t)p * stride);
    }
    for (int p = 0; p < stride; p++)
        border[p] *= inverse;
}

/* Columns from ... end - 1. Returns how many pivots are negative, or -1. */
INLINE int factor_columns(struct arrow *a, int kd, int tail, int stride, int from, int end)
{
    const int n = a->n;
    int negative = 0;
    for (int j = from; j < end; j++) {
        double *l = a->factor.band + (ptrdiff_t)j * (kd + 1);
        if (is_lost(l[0], a->magnitude[j], !a->full && j == n - 1))
            return -1;
        negative += l[0] < 0;
        eliminate(kd, tail ? n - 1 - j : kd, stride, l, a->factor.border + (ptrdiff_t)j * a->stride, a->factor.corner,
                  a->magnitude + j, a->magnitude + n);
    }
    return negative;
}

INLINE int factor_band(struct arrow *a, int kd, int stride)
{
    const int n = a->n, whole = n > kd ? n - kd : 0, bare = a->first < whole ? a->first : whole;
    int first = factor_columns(a, kd, 0, 0, 0, bare); /* nothing below the band yet */
    int second = first < 0 ? -1 : factor_columns(a, kd, 0, stride, bare, whole);
    int third = second < 0 ? -1 : factor_columns(a, kd, 1, stride, whole, n);
    return third < 0 ? -1 : first + second + third;
}

INLINE int factor_chain(struct arrow *a, int kd)
{
    switch (a->stride) {
    case 0:
        return factor_band(a, kd, 0);
    case 4:
        return factor_band(a, kd, 4);
    case 8:
        return factor_band(a, kd, 8);
    default:
        return factor_band(a, kd, a->stride);
    }
}

EACH_MACHINE static int factor_any(struct arrow *a, double sigma)
{
    int full = a->full ? a->stride : 0;
    combine((a->kd + 1) * a->n, a->k.band, sigma, a->m.band, a->factor.band);
    combine(full * a->n, a->k.border, sigma, a->m.border, a->factor.border);
    combine(full * full, a->k.corner, sigma, a->m.corner, a->factor.corner);
    for (int j = 0; j < a->n; j++)
        a->magnitude[j] = fabs(a->factor.band[(ptrdiff_t)j * (a->kd + 1)]);
    for (int p = 0; p < a->full; p++)
        a->magnitude[a->n + p] = fabs(a->factor.corner[p + (ptrdiff_t)p * a->stride]);
    if (a->kd == CHAIN)
        return factor_chain(a, CHAIN);
    return a->kd == FORCES ? factor_chain(a, FORCES) : factor_band(a, a->kd, a->stride);
}

int arrow_factor(struct arrow *a, double sigma)
{
    int negative = factor_any(a, sigma);
    double *corner = a->factor.corner, *magnitude = a->magnitude + a->n;
    for (int p = 0; p < a->full && negative >= 0; p++) {
        double *column = corner + (ptrdiff_t)p * a->stride, pivot = column[p];
        if (is_lost(pivot, magnitude[p], p == a->full - 1))
            return -1;
        negative += pivot < 0;
        for (int q = p + 1; q < a->full; q++) {
            double part = column[q] / pivot;
            magnitude[q] += fabs(part * column[q]);
            for (int r = q; r < a->full; r++)
                corner[r + (ptrdiff_t)q * a->stride] -= part * column[r];
        }
        for (int q = p + 1; q < a->full; q++)
            column[q] /= pivot;
    }
    return negative;
}

INLINE void solve_below(const struct arrow *a, int kd, int tail, int from, int end, double *b)
{
    const int n = a->n;
    double *restrict below = b + n;
    for (int j = from; j < end; j++) {
        const double *restrict l = a->factor.band + (ptrdiff_t)j * (kd + 1),
                               *border = a->factor.border + (ptrdiff_t)j * a->stride;
        double now = b[j];
        int reach = tail ? n - 1 - j : kd;
#pragma GCC unroll 8
        for (int i = 1; i <= reach; i++)
            b[j + i] -= l[i] * now;
        for (int p = 0; p < a->full && j >= a->first; p++)
            below[p] -= border[p] * now;
    }
}

INLINE void solve_above(const struct arrow *a, int kd, int tail, int from, int end, double *b)
{
    const int n = a->n;
    const double *restrict below = b + n;
    for (int j = end - 1; j >= from; j--) {
        const double *restrict l = a->factor.band + (ptrdiff_t)j * (kd + 1),
                               *border = a->factor.border + (ptrdiff_t)j * a->stride;
        double sum = b[j] / l[0];
        for (int p = 0; p < a->full && j >= a->first; p++)
            sum -= border[p] * below[p];
        int reach = tail ? n - 1 - j : kd;
#pragma GCC unroll 8
        for (int i = reach; i >= 1; i--)
            sum -= l[i] * b[j + i];
        b[j] = sum;
    }
}

static void solve_corner(const struct arrow *a, double *below)
{
    const double *corner = a->factor.corner;
    for (int p = 0; p < a->full; p++)
        for (int q = p + 1; q < a->full; q++)
            below[q] -= corner[q + (ptrdiff_t)p * a->stride] * below[p];
    for (int p = a->full - 1; p >= 0; p--) {
        below[p] /= corner[p + (ptrdiff_t)p * a->stride];
        for (int q = p + 1; q < a->full; q++)
            below[p] -= corner[q + (ptrdiff_t)p * a->stride] * below[q];
    }
}

INLINE void solve(const struct arrow *a, int kd, double *b)
{
    const int n = a->n, whole = n > kd ? n - kd : 0;
    solve_below(a, kd, 0, 0, whole, b);
    solve_below(a, kd, 1, whole, n, b);
    solve_corner(a, b + n);
    solve_above(a, kd, 1, whole, n, b);
    solve_above(a, kd, 0, 0, whole, b);
}

void arrow_solve(const struct arrow *a, double *b)
{
    if (a->kd == CHAIN)
        solve(a, CHAIN, b);
    else if (a->kd == FORCES)
        solve(a, FORCES, b);
    else
        solve(a, a->kd, b);
}
