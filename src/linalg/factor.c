#include "linalg/linalg.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <limits.h>
#include <math.h>
#include <string.h>

#define WIDE_COLUMNS 8 /* right-hand sides that are solved together, of wide bands */

int factor_is_wide(const rotid_matrix *structure)
{
    return structure->kd >= FACTOR_WIDE;
}

static int new_wide(struct pool *pool, int n, int kd, struct factor *f)
{
    f->reach = POOL_ARRAY(pool, int, n);
    f->row = POOL_ARRAY(pool, int, kd + 1);
    f->value = POOL_ARRAY(pool, double, kd + 1);
    return f->reach && f->row && f->value ? wide_new(pool, n, kd, &f->wide) : ROTID_ERROR_MEMORY;
}

static int new_narrow(struct pool *pool, int n, struct factor *f)
{
    f->band = POOL_ROOM(pool, double, (size_t)f->lda *(size_t)n);
    f->band_pivot = POOL_ARRAY(pool, int, n);
    return f->band && f->band_pivot ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int factor_new(struct pool *pool, enum factor_kind kind, const rotid_matrix *structure, int n, const int *kept, struct factor *f)
{
    int nfar = structure->nfar, kd = structure->kd;
    *f = (struct factor){.kind = kind, .kd = kd, .lda = kind == FACTOR_LU ? 3 * kd + 1 : kd + 1};
    f->is_wide = factor_is_wide(structure);
    size_t outer = (size_t)nfar;
    f->position = POOL_ARRAY(pool, int, structure->n);
    f->inner = POOL_ARRAY(pool, int, n);
    f->outer = POOL_ARRAY(pool, int, outer);
    f->coupling = POOL_ROOM(pool, double, (size_t)n *outer);
    f->x = POOL_ROOM(pool, double, (size_t)n *outer);
    f->schur = POOL_ARRAY(pool, double, outer *outer);
    f->schur_work = POOL_ARRAY(pool, double, 4 * outer);
    f->work = POOL_ROOM(pool, double, (f->is_wide ? WIDE_COLUMNS : BAND_LANES) * (size_t)n);
    f->outer_work = POOL_ARRAY(pool, double, WIDE_COLUMNS *outer); /* >= 2 BAND_LANES */
    f->same = POOL_ARRAY(pool, int, n);
    f->first = POOL_ARRAY(pool, int, outer);
    f->last = POOL_ARRAY(pool, int, outer);
    f->schur_pivot = POOL_ARRAY(pool, int, outer);
    if (!f->position || !f->inner || !f->outer || !f->coupling || !f->x || !f->schur || !f->schur_work || !f->work || !f->same ||
        !f->outer_work || !f->first || !f->last || !f->schur_pivot)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < n; i++)
        f->same[i] = i;
    factor_keep(f, structure, n, kept);
    return f->is_wide ? new_wide(pool, n, kd, f) : new_narrow(pool, n, f);
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
    return columns >= 3 ? BAND_LANES : columns;
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

/* X := A_rr^-1 A_rf */
static void solve_coupling(struct factor *f)
{
    if (f->is_wide) {
        memcpy(f->x, f->coupling, (size_t)f->nr * (size_t)f->nf * sizeof(double));
        wide_solve(&f->wide, f->nf, f->nr, f->x);
        return;
    }
    for (int q = 0; q < f->nf; q += BAND_LANES) {
        int columns = f->nf - q < BAND_LANES ? f->nf - q : BAND_LANES, lanes = lanes_for(columns);
        ptrdiff_t at = (ptrdiff_t)q * f->nr;
        band_gather(f->nr, f->same, columns, f->nr, f->coupling + at, lanes, f->work);
        inner_solve(f, lanes, f->work);
        band_scatter(f->nr, f->same, columns, f->nr, lanes, f->work, f->x + at);
    }
}

static int factor_inner(struct factor *f)
{
    if (!f->is_wide)
        return f->kind == FACTOR_CHOLESKY ? band_cholesky(f->nr, f->kd, f->band) : band_lu(f->nr, f->kd, f->band, f->band_pivot);
    return f->kind == FACTOR_CHOLESKY ? wide_cholesky(&f->wide) : wide_indefinite(&f->wide) < 0;
}

static int compute(struct factor *f, const struct factor_source *source)
{
    factor_gather(f, source);
    if (factor_inner(f))
        return 1;
    if (!f->nf)
        return 0;
    solve_coupling(f);
    form_schur(f);
    lapack_int info;
    if (f->kind == FACTOR_CHOLESKY)
        info = LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', f->nf, f->schur, f->nf);
    else
        info = LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, f->nf, f->nf, f->schur, f->nf, f->schur_pivot);
    return info != 0;
}

int factor_compute(struct factor *f, const rotid_matrix *a)
{
    return compute(f, &(struct factor_source){.a = a});
}

int factor_compute_pencil(struct factor *f, const struct pencil *p, double shift)
{
    return compute(f, &(struct factor_source){.pencil = p, .shift = shift});
}

int factor_is_singular(const struct factor *f, const rotid_matrix *a)
{
    double rounding = 256 * f->n * DBL_EPSILON; /* free beams of 2 to 1280 elements leave a sixth of it at most */
    for (int i = 0; i < f->nr; i++) {
        double pivot = f->is_wide ? wide_column(&f->wide, i)[i] : f->band[(ptrdiff_t)i * f->lda];
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

/* outer rows of b [n * columns] := A_ff^-1 of those less A_fr inner; inner := inner - X outer */
static void solve_border(struct factor *f, int columns, int lanes, double *b)
{
    double *inner = f->work, *outer = f->outer_work, *row = outer + BAND_LANES * (ptrdiff_t)f->nf;
    for (int c = 0; c < columns; c++)
        for (int p = 0; p < f->nf; p++) {
            const double *coupling = f->coupling + (ptrdiff_t)p * f->nr;
            double sum = b[f->outer[p] + (ptrdiff_t)c * f->n];
            for (int i = f->first[p]; i < f->last[p]; i++)
                sum -= coupling[i] * inner[(ptrdiff_t)i * lanes + c];
            outer[p + c * f->nf] = sum;
        }
    outer_solve(f, columns, outer);
    for (int p = 0; p < f->nf; p++)
        for (int c = 0; c < lanes; c++) {
            row[p * lanes + c] = c < columns ? outer[p + c * f->nf] : 0;
            if (c < columns)
                b[f->outer[p] + (ptrdiff_t)c * f->n] = row[p * lanes + c];
        }
    band_subtract(f->nr, f->nf, f->x, lanes, row, inner);
}

/* `columns` columns of b, at most BAND_LANES */
static void solve_together(struct factor *f, int columns, double *b)
{
    int lanes = lanes_for(columns);
    band_gather(f->nr, f->inner, columns, f->n, b, lanes, f->work);
    inner_solve(f, lanes, f->work);
    if (f->nf)
        solve_border(f, columns, lanes, b);
    band_scatter(f->nr, f->inner, columns, f->n, lanes, f->work, b);
}

/* As solve_together, by level 3 */
static void solve_wide(struct factor *f, int columns, double *b)
{
    int nr = f->nr, nf = f->nf;
    double *inner = f->work, *outer = f->outer_work;
    for (int c = 0; c < columns; c++) {
        for (int i = 0; i < nr; i++)
            inner[i + (ptrdiff_t)c * nr] = b[f->inner[i] + (ptrdiff_t)c * f->n];
        for (int p = 0; p < nf; p++)
            outer[p + c * nf] = b[f->outer[p] + (ptrdiff_t)c * f->n];
    }
    if (nr) {
        wide_solve(&f->wide, columns, nr, inner);
        cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, nf, columns, nr, -1, f->coupling, nr, inner, nr, 1, outer, nf);
    }
    outer_solve(f, columns, outer);
    if (nr)
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, nr, columns, nf, -1, f->x, nr, outer, nf, 1, inner, nr);
    for (int c = 0; c < columns; c++) {
        for (int i = 0; i < nr; i++)
            b[f->inner[i] + (ptrdiff_t)c * f->n] = inner[i + (ptrdiff_t)c * nr];
        for (int p = 0; p < nf; p++)
            b[f->outer[p] + (ptrdiff_t)c * f->n] = outer[p + c * nf];
    }
}

void factor_solve(struct factor *f, int columns, double *b)
{
    if (f->is_wide && !f->nf) {
        wide_solve(&f->wide, columns, f->n, b);
        return;
    }
    int together = f->is_wide ? WIDE_COLUMNS : BAND_LANES;
    for (int c = 0; c < columns; c += together)
        (f->is_wide ? solve_wide : solve_together)(f, columns - c < together ? columns - c : together, b + (ptrdiff_t)c * f->n);
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

static int negative_count(struct factor *f, const struct factor_source *source)
{
    factor_gather(f, source);
    int negative = f->is_wide ? wide_indefinite(&f->wide) : band_ldl(f);
    if (!f->nf || negative < 0)
        return negative;
    if (f->is_wide)
        solve_coupling(f);
    else {
        memcpy(f->x, f->coupling, (size_t)f->nr * (size_t)f->nf * sizeof(double));
        for (int p = 0; p < f->nf; p++)
            ldl_solve(f, f->x + (ptrdiff_t)p * f->nr);
    }
    form_schur(f);
    double *value = f->schur_work;
    if (LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'N', 'L', f->nf, f->schur, f->nf, value, value + f->nf, 3 * f->nf))
        return -1;
    for (int p = 0; p < f->nf; p++)
        negative += value[p] < 0;
    return negative;
}

int factor_negative_count(struct factor *f, const rotid_matrix *a)
{
    return negative_count(f, &(struct factor_source){.a = a});
}

int factor_negative_count_pencil(struct factor *f, const struct pencil *p, double shift)
{
    return negative_count(f, &(struct factor_source){.pencil = p, .shift = shift});
}
