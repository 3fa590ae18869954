#include "linalg/linalg.h"

#include <cblas.h>

#include "linalg/machine.h"

EACH_MACHINE static double dot(int n, const double *a, const double *b)
{
    four sum[2] = {0};
    double rest = 0;
    int i = 0;
    for (; i + 8 <= n; i += 8)
        for (int s = 0; s < 2; s++)
            sum[s] += FOUR(a + i + 4 * (ptrdiff_t)s) * FOUR(b + i + 4 * (ptrdiff_t)s);
    for (; i < n; i++)
        rest += a[i] * b[i];
    sum[0] += sum[1];
    return (sum[0][0] + sum[0][2]) + (sum[0][1] + sum[0][3]) + rest;
}

double product_dot(int n, const double *a, const double *b)
{
    return dot(n, a, b);
}

double basis_remove(int n, int count, const double *basis, double *v)
{
    double sum = 0;
    for (int b = 0; b < count; b++) {
        const double *q = basis + (ptrdiff_t)b * n;
        double along = product_dot(n, q, v);
        for (int i = 0; i < n; i++)
            v[i] -= along * q[i];
        sum += along * along;
    }
    return sum;
}

int basis_extend(int n, int count, double least, double *basis)
{
    double *column = basis + (ptrdiff_t)count * n, raw = sqrt(product_dot(n, column, column));
    for (int pass = 0; pass < 2; pass++)
        (void)basis_remove(n, count, basis, column);
    double left = sqrt(product_dot(n, column, column));
    if (!(left > least * raw))
        return count;
    for (int i = 0; i < n; i++)
        column[i] /= left;
    return count + 1;
}

int basis_add(int n, int ncolumn, const double *column, double least, int count, double *basis)
{
    for (int p = 0; p < ncolumn; p++) {
        memcpy(basis + (ptrdiff_t)count * n, column + (ptrdiff_t)p * n, (size_t)n * sizeof *basis);
        count = basis_extend(n, count, least, basis);
    }
    return count;
}

void product_transposed(int m, int n, int k, const double *a, const double *b, double *c)
{
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, m, n, k, 1, a, k, b, k, 0, c, m);
}

void product_subtract(int m, int n, int k, const double *a, const double *b, double *c)
{
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, m, n, k, -1, a, m, b, k, 1, c, m);
}

void product_add_transposed(int m, int n, int k, int ld, const double *a, const double *b, double *c)
{
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, m, n, k, 1, a, ld, b, ld, 1, c, m);
}

void product_gram(int n, int k, const double *a, double *c)
{
    cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, n, k, 1, a, k, 0, c, n);
    for (int j = 0; j < n; j++)
        for (int i = j + 1; i < n; i++)
            c[j + (ptrdiff_t)i * n] = c[i + (ptrdiff_t)j * n];
}

void product_combine(int m, int k, double part, const double *a, const double *x, double *y)
{
    for (int i = 0; i < m; i++)
        y[i] = 0;
    if (m && k)
        cblas_dgemv(CblasColMajor, CblasNoTrans, m, k, part, a, m, x, 1, 0, y, 1);
}
