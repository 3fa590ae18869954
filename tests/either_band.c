#include "either_band.h"

#include "linalg/linalg.h"
#include "support.h"

int either_band_wide;

int either_band_is_too_small(int n)
{
    return either_band_wide && n <= FACTOR_WIDE;
}

int either_band_new(struct pool *pool, const rotid_matrix *structure, int count, struct either_band *e)
{
    rotid_matrix *both[] = {&e->k, &e->m};
    if (!either_band_wide)
        return eigen_band_new(pool, structure, count, &e->narrow);
    for (int i = 0; i < 2; i++)
        assert_status(matrix_new(pool, structure->n, structure->kd > FACTOR_WIDE ? structure->kd : FACTOR_WIDE, structure->nfar,
                                 structure->far, both[i]),
                      ROTID_OK);
    return eigen_wide_new(pool, &e->k, count, &e->wide);
}

void widen(const rotid_matrix *from, rotid_matrix *to)
{
    matrix_zero(to);
    for (int j = 0; j < from->n; j++)
        for (int d = 0; d <= from->kd && j + d < from->n; d++)
            to->band[d + (ptrdiff_t)j * (to->kd + 1)] = from->band[d + (ptrdiff_t)j * (from->kd + 1)];
    memcpy(to->block, from->block, (size_t)from->nfar * (size_t)from->nfar * sizeof *to->block);
}

int either_band_solve(struct either_band *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi)
{
    if (!either_band_wide)
        return eigen_band_solve(&e->narrow, k, m, lambda, phi);
    widen(k, &e->k);
    widen(m, &e->m);
    return eigen_wide_solve(&e->wide, &e->k, &e->m, lambda, phi);
}
