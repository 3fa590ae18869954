#include "linalg/least_squares.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

/* dgels: min(m, n) + max(1, m, n) * block; the workspace is stated, not asked for, so that callers can size theirs ahead */
#define BLOCK 16

size_t least_squares_workspace(int m, int n)
{
    size_t rows = (size_t)m + (size_t)n;
    return rows * (size_t)n + rows + (size_t)n + rows * BLOCK;
}

int least_squares_damped_step(int m, int n, const double *jacobian, const double *r, double mu, const double *scale, double *h,
                              double *work)
{
    int rows = m + n;
    double *stack = work, *right = stack + (ptrdiff_t)rows * n, *lapack = right + rows, root = sqrt(mu);
    for (int j = 0; j < n; j++) {
        double *column = stack + (ptrdiff_t)j * rows;
        memcpy(column, jacobian + (ptrdiff_t)j * m, (size_t)m * sizeof(double));
        memset(column + m, 0, (size_t)n * sizeof(double));
        column[m + j] = root * scale[j];
    }
    for (int i = 0; i < m; i++)
        right[i] = -r[i];
    memset(right + m, 0, (size_t)n * sizeof(double));
    int lwork = (int)(least_squares_workspace(m, n) - (size_t)rows * (size_t)n - (size_t)rows);
    if (LAPACKE_dgels_work(LAPACK_COL_MAJOR, 'N', rows, n, 1, stack, rows, right, rows, lapack, lwork))
        return 1;
    memcpy(h, right, (size_t)n * sizeof(double));
    for (int j = 0; j < n; j++)
        if (!isfinite(h[j]))
            return 1;
    return 0;
}

size_t singular_values_workspace(int m, int n)
{
    size_t most = (size_t)(m > n ? m : n), least = (size_t)(m > n ? n : m);
    return (size_t)m * (size_t)n + (size_t)n * (size_t)n + least + 8 * (3 * least + most);
}

int singular_values(int m, int n, const double *jacobian, double *value, double *direction, double *work)
{
    int least = m < n ? m : n, most = m < n ? n : m;
    double *copy = work, *vt = copy + (ptrdiff_t)m * n, *s = vt + (ptrdiff_t)n * n, *lapack = s + least;
    memcpy(copy, jacobian, (size_t)m * (size_t)n * sizeof(double));
    if (LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'N', 'A', m, n, copy, m, s, NULL, 1, vt, n, lapack, 8 * (3 * least + most)))
        return 1;
    for (int j = 0; j < n; j++) {
        value[j] = j < least ? s[j] : 0;
        for (int i = 0; i < n; i++)
            direction[i + (ptrdiff_t)j * n] = vt[j + (ptrdiff_t)i * n];
    }
    return 0;
}
