#include "linalg/linalg.h"

#include <limits.h>
#include <string.h>

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
        f->schur[(-1 - pi) + (-1 - pj) * f->nf] = f->schur[(-1 - pj) + (-1 - pi) * f->nf] = value;
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
        int j = f->kept[k], pj = f->position[j], reach = a->kd < a->n - 1 - j ? a->kd : a->n - 1 - j;
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
    int reach = a->kd < a->n - 1 - j ? a->kd : a->n - 1 - j, count = 0;
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
    int d = a->kd < a->n - 1 - j ? a->kd : a->n - 1 - j;
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
                f->schur[(-1 - fp) + (-1 - fq) * f->nf] += part * a->block[p + q * a->nfar];
        }
}

void factor_gather(struct factor *f, const struct factor_source *source)
{
    memset(f->coupling, 0, (size_t)f->nr * (size_t)f->nf * sizeof(double));
    memset(f->schur, 0, (size_t)f->nf * (size_t)f->nf * sizeof(double));
    if (f->is_wide)
        gather_wide(f, source);
    else
        gather_narrow(f, source->a);
    add_block(f, 1, source->pencil ? source->pencil->stiffness : source->a);
    if (source->pencil)
        add_block(f, -source->shift, source->pencil->mass);
}
