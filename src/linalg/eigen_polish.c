#include "linalg/eigen_polish.h"

#include <cblas.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "linalg/matrix.h"
#include "linalg/ritz.h"

#define ROUNDS  4    /* the error is cubed in each */
#define CLUSTER 1e-3 /* eigenvalues nearer than this share a shift: one of its own would turn both vectors into one */
#define NEAR    1e-2 /* of the residual of a pair that is not wanted */
#define OFFSET  1e-7 /* of that shift below the lowest of them */

double eigen_rounding(const struct eigen_band *e)
{
    return fmin(1e-4, 16 * DBL_EPSILON * e->largest / -e->shift);
}

double eigen_residuals(struct eigen_band *e, const rotid_matrix *m, int columns, int watched)
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

static int is_wanted(const struct eigen_band *e, int pair)
{
    return pair >= e->from && pair < e->to;
}

/* Pairs that are not at the tolerance, nor at the rounding with no more to expect: they are open again. */
static int count_open(struct eigen_band *e, double rounding, double *expected)
{
    int open = 0;
    for (int j = 0; j < e->count; j++) {
        if (e->residual[j] <= (is_wanted(e, j) ? e->within : NEAR) || (expected[j] <= e->within && e->residual[j] <= rounding))
            continue;
        expected[j] = INFINITY;
        open++;
    }
    return open;
}

int eigen_polish(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m)
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
