#include "linalg/eigen_wide.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "base/random.h"

#define TOLERANCE   2e-12 /* of the residual |(K - s M)^-1 M phi - theta phi|_M / theta */
#define ROUGH       1e-3  /* of it, where eigenvalues are sought for their size */
#define FIRST_SHIFT 1e-10 /* of the highest eigenvalue: far above its rounding */
#define ZERO        1e-14 /* of the highest eigenvalue: below this, rounding of a rigid motion */
#define GUARDS      5     /* pairs beyond those wanted that are kept when the basis is condensed */
#define BLOCKS      8     /* in the basis, before it is condensed to the lowest pairs */
#define MOST_BLOCKS 200
#define NOTHING     1e-13 /* of the length of a vector: what is left of it after projection is rounding */
#define REPAIRS     4     /* times that random vectors look for pairs that were missed */

int eigen_wide_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_wide *e)
{
    int n = structure->n, block = count + GUARDS < n ? count + GUARDS : n, most = BLOCKS * block;
    *e = (struct eigen_wide){.n = n, .count = count, .block = block, .most = most};
    size_t vectors = (size_t)n * (size_t)(most + 2 * block), squares = (size_t)most * (size_t)most;
    e->all = POOL_ARRAY(pool, int, n);
    e->basis = POOL_ARRAY(pool, double, vectors);
    e->mass_basis = POOL_ARRAY(pool, double, vectors);
    e->ritz = POOL_ARRAY(pool, double, (size_t)n *(size_t)block);
    e->image = POOL_ARRAY(pool, double, (size_t)n *(size_t)block);
    e->projected = POOL_ARRAY(pool, double, squares);
    e->vector = POOL_ARRAY(pool, double, squares);
    e->component = POOL_ARRAY(pool, double, squares);
    e->value = POOL_ARRAY(pool, double, block);
    e->theta = POOL_ARRAY(pool, double, most);
    e->iwork = POOL_ARRAY(pool, int, 12 * (size_t)most);
    e->remainder = POOL_ARRAY(pool, double, 4 * (size_t)block * (size_t)block);
    e->work = POOL_ARRAY(pool, double, 34 * (size_t)most);
    if (!e->all || !e->basis || !e->mass_basis || !e->ritz || !e->image || !e->projected || !e->vector || !e->component ||
        !e->value || !e->theta || !e->iwork || !e->remainder || !e->work)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < n; i++)
        e->all[i] = i;
    int status = pencil_new(pool, structure, &e->pencil);
    return status ? status : factor_new(pool, FACTOR_CHOLESKY, structure, n, e->all, &e->factor);
}

/* Makes the columns of W [n * columns], M W beside it, M-orthonormal: W = Q R, R [2 block * columns]. Columns that are least[c]
 * long or shorter without those before them are dropped. Returns how many are left. */
static int gram_schmidt(struct eigen_wide *e, int columns, const double *least, double *w, double *mw, double *remainder)
{
    int n = e->n, rank = 0;
    memset(remainder, 0, 2 * (size_t)e->block * (size_t)columns * sizeof(double));
    for (int c = 0; c < columns; c++) {
        double *x = w + (ptrdiff_t)rank * n, *mx = mw + (ptrdiff_t)rank * n, *r = remainder + 2 * (ptrdiff_t)c * e->block;
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
static void project_out(struct eigen_wide *e, int size, int columns, double *w, double *part)
{
    int n = e->n;
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, size, columns, n, 1, e->mass_basis, n, w, n, 0, part, e->most);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, columns, size, -1, e->basis, n, part, e->most, 1, w, n);
}

/* Takes off what rounding has left of the basis in W, and of its columns in each other. Returns how many columns are left: those
 * that were rounding from the start are not orthogonal yet, nor independent. */
static int again(struct eigen_wide *e, int size, int columns, double *w, double *mw)
{
    int n = e->n;
    double *square = e->component + 2 * (ptrdiff_t)e->most * e->block, *least = e->work;
    if (size) {
        project_out(e, size, columns, w, e->component);
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, columns, size, -1, e->mass_basis, n, e->component, e->most, 1,
                    mw, n);
    }
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, columns, columns, n, 1, w, n, mw, n, 0, square, columns);
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'U', columns, square, columns)) {
        for (int c = 0; c < columns; c++)
            least[c] = 0.5;
        return gram_schmidt(e, columns, least, w, mw, e->component);
    }
    cblas_dtrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, n, columns, 1, square, columns, w, n);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, n, columns, 1, square, columns, mw, n);
    return columns;
}

/* The `columns` columns behind the first `size` of the basis: taken orthogonal to those and to each other, twice because once
 * leaves errors of the size of the cancellation. coefficient [size * columns], leading dimension most: what was along the basis.
 * Sets `outside` and `next`. */
static void orthonormalise(struct eigen_wide *e, int size, int columns, double *coefficient)
{
    int n = e->n;
    double *w = e->basis + (ptrdiff_t)size * n, *mw = e->mass_basis + (ptrdiff_t)size * n, *least = e->work;
    if (size)
        project_out(e, size, columns, w, coefficient);
    pencil_multiply_mass(&e->pencil, columns, w, mw);
    for (int c = 0; c < columns; c++) {
        double square = fabs(cblas_ddot(n, w + (ptrdiff_t)c * n, 1, mw + (ptrdiff_t)c * n, 1));
        for (int i = 0; i < size; i++)
            square += coefficient[i + (ptrdiff_t)c * e->most] * coefficient[i + (ptrdiff_t)c * e->most];
        least[c] = NOTHING * sqrt(square);
    }
    e->outside = gram_schmidt(e, columns, least, w, mw, e->remainder);
    e->next = e->outside < n - size ? e->outside : n - size;
    if (e->next)
        e->next = again(e, size, e->next, w, mw);
}

/* One block more: what (K - s M)^-1 M makes of the last one. */
static void expand(struct eigen_wide *e)
{
    int n = e->n, columns = e->next, size = e->size + columns;
    double *w = e->basis + (ptrdiff_t)size * n;
    memcpy(w, e->mass_basis + (ptrdiff_t)e->size * n, (size_t)n * (size_t)columns * sizeof *w);
    factor_solve(&e->factor, columns, w);
    double *coefficient = e->projected + (ptrdiff_t)e->size * e->most;
    e->last = columns;
    e->size = size;
    orthonormalise(e, size, columns, coefficient);
}

/* Random vectors beside the block that is multiplied next */
static void add_random(struct eigen_wide *e)
{
    int size = e->size + e->next, before = e->next;
    double *x = e->basis + (ptrdiff_t)size * e->n;
    for (ptrdiff_t i = 0; i < (ptrdiff_t)e->n * e->count; i++)
        x[i] = random_normal(&e->stream);
    orthonormalise(e, size, e->count, e->vector);
    e->next += before;
}

static int known_pairs(const struct eigen_wide *e)
{
    return e->size < e->block ? e->size : e->block;
}

/* The pairs of the projected operator that belong to the lowest eigenvalues, theta ascending: the lowest one comes last. */
static int project(struct eigen_wide *e)
{
    int size = e->size, pairs = known_pairs(e);
    lapack_int found = 0;
    double *a = e->component;
    for (int j = 0; j < size; j++)
        memcpy(a + (ptrdiff_t)j * size, e->projected + (ptrdiff_t)j * e->most, (size_t)(j + 1) * sizeof(double));
    lapack_int info = LAPACKE_dsyevr_work(LAPACK_COL_MAJOR, 'V', 'I', 'U', size, a, size, 0, 0, size - pairs + 1, size, 0, &found,
                                          e->theta, e->vector, size, e->iwork, e->work, 34 * e->most, e->iwork + 2 * e->most,
                                          10 * e->most);
    return info || found != pairs ? ROTID_ERROR_EIGEN : ROTID_OK;
}

static double theta(const struct eigen_wide *e, int pair)
{
    return e->theta[known_pairs(e) - 1 - pair];
}

static const double *components(const struct eigen_wide *e, int pair)
{
    return e->vector + (ptrdiff_t)(known_pairs(e) - 1 - pair) * e->size;
}

/* Relative residual of a pair, 0 the lowest */
static double residual(const struct eigen_wide *e, int pair)
{
    const double *y = components(e, pair) + e->size - e->last;
    double square = 0;
    for (int b = 0; b < e->outside; b++) {
        double sum = 0;
        for (int c = 0; c < e->last; c++)
            sum += e->remainder[b + 2 * c * e->block] * y[c];
        square += sum * sum;
    }
    return sqrt(square) / theta(e, pair);
}

/* target [n * pairs] := the vectors of the lowest pairs from the basis or M times it; component is overwritten */
static void combine(struct eigen_wide *e, const double *basis, int pairs, double *target)
{
    for (int j = 0; j < pairs; j++)
        memcpy(e->component + (ptrdiff_t)j * e->size, components(e, j), (size_t)e->size * sizeof(double));
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, e->n, pairs, e->size, 1, basis, e->n, e->component, e->size, 0, target,
                e->n);
}

/* The lowest pairs become the basis, before the block that has not been multiplied (thick restart). */
static void condense(struct eigen_wide *e)
{
    int n = e->n, pairs = known_pairs(e);
    double *both[] = {e->basis, e->mass_basis};
    for (int b = 0; b < 2; b++) {
        combine(e, both[b], pairs, e->image);
        memcpy(both[b], e->image, (size_t)n * (size_t)pairs * sizeof(double));
        memmove(both[b] + (ptrdiff_t)pairs * n, both[b] + (ptrdiff_t)e->size * n, (size_t)n * (size_t)e->next * sizeof(double));
    }
    for (int j = 0; j < pairs; j++) {
        memset(e->projected + (ptrdiff_t)j * e->most, 0, (size_t)pairs * sizeof(double));
        e->projected[j + (ptrdiff_t)j * e->most] = theta(e, j);
    }
    e->size = pairs;
}

/* Until the residuals of the lowest `watched` pairs are below the tolerance. */
static int iterate(struct eigen_wide *e, int watched, double tolerance)
{
    for (int step = 0; step < MOST_BLOCKS; step++) {
        if (e->size + e->next > e->most)
            condense(e);
        expand(e);
        int status = project(e), open = e->size < watched;
        if (status)
            return status;
        for (int j = 0; j < watched && !open; j++)
            open = !(theta(e, j) > 0) || !(residual(e, j) <= tolerance);
        if (!open)
            return ROTID_OK;
        if (!e->next) { /* the basis holds all of its own images, and not yet the pairs */
            condense(e);
            add_random(e);
        }
    }
    return ROTID_ERROR_EIGEN;
}

/* ritz and value := the lowest pairs of the basis */
static void take_pairs(struct eigen_wide *e)
{
    int pairs = known_pairs(e);
    combine(e, e->basis, pairs, e->ritz);
    for (int j = 0; j < e->block; j++)
        e->value[j] = j < pairs && theta(e, j) > 0 ? 1 / theta(e, j) + e->shift : INFINITY;
}

/* The basis begins with the vectors in ritz. */
static int begin(struct eigen_wide *e)
{
    e->size = e->last = 0;
    memcpy(e->basis, e->ritz, (size_t)e->n * (size_t)e->count * sizeof(double));
    orthonormalise(e, 0, e->count, e->component);
    return factor_compute_pencil(&e->factor, &e->pencil, e->shift) ? ROTID_ERROR_STIFFNESS : ROTID_OK;
}

/* The first shift is far below the first mode and yet well above rounding; the next one, knowing the third eigenvalue (the first
 * two may be rigid-body modes at zero) or the first above it that is not zero, is of its size: the iteration then converges about
 * as fast as with none. Returns 0 where no such eigenvalue is known. */
static int choose_shift(struct eigen_wide *e)
{
    int j = e->block < 3 ? e->block - 1 : 2;
    while (j + 1 < e->block && e->value[j] < ZERO * e->largest)
        j++;
    if (!isfinite(e->value[j]) || e->value[j] < ZERO * e->largest)
        return 0;
    e->shift = -0.1 * fabs(e->value[j]);
    return 1;
}

static int start(struct eigen_wide *e)
{
    for (ptrdiff_t i = 0; i < (ptrdiff_t)e->n * e->count; i++)
        e->ritz[i] = random_normal(&e->stream);
    e->shift = -FIRST_SHIFT * e->largest;
    int status = begin(e);
    if (!status)
        status = iterate(e, e->block < 3 ? e->block : 3, ROUGH);
    if (status)
        return status;
    take_pairs(e);
    return choose_shift(e) ? ROTID_OK : ROTID_ERROR_STIFFNESS;
}

/* Refuses what no rotor has, the same way whatever was solved before. */
static int check(struct eigen_wide *e, const rotid_matrix *k, const rotid_matrix *m)
{
    struct pencil *p = &e->pencil;
    if (!pencil_take(p, k, m) || !e->definite)
        e->definite = !factor_compute(&e->factor, m);
    if (!e->definite)
        return ROTID_ERROR_MASS;
    e->largest = 0;
    for (int i = 0; i < e->n; i++)
        e->largest = fmax(e->largest, p->k[p->start[i]] / p->m[p->start[i]]);
    return isfinite(e->largest) && e->largest > 0 ? ROTID_OK : ROTID_ERROR_STIFFNESS;
}

/* The number of eigenvalues below a shift just above the last pair, which rounding limits in how near it can be, less that of the
 * Ritz values there: 0 proves that none was missed, also of those that lie between the last pair and the shift. Ritz values lie
 * above the eigenvalues that they belong to, so no fewer can be there. */
static int count_missed(struct eigen_wide *e)
{
    double last = e->value[e->count - 1], shift = last + 1e-6 * (fabs(last) - e->shift);
    int known = e->count;
    while (known < e->block && e->value[known] <= shift)
        known++;
    return factor_negative_count_pencil(&e->factor, &e->pencil, shift) - known;
}

/* From the vectors in ritz to pairs of which none is missed. Equal eigenvalues beyond the number of vectors come late, and with
 * new random vectors. */
static int attempt(struct eigen_wide *e)
{
    int status = begin(e), watched = e->count;
    for (int repair = 0; !status; repair++) {
        status = iterate(e, watched, TOLERANCE);
        if (status)
            break;
        take_pairs(e);
        int missed = count_missed(e);
        if (!missed)
            return ROTID_OK;
        if (repair == REPAIRS || missed < 0 || factor_compute_pencil(&e->factor, &e->pencil, e->shift))
            return ROTID_ERROR_EIGEN;
        watched = watched + missed < e->block ? watched + missed : e->block;
        condense(e);
        add_random(e);
    }
    return status;
}

/* lambda and phi from ritz: the quotients with K and M themselves have less rounding than the values of the iteration */
static void give(struct eigen_wide *e, double *lambda, double *phi)
{
    int n = e->n;
    memcpy(phi, e->ritz, (size_t)n * (size_t)e->count * sizeof *phi);
    pencil_multiply_mass(&e->pencil, e->count, phi, e->image);
    for (int j = 0; j < e->count; j++) {
        double square = cblas_ddot(n, phi + (ptrdiff_t)j * n, 1, e->image + (ptrdiff_t)j * n, 1);
        cblas_dscal(n, 1 / sqrt(square), phi + (ptrdiff_t)j * n, 1);
    }
    pencil_multiply_stiffness(&e->pencil, e->count, phi, e->image);
    for (int j = 0; j < e->count; j++) {
        double value = cblas_ddot(n, phi + (ptrdiff_t)j * n, 1, e->image + (ptrdiff_t)j * n, 1);
        int at = j;
        for (; at > 0 && lambda[at - 1] > value; at--) { /* of rigid motions, rounding is all there is */
            lambda[at] = lambda[at - 1];
            cblas_dswap(n, phi + (ptrdiff_t)at * n, 1, phi + (ptrdiff_t)(at - 1) * n, 1);
        }
        lambda[at] = value;
    }
}

int eigen_wide_solve(struct eigen_wide *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi)
{
    int status = check(e, k, m);
    e->stream = (struct random_stream){20240229};
    if (status)
        return status;
    int warm = e->started;
    e->started = 0;
    status = warm ? attempt(e) : ROTID_ERROR_EIGEN;
    if (status) {
        status = start(e);
        if (!status)
            status = attempt(e);
    }
    if (status)
        return status;
    give(e, lambda, phi);
    if (lambda[0] < -FIRST_SHIFT * e->largest)
        return ROTID_ERROR_STIFFNESS;
    e->started = 1;
    (void)choose_shift(e); /* for the next call */
    return ROTID_OK;
}
