#include "linalg/linalg.h"

#include <limits.h>

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

typedef long long four_counts __attribute__((vector_size(32)));

/* How many of the entries below the diagonal are not zero in K or M */
EACH_MACHINE static long long count_entries(const rotid_matrix *k, const rotid_matrix *m)
{
    four_counts sum = {0};
    long long rest = 0;
    for (int j = 0; j < k->n; j++) {
        const double *kj = k->band + (ptrdiff_t)j * (k->kd + 1), *mj = m->band + (ptrdiff_t)j * (k->kd + 1);
        int reach = matrix_reach(k, j), d = 1;
        for (; d + 4 <= reach + 1; d += 4)
            sum -= (four_counts)((FOUR(kj + d) != 0) | (FOUR(mj + d) != 0));
        for (; d <= reach; d++)
            rest += kj[d] != 0 || mj[d] != 0;
    }
    return rest + sum[0] + sum[1] + sum[2] + sum[3];
}

/* Entries at the places of the call before; *same: whether M is that of then. Returns whether none is anywhere else. */
static int take_again(struct pencil *p, const rotid_matrix *k, const rotid_matrix *m, int *same)
{
    long long count = 0;
    for (int j = 0; j < p->n; j++) {
        const double *kj = k->band + (ptrdiff_t)j * (k->kd + 1) - j, *mj = m->band + (ptrdiff_t)j * (k->kd + 1) - j;
        for (int at = p->start[j]; at < p->start[j + 1]; at++) {
            int i = p->row[at];
            count += i != j && (kj[i] != 0 || mj[i] != 0);
            *same &= p->m[at] == mj[i];
            p->k[at] = kj[i];
            p->m[at] = mj[i];
        }
    }
    return count == count_entries(k, m);
}

static void take_new(struct pencil *p, const rotid_matrix *k, const rotid_matrix *m)
{
    int at = 0;
    for (int j = 0; j < p->n; j++) {
        int reach = matrix_reach(k, j);
        const double *kj = k->band + (ptrdiff_t)j * (k->kd + 1), *mj = m->band + (ptrdiff_t)j * (k->kd + 1);
        p->start[j] = at;
        for (int d = 0; d <= reach; d++) {
            if (d && d + MATRIX_STRETCH <= reach && matrix_stretch_is_zero(kj + d) && matrix_stretch_is_zero(mj + d)) {
                d += MATRIX_STRETCH - 1;
                continue;
            }
            if (d && kj[d] == 0 && mj[d] == 0)
                continue;
            p->row[at] = j + d;
            p->k[at] = kj[d];
            p->m[at++] = mj[d];
        }
    }
    p->start[p->n] = at;
}

int pencil_take(struct pencil *p, const rotid_matrix *k, const rotid_matrix *m)
{
    int same = p->mass != NULL;
    if (!same || !take_again(p, k, m, &same)) {
        take_new(p, k, m);
        same = 0;
    }
    p->stiffness = k;
    p->mass = m;
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
