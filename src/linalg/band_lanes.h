/* Solutions with the factors of a narrow band for one number of right-hand sides, interleaved as one vector a row. band.c
 * includes this file once for each number, with LANES (the vector type) and NAMED(kernel) defined; no guard therefore. A row that
 * has all its kd neighbours is a case of its own, whose loops have constant ends where kd is a constant. The neighbour found last
 * comes last in a sum: the others need not wait for it. */

/* Row b of L X = B: the columns before it, each one down */
INLINE void NAMED(below)(int kd, int reach, const double *restrict l, LANES *restrict b)
{
    LANES sum = b[0];
#pragma GCC unroll 8
    for (int d = reach; d >= 1; d--)
        sum -= l[d - (ptrdiff_t)d * (kd + 1)] * b[-d];
    b[0] = sum * (1 / l[0]);
}

/* Row b of U X = B: stride leads from column to column along it */
INLINE void NAMED(above)(int reach, ptrdiff_t stride, const double *restrict u, LANES *restrict b)
{
    LANES sum = b[0];
#pragma GCC unroll 8
    for (int d = reach; d >= 1; d--)
        sum -= u[d * stride] * b[d];
    b[0] = sum * (1 / u[0]);
}

/* L L' X = B */
INLINE void NAMED(cholesky_solve)(int n, int kd, const double *restrict band, LANES *restrict b)
{
    const ptrdiff_t lda = kd + 1;
    int j = 0;
    for (; j < least(kd, n); j++)
        NAMED(below)(kd, j, band + j * lda, b + j);
    for (; j < n; j++)
        NAMED(below)(kd, kd, band + j * lda, b + j);
    for (j = n - 1; j >= 0 && j + kd >= n; j--)
        NAMED(above)(n - 1 - j, 1, band + j * lda, b + j);
    for (; j >= 0; j--)
        NAMED(above)(kd, 1, band + j * lda, b + j);
}

/* Rows p and 0 change places, and row 0 is taken off the `reach` rows below it. */
INLINE void NAMED(eliminate)(int reach, const double *restrict l, int p, LANES *restrict b)
{
    LANES pivot = b[p];
    b[p] = b[0];
    b[0] = pivot;
#pragma GCC unroll 8
    for (int d = 1; d <= reach; d++)
        b[d] -= l[d] * pivot;
}

/* P L U X = B */
INLINE void NAMED(lu_solve)(int n, int kd, const double *restrict band, const int *restrict pivot, LANES *restrict b)
{
    const ptrdiff_t lda = 3 * kd + 1;
    const double *diagonal = band + 2 * (ptrdiff_t)kd;
    int j = 0;
    for (; j < n - kd; j++)
        NAMED(eliminate)(kd, diagonal + j * lda, pivot[j] - 1 - j, b + j);
    for (; j < n; j++)
        NAMED(eliminate)(n - 1 - j, diagonal + j * lda, pivot[j] - 1 - j, b + j);
    for (j = n - 1; j >= 0 && j + 2 * kd >= n; j--)
        NAMED(above)(n - 1 - j, lda - 1, diagonal + j * lda, b + j);
    for (; j >= 0; j--)
        NAMED(above)(2 * kd, lda - 1, diagonal + j * lda, b + j);
}

/* B := B - X R, X [n * count] by columns, R [count] interleaved as B is */
INLINE void NAMED(subtract)(int n, int count, const double *restrict x, const LANES *restrict r, LANES *restrict b)
{
    for (int i = 0; i < n; i++) {
        LANES sum = b[i];
        for (int p = 0; p < count; p++)
            sum -= x[i + (ptrdiff_t)p * n] * r[p];
        b[i] = sum;
    }
}

/* B [n] := rows row[i] of `columns` columns of length `length`, and zeros behind them */
INLINE void NAMED(gather)(int n, const int *restrict row, int columns, ptrdiff_t length, const double *restrict x,
                          double *restrict b)
{
    enum { WIDTH = sizeof(LANES) / sizeof(double) };
    if (columns < WIDTH)
        memset(b, 0, (size_t)n * sizeof(LANES));
    for (int i = 0; i < n; i++) {
        const double *at = x + row[i];
#pragma GCC unroll 4
        for (int c = 0; c < columns; c++)
            b[i * (ptrdiff_t)WIDTH + c] = at[c * length];
    }
}

/* The way back */
INLINE void NAMED(scatter)(int n, const int *restrict row, int columns, ptrdiff_t length, const double *restrict b,
                           double *restrict x)
{
    enum { WIDTH = sizeof(LANES) / sizeof(double) };
    for (int i = 0; i < n; i++) {
        double *at = x + row[i];
#pragma GCC unroll 4
        for (int c = 0; c < columns; c++)
            at[c * length] = b[i * (ptrdiff_t)WIDTH + c];
    }
}
