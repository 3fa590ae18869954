#include "linalg/factor.h"

#include <float.h>
#include <lapacke.h>
#include <limits.h>
#include <math.h>
#include <string.h>

#include "linalg/band.h"

int factor_new(struct pool *pool, enum factor_kind kind, const rotid_matrix *structure, int n, const int *kept, struct factor *f)
{
    int nfar = structure->nfar, kd = structure->kd;
    *f = (struct factor){.kind = kind, .kd = kd, .lda = kind == FACTOR_LU ? 3 * kd + 1 : kd + 1};
    size_t outer = (size_t)nfar;
    f->position = POOL_ARRAY(pool, int, structure->n);
    f->inner = POOL_ARRAY(pool, int, n);
    f->outer = POOL_ARRAY(pool, int, outer);
    f->band = POOL_ARRAY(pool, double, (size_t)f->lda *(size_t)n);
    f->coupling = POOL_ARRAY(pool, double, (size_t)n *outer);
    f->x = POOL_ARRAY(pool, double, (size_t)n *outer);
    f->schur = POOL_ARRAY(pool, double, outer *outer);
    f->schur_work = POOL_ARRAY(pool, double, 4 * outer);
    f->work = POOL_ARRAY(pool, double, BAND_LANES *(size_t)n);
    f->outer_work = POOL_ARRAY(pool, double, BAND_LANES *outer);
    f->first = POOL_ARRAY(pool, int, outer);
    f->last = POOL_ARRAY(pool, int, outer);
    f->band_pivot = POOL_ARRAY(pool, int, n);
    f->schur_pivot = POOL_ARRAY(pool, int, outer);
    if (!f->position || !f->inner || !f->outer || !f->band || !f->coupling || !f->x || !f->schur || !f->schur_work || !f->work ||
        !f->outer_work || !f->first || !f->last || !f->band_pivot || !f->schur_pivot)
        return ROTID_ERROR_MEMORY;
    factor_keep(f, structure, n, kept);
    return ROTID_OK;
}

void factor_keep(struct factor *f, const rotid_matrix *structure, int n, const int *kept)
{
    f->n = n;
    f->kept = kept;
    f->nr = f->nf = 0;
    for (int i = 0; i < structure->n; i++)
        f->position[i] = INT_MIN;
    for (int k = 0, next = 0; k < n; k++) {
        while (next < structure->nfar && structure->far[next] < kept[k])
            next++;
        if (next < structure->nfar && structure->far[next] == kept[k]) {
            f->position[kept[k]] = -1 - f->nf;
            f->outer[f->nf++] = k;
        } else {
            f->position[kept[k]] = f->nr;
            f->inner[f->nr++] = k;
        }
    }
}

/* Band storage of LAPACK: Cholesky keeps the lower triangle, LU both with kd rows of fill above. */
static void put_inner(struct factor *f, int row, int column, double value)
{
    if (f->kind == FACTOR_CHOLESKY) {
        f->band[(row - column) + (ptrdiff_t)column * f->lda] = value;
        return;
    }
    f->band[2 * f->kd + (row - column) + (ptrdiff_t)column * f->lda] = value;
    f->band[2 * f->kd + (column - row) + (ptrdiff_t)row * f->lda] = value;
}

/* value[d] to row column + d, d = 0 ... reach */
static void put_inner_column(struct factor *f, int column, int reach, const double *value)
{
    if (f->kind == FACTOR_CHOLESKY) {
        memcpy(f->band + (ptrdiff_t)column * f->lda, value, (size_t)(reach + 1) * sizeof *value);
        return;
    }
    double *target = f->band + 2 * (ptrdiff_t)f->kd + (ptrdiff_t)column * f->lda;
    for (int d = 0; d <= reach; d++)
        target[d] = target[(ptrdiff_t)d * (f->lda - 1)] = value[d];
}

static void gather(struct factor *f, const rotid_matrix *a)
{
    memset(f->band, 0, (size_t)f->lda * (size_t)f->nr * sizeof(double));
    memset(f->coupling, 0, (size_t)f->nr * (size_t)f->nf * sizeof(double));
    memset(f->schur, 0, (size_t)f->nf * (size_t)f->nf * sizeof(double));
    for (int k = 0; k < f->n; k++) {
        int j = f->kept[k], pj = f->position[j], reach = a->kd < a->n - 1 - j ? a->kd : a->n - 1 - j;
        const double *column = a->band + (ptrdiff_t)j * (a->kd + 1);
        if (pj >= 0 && f->position[j + reach] == pj + reach) { /* nothing left out and nothing far from here to there */
            put_inner_column(f, pj, reach, column);
            continue;
        }
        for (int d = 0; d <= reach; d++) {
            int pi = f->position[j + d];
            if (pi == INT_MIN)
                continue;
            if (pi >= 0 && pj >= 0)
                put_inner(f, pi, pj, column[d]);
            else if (pi >= 0)
                f->coupling[pi + (ptrdiff_t)(-1 - pj) * f->nr] = column[d];
            else if (pj >= 0)
                f->coupling[pj + (ptrdiff_t)(-1 - pi) * f->nr] = column[d];
            else
                f->schur[(-1 - pi) + (-1 - pj) * f->nf] = f->schur[(-1 - pj) + (-1 - pi) * f->nf] = column[d];
        }
    }
    for (int q = 0; q < a->nfar; q++)
        for (int p = 0; p < a->nfar; p++) {
            int fp = f->position[a->far[p]], fq = f->position[a->far[q]];
            if (fp != INT_MIN && fq != INT_MIN)
                f->schur[(-1 - fp) + (-1 - fq) * f->nf] += a->block[p + q * a->nfar];
        }
}

/* b [nr * lanes] interleaved */
static void inner_solve(struct factor *f, int lanes, double *b)
{
    if (f->kind == FACTOR_CHOLESKY)
        band_cholesky_solve(f->nr, f->kd, f->band, lanes, b);
    else
        band_lu_solve(f->nr, f->kd, f->band, f->band_pivot, lanes, b);
}

/* columns left to solve, rounded up to what the kernels have */
static int lanes_for(int columns)
{
    return columns >= 5 ? BAND_LANES : columns >= 3 ? 4 : columns;
}

/* S := A_ff - A_fr X */
static void form_schur(struct factor *f)
{
    for (int p = 0; p < f->nf; p++) { /* the rows that a far degree of freedom couples to: few, beside it */
        const double *coupling = f->coupling + (ptrdiff_t)p * f->nr;
        f->first[p] = 0;
        f->last[p] = f->nr;
        while (f->last[p] > 0 && coupling[f->last[p] - 1] == 0)
            f->last[p]--;
        while (f->first[p] < f->last[p] && coupling[f->first[p]] == 0)
            f->first[p]++;
    }
    for (int q = 0; q < f->nf; q++)
        for (int p = 0; p < f->nf; p++) {
            double sum = 0;
            for (int i = f->first[p]; i < f->last[p]; i++)
                sum += f->coupling[i + (ptrdiff_t)p * f->nr] * f->x[i + (ptrdiff_t)q * f->nr];
            f->schur[p + q * f->nf] -= sum;
        }
}

int factor_compute(struct factor *f, const rotid_matrix *a)
{
    gather(f, a);
    if (f->kind == FACTOR_CHOLESKY ? band_cholesky(f->nr, f->kd, f->band) : band_lu(f->nr, f->kd, f->band, f->band_pivot))
        return 1;
    if (!f->nf)
        return 0;
    for (int q = 0; q < f->nf; q += BAND_LANES) {
        int columns = f->nf - q < BAND_LANES ? f->nf - q : BAND_LANES, lanes = lanes_for(columns);
        memset(f->work, 0, (size_t)f->nr * (size_t)lanes * sizeof(double));
        for (int c = 0; c < columns; c++)
            for (int i = 0; i < f->nr; i++)
                f->work[(ptrdiff_t)i * lanes + c] = f->coupling[i + (ptrdiff_t)(q + c) * f->nr];
        inner_solve(f, lanes, f->work);
        for (int c = 0; c < columns; c++)
            for (int i = 0; i < f->nr; i++)
                f->x[i + (ptrdiff_t)(q + c) * f->nr] = f->work[(ptrdiff_t)i * lanes + c];
    }
    form_schur(f);
    lapack_int info;
    if (f->kind == FACTOR_CHOLESKY)
        info = LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', f->nf, f->schur, f->nf);
    else
        info = LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, f->nf, f->nf, f->schur, f->nf, f->schur_pivot);
    return info != 0;
}

int factor_is_singular(const struct factor *f, const rotid_matrix *a)
{
    double rounding = 256 * f->n * DBL_EPSILON; /* free beams of 2 to 1280 elements leave a sixth of it at most */
    for (int i = 0; i < f->nr; i++) {
        double pivot = f->band[(ptrdiff_t)i * f->lda];
        if (pivot * pivot <= rounding * a->band[(ptrdiff_t)f->kept[f->inner[i]] * (a->kd + 1)])
            return 1;
    }
    for (int p = 0; p < a->nfar; p++) {
        int place = f->position[a->far[p]];
        if (place == INT_MIN)
            continue;
        double pivot = f->schur[(ptrdiff_t)(-1 - place) * (f->nf + 1)];
        if (pivot * pivot <= rounding * (a->band[(ptrdiff_t)a->far[p] * (a->kd + 1)] + a->block[(ptrdiff_t)p * (a->nfar + 1)]))
            return 1;
    }
    return 0;
}

static void outer_solve(struct factor *f, int columns, double *b)
{
    if (f->kind == FACTOR_CHOLESKY)
        (void)LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', f->nf, columns, f->schur, f->nf, b, f->nf);
    else
        (void)LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', f->nf, columns, f->schur, f->nf, f->schur_pivot, b, f->nf);
}

/* outer [nf * columns] := A_ff part of b less A_fr inner, solved; inner := inner - X outer */
static void solve_border(struct factor *f, int columns, int lanes, double *b)
{
    double *inner = f->work, *outer = f->outer_work;
    for (int c = 0; c < columns; c++)
        for (int p = 0; p < f->nf; p++) {
            const double *coupling = f->coupling + (ptrdiff_t)p * f->nr;
            double sum = b[f->outer[p] + (ptrdiff_t)c * f->n];
            for (int i = f->first[p]; i < f->last[p]; i++)
                sum -= coupling[i] * inner[(ptrdiff_t)i * lanes + c];
            outer[p + c * f->nf] = sum;
        }
    outer_solve(f, columns, outer);
    for (int p = 0; p < f->nf; p++) {
        const double *restrict x = f->x + (ptrdiff_t)p * f->nr;
        double row[BAND_LANES] = {0};
        for (int c = 0; c < columns; c++)
            b[f->outer[p] + (ptrdiff_t)c * f->n] = row[c] = outer[p + c * f->nf];
        for (int i = 0; i < f->nr; i++)
            for (int c = 0; c < lanes; c++)
                inner[(ptrdiff_t)i * lanes + c] -= x[i] * row[c];
    }
}

/* `columns` columns of b, at most BAND_LANES */
static void solve_together(struct factor *f, int columns, double *b)
{
    int lanes = lanes_for(columns);
    double *inner = f->work;
    if (columns < lanes)
        memset(inner, 0, (size_t)f->nr * (size_t)lanes * sizeof(double));
    for (int c = 0; c < columns; c++)
        for (int i = 0; i < f->nr; i++)
            inner[(ptrdiff_t)i * lanes + c] = b[f->inner[i] + (ptrdiff_t)c * f->n];
    inner_solve(f, lanes, inner);
    if (f->nf)
        solve_border(f, columns, lanes, b);
    for (int c = 0; c < columns; c++)
        for (int i = 0; i < f->nr; i++)
            b[f->inner[i] + (ptrdiff_t)c * f->n] = inner[(ptrdiff_t)i * lanes + c];
}

void factor_solve(struct factor *f, int columns, double *b)
{
    for (int c = 0; c < columns; c += BAND_LANES)
        solve_together(f, columns - c < BAND_LANES ? columns - c : BAND_LANES, b + (ptrdiff_t)c * f->n);
}

/* LDL' of the inner band in its own storage (unit lower L below, D on the diagonal); returns the number of negative pivots. A
 * pivot that cancels is replaced by a tiny one of its scale, which moves the shift by rounding and keeps the count. */
static int band_ldl(struct factor *f)
{
    int negative = 0;
    for (int j = 0; j < f->nr; j++) {
        double *l = f->band + (ptrdiff_t)j * f->lda;
        int reach = f->kd < f->nr - 1 - j ? f->kd : f->nr - 1 - j;
        double scale = fabs(l[0]);
        for (int d = 1; d <= reach; d++)
            scale = fmax(scale, fabs(l[d]));
        if (fabs(l[0]) < 1e-15 * scale)
            l[0] = -1e-15 * scale;
        negative += l[0] < 0;
        for (int d = 1; d <= reach; d++) {
            double factor = l[d] / l[0];
            double *target = f->band + (ptrdiff_t)(j + d) * f->lda;
            for (int e = d; e <= reach; e++)
                target[e - d] -= factor * l[e];
        }
        for (int d = 1; d <= reach; d++)
            l[d] /= l[0];
    }
    return negative;
}

static void ldl_solve(const struct factor *f, double *b)
{
    for (int j = 0; j < f->nr; j++) {
        const double *l = f->band + (ptrdiff_t)j * f->lda;
        int reach = f->kd < f->nr - 1 - j ? f->kd : f->nr - 1 - j;
        for (int d = 1; d <= reach; d++)
            b[j + d] -= l[d] * b[j];
    }
    for (int j = f->nr - 1; j >= 0; j--) {
        const double *l = f->band + (ptrdiff_t)j * f->lda;
        int reach = f->kd < f->nr - 1 - j ? f->kd : f->nr - 1 - j;
        b[j] /= l[0];
        for (int d = 1; d <= reach; d++)
            b[j] -= l[d] * b[j + d];
    }
}

int factor_negative_count(struct factor *f, const rotid_matrix *a)
{
    gather(f, a);
    int negative = band_ldl(f);
    if (!f->nf)
        return negative;
    memcpy(f->x, f->coupling, (size_t)f->nr * (size_t)f->nf * sizeof(double));
    for (int p = 0; p < f->nf; p++)
        ldl_solve(f, f->x + (ptrdiff_t)p * f->nr);
    form_schur(f);
    double *value = f->schur_work;
    if (LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'N', 'L', f->nf, f->schur, f->nf, value, value + f->nf, 3 * f->nf))
        return -1;
    for (int p = 0; p < f->nf; p++)
        negative += value[p] < 0;
    return negative;
}
