#include "ema/lscf.h"
#include "ema/next_roots.h"
#include "ema/poles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/order.h"
#include "base/parallel.h"
#include "linalg/cholesky.h"
#include "linalg/product.h"
#include "linalg/roots.h"

#define PI 3.141592653589793

/* lines whose powers stand in memory at a time: 512 lines of 100 powers stay in the cache */
#define BLOCK        512
#define MOST_AT_ONCE 24 /* channels that share the powers of a block */

struct sums { /* a group of channels */
    const struct ema_band *band;
    int order;
    const double *spacing, *median; /* [nline]; [nchannel] of 1/variance or of 1/mean |H|^2 */
    double *result;                 /* [4 (order + 1) * nchannel]: r, t, p of cosines, q of sines */
    double **work;
    int group;
};

static size_t sums_workspace(int order)
{
    size_t powers = (size_t)order + 1;
    return (size_t)2 * BLOCK * powers + (size_t)BLOCK * 4 * MOST_AT_ONCE + powers * 4 * MOST_AT_ONCE;
}

/* cosines and sines [lines * (order + 1)] of j theta, by rotation: its error grows as j eps */
static void powers_of_block(const struct ema_band *band, int order, int first, int lines, double *cosine, double *sine)
{
    for (int i = 0; i < lines; i++) {
        double theta = PI * (band->omega[first + i] - band->low) / (band->high - band->low), c1 = cos(theta), s1 = sin(theta);
        double c = 1, s = 0;
        for (int j = 0; j <= order; j++) {
            cosine[i + (ptrdiff_t)j * lines] = c;
            sine[i + (ptrdiff_t)j * lines] = s;
            double next = c * c1 - s * s1;
            s = c * s1 + s * c1;
            c = next;
        }
    }
}

static double line_weight(const struct sums *sums, int c, int i)
{
    const struct ema_band *band = sums->band;
    double median = sums->median[c];
    if (!band->variance)
        return sums->spacing[i] * median;
    double weight = 1 / band->variance[i + (ptrdiff_t)c * band->nline];
    return sums->spacing[i] * fmin(fmax(weight, median / 100), median * 100);
}

/* r_j = sum w cos j theta, t_j = sum w |H|^2 cos j theta, p_j = sum w Re H cos j theta, q_j = sum w Im H sin j theta */
static int sum_group(void *context, int index, int worker)
{
    const struct sums *sums = context;
    const struct ema_band *band = sums->band;
    int n = sums->order + 1, from = index * sums->group;
    int channels = band->nchannel - from < sums->group ? band->nchannel - from : sums->group;
    double *cosine = sums->work[worker], *sine = cosine + (ptrdiff_t)BLOCK * n, *even = sine + (ptrdiff_t)BLOCK * n;
    double *odd = even + (ptrdiff_t)BLOCK * 3 * channels, *part = even + (ptrdiff_t)BLOCK * 4 * MOST_AT_ONCE;
    for (int first = 0; first < band->nline; first += BLOCK) {
        int lines = band->nline - first < BLOCK ? band->nline - first : BLOCK;
        powers_of_block(band, sums->order, first, lines, cosine, sine);
        for (int k = 0; k < channels; k++) {
            const double complex *h = band->h + (ptrdiff_t)(from + k) * band->nline + first;
            double *column = even + (ptrdiff_t)3 * k * lines, *last = odd + (ptrdiff_t)k * lines;
            for (int i = 0; i < lines; i++) {
                double w = line_weight(sums, from + k, first + i), re = creal(h[i]), im = cimag(h[i]);
                column[i] = w;
                column[i + lines] = w * (re * re + im * im);
                column[i + 2 * lines] = w * re;
                last[i] = w * im;
            }
        }
        double *odd_part = part + (ptrdiff_t)n * 3 * channels;
        product_transposed(n, 3 * channels, lines, cosine, even, part);
        product_transposed(n, channels, lines, sine, odd, odd_part);
        for (int k = 0; k < channels; k++) {
            double *result = sums->result + (ptrdiff_t)4 * n * (from + k);
            for (int j = 0; j < 3 * n; j++)
                result[j] += part[(ptrdiff_t)3 * n * k + j];
            for (int j = 0; j < n; j++)
                result[3 * n + j] += odd_part[(ptrdiff_t)n * k + j];
        }
    }
    return 0;
}

/* normal += T - X' R^-1 X of one channel; r, x [n * n] workspace */
static void add_channel(int n, const double *sum, double *r, double *x, double *y, double *normal)
{
    const double *rs = sum, *ts = rs + n, *ps = ts + n, *qs = ps + n;
    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++) {
            int lag = abs(k - j);
            /* uneven lines may leave R semidefinite: 1e-12 of its diagonal is below what the coefficients are known to */
            r[j + (ptrdiff_t)k * n] = rs[lag] * (lag ? 1 : 1 + 1e-12);
            x[j + (ptrdiff_t)k * n] = ps[lag] - (k > j ? qs[lag] : -qs[lag]);
        }
    if (cholesky_factor(n, r))
        return;
    cholesky_forward(n, r, n, x);
    product_gram(n, n, x, y);
    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++)
            normal[j + (ptrdiff_t)k * n] += ts[abs(k - j)] - y[j + (ptrdiff_t)k * n];
}

static void weights(const struct ema_band *band, double *spacing, double *median, double *scratch)
{
    int n = band->nline;
    for (int i = 0; i < n; i++) {
        double before = band->omega[i > 0 ? i - 1 : 0], after = band->omega[i + 1 < n ? i + 1 : n - 1];
        spacing[i] = (after - before) / (band->high - band->low) / (i > 0 && i + 1 < n ? 2 : 1);
    }
    for (int c = 0; c < band->nchannel; c++) {
        if (band->variance) {
            for (int i = 0; i < n; i++)
                scratch[i] = 1 / band->variance[i + (ptrdiff_t)c * n];
            median[c] = double_of_rank((size_t)n, (size_t)n / 2, scratch);
            continue;
        }
        double sum = 0;
        for (int i = 0; i < n; i++) {
            double size = cabs(band->h[i + (ptrdiff_t)c * n]);
            sum += spacing[i] * size * size;
        }
        median[c] = sum > 0 ? 1 / sum : 0;
    }
}

int lscf_normal_matrix(struct pool *pool, const struct ema_band *band, int order, int threads, double *normal)
{
    int n = order + 1, group = band->nchannel < MOST_AT_ONCE ? band->nchannel : MOST_AT_ONCE;
    int tasks = group ? (band->nchannel + group - 1) / group : 0, workers = threads < tasks ? threads : tasks;
    double *spacing = POOL_ARRAY(pool, double, band->nline), *median = POOL_ARRAY(pool, double, band->nchannel);
    double *scratch = POOL_ARRAY(pool, double, band->nline), **work = POOL_ARRAY(pool, double *, workers > 0 ? workers : 1);
    double *result = POOL_ARRAY(pool, double, (size_t)4 * (size_t)n * (size_t)band->nchannel);
    double *matrices = POOL_ARRAY(pool, double, (size_t)3 * (size_t)n * (size_t)n);
    if (!spacing || !median || !scratch || !work || !result || !matrices)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < (workers > 0 ? workers : 1); i++)
        if (!(work[i] = POOL_ARRAY(pool, double, sums_workspace(order))))
            return ROTID_ERROR_MEMORY;
    weights(band, spacing, median, scratch);
    struct sums sums = {
        .band = band, .order = order, .spacing = spacing, .median = median, .result = result, .work = work, .group = group};
    (void)parallel_for(workers, tasks, sum_group, &sums);
    memset(normal, 0, (size_t)n * (size_t)n * sizeof(double));
    for (int c = 0; c < band->nchannel; c++)
        add_channel(n, result + (ptrdiff_t)4 * n * c, matrices, matrices + (ptrdiff_t)n * n, matrices + (ptrdiff_t)2 * n * n,
                    normal);
    return ROTID_OK;
}

/* The poles above the lower end, from the roots 1/z of the reversed polynomial. */
static int keep_poles(const struct ema_band *band, int m, const double complex *root, double complex *pole)
{
    double t = PI / (band->high - band->low);
    int kept = 0;
    for (int j = 0; j < m; j++) {
        double size = cabs(root[j]), theta = -carg(root[j]);
        if (size > 0 && theta > 0 && theta < PI)
            pole[kept++] = CMPLX(-log(size) / t, band->low + theta / t);
    }
    sort_poles((size_t)kept, pole);
    return kept;
}

int lscf_poles(struct pool *pool, const struct ema_band *band, int order, int step, double *normal, int *count,
               double complex *pole)
{
    int n = order + 1;
    double *block = POOL_ARRAY(pool, double, (size_t)order *(size_t)order), *right = POOL_ARRAY(pool, double, order);
    double *a = POOL_ARRAY(pool, double, order), *work = POOL_ARRAY(pool, double, polynomial_roots_workspace(order));
    double complex *root = POOL_ARRAY(pool, double complex, order), *before = POOL_ARRAY(pool, double complex, order);
    int *done = POOL_ARRAY(pool, int, order);
    if (!block || !right || !a || !work || !root || !before || !done)
        return ROTID_ERROR_MEMORY;
    /* Without noise M is singular past the true order: a ridge at the rounding of the sums stands in for the noise. */
    for (double ridge = 1e-14;; ridge *= 10) {
        for (int k = 0; k < order; k++)
            for (int j = 0; j < order; j++)
                block[j + (ptrdiff_t)k * order] = normal[j + 1 + (ptrdiff_t)(k + 1) * n] * (j == k ? 1 + ridge : 1);
        if (!cholesky_factor(order, block))
            break;
        if (ridge > 1e-3)
            return ROTID_ERROR_EIGEN;
    }
    for (int j = 0; j < order; j++)
        right[j] = -normal[j + 1];
    cholesky_forward(order, block, 1, right);
    for (int i = 0, m = step; m <= order; i++, m += step) {
        memcpy(a, right, (size_t)m * sizeof(double));
        cholesky_backward_leading(m, order, block, a);
        if ((m == step || step != 2 || next_roots(m, a, before, root, done, work)) && polynomial_roots(m, a, root, work))
            return ROTID_ERROR_EIGEN;
        memcpy(before, root, (size_t)m * sizeof *root);
        count[i] = keep_poles(band, m, root, pole + (ptrdiff_t)i * order);
    }
    return ROTID_OK;
}
