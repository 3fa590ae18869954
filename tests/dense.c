#include "dense.h"

#include <cblas.h>
#include <lapacke.h>

#include "linalg/linalg.h"

double *numbers(struct pool *pool, ptrdiff_t count)
{
    double *array = POOL_ARRAY(pool, double, count);
    assert_non_null(array);
    return array;
}

double *random_numbers(struct pool *pool, struct random_stream *stream, ptrdiff_t count)
{
    double *array = numbers(pool, count);
    for (ptrdiff_t i = 0; i < count; i++)
        array[i] = random_normal(stream);
    return array;
}

void random_positive(struct pool *pool, struct random_stream *stream, int n, int kd, int nfar, const int *far, double floor,
                     rotid_matrix *a)
{
    double *g = numbers(pool, n);
    assert_status(matrix_new(pool, n, kd, nfar, far, a), ROTID_OK);
    for (int first = 0; first < n; first++) {
        int last = first + kd < n ? first + kd : n - 1;
        for (int i = first; i <= last; i++)
            g[i] = random_normal(stream);
        for (int j = first; j <= last; j++)
            for (int i = j; i <= last; i++)
                a->band[(i - j) + (ptrdiff_t)j * (kd + 1)] += g[i] * g[j];
        a->band[(ptrdiff_t)first * (kd + 1)] += floor;
    }
    for (int r = 0; r < nfar; r++) {
        for (int p = 0; p < nfar; p++)
            g[p] = random_normal(stream);
        for (int q = 0; q < nfar; q++)
            for (int p = 0; p < nfar; p++)
                a->block[p + q * nfar] += g[p] * g[q];
    }
}

double *dense_of(struct pool *pool, const rotid_matrix *a)
{
    int n = a->n, kd = a->kd;
    double *full = numbers(pool, (ptrdiff_t)n * n);
    for (int j = 0; j < n; j++)
        for (int i = j; i < n && i <= j + kd; i++)
            full[i + (ptrdiff_t)j * n] = full[j + (ptrdiff_t)i * n] = a->band[(i - j) + (ptrdiff_t)j * (kd + 1)];
    for (int q = 0; q < a->nfar; q++)
        for (int p = 0; p < a->nfar; p++)
            full[a->far[p] + (ptrdiff_t)a->far[q] * n] += a->block[p + q * a->nfar];
    return full;
}

double *dense_part(struct pool *pool, int n, const double *a, int nrow, const int *row, int ncolumn, const int *column)
{
    double *part = numbers(pool, (ptrdiff_t)nrow * ncolumn);
    for (int j = 0; j < ncolumn; j++)
        for (int i = 0; i < nrow; i++)
            part[i + (ptrdiff_t)j * nrow] = a[row[i] + (ptrdiff_t)column[j] * n];
    return part;
}

double *dense_product(struct pool *pool, int rows, int inner, int columns, const double *a, const double *b)
{
    double *c = numbers(pool, (ptrdiff_t)rows * columns);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rows, columns, inner, 1, a, rows, b, inner, 0, c, rows);
    return c;
}

double *dense_transposed_product(struct pool *pool, int rows, int inner, int columns, const double *a, const double *b)
{
    double *c = numbers(pool, (ptrdiff_t)rows * columns);
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, rows, columns, inner, 1, a, inner, b, inner, 0, c, rows);
    return c;
}

double *dense_solution(struct pool *pool, int n, int columns, const double *a, const double *b)
{
    double *copy = numbers(pool, (ptrdiff_t)n * n), *x = numbers(pool, (ptrdiff_t)n * columns);
    int *pivot = POOL_ARRAY(pool, int, n);
    assert_non_null(pivot);
    memcpy(copy, a, (size_t)n * (size_t)n * sizeof *a);
    memcpy(x, b, (size_t)n * (size_t)columns * sizeof *b);
    if (n)
        assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, n, columns, copy, n, pivot, x, n), 0);
    return x;
}

void dense_pairs(struct pool *pool, int n, const double *k, const double *m, double shift, double *lambda, double *phi)
{
    ptrdiff_t square = (ptrdiff_t)n * n;
    double *a = numbers(pool, square), *b = numbers(pool, square), *mu = numbers(pool, n);
    for (ptrdiff_t i = 0; i < square; i++) {
        a[i] = m[i];
        b[i] = k[i] - shift * m[i];
    }
    assert_int_equal(LAPACKE_dsygv(LAPACK_COL_MAJOR, 1, 'V', 'L', n, a, n, b, n, mu), 0);
    for (int j = 0; j < n; j++) {
        const double *source = a + (ptrdiff_t)(n - 1 - j) * n;
        lambda[j] = 1 / mu[n - 1 - j] + shift;
        for (int i = 0; i < n; i++)
            phi[i + (ptrdiff_t)j * n] = source[i] / sqrt(mu[n - 1 - j]);
    }
}

double dense_norm(int rows, int columns, const double *a)
{
    double largest = 0;
    for (int j = 0; j < columns; j++)
        largest = fmax(largest, cblas_dasum(rows, a + (ptrdiff_t)j * rows, 1));
    return largest;
}

/* slave [n - nc] */
static int *slaves_of(struct pool *pool, int n, int nc, const int *master)
{
    int *slave = POOL_ARRAY(pool, int, n);
    assert_non_null(slave);
    for (int i = 0, count = 0; i < n; i++) {
        int is_master = 0;
        for (int c = 0; c < nc; c++)
            is_master |= master[c] == i;
        if (!is_master)
            slave[count++] = i;
    }
    return slave;
}

double *dense_guyan(struct pool *pool, int n, const double *k, int nc, const int *master)
{
    const int *slave = slaves_of(pool, n, nc, master);
    int ni = n - nc;
    const double *k_ii = dense_part(pool, n, k, ni, slave, ni, slave), *k_ic = dense_part(pool, n, k, ni, slave, nc, master);
    double *phi = dense_solution(pool, ni, nc, k_ii, k_ic), *t = numbers(pool, (ptrdiff_t)n * nc);
    for (int c = 0; c < nc; c++) {
        for (int i = 0; i < ni; i++)
            t[slave[i] + (ptrdiff_t)c * n] = -phi[i + (ptrdiff_t)c * ni];
        t[master[c] + (ptrdiff_t)c * n] = 1;
    }
    return t;
}

double *dense_congruence(struct pool *pool, int n, int nc, const double *a, const double *t)
{
    return dense_transposed_product(pool, nc, n, nc, t, dense_product(pool, n, n, nc, a, t));
}

double *dense_irs(struct pool *pool, int n, const double *k, const double *m, int nc, const int *master)
{
    const int *slave = slaves_of(pool, n, nc, master);
    int ni = n - nc;
    double *t = dense_guyan(pool, n, k, nc, master);
    double *w = dense_solution(pool, nc, nc, dense_congruence(pool, n, nc, m, t), dense_congruence(pool, n, nc, k, t));
    double *image = dense_product(pool, n, nc, nc, dense_product(pool, n, n, nc, m, t), w);
    double *right = numbers(pool, (ptrdiff_t)ni * nc);
    for (int c = 0; c < nc; c++)
        for (int i = 0; i < ni; i++)
            right[i + (ptrdiff_t)c * ni] = image[slave[i] + (ptrdiff_t)c * n];
    double *correction = dense_solution(pool, ni, nc, dense_part(pool, n, k, ni, slave, ni, slave), right);
    for (int c = 0; c < nc; c++)
        for (int i = 0; i < ni; i++)
            t[slave[i] + (ptrdiff_t)c * n] += correction[i + (ptrdiff_t)c * ni];
    return t;
}
