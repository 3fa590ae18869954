/* Symmetric indefinite factorisation with diagonal pivoting (Bunch and Kaufman, Math. Comp. 31, 1977).
 *
 * P A P' = L D L' with unit lower triangular L and blocks of size 1 or 2 on the diagonal of D. By Sylvester's law of inertia A
 * has as many negative eigenvalues as D; a block of size 2 is only chosen where its determinant is negative, so it has exactly
 * one. Pivoting matters here: a dynamic stiffness is indefinite, and a leading submatrix is singular whenever a part of the
 * structure resonates. */
#include <float.h>
#include <math.h>

#include "oracle.h"

/* Rows and columns p < q of the symmetric matrix in the lower triangle of a; the finished columns of L are exchanged as well, so
 * that one permutation describes all of L. */
static void exchange(int n, double *a, int p, int q)
{
    double keep;

    for (int j = 0; j < p; j++) {
        keep = a[p * n + j];
        a[p * n + j] = a[q * n + j];
        a[q * n + j] = keep;
    }
    for (int j = p + 1; j < q; j++) {
        keep = a[j * n + p];
        a[j * n + p] = a[q * n + j];
        a[q * n + j] = keep;
    }
    for (int i = q + 1; i < n; i++) {
        keep = a[i * n + p];
        a[i * n + p] = a[i * n + q];
        a[i * n + q] = keep;
    }
    keep = a[p * n + p];
    a[p * n + p] = a[q * n + q];
    a[q * n + q] = keep;
}

/* Size of the next block, 1 or 2; *with is the row to be exchanged with row k + size - 1. */
static int choose(int n, const double *a, int k, int *with)
{
    const double alpha = (1.0 + sqrt(17.0)) / 8.0; /* balances the growth of one block of size 2 and of two of size 1 */
    double diagonal = fabs(a[k * n + k]), column = 0.0, row = 0.0;
    int largest = k;

    for (int i = k + 1; i < n; i++) {
        if (fabs(a[i * n + k]) > column) {
            column = fabs(a[i * n + k]);
            largest = i;
        }
    }
    *with = k;
    if (diagonal >= alpha * column)
        return 1;
    for (int j = k; j < largest; j++)
        row = fmax(row, fabs(a[largest * n + j]));
    for (int i = largest + 1; i < n; i++)
        row = fmax(row, fabs(a[i * n + largest]));
    if (diagonal * row >= alpha * column * column)
        return 1;
    *with = largest;
    return fabs(a[largest * n + largest]) >= alpha * row ? 1 : 2;
}

void oracle_factor(int n, double *a, int *pivot, int *negative, double *log_determinant)
{
    int size;

    *negative = 0;
    *log_determinant = 0.0;
    for (int k = 0; k < n; k += size) {
        int with;
        size = choose(n, a, k, &with);
        if (with != k + size - 1)
            exchange(n, a, k + size - 1, with);
        pivot[k] = size == 1 ? with : -1; /* -1 marks the first row of a block of size 2 */
        if (size == 1) {
            double d = a[k * n + k];
            if (d == 0.0)
                d = a[k * n + k] = DBL_EPSILON;
            *negative += d < 0.0;
            *log_determinant += log(fabs(d));
            for (int i = k + 1; i < n; i++) {
                double factor = a[i * n + k] / d;
                for (int j = k + 1; factor != 0.0 && j <= i; j++)
                    a[i * n + j] -= factor * a[j * n + k];
            }
            for (int i = k + 1; i < n; i++)
                a[i * n + k] /= d;
            continue;
        }
        pivot[k + 1] = with;
        double d11 = a[k * n + k], d21 = a[(k + 1) * n + k], d22 = a[(k + 1) * n + k + 1];
        double ratio11 = d11 / d21, ratio22 = d22 / d21, scale = d21 * (ratio11 * ratio22 - 1.0); /* det / d21, no overflow */
        *negative += 1;
        *log_determinant += log(fabs(d21)) + log(fabs(scale));
        /* From the last row up, since a row needs the untouched columns k and k + 1 of the rows above it. */
        for (int i = n - 1; i > k + 1; i--) {
            double first = (ratio22 * a[i * n + k] - a[i * n + k + 1]) / scale;
            double second = (ratio11 * a[i * n + k + 1] - a[i * n + k]) / scale;
            for (int j = k + 2; j <= i; j++)
                a[i * n + j] -= first * a[j * n + k] + second * a[j * n + k + 1];
            a[i * n + k] = first;
            a[i * n + k + 1] = second;
        }
    }
}

void oracle_solve(int n, const double *a, const int *pivot, double *x, double *work)
{
    int size;

    /* work := P x, the exchanges in the order in which they were made */
    for (int i = 0; i < n; i++)
        work[i] = x[i];
    for (int k = 0; k < n; k += size) {
        size = pivot[k] < 0 ? 2 : 1;
        int row = k + size - 1;
        double keep = work[row];
        work[row] = work[pivot[row]];
        work[pivot[row]] = keep;
    }
    for (int k = 0; k < n; k += size) {
        size = pivot[k] < 0 ? 2 : 1;
        for (int i = k + size; i < n; i++) {
            work[i] -= a[i * n + k] * work[k];
            if (size == 2)
                work[i] -= a[i * n + k + 1] * work[k + 1];
        }
    }
    for (int k = 0; k < n; k += size) {
        size = pivot[k] < 0 ? 2 : 1;
        if (size == 1) {
            work[k] /= a[k * n + k];
        } else {
            double d21 = a[(k + 1) * n + k], ratio11 = a[k * n + k] / d21, ratio22 = a[(k + 1) * n + k + 1] / d21;
            double scale = d21 * (ratio11 * ratio22 - 1.0), first = work[k], second = work[k + 1];
            work[k] = (ratio22 * first - second) / scale;
            work[k + 1] = (ratio11 * second - first) / scale;
        }
    }
    for (int k = n - 1; k >= 0; k -= size) {
        size = k > 0 && pivot[k - 1] < 0 ? 2 : 1;
        for (int row = k - size + 1; row <= k; row++) {
            for (int i = k + 1; i < n; i++)
                work[row] -= a[i * n + row] * work[i];
        }
    }
    for (int k = n - 1; k >= 0; k -= size) {
        size = k > 0 && pivot[k - 1] < 0 ? 2 : 1;
        double keep = work[k];
        work[k] = work[pivot[k]];
        work[pivot[k]] = keep;
    }
    for (int i = 0; i < n; i++)
        x[i] = work[i];
}
