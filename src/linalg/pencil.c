#include "linalg/linalg.h"

#include <limits.h>
#include <string.h>

#include "linalg/machine.h"

#define LANES  8
#define INLINE static inline __attribute__((always_inline))

int pencil_new(struct pool *pool, const rotid_matrix *structure, struct pencil *p)
{
    size_t n = (size_t)structure->n, most = n * (size_t)(structure->kd + 1);
    *p = (struct pencil){.n = structure->n};
    if (most > INT_MAX) /* places are counted in int; such bands take 50 GB */
        return ROTID_ERROR_MEMORY;
    p->start = POOL_ARRAY(pool, int, n + 1);
    p->row = POOL_ARRAY(pool, int, most);
    p->k = POOL_ARRAY(pool, double, most);
    p->m = POOL_ARRAY(pool, double, most);
    p->block = POOL_ARRAY(pool, double, (size_t)structure->nfar *(size_t)structure->nfar);
    p->x = POOL_ARRAY(pool, double, LANES *n);
    p->y = POOL_ARRAY(pool, double, LANES *n);
    return p->start && p->row && p->k && p->m && p->block && p->x && p->y ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Whether M is that of the call before shows in a digest of its entries: where K has entries that are rounding, they come and go
 * with its parameters, and so do places of the pattern. */
static uint64_t digest(uint64_t before, uint64_t place, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    before = (before ^ bits ^ place * 0xff51afd7ed558ccdULL) * 0x9e3779b97f4a7c15ULL;
    return before ^ before >> 29;
}

int pencil_take(struct pencil *p, const rotid_matrix *k, const rotid_matrix *m)
{
    int same = p->mass != NULL, at = 0;
    uint64_t entries = 0;
    p->stiffness = k;
    p->mass = m;
    for (int j = 0; j < p->n; j++) {
        int reach = k->kd < p->n - 1 - j ? k->kd : p->n - 1 - j;
        const double *kj = k->band + (ptrdiff_t)j * (k->kd + 1), *mj = m->band + (ptrdiff_t)j * (k->kd + 1);
        p->start[j] = at;
        for (int d = 0; d <= reach; d++) {
            if (d && d + MATRIX_STRETCH <= reach && matrix_stretch_is_zero(kj + d) && matrix_stretch_is_zero(mj + d)) {
                d += MATRIX_STRETCH - 1;
                continue;
            }
            if (d && kj[d] == 0 && mj[d] == 0)
                continue;
            if (mj[d] != 0)
                entries = digest(entries, (uint64_t)j * (uint64_t)(k->kd + 1) + (uint64_t)d, mj[d]);
            p->row[at] = j + d;
            p->k[at] = kj[d];
            p->m[at++] = mj[d];
        }
    }
    p->start[p->n] = at;
    same &= p->digest == entries;
    p->digest = entries;
    for (ptrdiff_t i = 0; i < (ptrdiff_t)m->nfar * m->nfar; i++) {
        same &= p->block[i] == m->block[i];
        p->block[i] = m->block[i];
    }
    return same;
}

/* y += A x for 4 `fours` columns, interleaved; compiled for each number of them as a constant */
INLINE void multiply_fours(const struct pencil *p, const double *restrict value, int fours, const four *restrict x,
                           four *restrict y)
{
    for (int j = 0; j < p->n; j++) {
        four from[LANES / 4], sum[LANES / 4];
        int at = p->start[j];
#pragma GCC unroll 2
        for (int c = 0; c < fours; c++) {
            from[c] = x[(ptrdiff_t)j * fours + c];
            sum[c] = y[(ptrdiff_t)j * fours + c] + value[at] * from[c];
        }
        while (++at < p->start[j + 1]) {
            const double a = value[at];
            ptrdiff_t i = (ptrdiff_t)p->row[at] * fours;
#pragma GCC unroll 2
            for (int c = 0; c < fours; c++) {
                sum[c] += a * x[i + c];
                y[i + c] += a * from[c];
            }
        }
#pragma GCC unroll 2
        for (int c = 0; c < fours; c++)
            y[(ptrdiff_t)j * fours + c] = sum[c];
    }
}

EACH_MACHINE static void multiply_8(const struct pencil *p, const double *value, const double *x, double *y)
{
    multiply_fours(p, value, 2, (const four *)x, (four *)y);
}

EACH_MACHINE static void multiply_4(const struct pencil *p, const double *value, const double *x, double *y)
{
    multiply_fours(p, value, 1, (const four *)x, (four *)y);
}

static void multiply_1(const struct pencil *p, const double *restrict value, const double *restrict x, double *restrict y)
{
    for (int j = 0; j < p->n; j++) {
        int at = p->start[j];
        double sum = value[at] * x[j];
        while (++at < p->start[j + 1]) {
            sum += value[at] * x[p->row[at]];
            y[p->row[at]] += value[at] * x[j];
        }
        y[j] += sum;
    }
}

/* `columns` columns, at most `lanes` */
INLINE void multiply_together(struct pencil *p, const double *value, const rotid_matrix *a, int lanes, int columns,
                              const double *x, double *y)
{
    ptrdiff_t n = p->n;
    memset(p->y, 0, (size_t)n * (size_t)lanes * sizeof *y);
    for (int c = 0; c < lanes; c++)
        for (ptrdiff_t i = 0; i < n; i++)
            p->x[i * lanes + c] = c < columns ? x[i + c * n] : 0;
    (lanes == LANES ? multiply_8 : lanes == 4 ? multiply_4 : multiply_1)(p, value, p->x, p->y);
    for (int g = 0; g < a->nfar; g++)
        for (int f = 0; f < a->nfar; f++)
            for (int c = 0; c < lanes; c++)
                p->y[(ptrdiff_t)a->far[f] * lanes + c] +=
                    a->block[f + (ptrdiff_t)g * a->nfar] * p->x[(ptrdiff_t)a->far[g] * lanes + c];
    for (int c = 0; c < columns; c++)
        for (ptrdiff_t i = 0; i < n; i++)
            y[i + c * n] = p->y[i * lanes + c];
}

static void multiply(struct pencil *p, const double *value, const rotid_matrix *a, int columns, const double *x, double *y)
{
    ptrdiff_t n = p->n;
    for (; columns > 4; columns -= LANES, x += LANES * n, y += LANES * n)
        multiply_together(p, value, a, LANES, columns < LANES ? columns : LANES, x, y);
    if (columns > 1)
        multiply_together(p, value, a, 4, columns, x, y);
    else if (columns == 1)
        multiply_together(p, value, a, 1, 1, x, y);
}

void pencil_multiply_stiffness(struct pencil *p, int columns, const double *x, double *y)
{
    multiply(p, p->k, p->stiffness, columns, x, y);
}

void pencil_multiply_mass(struct pencil *p, int columns, const double *x, double *y)
{
    multiply(p, p->m, p->mass, columns, x, y);
}
