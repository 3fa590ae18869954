#include "linalg/linalg.h"

#include <float.h>
#include <lapacke.h>

#define LONGER 1.1    /* than the radius: as near as it matters */
#define MOST   1000   /* of the exponent of that unit, which has an inverse */
#define LEAST  1e-250 /* between these a sum of squares has lost nothing that counts */
#define LARGE  1e250
#define TURNS  100 /* of Newton's iteration, which needs about five: it is monotonous, and quadratic near its end */

size_t least_squares_workspace(int m, int n)
{
    size_t rows = (size_t)m + (size_t)n;
    return rows * ((size_t)n + 1) + 4 * (size_t)n + 2;
}

/* The power of two that brings a column of this scale to 1: of columns 1e300 apart, one unit would make zeros. It changes no
 * digit of the QR, since its reflections see a column's own power of two in that column alone. */
static double unit_of(double scale)
{
    int exponent;
    (void)frexp(scale, &exponent);
    return ldexp(1, -(exponent > MOST ? MOST : exponent < -MOST ? -MOST : exponent));
}

/* For one mu, J U y = -r with U = diag(unit_of(scale)), h = U y: the QR of [J U, r] over the damping, y to `right` behind the
 * stack, R U to its upper triangle, leading dimension m + n. *length = |D h|. */
static int solve_damped(int m, int n, const double *jacobian, const double *r, const double *scale, const double *floor,
                        double mu, double *length, double *work)
{
    int rows = m + n;
    double *stack = work, *last = stack + (ptrdiff_t)rows * n, *right = last + rows, *part = right + n, *lapack = part + n,
           root = sqrt(mu);
    for (int j = 0; j < n; j++) {
        double *column = stack + (ptrdiff_t)j * rows, unit = unit_of(scale[j]);
        for (int i = 0; i < m; i++)
            column[i] = unit * jacobian[i + (ptrdiff_t)j * m];
        memset(column + m, 0, (size_t)n * sizeof(double));
        column[m + j] = hypot(root * (unit * scale[j]), unit * floor[j]);
    }
    for (int i = 0; i < m; i++)
        last[i] = -r[i];
    memset(last + m, 0, (size_t)n * sizeof(double));
    if (LAPACKE_dgeqr2_work(LAPACK_COL_MAJOR, rows, n + 1, stack, rows, lapack, lapack + n + 1))
        return 1;
    memcpy(right, last, (size_t)n * sizeof(double));
    if (LAPACKE_dtrtrs_work(LAPACK_COL_MAJOR, 'U', 'N', 'N', n, 1, stack, rows, right, n))
        return 1;
    for (int j = 0; j < n; j++)
        part[j] = unit_of(scale[j]) * scale[j] * right[j];
    *length = least_squares_length(n, NULL, part);
    return !isfinite(*length);
}

/* The square of |D h| times a power of two */
static double square_in(double unit, int n, const double *scale, const double *h)
{
    double sum = 0;
    for (int j = 0; j < n; j++) {
        double part = unit * (scale ? scale[j] * h[j] : h[j]);
        sum += part * part;
    }
    return sum;
}

double least_squares_length(int n, const double *scale, const double *h)
{
    double square = square_in(1, n, scale, h), largest = 0;
    if (square > LEAST && square < LARGE)
        return sqrt(square);
    for (int j = 0; j < n; j++) {
        double part = fabs(scale ? scale[j] * h[j] : h[j]);
        if (!(part <= largest)) /* of a NaN the square says so */
            largest = part;
    }
    if (!(largest > 0) || !isfinite(largest))
        return largest;
    return sqrt(square_in(unit_of(largest), n, scale, h)) / unit_of(largest);
}

/* (D^2 h)' (R'R)^-1 (D^2 h) = -|D h| d|D h|/dmu, with R U and D h = D U y of the last solution */
static double length_slope(int m, int n, const double *scale, double *work)
{
    int rows = m + n;
    double *q = work + (ptrdiff_t)rows * (n + 1) + n, sum = 0;
    for (int j = 0; j < n; j++)
        q[j] *= unit_of(scale[j]) * scale[j];
    if (LAPACKE_dtrtrs_work(LAPACK_COL_MAJOR, 'U', 'T', 'N', n, 1, work, rows, q, n))
        return 0;
    for (int j = 0; j < n; j++)
        sum += q[j] * q[j];
    return sum;
}

int least_squares_damped_step(int m, int n, const double *jacobian, const double *r, const double *scale, const double *floor,
                              double radius, double *mu, double *h, double *length, double *work)
{
    const double *y = work + (ptrdiff_t)(m + n) * (n + 1);
    for (int turn = 0;; turn++) {
        if (solve_damped(m, n, jacobian, r, scale, floor, *mu, length, work))
            return 1;
        if (!(*length > LONGER * radius))
            break;
        double raise = *length * *length / length_slope(m, n, scale, work) * (*length - radius) / radius;
        if (turn == TURNS)
            return 1;
        *mu += raise > 0 && isfinite(raise) ? raise : 99 * *mu; /* where the slope is lost below or above all numbers */
    }
    for (int j = 0; j < n;
         j++) /* |D h| has a double, and h need not: then x would go past all numbers, and the step is too long */
        h[j] = fmax(-DBL_MAX, fmin(DBL_MAX, unit_of(scale[j]) * y[j]));
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
