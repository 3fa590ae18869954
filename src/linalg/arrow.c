#include "linalg/linalg.h"
#include "linalg/machine.h"

#define INLINE static inline __attribute__((always_inline))
#define LOST   1e-7 /* of what was added up: a smaller pivot leaves nine digits or less to the solution */
#define CHAIN  3    /* half band of a chain of elements */
#define FORCES 5    /* and with a force beside every rotation */

_Static_assert(ARROW_SHIFTS * sizeof(double) == sizeof(four), "a vector holds one number of each shift");

typedef int64_t four_signs __attribute__((vector_size(32)));

static int new_matrix(struct pool *pool, const struct arrow *a, size_t shifts, struct arrow_matrix *matrix)
{
    size_t n = (size_t)a->n, full = (size_t)a->full;
    matrix->band = POOL_ARRAY(pool, double, shifts *n *(size_t)(a->kd + 1));
    matrix->border = POOL_ARRAY(pool, double, shifts *n *full);
    matrix->corner = POOL_ARRAY(pool, double, shifts *full *full);
    return matrix->band && matrix->border && matrix->corner ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int arrow_new(struct pool *pool, int n, int kd, int full, struct arrow *a)
{
    *a = (struct arrow){.n = n, .kd = kd, .full = full, .first = n};
    a->magnitude = POOL_ARRAY(pool, double, ARROW_SHIFTS *(size_t)(n + full));
    int status = a->magnitude ? new_matrix(pool, a, 1, &a->k) : ROTID_ERROR_MEMORY;
    if (!status)
        status = new_matrix(pool, a, 1, &a->m);
    return status ? status : new_matrix(pool, a, ARROW_SHIFTS, &a->factor);
}

void arrow_zero(struct arrow *a, struct arrow_matrix *matrix)
{
    memset(matrix->band, 0, (size_t)a->n * (size_t)(a->kd + 1) * sizeof(double));
    if (!a->full)
        return;
    memset(matrix->border, 0, (size_t)a->n * (size_t)a->full * sizeof(double));
    memset(matrix->corner, 0, (size_t)a->full * (size_t)a->full * sizeof(double));
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
        matrix->border[high + (ptrdiff_t)low * a->full] += value;
        a->first = low < a->first ? low : a->first;
        return;
    }
    matrix->corner[high + (ptrdiff_t)(low - a->n) * a->full] += value;
}

void arrow_take(struct arrow *a, struct arrow_matrix *matrix, const rotid_matrix *from, const int *row)
{
    int n = from->n, kd = from->kd;
    arrow_zero(a, matrix);
    for (int j = 0; j < n; j++) {
        int reach = kd < n - 1 - j ? kd : n - 1 - j;
        const double *column = from->band + (ptrdiff_t)j * (kd + 1);
        if (row[j + reach] < a->n && row[j + reach] == row[j] + reach) { /* none of them far */
            memcpy(matrix->band + (ptrdiff_t)row[j] * (kd + 1), column, (size_t)(reach + 1) * sizeof *column);
            continue;
        }
        for (int d = 0; d <= reach; d++)
            if (column[d] != 0)
                arrow_add(a, matrix, row[j + d], row[j], column[d]);
    }
    for (int q = 0; q < from->nfar; q++)
        for (int p = q; p < from->nfar; p++)
            arrow_add(a, matrix, row[from->far[p]], row[from->far[q]], from->block[p + (ptrdiff_t)q * from->nfar]);
}

static const four_signs all_but_sign = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX};
#define MAGNITUDE(x) ((four)((four_signs)(x)&all_but_sign))

INLINE void combine(int count, const double *restrict k, const double *sigma, const double *restrict m, four *restrict out)
{
    const four shift = FOUR(sigma);
    for (int i = 0; i < count; i++)
        out[i] = k[i] - shift * m[i];
}

/* What has become of the pivots: all bits of a shift are set where one was lost; minus the number of negative ones. */
struct pivots {
    four_signs lost, negative;
};

/* A last pivot may be anything but zero: that of a matrix that is nearly singular, as for inverse iteration. */
INLINE void judge(const four *pivot, const four *magnitude, int last, struct pivots *all)
{
    four least = (last ? 0.0 : LOST) * *magnitude;
    all->lost |= ~(four_signs)(MAGNITUDE(*pivot) > least);
    all->negative += (four_signs)(*pivot < 0.0);
}

/* Takes a column of the band, l [reach + 1], off those behind it, and its part of the full rows, border [full], off theirs. */
INLINE void eliminate(int kd, int reach, int full, four *restrict l, four *restrict border, four *restrict corner,
                      four *restrict magnitude, four *restrict corner_magnitude)
{
    const ptrdiff_t lda = kd + 1;
    four inverse = 1.0 / l[0];
#pragma GCC unroll 8
    for (int i = 1; i <= reach; i++) {
        four part = l[i] * inverse, *target = l + i * lda - i;
        magnitude[i] += MAGNITUDE(part * l[i]);
#pragma GCC unroll 8
        for (int e = i; e <= reach; e++)
            target[e] -= part * l[e];
        for (int p = 0; p < full; p++)
            border[p + (ptrdiff_t)i * full] -= part * border[p];
    }
#pragma GCC unroll 8
    for (int i = 1; i <= reach; i++)
        l[i] *= inverse;
    for (int p = 0; p < full; p++) {
        four part = border[p] * inverse;
        corner_magnitude[p] += MAGNITUDE(part * border[p]);
        for (int q = p; q < full; q++)
            corner[q + (ptrdiff_t)p * full] -= part * border[q];
    }
    for (int p = 0; p < full; p++)
        border[p] *= inverse;
}

/* Columns from ... end - 1, of which those of the tail have fewer than kd rows below them */
INLINE void factor_columns(struct arrow *a, int kd, int tail, int full, int from, int end, struct pivots *all)
{
    const int n = a->n;
    four *magnitude = (four *)a->magnitude;
    for (int j = from; j < end; j++) {
        four *l = (four *)a->factor.band + (ptrdiff_t)j * (kd + 1);
        judge(l, magnitude + j, !a->full && j == n - 1, all);
        eliminate(kd, tail ? n - 1 - j : kd, full, l, (four *)a->factor.border + (ptrdiff_t)j * full, (four *)a->factor.corner,
                  magnitude + j, magnitude + n);
    }
}

INLINE void factor_band(struct arrow *a, int kd, struct pivots *all)
{
    const int n = a->n, whole = n > kd ? n - kd : 0, bare = a->first < whole ? a->first : whole;
    factor_columns(a, kd, 0, 0, 0, bare, all); /* nothing below the band yet */
    factor_columns(a, kd, 0, a->full, bare, whole, all);
    factor_columns(a, kd, 1, a->full, whole, n, all);
}

INLINE void factor_corner(struct arrow *a, struct pivots *all)
{
    const int full = a->full;
    four *corner = (four *)a->factor.corner, *magnitude = (four *)a->magnitude + a->n;
    for (int p = 0; p < full; p++) {
        four *column = corner + (ptrdiff_t)p * full, pivot = column[p];
        judge(column + p, magnitude + p, p == full - 1, all);
        for (int q = p + 1; q < full; q++) {
            four part = column[q] / pivot;
            magnitude[q] += MAGNITUDE(part * column[q]);
            for (int r = q; r < full; r++)
                corner[r + (ptrdiff_t)q * full] -= part * column[r];
        }
        for (int q = p + 1; q < full; q++)
            column[q] /= pivot;
    }
}

EACH_MACHINE static void factor_all(struct arrow *a, const double *sigma, struct pivots *all)
{
    four *band = (four *)a->factor.band, *corner = (four *)a->factor.corner, *magnitude = (four *)a->magnitude;
    combine((a->kd + 1) * a->n, a->k.band, sigma, a->m.band, band);
    combine(a->full * a->n, a->k.border, sigma, a->m.border, (four *)a->factor.border);
    combine(a->full * a->full, a->k.corner, sigma, a->m.corner, corner);
    for (int j = 0; j < a->n; j++)
        magnitude[j] = MAGNITUDE(band[(ptrdiff_t)j * (a->kd + 1)]);
    for (int p = 0; p < a->full; p++)
        magnitude[a->n + p] = MAGNITUDE(corner[p + (ptrdiff_t)p * a->full]);
    if (a->kd == CHAIN)
        factor_band(a, CHAIN, all);
    else if (a->kd == FORCES)
        factor_band(a, FORCES, all);
    else
        factor_band(a, a->kd, all);
    factor_corner(a, all);
}

void arrow_factor(struct arrow *a, const double *sigma, int *negative)
{
    struct pivots all = {0};
    factor_all(a, sigma, &all);
    for (int s = 0; s < ARROW_SHIFTS; s++)
        negative[s] = all.lost[s] ? -1 : (int)-all.negative[s];
}

int arrow_count(struct arrow *a, double sigma)
{
    const double shifts[ARROW_SHIFTS] = {sigma, sigma, sigma, sigma};
    int negative[ARROW_SHIFTS];
    arrow_factor(a, shifts, negative);
    return negative[0];
}

INLINE void solve_below(const struct arrow *a, int kd, int tail, int from, int end, four *b)
{
    const int n = a->n;
    four *restrict below = b + n;
    for (int j = from; j < end; j++) {
        const four *restrict l = (const four *)a->factor.band + (ptrdiff_t)j * (kd + 1),
                             *border = (const four *)a->factor.border + (ptrdiff_t)j * a->full;
        four now = b[j];
        int reach = tail ? n - 1 - j : kd;
#pragma GCC unroll 8
        for (int i = 1; i <= reach; i++)
            b[j + i] -= l[i] * now;
        for (int p = 0; p < a->full && j >= a->first; p++)
            below[p] -= border[p] * now;
    }
}

INLINE void solve_above(const struct arrow *a, int kd, int tail, int from, int end, four *b)
{
    const int n = a->n;
    const four *restrict below = b + n;
    for (int j = end - 1; j >= from; j--) {
        const four *restrict l = (const four *)a->factor.band + (ptrdiff_t)j * (kd + 1),
                             *border = (const four *)a->factor.border + (ptrdiff_t)j * a->full;
        four sum = b[j] / l[0];
        int reach = tail ? n - 1 - j : kd;
        for (int p = 0; p < a->full && j >= a->first; p++)
            sum -= border[p] * below[p];
#pragma GCC unroll 8
        for (int i = reach; i >= 1; i--)
            sum -= l[i] * b[j + i];
        b[j] = sum;
    }
}

INLINE void solve_corner(const struct arrow *a, four *below)
{
    const int full = a->full;
    const four *corner = (const four *)a->factor.corner;
    for (int p = 0; p < full; p++)
        for (int q = p + 1; q < full; q++)
            below[q] -= corner[q + (ptrdiff_t)p * full] * below[p];
    for (int p = full - 1; p >= 0; p--) {
        below[p] /= corner[p + (ptrdiff_t)p * full];
        for (int q = p + 1; q < full; q++)
            below[p] -= corner[q + (ptrdiff_t)p * full] * below[q];
    }
}

INLINE void solve(const struct arrow *a, int kd, four *b)
{
    const int n = a->n, whole = n > kd ? n - kd : 0;
    solve_below(a, kd, 0, 0, whole, b);
    solve_below(a, kd, 1, whole, n, b);
    solve_corner(a, b + n);
    solve_above(a, kd, 1, whole, n, b);
    solve_above(a, kd, 0, 0, whole, b);
}

EACH_MACHINE static void solve_all(const struct arrow *a, double *b)
{
    if (a->kd == CHAIN)
        solve(a, CHAIN, (four *)b);
    else if (a->kd == FORCES)
        solve(a, FORCES, (four *)b);
    else
        solve(a, a->kd, (four *)b);
}

void arrow_solve(const struct arrow *a, double *b)
{
    solve_all(a, b);
}
