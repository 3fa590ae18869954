#include "linalg/linalg.h"

#include <lapacke.h>

int symmetric_new(struct pool *pool, int n, struct symmetric *s)
{
    *s = (struct symmetric){.n = n, .lwork = 32 * n};
    s->a = POOL_ARRAY(pool, double, (size_t)n *(size_t)n);
    s->work = POOL_ARRAY(pool, double, s->lwork);
    s->pivot = POOL_ARRAY(pool, int, n);
    return s->a && s->work && s->pivot ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int symmetric_factor(struct symmetric *s, int size)
{
    return size && LAPACKE_dsytrf_work(LAPACK_COL_MAJOR, 'L', size, s->a, size, s->pivot, s->work, s->lwork) != 0;
}

int symmetric_negative(const struct symmetric *s, int size)
{
    int negative = 0;
    for (int i = 0; i < size; i++)
        if (s->pivot[i] < 0) { /* a block of two, which is chosen where it is indefinite */
            negative++;
            i++;
        } else {
            negative += s->a[i + (ptrdiff_t)i * size] < 0;
        }
    return negative;
}

void symmetric_solve(struct symmetric *s, int size, double *b)
{
    if (size)
        (void)LAPACKE_dsytrs_work(LAPACK_COL_MAJOR, 'L', size, 1, s->a, size, s->pivot, b, size);
}
