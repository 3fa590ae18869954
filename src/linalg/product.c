#include "linalg/product.h"

#include <cblas.h>

void product_transposed(int m, int n, int k, const double *a, const double *b, double *c)
{
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, m, n, k, 1, a, k, b, k, 0, c, m);
}

void product_subtract(int m, int n, int k, const double *a, const double *b, double *c)
{
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, m, n, k, -1, a, m, b, k, 1, c, m);
}
