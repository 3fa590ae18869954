#include <cblas.h>
#include <lapacke.h>

#include "linalg/linalg.h"

#define TOLERANCE 2e-12 /* of the residual of a pair: a vector is then as good as its arithmetic */
#define ROUGH     1e-3  /* of it, where eigenvalues are sought for their size */
#define NEAR      1e-4  /* of it, of a pair that is not wanted: its eigenvalue is off by the square of that */
#define GUARDS    5     /* pairs beyond those wanted that are kept: of equal eigenvalues, that many may follow the last */
#define REPAIRS   4     /* times that random vectors look for pairs that were missed */

int eigen_wide_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_wide *e)
{
    int n = structure->n, block = count + GUARDS < n ? count + GUARDS : n;
    *e = (struct eigen_wide){.n = n, .count = count, .block = block, .to = count, .within = TOLERANCE};
    e->all = POOL_ARRAY(pool, int, n);
    e->ritz = POOL_ARRAY(pool, double, (size_t)n *(size_t)block);
    e->value = POOL_ARRAY(pool, double, block);
    e->tolerance = POOL_ARRAY(pool, double, block);
    if (!e->all || !e->ritz || !e->value || !e->tolerance)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < n; i++)
        e->all[i] = i;
    int status = pencil_new(pool, structure, &e->pencil);
    if (!status)
        status = factor_new(pool, FACTOR_CHOLESKY, structure, n, e->all, &e->factor);
    return status ? status : lanczos_new(pool, &e->pencil, &e->factor, count, block, &e->lanczos);
}

/* ritz and value := the lowest pairs of the basis */
static void take_pairs(struct eigen_wide *e)
{
    int pairs = lanczos_known(&e->lanczos);
    lanczos_vectors(&e->lanczos, pairs, e->ritz);
    for (int j = 0; j < e->block; j++) {
        double theta = j < pairs ? lanczos_theta(&e->lanczos, j) : 0;
        e->value[j] = theta > 0 ? 1 / theta + e->shift : INFINITY;
    }
}

static int iterate(struct eigen_wide *e, int watched, double wanted, double others)
{
    for (int j = 0; j < e->block; j++)
        e->tolerance[j] = j >= e->from && j < e->to ? wanted : others;
    return lanczos_iterate(&e->lanczos, watched, e->tolerance);
}

/* The iteration begins with the vectors in ritz. */
static int begin(struct eigen_wide *e)
{
    lanczos_begin(&e->lanczos, e->ritz);
    return factor_compute_pencil(&e->factor, &e->pencil, e->shift) ? ROTID_ERROR_STIFFNESS : ROTID_OK;
}

/* Returns 0 where no eigenvalue is known that has the size for one: all may be zero, and the shift stays. */
static int choose_shift(struct eigen_wide *e)
{
    double shift = shift_of(e->block, e->value, e->largest);
    if (shift < 0)
        e->shift = shift;
    return shift < 0;
}

static int start(struct eigen_wide *e)
{
    struct random_stream stream = {20240229};
    for (ptrdiff_t i = 0; i < (ptrdiff_t)e->n * e->count; i++)
        e->ritz[i] = random_normal(&stream);
    e->shift = -FIRST_SHIFT * e->largest;
    int status = begin(e);
    if (!status)
        status = iterate(e, e->block < 3 ? e->block : 3, ROUGH, ROUGH);
    if (status)
        return status;
    take_pairs(e);
    return choose_shift(e) || e->n > EIGEN_DENSE_MOST ? ROTID_OK : ROTID_ERROR_STIFFNESS;
}

/* Refuses what no rotor has, the same way whatever was solved before. */
static int check(struct eigen_wide *e, const rotid_matrix *k, const rotid_matrix *m)
{
    struct pencil *p = &e->pencil;
    if ((!pencil_take(p, k, m) || !e->definite) && !e->vouched)
        e->definite = !factor_compute(&e->factor, m);
    if (!e->definite && !e->vouched)
        return ROTID_ERROR_MASS;
    e->largest = highest_of(k, m);
    return e->largest > 0 ? ROTID_OK : ROTID_ERROR_STIFFNESS;
}

/* The number of eigenvalues below a shift just above the last pair, which rounding limits in how near it can be, less that of the
 * Ritz values there: 0 proves that none was missed, also of those that lie between the last pair and the shift. Ritz values lie
 * above the eigenvalues that they belong to, so no fewer can be there. More may equal the last pair than are kept: where the
 * pairs below them are all that are there, none was missed either. -1 where that does not hold or the count fails. */
static int count_missed(struct eigen_wide *e)
{
    double shift = shift_above(e->value[e->count - 1], e->shift, e->largest);
    int known = e->count;
    while (known < e->block && e->value[known] <= shift)
        known++;
    int below = factor_negative_count_pencil(&e->factor, &e->pencil, shift);
    if (below >= 0 && below <= e->block)
        return below - known;
    if (e->n <= EIGEN_DENSE_MOST) /* the dense solver has more digits then */
        return -1;
    double last = e->value[e->count - 1];
    pencil_multiply_stiffness(&e->pencil, e->count, e->ritz, e->lanczos.image);
    if (last < ZERO * e->largest && !all_at_rest(e->pencil.stiffness, e->count, e->ritz, e->lanczos.image))
        return -1;
    shift = shift_below(last, e->shift, e->largest);
    for (known = 0; known < e->count && e->value[known] <= shift;)
        known++;
    return factor_negative_count_pencil(&e->factor, &e->pencil, shift) == known ? 0 : -1;
}

/* From the vectors in ritz to pairs of which none is missed. Equal eigenvalues beyond the number of vectors come late, and with
 * new random vectors: as many as were missed. */
static int attempt(struct eigen_wide *e)
{
    int status = begin(e), watched = e->count;
    for (int repair = 0; !status; repair++) {
        status = iterate(e, watched, e->within, fmax(e->within, NEAR));
        if (status)
            break;
        take_pairs(e);
        int missed = count_missed(e);
        if (!missed)
            return ROTID_OK;
        if (repair == REPAIRS || missed < 0)
            return ROTID_ERROR_EIGEN;
        watched = watched + missed < e->block ? watched + missed : e->block;
        status =
            factor_compute_pencil(&e->factor, &e->pencil, e->shift) ? ROTID_ERROR_EIGEN : lanczos_extend(&e->lanczos, missed);
    }
    return status;
}

/* lambda and phi from ritz: the quotients with K and M themselves have less rounding than the values of the iteration */
static void give(struct eigen_wide *e, double *lambda, double *phi)
{
    int n = e->n;
    double *image = e->lanczos.image;
    memcpy(phi, e->ritz, (size_t)n * (size_t)e->count * sizeof *phi);
    pencil_multiply_mass(&e->pencil, e->count, phi, image);
    for (int j = 0; j < e->count; j++) {
        double square = cblas_ddot(n, phi + (ptrdiff_t)j * n, 1, image + (ptrdiff_t)j * n, 1);
        cblas_dscal(n, 1 / sqrt(square), phi + (ptrdiff_t)j * n, 1);
    }
    pencil_multiply_stiffness(&e->pencil, e->count, phi, image);
    for (int j = 0; j < e->count; j++) {
        double value = cblas_ddot(n, phi + (ptrdiff_t)j * n, 1, image + (ptrdiff_t)j * n, 1);
        int at = j;
        for (; at > 0 && lambda[at - 1] > value; at--) { /* of rigid motions, rounding is all there is */
            lambda[at] = lambda[at - 1];
            cblas_dswap(n, phi + (ptrdiff_t)at * n, 1, phi + (ptrdiff_t)(at - 1) * n, 1);
        }
        lambda[at] = value;
    }
}

/* Of the vectors in ritz: their Rayleigh quotients, the sizes of the eigenvalues */
static int choose_first_shift(struct eigen_wide *e)
{
    int n = e->n;
    double *image = e->lanczos.image;
    pencil_multiply_mass(&e->pencil, e->count, e->ritz, image);
    for (int j = 0; j < e->block; j++)
        e->value[j] =
            j < e->count ? 1 / cblas_ddot(n, e->ritz + (ptrdiff_t)j * n, 1, image + (ptrdiff_t)j * n, 1) : (double)INFINITY;
    pencil_multiply_stiffness(&e->pencil, e->count, e->ritz, image);
    for (int j = 0; j < e->count; j++)
        e->value[j] *= cblas_ddot(n, e->ritz + (ptrdiff_t)j * n, 1, image + (ptrdiff_t)j * n, 1);
    return choose_shift(e);
}

int eigen_wide_solve(struct eigen_wide *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi)
{
    int status = check(e, k, m);
    if (status)
        return status;
    int warm = e->started && (e->shift < 0 || choose_first_shift(e));
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

#define SMALL 8 /* no difference in time; and any number of eigenvalues may be zero */
#define LARGE 600

/* Fitted to times of both, one cold and three warm solutions with one thread, n = 42 to 1200, of any kd and count: it takes 2.5
 * times as long as the better one at worst, where both take a millisecond. From LARGE on few pairs take longer by the dense
 * solution however wide the band is: twice as long at n = 948, kd = 577. */
static int is_dense(const rotid_matrix *structure, int count)
{
    double n = structure->n, by_count = 0.15 * count * sqrt(n);
    return n <= SMALL || count == structure->n || (n < LARGE ? 2.5 * structure->kd : 0) + by_count >= n;
}

int eigen_full_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_full *e)
{
    *e = (struct eigen_full){0};
    if (is_dense(structure, count))
        return eigen_full_new_dense(pool, structure, count, e);
    e->wide = factor_is_wide(structure);
    return e->wide ? eigen_wide_new(pool, structure, count, &e->panels) : eigen_band_new(pool, structure, count, &e->band);
}

int eigen_full_new_dense(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_full *e)
{
    size_t n = (size_t)structure->n, columns = (size_t)count;
    *e = (struct eigen_full){.dense = 1};
    e->k = POOL_ARRAY(pool, double, n *n);
    e->m = POOL_ARRAY(pool, double, n *n);
    e->image = POOL_ARRAY(pool, double, n *columns);
    e->product = POOL_ARRAY(pool, double, n *columns);
    e->squares = POOL_ARRAY(pool, double, 2 * columns * columns);
    e->work = POOL_ARRAY(pool, double, RITZ_WORK *columns);
    if (!e->k || !e->m || !e->image || !e->product || !e->squares || !e->work)
        return ROTID_ERROR_MEMORY;
    return eigen_dense_new(pool, structure->n, count, &e->solver);
}

void eigen_full_want(struct eigen_full *e, int from, int to)
{
    e->panels.from = e->band.from = from;
    e->panels.to = e->band.to = to;
}

void eigen_full_within(struct eigen_full *e, double residual)
{
    e->panels.within = e->band.within = residual;
}

void eigen_full_begin(struct eigen_full *e, const double *phi)
{
    if (e->wide) {
        memcpy(e->panels.ritz, phi, (size_t)e->panels.n * (size_t)e->panels.count * sizeof *phi);
        e->panels.started = 1;
    } else if (!e->dense)
        eigen_band_begin(&e->band, phi);
}

int eigen_full_correct(struct eigen_full *e, const rotid_matrix *k, const rotid_matrix *m, double lambda, int columns, double *x)
{
    struct factor *factor = e->wide ? &e->panels.factor : &e->band.factor;
    int status = ROTID_ERROR_STIFFNESS;
    if (e->wide)
        status = factor_compute_pencil(factor, &e->panels.pencil, lambda);
    else if (!e->dense) {
        matrix_combine(1, k, -lambda, m, &e->band.shifted);
        status = factor_compute(factor, &e->band.shifted);
    }
    if (status)
        return ROTID_ERROR_STIFFNESS;
    factor_solve(factor, columns, x);
    return ROTID_OK;
}

int eigen_full_solve(struct eigen_full *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi)
{
    int n = k->n, count = e->solver.count;
    if (e->wide)
        return eigen_wide_solve(&e->panels, k, m, lambda, phi);
    if (!e->dense)
        return eigen_band_solve(&e->band, k, m, lambda, phi);
    matrix_to_dense(k, n, e->k);
    matrix_to_dense(m, n, e->m);
    int status = eigen_dense_solve(&e->solver, e->k, e->m, lambda, phi);
    if (status)
        return status;
    matrix_multiply(m, count, phi, e->image);
    /* (K - s M)^-1 with the shift of that solution */
    (void)LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', n, count, e->solver.b, n, e->image, n);
    double *value = e->k, *vector = e->m; /* not needed any more */
    if (!ritz_pairs(n, count, k, m, e->image, value, vector, e->product, e->squares, e->work)) {
        memcpy(lambda, value, (size_t)count * sizeof *lambda);
        memcpy(phi, vector, (size_t)n * (size_t)count * sizeof *phi);
        return ROTID_OK;
    }
    matrix_multiply(m, count, phi, e->image);
    for (int j = 0; j < count; j++) { /* the solver's phi' (K - s M) phi = 1 says little of M where lambda is large */
        double *x = phi + (ptrdiff_t)j * n;
        cblas_dscal(n, 1 / sqrt(cblas_ddot(n, x, 1, e->image + (ptrdiff_t)j * n, 1)), x, 1);
    }
    return ROTID_OK;
}
