#include "linalg/linalg.h"

#include <cblas.h>
#include <lapacke.h>

#define BLOCKS     6 /* of the pairs known, in the basis, before it is condensed to them */
#define MOST_STEPS 200
#define NOTHING    1e-13 /* of the length of a vector: what is left of it after projection is rounding */

int lanczos_new(struct pool *pool, struct pencil *pencil, struct factor *factor, int columns, int block, struct lanczos *l)
{
    int n = pencil->n, most = BLOCKS * block, behind = 2 * block;
    *l = (struct lanczos){
        .n = n, .columns = columns, .block = block, .most = most, .behind = behind, .pencil = pencil, .factor = factor};
    size_t vectors = (size_t)n * (size_t)(most + behind), squares = (size_t)most * (size_t)most;
    l->basis = POOL_ARRAY(pool, double, vectors);
    l->mass_basis = POOL_ARRAY(pool, double, vectors);
    l->image = POOL_ARRAY(pool, double, (size_t)n *(size_t)block);
    l->projected = POOL_ARRAY(pool, double, squares);
    l->vector = POOL_ARRAY(pool, double, squares);
    l->component = POOL_ARRAY(pool, double, squares);
    l->theta = POOL_ARRAY(pool, double, most);
    l->remainder = POOL_ARRAY(pool, double, (size_t)behind *(size_t)behind);
    l->work = POOL_ARRAY(pool, double, 34 * (size_t)most);
    l->iwork = POOL_ARRAY(pool, int, 12 * (size_t)most);
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

/* Makes the columns of W [n * columns], M W beside it, M-orthonormal: W = Q R, R [behind * columns]. Columns that are least[c]
 * long or shorter without those before them are dropped. Returns how many are left. */
static int gram_schmidt(struct lanczos *l, int columns, const double *least, double *w, double *mw, double *remainder)
{
    int n = l->n, rank = 0;
    memset(remainder, 0, (size_t)l->behind * (size_t)columns * sizeof(double));
    for (int c = 0; c < columns; c++) {
        double *x = w + (ptrdiff_t)rank * n, *mx = mw + (ptrdiff_t)rank * n, *r = remainder + (ptrdiff_t)c * l->behind;
        if (rank < c) {
            memcpy(x, w + (ptrdiff_t)c * n, (size_t)n * sizeof *x);
            memcpy(mx, mw + (ptrdiff_t)c * n, (size_t)n * sizeof *x);
        }
        if (rank) {
            cblas_dgemv(CblasColMajor, CblasTrans, n, rank, 1, mw, n, x, 1, 0, r, 1);
            cblas_dgemv(CblasColMajor, CblasNoTrans, n, rank, -1, w, n, r, 1, 1, x, 1);
            cblas_dgemv(CblasColMajor, CblasNoTrans, n, rank, -1, mw, n, r, 1, 1, mx, 1);
        }
        double square = cblas_ddot(n, x, 1, mx, 1), length = square > 0 ? sqrt(square) : 0;
        if (!(length > least[c]))
            continue;
        cblas_dscal(n, 1 / length, x, 1);
        cblas_dscal(n, 1 / length, mx, 1);
        r[rank++] = length;
    }
    return rank;
}

/* W := W - V (M V)' W for the first `size` columns V of the basis; part [size * columns], leading dimension most: (M V)' W. */
static void project_out(struct lanczos *l, int size, int columns, double *w, double *part)
{
    int n = l->n;
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, size, columns, n, 1, l->mass_basis, n, w, n, 0, part, l->most);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, columns, size, -1, l->basis, n, part, l->most, 1, w, n);
}

/* Takes off what rounding has left of the basis in W, and of its columns in each other. Returns how many columns are left: those
 * that were rounding from the start are not orthogonal yet, nor independent. */
static int again(struct lanczos *l, int size, int columns, double *w, double *mw)
{
    int n = l->n;
    double *square = l->component + (ptrdiff_t)l->most * l->behind, *least = l->work;
    if (size)
        project_out(l, size, columns, w, l->component);
    pencil_multiply_mass(l->pencil, columns, w, mw); /* what was subtracted from M W left rounding of the whole column there */
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, columns, columns, n, 1, w, n, mw, n, 0, square, columns);
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'U', columns, square, columns)) {
        for (int c = 0; c < columns; c++)
            least[c] = 0.5;
        return gram_schmidt(l, columns, least, w, mw, l->component);
    }
    cblas_dtrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, n, columns, 1, square, columns, w, n);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, n, columns, 1, square, columns, mw, n);
    return columns;
}

/* The `columns` columns behind the first `size` of the basis: taken orthogonal to those and to each other, twice because once
 * leaves errors of the size of the cancellation. coefficient [size * columns], leading dimension most: what was along the basis.
 * Sets `outside` and `next`. */
static void orthonormalise(struct lanczos *l, int size, int columns, double *coefficient)
{
    int n = l->n;
    double *w = l->basis + (ptrdiff_t)size * n, *mw = l->mass_basis + (ptrdiff_t)size * n, *least = l->work;
    if (size)
        project_out(l, size, columns, w, coefficient);
    pencil_multiply_mass(l->pencil, columns, w, mw);
    for (int c = 0; c < columns; c++) {
        double square = fabs(cblas_ddot(n, w + (ptrdiff_t)c * n, 1, mw + (ptrdiff_t)c * n, 1));
        for (int i = 0; i < size; i++)
            square += coefficient[i + (ptrdiff_t)c * l->most] * coefficient[i + (ptrdiff_t)c * l->most];
        least[c] = NOTHING * sqrt(square);
    }
    l->outside = gram_schmidt(l, columns, least, w, mw, l->remainder);
    l->next = l->outside < n - size ? l->outside : n - size;
    if (l->next)
        l->next = again(l, size, l->next, w, mw);
}

/* One block more: what (K - s M)^-1 M makes of the last one. */
static void expand(struct lanczos *l)
{
    int n = l->n, columns = l->next, size = l->size + columns;
    double *w = l->basis + (ptrdiff_t)size * n;
    memcpy(w, l->mass_basis + (ptrdiff_t)l->size * n, (size_t)n * (size_t)columns * sizeof *w);
    factor_solve(l->factor, columns, w);
    double *coefficient = l->projected + (ptrdiff_t)l->size * l->most;
    l->last = columns;
    l->size = size;
    orthonormalise(l, size, columns, coefficient);
}

int lanczos_known(const struct lanczos *l)
{
    return l->size < l->block ? l->size : l->block;
}

/* The pairs of the projected operator that belong to the lowest eigenvalues, theta ascending: the lowest one comes last. */
static int project(struct lanczos *l)
{
    int size = l->size, pairs = lanczos_known(l);
    lapack_int found = 0;
    double *a = l->component;
    for (int j = 0; j < size; j++)
        memcpy(a + (ptrdiff_t)j * size, l->projected + (ptrdiff_t)j * l->most, (size_t)(j + 1) * sizeof(double));
    lapack_int info =
        LAPACKE_dsyevr_work(LAPACK_COL_MAJOR, 'V', 'I', 'U', size, a, size, 0, 0, size - pairs + 1, size, 0, &found, l->theta,
                            l->vector, size, l->iwork, l->work, 34 * l->most, l->iwork + 2 * (ptrdiff_t)l->most, 10 * l->most);
    return info || found != pairs ? ROTID_ERROR_EIGEN : ROTID_OK;
}

double lanczos_theta(const struct lanczos *l, int pair)
{
    return l->theta[lanczos_known(l) - 1 - pair];
}

static const double *components(const struct lanczos *l, int pair)
{
    return l->vector + (ptrdiff_t)(lanczos_known(l) - 1 - pair) * l->size;
}

/* Relative residual of a pair, 0 the lowest */
static double residual(const struct lanczos *l, int pair)
{
    const double *y = components(l, pair) + l->size - l->last;
    double square = 0;
    for (int b = 0; b < l->outside; b++) {
        double sum = 0;
        for (int c = 0; c < l->last; c++)
            sum += l->remainder[b + (ptrdiff_t)c * l->behind] * y[c];
        square += sum * sum;
    }
    return sqrt(square) / lanczos_theta(l, pair);
}

/* target [n * pairs] := the vectors of the lowest pairs from the basis or M times it; component is overwritten */
static void combine(struct lanczos *l, const double *basis, int pairs, double *target)
{
    for (int j = 0; j < pairs; j++)
        memcpy(l->component + (ptrdiff_t)j * l->size, components(l, j), (size_t)l->size * sizeof(double));
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, l->n, pairs, l->size, 1, basis, l->n, l->component, l->size, 0, target,
                l->n);
}

/* The lowest pairs become the basis, before the block that has not been multiplied (thick restart). */
static void condense(struct lanczos *l)
{
    int n = l->n, pairs = lanczos_known(l);
    double *both[] = {l->basis, l->mass_basis};
    for (int b = 0; b < 2; b++) {
        combine(l, both[b], pairs, l->image);
        memcpy(both[b], l->image, (size_t)n * (size_t)pairs * sizeof(double));
        memmove(both[b] + (ptrdiff_t)pairs * n, both[b] + (ptrdiff_t)l->size * n, (size_t)n * (size_t)l->next * sizeof(double));
    }
    for (int j = 0; j < pairs; j++) {
        memset(l->projected + (ptrdiff_t)j * l->most, 0, (size_t)pairs * sizeof(double));
        l->projected[j + (ptrdiff_t)j * l->most] = lanczos_theta(l, j);
    }
    l->size = pairs;
}

int lanczos_extend(struct lanczos *l, int columns)
{
    if (columns > l->behind - l->next)
        return ROTID_ERROR_EIGEN;
    condense(l);
    int size = l->size + l->next, before = l->next;
    double *x = l->basis + (ptrdiff_t)size * l->n;
    for (ptrdiff_t i = 0; i < (ptrdiff_t)l->n * columns; i++)
        x[i] = random_normal(&l->stream);
    orthonormalise(l, size, columns, l->vector);
    l->next += before;
    return ROTID_OK;
}

int lanczos_iterate(struct lanczos *l, int watched, const double *tolerance)
{
    for (int step = 0; step < MOST_STEPS; step++) {
        if (l->size + l->next > l->most)
            condense(l);
        expand(l);
        int status = project(l), open = l->size < watched;
        if (status)
            return status;
        for (int j = 0; j < watched && !open; j++)
            open = !(lanczos_theta(l, j) > 0) || !(residual(l, j) <= tolerance[j]);
        if (!open)
            return ROTID_OK;
        if (!l->next &&
            (status = lanczos_extend(l, l->columns))) /* the basis holds all of its own images, and not yet the pairs */
            return status;
    }
    return ROTID_ERROR_EIGEN;
}

void lanczos_begin(struct lanczos *l, const double *x)
{
    l->stream = (struct random_stream){20240229};
    l->size = l->last = 0;
    memcpy(l->basis, x, (size_t)l->n * (size_t)l->columns * sizeof *x);
    orthonormalise(l, 0, l->columns, l->component);
}

void lanczos_vectors(struct lanczos *l, int pairs, double *target)
{
    combine(l, l->basis, pairs, target);
}
