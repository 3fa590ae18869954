#include "linalg/linalg.h"
#include "linalg/machine.h"

#define WIDE    20 /* half band from which zeros are looked for: a finite element couples few of the rows between */
#define STRETCH MATRIX_STRETCH
#define BLOCK   64 /* rows whose diagonals are laid out at once */
#define INLINE  static inline __attribute__((always_inline))

int matrix_new(struct pool *pool, int n, int kd, int nfar, const int *far, rotid_matrix *a)
{
    *a = (rotid_matrix){.n = n, .kd = kd, .nfar = nfar, .far = far};
    a->band = pool_get(pool, (size_t)n * (size_t)(kd + 1), sizeof(double));
    a->block = pool_get(pool, (size_t)nfar * (size_t)nfar, sizeof(double));
    return a->band && a->block ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static size_t band_length(const rotid_matrix *a)
{
    return (size_t)a->n * (size_t)(a->kd + 1);
}

static size_t block_length(const rotid_matrix *a)
{
    return (size_t)a->nfar * (size_t)a->nfar;
}

int matrix_like(struct pool *pool, const rotid_matrix *structure, rotid_matrix *a)
{
    return matrix_new(pool, structure->n, structure->kd, structure->nfar, structure->far, a);
}

void matrix_zero(rotid_matrix *a)
{
    memset(a->band, 0, band_length(a) * sizeof(double));
    if (a->nfar)
        memset(a->block, 0, block_length(a) * sizeof(double));
}

int matrix_far_position(const rotid_matrix *a, int dof)
{
    for (int f = 0; f < a->nfar; f++)
        if (a->far[f] == dof)
            return f;
    return -1;
}

void matrix_add(rotid_matrix *a, int i, int j, double value)
{
    int low = i < j ? i : j, high = i < j ? j : i;
    if (high - low <= a->kd) {
        a->band[(high - low) + (ptrdiff_t)low * (a->kd + 1)] += value;
        return;
    }
    int fi = matrix_far_position(a, i), fj = matrix_far_position(a, j);
    a->block[fi + (ptrdiff_t)fj * a->nfar] += value;
    a->block[fj + (ptrdiff_t)fi * a->nfar] += value;
}

void matrix_add_element(rotid_matrix *a, int nd, const int *dof, const double *e)
{
    int increasing = dof[nd - 1] - dof[0] <= a->kd;
    for (int i = 1; i < nd; i++)
        increasing &= dof[i] > dof[i - 1];
    if (increasing) { /* in the band, all of it */
        for (int j = 0; j < nd; j++) {
            double *column = a->band + (ptrdiff_t)dof[j] * (a->kd + 1) - dof[j];
            for (int i = j; i < nd; i++)
                column[dof[i]] += e[i + j * nd];
        }
        return;
    }
    for (int j = 0; j < nd; j++)
        for (int i = j; i < nd; i++)
            matrix_add(a, dof[i], dof[j], e[i + j * nd]);
}

void matrix_combine(double alpha, const rotid_matrix *a, double beta, const rotid_matrix *b, rotid_matrix *c)
{
    size_t length = band_length(a);
    for (size_t i = 0; i < length; i++)
        c->band[i] = alpha * a->band[i] + beta * b->band[i];
    length = block_length(a);
    for (size_t i = 0; i < length; i++)
        c->block[i] = alpha * a->block[i] + beta * b->block[i];
}

/* Row i of the band times x. Row by row, so that no sum waits for the store of another. */
static inline __attribute__((always_inline)) double row_product(const double *row, int ld, int below, int above, const double *x)
{
    double sum = row[0] * x[0];
    for (int d = 1; d <= below; d++)
        sum += row[d] * x[d];
    for (int d = 1; d <= above; d++)
        sum += row[d - (ptrdiff_t)d * ld] * x[-d];
    return sum;
}

/* Rows begin ... end - 1 of the band times x */
static void multiply_rows(const rotid_matrix *a, int begin, int end, const double *x, double *y)
{
    int n = a->n, kd = a->kd, ld = kd + 1;
    for (int i = begin; i < end; i++)
        y[i] = row_product(a->band + (ptrdiff_t)i * ld, ld, kd < n - 1 - i ? kd : n - 1 - i, kd < i ? kd : i, x + i);
}

/* Rows begin ... begin + count - 1 of `columns` columns, count <= BLOCK, of a band with kd = 3, rows 3 and more from both ends.
 * The diagonals are laid out first, so that the rows are elements of vectors: diagonal[d] holds A(i, i + d) from row begin - 3
 * on. */
INLINE void multiply_block(const rotid_matrix *a, int begin, int count, int columns, const double *x, double *y)
{
    double diagonal[4][BLOCK + 3];
    const double *band = a->band + 4 * (ptrdiff_t)(begin - 3);
    for (int i = 0; i < count + 3; i++)
        for (int d = 0; d < 4; d++)
            diagonal[d][i] = band[4 * i + d];
    for (int c = 0; c < columns; c++) {
        const double *restrict in = x + begin + (ptrdiff_t)c * a->n;
        double *restrict out = y + begin + (ptrdiff_t)c * a->n;
        int i = 0;
        for (; i + 4 <= count; i += 4) {
            *(four *)(out + i) = FOUR(diagonal[0] + 3 + i) * FOUR(in + i) + FOUR(diagonal[1] + 3 + i) * FOUR(in + i + 1) +
                                 FOUR(diagonal[2] + 3 + i) * FOUR(in + i + 2) + FOUR(diagonal[3] + 3 + i) * FOUR(in + i + 3) +
                                 FOUR(diagonal[1] + 2 + i) * FOUR(in + i - 1) + FOUR(diagonal[2] + 1 + i) * FOUR(in + i - 2) +
                                 FOUR(diagonal[3] + i) * FOUR(in + i - 3);
        }
        for (; i < count; i++)
            out[i] = row_product(a->band + 4 * (ptrdiff_t)(begin + i), 4, 3, 3, in + i);
    }
}

/* y += the part of column j in rows j + d ... of the lower triangle, and of the same row in the upper one, times x */
static inline __attribute__((always_inline)) void multiply_stretch(int length, const double *restrict a, double xj,
                                                                   const double *restrict x, double *restrict y,
                                                                   double *restrict sum)
{
    double part = 0;
    for (int i = 0; i < length; i++) {
        y[i] += a[i] * xj;
        part += a[i] * x[i];
    }
    *sum += part;
}

/* All columns in one pass over the band, which is longer than they are. */
static void multiply_wide(const rotid_matrix *a, int columns, const double *x, double *y)
{
    ptrdiff_t n = a->n;
    memset(y, 0, (size_t)n * (size_t)columns * sizeof *y);
    for (ptrdiff_t j = 0; j < n; j++) {
        const double *band = a->band + j * (a->kd + 1);
        int reach = a->kd < n - 1 - j ? a->kd : (int)(n - 1 - j), d = 1;
        for (int c = 0; c < columns; c++)
            y[j + c * n] += band[0] * x[j + c * n];
        for (; d + STRETCH <= reach + 1; d += STRETCH) {
            if (matrix_stretch_is_zero(band + d))
                continue;
            for (int c = 0; c < columns; c++)
                multiply_stretch(STRETCH, band + d, x[j + c * n], x + j + d + c * n, y + j + d + c * n, y + j + c * n);
        }
        for (int c = 0; c < columns; c++)
            multiply_stretch(reach + 1 - d, band + d, x[j + c * n], x + j + d + c * n, y + j + d + c * n, y + j + c * n);
    }
}

static void add_block_product(const rotid_matrix *a, const double *x, double *y)
{
    for (int g = 0; g < a->nfar; g++)
        for (int f = 0; f < a->nfar; f++)
            y[a->far[f]] += a->block[f + (ptrdiff_t)g * a->nfar] * x[a->far[g]];
}

EACH_MACHINE static void multiply_chain(const rotid_matrix *a, int columns, const double *x, double *y)
{
    for (int begin = 3; begin < a->n - 3; begin += BLOCK)
        multiply_block(a, begin, a->n - 3 - begin < BLOCK ? a->n - 3 - begin : BLOCK, columns, x, y);
}

void matrix_multiply(const rotid_matrix *a, int columns, const double *x, double *y)
{
    int n = a->n;
    int chain = a->kd == 3 && n > 6; /* of beam elements */
    if (a->kd >= WIDE)
        multiply_wide(a, columns, x, y);
    if (chain)
        multiply_chain(a, columns, x, y);
    for (int c = 0; c < columns; c++, x += n, y += n) {
        if (chain) {
            multiply_rows(a, 0, 3, x, y);
            multiply_rows(a, n - 3, n, x, y);
        } else if (a->kd < WIDE) {
            multiply_rows(a, 0, n, x, y);
        }
        add_block_product(a, x, y);
    }
}

double matrix_product(const rotid_matrix *a, const double *x, const double *y, double *work)
{
    matrix_multiply(a, 1, y, work);
    double sum = 0;
    for (int i = 0; i < a->n; i++)
        sum += x[i] * work[i];
    return sum;
}

/* 0 where all of a [length] are finite, else NaN: 0 x is for every x that is not. In sums that need not wait for each other. */
static double not_finite(size_t length, const double *a)
{
    double sum[STRETCH] = {0}, all = 0;
    size_t i = 0;
    for (; i + STRETCH <= length; i += STRETCH)
        for (int s = 0; s < STRETCH; s++)
            sum[s] += 0 * a[i + (size_t)s];
    for (; i < length; i++)
        all += 0 * a[i];
    for (int s = 0; s < STRETCH; s++)
        all += sum[s];
    return all;
}

int matrix_is_finite(const rotid_matrix *a)
{
    size_t ld = (size_t)a->kd + 1;
    double sum = not_finite((size_t)(a->n - a->kd) * ld, a->band);
    for (int j = a->n - a->kd; j < a->n; j++) /* where the band ends below the matrix, its storage holds anything */
        sum += not_finite((size_t)(a->n - j), a->band + (size_t)j * ld);
    return isfinite(sum + not_finite(block_length(a), a->block));
}

static int all_zero(size_t length, const double *a)
{
    size_t i = 0;
    for (; i + STRETCH <= length; i += STRETCH)
        if (!matrix_stretch_is_zero(a + i))
            return 0;
    for (; i < length; i++)
        if (a[i] != 0)
            return 0;
    return 1;
}

int matrix_is_zero(const rotid_matrix *a)
{
    return all_zero(band_length(a), a->band) && all_zero(block_length(a), a->block);
}

void matrix_occupied(const rotid_matrix *a, int *from, int *end)
{
    size_t ld = (size_t)a->kd + 1;
    if (!all_zero(block_length(a), a->block)) {
        *from = 0;
        *end = a->n;
        return;
    }
    int known = *end;
    while (*from < *end && all_zero(ld, a->band + (size_t)*from * ld))
        ++*from;
    while (*end > *from && all_zero(ld, a->band + (size_t)(*end - 1) * ld))
        --*end;
    if (*end > *from) /* the rows that the last of the columns reaches */
        *end = *end + a->kd < known ? *end + a->kd : known;
}

void matrix_rows(const rotid_matrix *a, int from, int length, rotid_matrix *part)
{
    *part = *a;
    if (length == a->n)
        return;
    *part = (rotid_matrix){.n = length, .kd = a->kd, .band = a->band + (ptrdiff_t)from * (a->kd + 1)};
}

void matrix_to_dense(const rotid_matrix *a, int ld, double *full)
{
    for (int j = 0; j < a->n; j++)
        memset(full + (ptrdiff_t)j * ld, 0, (size_t)a->n * sizeof *full);
    for (int j = 0; j < a->n; j++)
        for (int d = 0; d <= a->kd && j + d < a->n; d++)
            full[j + d + (ptrdiff_t)j * ld] = full[j + (ptrdiff_t)(j + d) * ld] = a->band[d + (ptrdiff_t)j * (a->kd + 1)];
    for (int g = 0; g < a->nfar; g++)
        for (int f = 0; f < a->nfar; f++)
            full[a->far[f] + (ptrdiff_t)a->far[g] * ld] += a->block[f + (ptrdiff_t)g * a->nfar];
}
