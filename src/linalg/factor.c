#include "linalg/linalg.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <limits.h>

#define WIDE_COLUMNS 8     /* right-hand sides that are solved together, of wide bands */
#define WIDE_PANEL   48    /* columns: of 32, 48, 64 and 96 the fastest one for half bands of 150 to 300 */
#define CANCELLED    1e-15 /* of the diagonal element: below this, a pivot is rounding */

/* A(i, j) = wide_column(w, j)[i], i >= j, i <= last[j] */
static inline double *wide_column(const struct wide *w, int j)
{
    int p = j / WIDE_PANEL, top = p * WIDE_PANEL;
    return w->value + w->place[p] - top + (ptrdiff_t)(j - top) * (w->end[p] - top);
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* For at most n rows and a half band of at most kd. ROTID_OK or ROTID_ERROR_MEMORY. */
static int wide_new(struct pool *pool, int n, int kd, struct wide *w)
{
    int panels = n / WIDE_PANEL + 1;
    *w = (struct wide){.kd = kd};
    w->end = POOL_ARRAY(pool, int, panels);
    w->place = POOL_ARRAY(pool, ptrdiff_t, panels);
    w->value = POOL_ARRAY(pool, double, (size_t)n *(size_t)(kd + WIDE_PANEL));
    w->sign = POOL_ARRAY(pool, double, n);
    w->work = POOL_ARRAY(pool, double, WIDE_PANEL *(size_t)(kd + WIDE_PANEL));
    return w->end && w->place && w->value && w->sign && w->work ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int width_of(const struct wide *w, int p)
{
    return least(WIDE_PANEL, w->n - p * WIDE_PANEL);
}

/* Makes A [n, n] zero. last [n]: the last row below or on the diagonal where a column may get an entry. */
static void wide_clear(struct wide *w, int n, const int *last)
{
    ptrdiff_t place = 0;
    w->n = n;
    w->panels = (n + WIDE_PANEL - 1) / WIDE_PANEL;
    for (int p = 0, end = 0; p < w->panels; p++) {
        int top = p * WIDE_PANEL, width = width_of(w, p);
        end = end > top + width ? end : top + width; /* the elimination fills what lies under the panels before */
        for (int j = top; j < top + width; j++)
            end = end > last[j] + 1 ? end : last[j] + 1;
        w->end[p] = end;
        w->place[p] = place;
        place += (ptrdiff_t)(end - top) * width;
    }
    memset(w->value, 0, (size_t)place * sizeof *w->value);
}

/* LDL' of the leading `width` rows of a panel, then columns scaled to L S L'. Returns the number of negative pivots. */
static int eliminate(int width, int ld, const double *scale, double *a, double *sign)
{
    int negative = 0;
    for (int j = 0; j < width; j++) {
        double *l = a + j + (ptrdiff_t)j * ld, tiny = CANCELLED * (scale[j] > 0 ? scale[j] : 1);
        if (fabs(l[0]) < tiny)
            l[0] = -tiny;
        sign[j] = l[0] < 0 ? -1 : 1;
        negative += l[0] < 0;
        double root = sqrt(fabs(l[0])), inverse = sign[j] / root;
        l[0] = root;
        for (int i = 1; i < width - j; i++)
            l[i] *= inverse;
        for (int c = 1; c < width - j; c++) {
            double *target = l + c + (ptrdiff_t)c * ld, factor = sign[j] * l[c];
            for (int i = c; i < width - j; i++)
                target[i - c] -= factor * l[i];
        }
    }
    return negative;
}

/* Factors the diagonal block of panel p. Nearly all blocks of K - sigma M are positive definite even where the matrix is not.
 * Returns the number of negative signs, or -1 where there are some and must not be. */
static int factor_diagonal(struct wide *w, int p, int indefinite)
{
    int top = p * WIDE_PANEL, ld = w->end[p] - top, width = width_of(w, p), negative = 0;
    double *a = w->value + w->place[p], *scale = w->sign + top;
    for (int j = 0; j < width && indefinite; j++)
        memcpy(w->work + (ptrdiff_t)j * WIDE_PANEL, a + (ptrdiff_t)j * ld, (size_t)width * sizeof *a);
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', width, a, ld)) {
        if (!indefinite)
            return -1;
        double given[WIDE_PANEL];
        memcpy(given, scale, (size_t)width * sizeof *given);
        for (int j = 0; j < width; j++)
            memcpy(a + (ptrdiff_t)j * ld, w->work + (ptrdiff_t)j * WIDE_PANEL, (size_t)width * sizeof *a);
        return eliminate(width, ld, given, a, w->sign + top);
    }
    for (int j = 0; j < width; j++) {
        double pivot = a[j + (ptrdiff_t)j * ld];
        if (!isfinite(pivot) || !(pivot > 0))
            return -1;
        w->sign[top + j] = 1;
    }
    return negative;
}

/* A = L L', returning -1 where A is not positive definite; or, where it may be indefinite, A = L S L' without pivoting, returning
 * the number of negative signs, which is that of the negative eigenvalues of A. A pivot that cancels is then replaced by a tiny
 * negative one of its scale, which moves A by rounding. */
static int wide_factor(struct wide *w, int indefinite)
{
    int negative = 0;
    for (int j = 0; j < w->n && indefinite; j++) /* the size that a pivot has before it cancels, until its sign is known */
        w->sign[j] = fabs(wide_column(w, j)[j]);
    for (int p = 0; p < w->panels; p++) {
        int top = p * WIDE_PANEL, ld = w->end[p] - top, width = width_of(w, p), below = ld - width,
            found = factor_diagonal(w, p, indefinite);
        if (found < 0)
            return -1;
        negative += found;
        if (!below)
            continue;
        double *a = w->value + w->place[p], *under = a + width;
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, below, width, 1, a, ld, under, ld);
        const double *signed_under = under; /* L S */
        int signed_ld = ld;
        if (found) {
            for (int j = 0; j < width; j++) {
                memcpy(w->work + (ptrdiff_t)j * below, under + (ptrdiff_t)j * ld, (size_t)below * sizeof *under);
                cblas_dscal(below, w->sign[top + j], under + (ptrdiff_t)j * ld, 1);
            }
            signed_under = w->work;
            signed_ld = below;
        }
        for (int q = p + 1, done = 0; done < below; q++, done += WIDE_PANEL) {
            int rows = below - done, columns = least(WIDE_PANEL, rows), to = w->end[q] - q * WIDE_PANEL;
            cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows, columns, width, -1, under + done, ld, signed_under + done,
                        signed_ld, 1, w->value + w->place[q], to);
        }
    }
    return negative;
}

/* B [n * columns], leading dimension ld, is overwritten by A^-1 B. */
static void wide_solve(const struct wide *w, int columns, int ld, double *b)
{
    for (int p = 0; p < w->panels; p++) {
        int top = p * WIDE_PANEL, rows = w->end[p] - top, width = width_of(w, p);
        const double *a = w->value + w->place[p];
        double *x = b + top;
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, width, columns, 1, a, rows, x, ld);
        if (rows > width)
            cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rows - width, columns, width, -1, a + width, rows, x, ld, 1,
                        x + width, ld);
    }
    for (int p = w->panels - 1; p >= 0; p--) {
        int top = p * WIDE_PANEL, rows = w->end[p] - top, width = width_of(w, p);
        const double *a = w->value + w->place[p];
        double *x = b + top;
        for (int j = 0; j < width; j++)
            for (int c = 0; c < columns && w->sign[top + j] < 0; c++)
                x[j + (ptrdiff_t)c * ld] = -x[j + (ptrdiff_t)c * ld];
        if (rows > width)
            cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, width, columns, rows - width, -1, a + width, rows, x + width, ld,
                        1, x, ld);
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit, width, columns, 1, a, rows, x, ld);
    }
}

/* ---- from a matrix to the storage of its factor: which rows and columns are kept, which of them are far */

/* A, or of a pencil K - shift M (wide bands alone) */
struct factor_source {
    const rotid_matrix *a; /* of a pencil K */
    const struct pencil *pencil;
    double shift;
};

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

/* pi, pj: positions of row and column */
static void put(struct factor *f, int pi, int pj, double value)
{
    if (pi == INT_MIN)
        return;
    if (pi >= 0 && pj >= 0)
        put_inner(f, pi, pj, value);
    else if (pi >= 0)
        f->coupling[pi + (ptrdiff_t)(-1 - pj) * f->nr] = value;
    else if (pj >= 0)
        f->coupling[pj + (ptrdiff_t)(-1 - pi) * f->nr] = value;
    else
        f->schur[(-1 - pi) + (-1 - pj) * (ptrdiff_t)f->nf] = f->schur[(-1 - pj) + (-1 - pi) * (ptrdiff_t)f->nf] = value;
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

static void gather_narrow(struct factor *f, const rotid_matrix *a)
{
    memset(f->band, 0, (size_t)f->lda * (size_t)f->nr * sizeof(double));
    for (int k = 0; k < f->n; k++) {
        int j = f->kept[k], pj = f->position[j], reach = matrix_reach(a, j);
        const double *column = a->band + (ptrdiff_t)j * (a->kd + 1);
        if (pj >= 0 && f->position[j + reach] == pj + reach) { /* nothing left out and nothing far from here to there */
            put_inner_column(f, pj, reach, column);
            continue;
        }
        for (int d = 0; d <= reach; d++)
            put(f, f->position[j + d], pj, column[d]);
    }
}

/* The entries of column j of the lower triangle that are not zero. Returns how many. */
static int column_of_matrix(const struct factor *f, const rotid_matrix *a, int j)
{
    const double *column = a->band + (ptrdiff_t)j * (a->kd + 1);
    int reach = matrix_reach(a, j), count = 0;
    for (int d = 0; d <= reach; d++) {
        if (d + MATRIX_STRETCH <= reach && matrix_stretch_is_zero(column + d))
            d += MATRIX_STRETCH - 1;
        else if (column[d] != 0) {
            f->row[count] = j + d;
            f->value[count++] = column[d];
        }
    }
    return count;
}

/* The last inner row of column j of the source, -1 where there is none; rows of the entries increase, and so do positions. */
static int last_row(const struct factor *f, const struct factor_source *source, int j)
{
    const rotid_matrix *a = source->a;
    const struct pencil *p = source->pencil;
    if (p) {
        for (int e = p->start[j + 1] - 1; e >= p->start[j]; e--)
            if (f->position[p->row[e]] >= 0)
                return f->position[p->row[e]];
        return -1;
    }
    const double *column = a->band + (ptrdiff_t)j * (a->kd + 1);
    int d = matrix_reach(a, j);
    for (; d >= 0; d--) {
        while (d + 1 >= MATRIX_STRETCH && matrix_stretch_is_zero(column + d + 1 - MATRIX_STRETCH))
            d -= MATRIX_STRETCH;
        if (d >= 0 && column[d] != 0 && f->position[j + d] >= 0)
            return f->position[j + d];
    }
    return -1;
}

/* The rows and entries of column j, of a matrix to f->row and f->value. Returns how many. */
static int column_of(const struct factor *f, const struct factor_source *source, int j, const int **row)
{
    const struct pencil *p = source->pencil;
    if (!p) {
        *row = f->row;
        return column_of_matrix(f, source->a, j);
    }
    int begin = p->start[j], count = p->start[j + 1] - begin;
    *row = p->row + begin;
    for (int e = 0; e < count; e++)
        f->value[e] = p->k[begin + e] - source->shift * p->m[begin + e];
    return count;
}

static void gather_wide(struct factor *f, const struct factor_source *source)
{
    for (int k = 0; k < f->nr; k++) {
        int last = last_row(f, source, f->kept[f->inner[k]]);
        f->reach[k] = last > k ? last : k;
    }
    wide_clear(&f->wide, f->nr, f->reach);
    for (int k = 0; k < f->n; k++) {
        const int *row;
        int count = column_of(f, source, f->kept[k], &row), pj = f->position[f->kept[k]];
        double *column = pj >= 0 ? wide_column(&f->wide, pj) : NULL;
        for (int e = 0; e < count; e++) {
            int pi = f->position[row[e]];
            if (column && pi >= 0)
                column[pi] = f->value[e];
            else
                put(f, pi, pj, f->value[e]);
        }
    }
}

static void add_block(struct factor *f, double part, const rotid_matrix *a)
{
    for (int q = 0; q < a->nfar; q++)
        for (int p = 0; p < a->nfar; p++) {
            int fp = f->position[a->far[p]], fq = f->position[a->far[q]];
            if (fp != INT_MIN && fq != INT_MIN)
                f->schur[(-1 - fp) + (-1 - fq) * (ptrdiff_t)f->nf] += part * a->block[p + q * (ptrdiff_t)a->nfar];
        }
}

/* band or wide, coupling and schur := the parts of A */
static void factor_gather(struct factor *f, const struct factor_source *source)
{
    memset(f->coupling, 0, (size_t)f->nr * (size_t)f->nf * sizeof(double));
    memset(f->schur, 0, (size_t)f->nf * (size_t)f->nf * sizeof(double));
    if (f->is_wide)
        gather_wide(f, source);
    else
        gather_narrow(f, source->a);
    add_block(f, 1, source->a);
    if (source->pencil)
        add_block(f, -source->shift, source->pencil->mass);
}

/* ---- factor, solve, count */

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
    if (pool->out_of_memory)
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
            f->schur[p + q * (ptrdiff_t)f->nf] -= sum;
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
    return wide_factor(&f->wide, f->kind != FACTOR_CHOLESKY) < 0;
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
    return compute(f, &(struct factor_source){.a = p->stiffness, .pencil = p, .shift = shift});
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
            outer[p + c * (ptrdiff_t)f->nf] = sum;
        }
    outer_solve(f, columns, outer);
    for (int p = 0; p < f->nf; p++)
        for (int c = 0; c < lanes; c++) {
            row[p * lanes + c] = c < columns ? outer[p + c * (ptrdiff_t)f->nf] : 0;
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
    int negative = f->is_wide ? wide_factor(&f->wide, 1) : band_ldl(f);
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
    return negative_count(f, &(struct factor_source){.a = p->stiffness, .pencil = p, .shift = shift});
}
