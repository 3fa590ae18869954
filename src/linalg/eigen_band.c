#include <cblas.h>
#include <float.h>
#include <lapacke.h>

#include "linalg/linalg.h"

#define INDEPENDENT 1e-3 /* least sine between a vector and those before it */

int ritz_pairs(int n, int count, const rotid_matrix *k, const rotid_matrix *m, double *y, double *value, double *vector,
               double *product, double *squares, double *work)
{
    double *a = squares, *b = a + (ptrdiff_t)count * count;
    for (int j = 0; j < count; j++) { /* solutions near an eigenvalue are of any size */
        double size = cblas_dnrm2(n, y + (ptrdiff_t)j * n, 1);
        if (!(size > 0) || !isfinite(size))
            return 1;
        cblas_dscal(n, 1 / size, y + (ptrdiff_t)j * n, 1);
    }
    matrix_multiply(m, count, y, product);
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, count, count, n, 1, y, n, product, n, 0, b, count);
    for (int j = 0; j < count; j++) {
        double square = b[j + (ptrdiff_t)j * count], inverse = 1 / sqrt(square);
        if (!(square > 0))
            return 1;
        cblas_dscal(n, inverse, y + (ptrdiff_t)j * n, 1);
        cblas_dscal(count, inverse, b + (ptrdiff_t)j * count, 1);
        cblas_dscal(count, inverse, b + j, count);
    }
    matrix_multiply(k, count, y, product);
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, count, count, n, 1, y, n, product, n, 0, a, count);
    /* y ascends, so that a support by a penalty of 1e18 stands last in A: reduced from there on, by the upper triangle, A leaves
     * its rounding to its own eigenvalue. From the first row on all of them would get it. */
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'U', count, b, count))
        return 1;
    for (int j = 0; j < count; j++)
        if (!(b[j + (ptrdiff_t)j * count] > INDEPENDENT))
            return 1;
    if (LAPACKE_dsygst_work(LAPACK_COL_MAJOR, 1, 'U', count, a, count, b, count) ||
        LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'U', count, a, count, value, work, RITZ_WORK * count))
        return 1;
    for (int j = 0; j < count; j++) /* a vector keeps the sign of y: rounding would choose it */
        if (a[j + (ptrdiff_t)j * count] < 0)
            cblas_dscal(count, -1, a + (ptrdiff_t)j * count, 1);
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans, CblasNonUnit, count, count, 1, b, count, a, count);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, count, count, 1, y, n, a, count, 0, vector, n);
    return 0;
}

#define AT_REST  1e-13 /* of the energy of its elements were each held alone: a motion that moves none against another */
#define ROUNDING 2e-15 /* of the highest eigenvalue: what the entries of K leave of the lowest ones */

double shift_of(int known, const double *value, double largest)
{
    int j = known < 3 ? known - 1 : 2;
    while (j + 1 < known && value[j] < ZERO * largest)
        j++;
    return isfinite(value[j]) && value[j] >= ZERO * largest ? -0.1 * value[j] : 0;
}

double diagonal_of(const rotid_matrix *a, int i, int *f)
{
    double value = a->band[(ptrdiff_t)i * (a->kd + 1)];
    while (*f < a->nfar && a->far[*f] < i)
        (*f)++;
    return *f < a->nfar && a->far[*f] == i ? value + a->block[(ptrdiff_t)*f * (a->nfar + 1)] : value;
}

double highest_of(const rotid_matrix *k, const rotid_matrix *m)
{
    double largest = 0;
    for (int i = 0, f = 0; i < k->n; i++)
        largest = fmax(largest, diagonal_of(k, i, &f) / diagonal_of(m, i, &f));
    return isfinite(largest) ? largest : 0;
}

int all_at_rest(const rotid_matrix *k, int count, const double *x, const double *kx)
{
    for (int j = 0; j < count; j++, x += k->n, kx += k->n) {
        double energy = 0, held = 0;
        for (int i = 0, f = 0; i < k->n; i++) {
            energy += x[i] * kx[i];
            held += diagonal_of(k, i, &f) * x[i] * x[i];
        }
        if (!(energy <= AT_REST * held))
            return 0;
    }
    return 1;
}

double shift_above(double last, double below, double largest)
{
    return last + 1e-6 * (fabs(last) - below) + ROUNDING * largest;
}

double shift_below(double last, double below, double largest)
{
    return last < ZERO * largest ? -FIRST_SHIFT * largest : last - 1e-6 * (last - below) - ROUNDING * largest;
}

#define ROUNDS            4    /* the error is cubed in each */
#define CLUSTER           1e-3 /* eigenvalues nearer than this share a shift: one of its own would turn both vectors into one */
#define EIGEN_POLISH_NEAR 1e-2 /* of the residual of a pair that is not wanted */
#define OFFSET            1e-7 /* of that shift below the lowest of them */

/* Residual that rounding leaves at most. */
static double eigen_rounding(const struct eigen_band *e)
{
    return fmin(1e-3, 16 * DBL_EPSILON * e->largest / -e->shift);
}

/* image := (K - s M)^-1 M ritz and mass_basis := M ritz for the first `columns` pairs; residual [watched] :=
 * |ritz - (lambda - s) image|_M. Returns the largest; INFINITY where one is not finite. */
static double eigen_residuals(struct eigen_band *e, const rotid_matrix *m, int columns, int watched)
{
    int n = e->n;
    double worst = 0;
    matrix_multiply(m, columns, e->ritz, e->image);
    memcpy(e->mass_basis, e->image, (size_t)n * (size_t)columns * sizeof(double));
    factor_solve(&e->factor, columns, e->image);
    for (int j = 0; j < watched; j++) { /* x - (lambda - s) y and M times that in the basis, which is free */
        const double *x = e->ritz + (ptrdiff_t)j * n, *y = e->image + (ptrdiff_t)j * n;
        double *difference = e->basis + (ptrdiff_t)j * n;
        for (int i = 0; i < n; i++)
            difference[i] = x[i] - (e->value[j] - e->shift) * y[i];
    }
    double *image_of_it = e->basis + (ptrdiff_t)watched * n;
    matrix_multiply(m, watched, e->basis, image_of_it);
    for (int j = 0; j < watched; j++) {
        e->residual[j] = sqrt(fabs(cblas_ddot(n, e->basis + (ptrdiff_t)j * n, 1, image_of_it + (ptrdiff_t)j * n, 1)));
        worst = fmax(worst, e->residual[j]);
        if (!isfinite(e->residual[j]))
            return INFINITY;
    }
    return worst;
}

int eigen_ritz_pairs(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    return ritz_pairs(e->n, e->count, k, m, e->image, e->value, e->ritz, e->basis, e->projected, e->work);
}

/* One past the last pair of the cluster that begins with pair j */
static int cluster_end(const struct eigen_band *e, int j)
{
    while (j + 1 < e->count && e->value[j + 1] - e->value[j] <= CLUSTER * (fabs(e->value[j + 1]) - e->shift))
        j++;
    return j + 1;
}

/* image := (K - sigma M)^-1 image for `count` <= ARROW_SHIFTS pairs by the arrow. Those that lost a pivot are left and get the
 * shift NAN. */
static void solve_together(struct eigen_band *e, int count, const int *pair, double *sigma)
{
    double shift[ARROW_SHIFTS];
    int negative[ARROW_SHIFTS], n = e->n;
    for (int s = 0; s < ARROW_SHIFTS; s++)
        shift[s] = sigma[pair[s < count ? s : 0]];
    arrow_factor(&e->arrow, shift, negative);
    for (int s = 0; s < ARROW_SHIFTS; s++)
        for (int i = 0; i < n; i++)
            e->rows[(ptrdiff_t)e->row[i] * ARROW_SHIFTS + s] =
                s < count && negative[s] >= 0 ? e->image[i + (ptrdiff_t)pair[s] * n] : 0;
    arrow_solve(&e->arrow, e->rows);
    for (int s = 0; s < count; s++) {
        for (int i = 0; i < n && negative[s] >= 0; i++)
            e->image[i + (ptrdiff_t)pair[s] * n] = e->rows[(ptrdiff_t)e->row[i] * ARROW_SHIFTS + s];
        if (negative[s] < 0)
            sigma[pair[s]] = NAN;
    }
}

/* sigma [count] := the shift of each pair that was solved, else NAN: pairs without a cluster of which more than the tolerance is
 * expected. */
static void solve_by_arrow(struct eigen_band *e, const double *expected, double *sigma)
{
    int pair[ARROW_SHIFTS], waiting = 0;
    for (int begin = 0, end; begin < e->count; begin = end) {
        end = cluster_end(e, begin);
        if (end - begin > 1 || !(expected[begin] > e->within))
            continue;
        sigma[begin] = e->value[begin];
        pair[waiting++] = begin;
        if (waiting == ARROW_SHIFTS) {
            solve_together(e, waiting, pair, sigma);
            waiting = 0;
        }
    }
    if (waiting)
        solve_together(e, waiting, pair, sigma);
}

/* image [n * (end - begin)] := (K - sigma M)^-1 image with the shift of pairs begin ... end - 1, which is returned; NAN: singular
 */
static double solve_shifted(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m, int begin, int end)
{
    double scale = fabs(e->value[begin]) - e->shift, spread = e->value[end - 1] - e->value[begin],
           sigma = end - begin > 1 ? e->value[begin] - fmax(spread, OFFSET * scale) : e->value[begin];
    for (int attempt = 0; attempt < 2; attempt++, sigma -= OFFSET * scale) {
        matrix_combine(1, k, -sigma, m, &e->shifted);
        if (factor_compute(&e->indefinite, &e->shifted))
            continue;
        factor_solve(&e->indefinite, end - begin, e->image + (ptrdiff_t)begin * e->n);
        return sigma;
    }
    return NAN;
}

/* expected [count] := residual that is left of each pair, whose shift and distance to the rest of the spectrum were sigma and gap
 * (NaN: it was not iterated): the angle by which the vector has turned out of its cluster, the pairs with the same shift, times
 * |lambda - sigma|/gap. M times the vectors before is in mass_basis. */
static void expect(struct eigen_band *e, const double *sigma, const double *gap, double *expected)
{
    for (int j = 0; j < e->count; j++) {
        if (isnan(sigma[j]))
            continue;
        double inside = 0;
        for (int i = 0; i < e->count; i++)
            if (sigma[i] == sigma[j]) {
                double cosine = cblas_ddot(e->n, e->ritz + (ptrdiff_t)j * e->n, 1, e->mass_basis + (ptrdiff_t)i * e->n, 1);
                inside += cosine * cosine;
            }
        double turned =
            sqrt(fmax(1 - inside, 4 * DBL_EPSILON)); /* less than that cannot be seen, but is known of the step before */
        expected[j] = fmin(turned, expected[j]) * fabs(e->value[j] - sigma[j]) / gap[j];
    }
}

/* Inverse iteration on all pairs of which more than the tolerance is expected, then Rayleigh-Ritz. Returns 0, or 1 on failure. */
static int iterate(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m, double *expected)
{
    int n = e->n, count = e->count;
    double *sigma = e->shifts, *gap = sigma + count;
    matrix_multiply(m, count, e->ritz, e->mass_basis);
    memcpy(e->image, e->mass_basis, (size_t)n * (size_t)count * sizeof(double));
    for (int j = 0; j < count; j++)
        sigma[j] = NAN;
    if (e->by_arrow)
        solve_by_arrow(e, expected, sigma);
    for (int begin = 0, end; begin < count; begin = end) {
        int good = 1;
        end = cluster_end(e, begin);
        for (int j = begin; j < end; j++)
            good &= expected[j] <= e->within;
        double at = NAN, distance = INFINITY;
        if (good)
            memcpy(e->image + (ptrdiff_t)begin * n, e->ritz + (ptrdiff_t)begin * n,
                   (size_t)n * (size_t)(end - begin) * sizeof(double));
        else if (isnan(at = isnan(sigma[begin]) ? solve_shifted(e, k, m, begin, end) : sigma[begin]))
            return 1;
        if (begin > 0)
            distance = at - e->value[begin - 1];
        if (end < count)
            distance = fmin(distance, e->value[end] - at);
        for (int j = begin; j < end; j++) {
            sigma[j] = at;
            gap[j] = distance;
        }
    }
    if (eigen_ritz_pairs(e, k, m))
        return 1;
    expect(e, sigma, gap, expected);
    return 0;
}

/* Pairs that are not at the tolerance, nor at the rounding with no more to expect: they are open again. */
static int count_open(struct eigen_band *e, double rounding, double *expected)
{
    int open = 0;
    for (int j = 0; j < e->count; j++) {
        if (e->residual[j] <= (j >= e->from && j < e->to ? e->within : EIGEN_POLISH_NEAR) ||
            (expected[j] <= e->within && e->residual[j] <= rounding))
            continue;
        expected[j] = INFINITY;
        open++;
    }
    return open;
}

/* From `count` pairs that are near (ritz, value; e->factor that of K - s M): one solution with K - lambda_j M each and
 * Rayleigh-Ritz on all together cubes their errors. Returns 0 when every residual is as small as the tolerance, or as rounding
 * lets it be where the iteration has no more to give; 1 where it fails: the pairs may then be anything. Nothing is known about
 * pairs that were missed. */
static int eigen_polish(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    double rounding = eigen_rounding(e) / 100, *expected = e->shifts + 2 * (ptrdiff_t)e->count, worst;
    memset(expected, 0, (size_t)e->count * sizeof *expected);
    for (int round = 0; round <= ROUNDS;) {
        if (!isfinite(eigen_residuals(e, m, e->count, e->count)))
            return 1;
        if (!count_open(e, round ? rounding : 0, expected))
            return 0;
        do { /* the residuals are asked again when all are expected to be small */
            if (round++ == ROUNDS || iterate(e, k, m, expected))
                return 1;
            worst = 0;
            for (int j = 0; j < e->count; j++)
                worst = fmax(worst, expected[j]);
        } while (worst > e->within && round < ROUNDS);
    }
    return 1;
}

#define TOLERANCE   1e-12 /* of the residual below: a vector is then as good as its arithmetic */
#define ACCEPTABLE  1e-7  /* after all cycles: eigenvalues are then good to its square */
#define NEAR        0.03  /* residual from which polishing converges */
#define MOST_CYCLES 60    /* where the dense solver stands in */
#define LAST_CYCLES 400   /* where none does: of a spectrum without a gap */
#define FEW_FAR     16 /* full rows, each of which costs an arrow as much as another row of the band, and more with the others */
#define FAILURES    3  /* of polishing, after which it is not tried again: the spectrum is not made for it */
#define GUARDS      5 /* pairs beyond those wanted: the iteration converges as (shifted) lambda_count / lambda_(count + GUARDS) */
#define DEPTH       3 /* Krylov blocks a cycle */

/* Polishing factors K - lambda M for every pair, which costs n (4 kd^2 + 12 kd nfar) operations each and twice; the block
 * iteration takes about three more cycles of 24 n kd and 108 n block for every pair. */
static int is_narrow(const rotid_matrix *structure, int count)
{
    double kd = structure->kd;
    return kd * (kd + 3.0 * structure->nfar) < 10 * kd + 36.0 * count;
}

/* Rows of the arrow: far degrees of freedom last */
static int new_arrow(struct pool *pool, const rotid_matrix *structure, struct eigen_band *e)
{
    int n = structure->n, nfar = structure->nfar;
    e->by_arrow = nfar <= FEW_FAR && !factor_is_wide(structure);
    if (!e->by_arrow)
        return ROTID_OK;
    e->row = POOL_ARRAY(pool, int, n);
    e->rows = POOL_ROOM(pool, double, ARROW_SHIFTS *(size_t)n);
    if (!e->row || !e->rows)
        return ROTID_ERROR_MEMORY;
    for (int i = 0, f = 0, inner = 0; i < n; i++)
        e->row[i] = f < nfar && structure->far[f] == i ? n - nfar + f++ : inner++;
    return arrow_new(pool, n - nfar, structure->kd, nfar, &e->arrow);
}

int eigen_band_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_band *e)
{
    int n = structure->n, block = count + GUARDS < n ? count + GUARDS : n;
    *e = (struct eigen_band){.n = n, .count = count, .block = block, .depth = DEPTH, .to = count, .within = TOLERANCE};
    e->failures = is_narrow(structure, count) ? 0 : FAILURES;
    int width = block * DEPTH;
    e->all = POOL_ARRAY(pool, int, n);
    e->basis = POOL_ROOM(pool, double, (size_t)n *(size_t)width);
    e->mass_basis = POOL_ROOM(pool, double, (size_t)n *(size_t)width);
    e->ritz = POOL_ROOM(pool, double, (size_t)n *(size_t)block);
    e->image = POOL_ROOM(pool, double, (size_t)n *(size_t)block);
    e->value = POOL_ARRAY(pool, double, width);
    e->residual = POOL_ARRAY(pool, double, block);
    e->shifts = POOL_ARRAY(pool, double, 3 * count);
    e->projected = POOL_ROOM(pool, double, (size_t)width *(size_t)width);
    e->work = POOL_ARRAY(pool, double, 2 * n > 34 * width ? 2 * n : 34 * width);
    if (pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < n; i++)
        e->all[i] = i;
    int status = matrix_like(pool, structure, &e->shifted);
    if (!status)
        status = factor_new(pool, FACTOR_CHOLESKY, structure, n, e->all, &e->factor);
    if (!status)
        status = factor_new(pool, FACTOR_CHOLESKY, structure, n, e->all, &e->inertia);
    if (!status)
        status = factor_new(pool, FACTOR_LU, structure, n, e->all, &e->indefinite);
    return status ? status : new_arrow(pool, structure, e);
}

/* Appends x [n] to the `size` M-orthonormal columns of the basis. Returns the new size; x is left out where it adds nothing, and
 * ROTID_ERROR_MASS comes back where x' M x is not positive. Two passes: one leaves errors of the size of the cancellation. */
static int append(struct eigen_band *e, const rotid_matrix *m, int size, const double *x)
{
    int n = e->n;
    double *v = e->basis + (ptrdiff_t)size * n, *mv = e->mass_basis + (ptrdiff_t)size * n;
    memcpy(v, x, (size_t)n * sizeof(double));
    for (int pass = 0; pass < 3; pass++) {
        if (size && pass) {
            cblas_dgemv(CblasColMajor, CblasTrans, n, size, 1, e->mass_basis, n, v, 1, 0, e->work, 1);
            cblas_dgemv(CblasColMajor, CblasNoTrans, n, size, -1, e->basis, n, e->work, 1, 1, v, 1);
        }
        matrix_multiply(m, 1, v, mv);
        double square = cblas_ddot(n, v, 1, mv, 1);
        if (!(square >= 0) && !pass)
            return ROTID_ERROR_MASS;
        if (!(square > 0))
            return size;
        double norm = sqrt(square); /* pass 0 scales, so that pass 1 shows how much of x is new */
        cblas_dscal(n, 1 / norm, v, 1);
        cblas_dscal(n, 1 / norm, mv, 1);
        if (pass == 1 && norm < 1e-12)
            return size;
    }
    return size + 1;
}

/* Rayleigh-Ritz on K in the basis: ritz and value get the lowest `block` pairs. */
static int rayleigh_ritz(struct eigen_band *e, const rotid_matrix *k, int size)
{
    int n = e->n, count = size < e->block ? size : e->block;
    for (int j = 0; j < size; j++) { /* K v, one column at a time, over the mass image that is not needed any more */
        double *kv = e->mass_basis + (ptrdiff_t)j * n;
        matrix_multiply(k, 1, e->basis + (ptrdiff_t)j * n, kv);
    }
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, size, size, n, 1, e->basis, n, e->mass_basis, n, 0, e->projected, size);
    if (LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', size, e->projected, size, e->value, e->work, 34 * size))
        return ROTID_ERROR_EIGEN;
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, count, size, 1, e->basis, n, e->projected, size, 0, e->ritz, n);
    return count < e->count ? ROTID_ERROR_EIGEN : ROTID_OK;
}

static int refactor(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    matrix_combine(1, k, -e->shift, m, &e->shifted);
    return factor_compute(&e->factor, &e->shifted) ? ROTID_ERROR_STIFFNESS : ROTID_OK;
}

/* One cycle: basis = [ritz, image, (K - s M)^-1 M image], new ritz. */
static int cycle(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    int n = e->n, size = 0;
    for (int depth = 0; depth < e->depth && size < n; depth++) {
        int begin = size;
        const double *source = depth ? e->image : e->ritz;
        for (int j = 0; j < e->block && size < n; j++) {
            size = append(e, m, size, source + (ptrdiff_t)j * n);
            if (size < 0)
                return size;
        }
        if (depth && size > begin && depth + 1 < e->depth) {
            memset(e->image, 0, (size_t)n * (size_t)e->block * sizeof(double));
            memcpy(e->image, e->mass_basis + (ptrdiff_t)begin * n, (size_t)n * (size_t)(size - begin) * sizeof(double));
            factor_solve(&e->factor, e->block, e->image);
        }
    }
    return rayleigh_ritz(e, k, size);
}

static int converge(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m, int watched, double tolerance)
{
    /* rounding stops the iteration here; above it, a residual that stays may be a partner of a repeated eigenvalue that comes
     * late */
    double rounding = eigen_rounding(e), worst = INFINITY, previous;
    int most = e->n > EIGEN_DENSE_MOST ? LAST_CYCLES : MOST_CYCLES;
    for (int c = 0; c < most; c++) {
        previous = worst;
        worst = eigen_residuals(e, m, e->block, watched);
        if (!isfinite(worst))
            return ROTID_ERROR_EIGEN;
        if (worst <= tolerance || (c > 1 && worst < rounding && worst > 0.3 * previous))
            return ROTID_OK;
        int status = cycle(e, k, m);
        if (status)
            return status;
    }
    return worst < ACCEPTABLE ? ROTID_OK : ROTID_ERROR_EIGEN;
}

static int choose_shift(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    double shift = shift_of(e->count < 3 ? e->block : e->count, e->value, e->largest);
    if (!(shift < 0) && e->n <= EIGEN_DENSE_MOST)
        return ROTID_ERROR_STIFFNESS;
    e->shift = shift < 0 ? shift : -FIRST_SHIFT * e->largest; /* all that are known may be zero */
    return refactor(e, k, m);
}

/* Motions under smooth loads, cosines along the degrees of freedom: where neighbours have neighbouring numbers, as along a beam,
 * they are near the lowest modes. */
static int start_smooth(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    int n = e->n, size = 0;
    for (int j = 0; j < e->block; j++) {
        double *x = e->ritz + (ptrdiff_t)j * n, now = cos(PI * j / (2.0 * n)), step = 2 * cos(PI * j / n), before = now;
        for (int i = 0; i < n; i++) { /* cos(pi j (i + 1/2)/n) */
            x[i] = now;
            double next = step * now - before;
            before = now;
            now = next;
        }
    }
    matrix_multiply(m, e->block, e->ritz, e->image);
    factor_solve(&e->factor, e->block, e->image);
    for (int j = 0; j < e->block; j++) {
        size = append(e, m, size, e->image + (ptrdiff_t)j * n);
        if (size < 0)
            return size;
    }
    return size < e->block ? ROTID_ERROR_EIGEN : rayleigh_ritz(e, k, size);
}

static int start_random(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    struct random_stream stream = {20240229};
    int n = e->n;
    for (int j = 0; j < e->block; j++) {
        double *x = e->ritz + (ptrdiff_t)j * n;
        for (int i = 0; i < n; i++)
            x[i] = random_normal(&stream);
        matrix_multiply(m, 1, x, e->work); /* residuals are measured in x' M x = 1 */
        cblas_dscal(n, 1 / sqrt(cblas_ddot(n, x, 1, e->work, 1)), x, 1);
        e->value[j] = 0;
    }
    return converge(e, k, m, e->block < 3 ? e->block : 3, 1e-3);
}

static int start(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    e->shift = -FIRST_SHIFT * e->largest;
    int status = refactor(e, k, m);
    if (!status)
        status = e->plain || e->failures ? start_random(e, k, m) : start_smooth(e, k, m);
    return status ? status : choose_shift(e, k, m);
}

/* Refuses what no beam has, the same way whatever was solved before. */
static int check(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    if (factor_compute(&e->inertia, m))
        return ROTID_ERROR_MASS;
    e->largest = highest_of(k, m);
    return e->largest > 0 ? ROTID_OK : ROTID_ERROR_STIFFNESS;
}

/* Are there as many eigenvalues below the shift as values that are known? */
static int all_known_below(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m, double shift, int expected)
{
    while (expected < e->known && e->value[expected] <= shift)
        expected++;
    int negative = e->by_arrow ? arrow_count(&e->arrow, shift) : -1;
    if (negative >= 0)
        return negative == expected;
    matrix_combine(1, k, -shift, m, &e->shifted);
    return factor_negative_count(&e->inertia, &e->shifted) == expected;
}

/* Are there exactly `count` eigenvalues below a shift just above the last one? Rounding limits how near it can be; a neighbour
 * closer than that is counted with it, and the Ritz values beyond `count` tell how many those are. Where more equal the last one
 * than there are vectors, those below it tell; of fewer rows the dense solver has more digits then. */
static int none_missed(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    double last = e->value[e->count - 1];
    if (all_known_below(e, k, m, shift_above(last, e->shift, e->largest), e->count))
        return 1;
    if (e->n <= EIGEN_DENSE_MOST)
        return 0;
    matrix_multiply(k, e->count, e->ritz, e->image);
    return (last >= ZERO * e->largest || all_at_rest(k, e->count, e->ritz, e->image)) &&
           all_known_below(e, k, m, shift_below(last, e->shift, e->largest), 0);
}

/* Ritz pairs of the vectors that are there. */
static int project(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    int size = 0;
    if (!e->plain) {
        memcpy(e->image, e->ritz, (size_t)e->n * (size_t)e->count * sizeof(double));
        return eigen_ritz_pairs(e, k, m) ? ROTID_ERROR_EIGEN : ROTID_OK;
    }
    for (int j = 0; j < e->block; j++) {
        size = append(e, m, size, e->ritz + (ptrdiff_t)j * e->n);
        if (size < 0)
            return size;
    }
    return rayleigh_ritz(e, k, size);
}

/* The vectors of the call before, or those that eigen_band_begin was given, with the new matrices */
static int warm(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    int status = project(e, k, m);
    if (status)
        return status;
    return e->shift < 0 ? refactor(e, k, m) : choose_shift(e, k, m);
}

/* From warm or cold to pairs of which none is missed. */
static int attempt(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
{
    int status = e->started ? warm(e, k, m) : start(e, k, m);
    if (!status && (e->plain || !e->started))
        status = converge(e, k, m, e->count, e->plain ? TOLERANCE : NEAR);
    if (!status && !e->plain && eigen_polish(e, k, m))
        status = ROTID_ERROR_EIGEN;
    e->known = e->plain ? e->block : e->count;
    return status || none_missed(e, k, m) ? status : ROTID_ERROR_EIGEN;
}

void eigen_band_begin(struct eigen_band *e, const double *phi)
{
    size_t known = (size_t)e->n * (size_t)e->count;
    memcpy(e->ritz, phi, known * sizeof *phi);
    memset(e->ritz + known, 0, (size_t)e->n * (size_t)(e->block - e->count) * sizeof *phi);
    e->started = 1;
}

/* Warm and polished; if that fails cold and polished; if that fails cold and plain. */
int eigen_band_solve(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi)
{
    int status = check(e, k, m);
    if (status)
        return status;
    if (e->by_arrow) {
        arrow_take(&e->arrow, &e->arrow.k, k, e->row);
        arrow_take(&e->arrow, &e->arrow.m, m, e->row);
    }
    for (e->plain = e->failures >= FAILURES;;) {
        status = attempt(e, k, m);
        if (!status && e->value[0] < -FIRST_SHIFT * e->largest)
            return ROTID_ERROR_STIFFNESS;
        if (!status) {
            e->started = 1;
            memcpy(lambda, e->value, (size_t)e->count * sizeof(double));
            memcpy(phi, e->ritz, (size_t)e->n * (size_t)e->count * sizeof(double));
            return ROTID_OK;
        }
        if (!e->started) {
            if (e->plain || status != ROTID_ERROR_EIGEN)
                return status;
            e->plain = 1;
            e->failures++;
        }
        e->started = 0;
    }
}
