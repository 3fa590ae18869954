#include "ema/ema.h"
#include "linalg/linalg.h"

#define STEPS   60
#define PRECISE 4e-16 /* of a root: a step below it is rounding */
#define REAL_PART                                                                                                                \
    1e-11 /* an imaginary part below that of the size is rounding; a pole so near to the end of the band is none                 \
           */

struct number { /* complex: the product of C guards against infinities at ten times the cost */
    double re, im;
};

static struct number inverse(double re, double im)
{
    double d = 1 / (re * re + im * im);
    return (struct number){re * d, -im * d};
}

/* p'/p at x, by the reversed polynomial outside of the unit circle; *small: p is no more than its own rounding */
static struct number logarithmic_derivative(int n, const double *c, double re, double im, int *small)
{
    int outside = re * re + im * im > 1;
    struct number at = outside ? inverse(re, im) : (struct number){re, im};
    double size = sqrt(at.re * at.re + at.im * at.im), first = outside ? c[n - 1] : 1, bound = fabs(first);
    struct number p = {first, 0}, d = {0, 0};
    for (int j = 0; j < n; j++) {
        double next = outside ? (j < n - 1 ? c[n - 2 - j] : 1) : c[j], old = d.re;
        d.re = d.re * at.re - d.im * at.im + p.re;
        d.im = old * at.im + d.im * at.re + p.im;
        old = p.re;
        p.re = p.re * at.re - p.im * at.im + next;
        p.im = old * at.im + p.im * at.re;
        bound = bound * size + fabs(next);
    }
    *small = p.re * p.re + p.im * p.im <= 1e-31 * bound * bound;
    if (!(p.re * p.re + p.im * p.im > 0))
        return (struct number){0, 0};
    struct number i = inverse(p.re, p.im), ratio = {d.re * i.re - d.im * i.im, d.re * i.im + d.im * i.re};
    if (!outside)
        return ratio;
    /* p(x) = x^n q(1/x): p'/p = y (n - y q'/q) */
    struct number rest = {n - (at.re * ratio.re - at.im * ratio.im), -(at.re * ratio.im + at.im * ratio.re)};
    return (struct number){at.re * rest.re - at.im * rest.im, at.re * rest.im + at.im * rest.re};
}

static struct number repulsion(int n, const double complex *root, int i)
{
    struct number sum = {0, 0};
    double re = creal(root[i]), im = cimag(root[i]);
    for (int j = 0; j < n; j++) {
        if (j == i)
            continue;
        struct number one = inverse(re - creal(root[j]), im - cimag(root[j]));
        sum.re += one.re;
        sum.im += one.im;
    }
    return sum;
}

static void start(int n, const double *c, const double complex *before, double complex *root, double *angle)
{
    double product = 1, best = 0, where = PI / 2;
    for (int i = 0; i < n - 2; i++) {
        product *= cabs(before[i]);
        /* off the axis, which a pair of real ones could not leave to become a complex one */
        root[i] = fabs(cimag(before[i])) > 0 ? before[i] : before[i] * CMPLX(1, i % 2 ? 1e-2 : -1e-2);
        angle[i] = carg(root[i]);
    }
    for (int i = 0; i < n - 2; i++) {
        double from = angle[i], gap = PI - from;
        for (int j = 0; j < n - 2; j++)
            if (angle[j] > from && angle[j] - from < gap)
                gap = angle[j] - from;
        if (from >= 0 && gap > best) {
            best = gap;
            where = from + gap / 2;
        }
    }
    double size = fmin(fmax(sqrt(fabs(c[n - 1]) / fmax(product, 1e-300)), 0.5), 2);
    root[n - 2] = CMPLX(size * cos(where), size * sin(where));
    root[n - 1] = conj(root[n - 2]) * 1.001; /* no symmetry that every step would keep */
}

/* Real roots on the axis, others exactly in pairs. Returns 0, or 1 where one has no partner. */
static int pair_up(int n, double complex *root, int *done)
{
    for (int i = 0; i < n; i++) {
        done[i] = fabs(cimag(root[i])) <= REAL_PART * cabs(root[i]);
        if (done[i])
            root[i] = creal(root[i]);
    }
    for (int i = 0; i < n; i++) {
        int partner = -1;
        double nearest = INFINITY;
        if (done[i])
            continue;
        for (int j = 0; j < n; j++)
            if (j != i && !done[j] && cabs(root[j] - conj(root[i])) < nearest) {
                partner = j;
                nearest = cabs(root[j] - conj(root[i]));
            }
        /* a double root is known to the root of the rounding */
        if (partner < 0 || !(nearest < 1e-6 * cabs(root[i])))
            return 1;
        root[partner] = conj(root[i]);
        done[i] = done[partner] = 1;
    }
    return 0;
}

int next_roots(int n, const double *c, const double complex *before, double complex *root, int *done, double *angle)
{
    for (int i = 0; i < n; i++) {
        done[i] = 0;
        if (!isfinite(c[i]))
            return 1;
    }
    start(n, c, before, root, angle);
    int left = n;
    for (int step = 0; step < STEPS && left; step++)
        for (int i = 0; i < n; i++) {
            int small;
            if (done[i])
                continue;
            struct number newton = logarithmic_derivative(n, c, creal(root[i]), cimag(root[i]), &small);
            struct number other = repulsion(n, root, i), move = inverse(newton.re - other.re, newton.im - other.im);
            if (!small && !(isfinite(move.re) && isfinite(move.im)))
                return 1;
            if (!small)
                root[i] -= CMPLX(move.re, move.im);
            if (small || hypot(move.re, move.im) <= PRECISE * cabs(root[i])) {
                done[i] = 1;
                left--;
            }
        }
    return left || pair_up(n, root, done);
}

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

/* normal [(order + 1)^2] := M. Weights: line spacing (so that uneven lines stand for the band that they cover), times 1/variance
 * where known, kept within a factor 100 of its median, else 1/mean |H|^2 of the channel. 1 <= order < nline. threads share the
 * channels; the result does not depend on their number. ROTID_OK, ROTID_ERROR_MEMORY. */
static int lscf_normal_matrix(struct pool *pool, const struct ema_band *band, int order, int threads, double *normal)
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

/* Poles of all orders step, 2 step, ... <= order from the leading blocks of M, with a_0 = 1: the coefficient of lowest power is
 * held because the roots that only fit noise then lie outside the unit circle (the reversed polynomial is that of a linear
 * prediction, whose roots lie inside), which is negative damping, while physical ones decay. count [order/step] of each order,
 * pole [(order/step) * order] column by column: those of positive theta only, lambda = log(z)/T + i low, T = pi/(high - low),
 * rising in imaginary part. M is overwritten. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_ERROR_EIGEN. */
static int lscf_poles(struct pool *pool, const struct ema_band *band, int order, int step, double *normal, int *count,
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

#define OVERDAMPED  0.2
#define LOOSER      4 /* damping of a track, over that of a stable pole */
#define GAP         2 /* orders that a track may advance at a time */
#define LEAST_TRACK 4
#define TRACK_SHARE 8 /* of the orders */
#define PICK_REACH  0.02

static double damping_of(double complex pole)
{
    return -creal(pole) / cabs(pole);
}

/* |a - b|/|b| of frequency and of damping */
static double frequency_change(double complex a, double complex b)
{
    return fabs(cabs(a) / cabs(b) - 1);
}

static double damping_change(double complex a, double complex b)
{
    return fabs(damping_of(a) / damping_of(b) - 1);
}

static void mark_stable(struct stabilisation *s, int i)
{
    for (int k = s->first[i]; k < s->first[i + 1]; k++) {
        for (int j = i ? s->first[i - 1] : 0; i && j < s->first[i]; j++) {
            if (frequency_change(s->pole[k], s->pole[j]) > s->frequency_tolerance)
                continue;
            s->table[k].stable_frequency = 1;
            if (damping_of(s->pole[k]) > 0 && damping_change(s->pole[k], s->pole[j]) <= s->damping_tolerance)
                s->table[k].stable_damping = 1;
        }
    }
}

int stabilisation_compute(struct pool *pool, const struct ema_band *band, int order, double decay,
                          const struct ema_options *options, struct stabilisation *out)
{
    int step = 2, norder = order / step;
    order = norder * step;
    *out = (struct stabilisation){.norder = norder,
                                  .step = step,
                                  .order = order,
                                  .frequency_tolerance = options->frequency_tolerance,
                                  .damping_tolerance = options->damping_tolerance};
    double *normal = POOL_ARRAY(pool, double, (size_t)(order + 1) * (size_t)(order + 1));
    double complex *raw = POOL_ARRAY(pool, double complex, (size_t)norder *(size_t)order);
    int *count = POOL_ARRAY(pool, int, norder);
    out->first = POOL_ARRAY(pool, int, norder + 1);
    if (!normal || !raw || !count || !out->first)
        return ROTID_ERROR_MEMORY;
    int status = lscf_normal_matrix(pool, band, order, options->threads, normal);
    if (status == ROTID_OK)
        status = lscf_poles(pool, band, order, step, normal, count, raw);
    if (status != ROTID_OK)
        return status;
    for (int i = 0; i < norder; i++)
        out->first[i + 1] = out->first[i] + count[i];
    out->npole = out->first[norder];
    out->pole = POOL_ARRAY(pool, double complex, out->npole);
    out->table = POOL_ARRAY(pool, struct ema_pole, out->npole);
    if (!out->pole || !out->table)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < norder; i++) {
        for (int k = 0; k < count[i]; k++) {
            double complex pole = raw[k + (ptrdiff_t)i * order], free = pole + decay;
            out->pole[out->first[i] + k] = pole;
            out->table[out->first[i] + k] = (struct ema_pole){
                .order = (i + 1) * step, .frequency_hz = cabs(free) / TWO_PI, .damping = damping_of(free), .mode = ROTID_NONE};
        }
        mark_stable(out, i);
    }
    return ROTID_OK;
}

struct track {
    int begin, end, length; /* orders, number of poles */
    int taken;              /* pole of the order at hand */
    int last;               /* pole */
};

/* Distance of a pole from another one in tolerances, that of the damping fourfold, or INFINITY. */
static double distance(const struct stabilisation *s, double complex pole, double complex from)
{
    double df = frequency_change(pole, from) / s->frequency_tolerance;
    double dz = damping_change(pole, from) / (LOOSER * s->damping_tolerance);
    return df <= 1 && dz <= 1 ? df + dz : INFINITY;
}

/* Extends the tracks by the poles of order i, nearest pairs first; what is left over begins a track. Returns the number of
 * tracks. */
static int follow(const struct stabilisation *s, int i, int ntrack, struct track *track, int *owner)
{
    int begin = s->first[i], end = s->first[i + 1];
    for (int t = 0; t < ntrack; t++)
        track[t].taken = -1;
    for (;;) {
        double best = INFINITY;
        int best_track = -1, best_pole = -1;
        for (int k = begin; k < end; k++) {
            double zeta = damping_of(s->pole[k]);
            if (owner[k] >= 0 || !(zeta > 0 && zeta < OVERDAMPED))
                continue;
            for (int t = 0; t < ntrack; t++) {
                if (track[t].taken >= 0 || track[t].end < i - GAP)
                    continue;
                double d = distance(s, s->pole[k], s->pole[track[t].last]);
                if (d < best) {
                    best = d;
                    best_track = t;
                    best_pole = k;
                }
            }
        }
        if (best_track < 0)
            break;
        owner[best_pole] = best_track;
        track[best_track].taken = track[best_track].last = best_pole;
        track[best_track].end = i;
        track[best_track].length++;
    }
    for (int k = begin; k < end; k++) {
        double zeta = damping_of(s->pole[k]);
        if (owner[k] < 0 && zeta > 0 && zeta < OVERDAMPED) {
            owner[k] = ntrack;
            track[ntrack++] = (struct track){.begin = i, .end = i, .length = 1, .last = k};
        }
    }
    return ntrack;
}

/* Tracks that end before another begins, at the same place, are one. */
static void join(const struct stabilisation *s, int ntrack, struct track *track, int *owner)
{
    for (int t = 0; t < ntrack; t++)
        for (int u = 0; u < ntrack; u++) {
            if (u == t || !track[u].length || !track[t].length || track[t].end >= track[u].begin)
                continue;
            double complex a = s->pole[track[t].last], b = s->pole[track[u].last];
            double width = 2 * fmax(fabs(creal(a)), fabs(creal(b)));
            if (cabs(a - b) > width || frequency_change(a, b) > s->frequency_tolerance)
                continue;
            for (int k = 0; k < s->npole; k++)
                if (owner[k] == t)
                    owner[k] = u;
            track[u].length += track[t].length;
            track[u].begin = track[t].begin;
            track[t].length = 0;
        }
}

int stabilisation_candidates(struct pool *pool, const struct stabilisation *table, int *count, double complex **pole)
{
    struct track *track = POOL_ARRAY(pool, struct track, table->npole);
    int *owner = POOL_ARRAY(pool, int, table->npole), ntrack = 0;
    *count = 0;
    *pole = POOL_ARRAY(pool, double complex, table->npole);
    if (!track || !owner || !*pole)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < table->npole; k++)
        owner[k] = -1;
    for (int i = 0; i < table->norder; i++)
        ntrack = follow(table, i, ntrack, track, owner);
    join(table, ntrack, track, owner);
    int least = table->norder / TRACK_SHARE > LEAST_TRACK ? table->norder / TRACK_SHARE : LEAST_TRACK;
    for (int t = 0; t < ntrack; t++) {
        if (track[t].length < least)
            continue;
        int skip = track[t].length / 2, taken = 0;
        double complex sum = 0;
        for (int k = 0; k < table->npole; k++)
            if (owner[k] == t && skip-- <= 0) {
                sum += table->pole[k];
                taken++;
            }
        (*pole)[(*count)++] = sum / taken;
    }
    sort_poles((size_t)*count, *pole);
    return ROTID_OK;
}

void stabilisation_picks(const struct stabilisation *table, int npick, const double *pick_hz, double complex *pole, int *unstable)
{
    for (int i = 0; i < npick; i++) {
        double best[2] = {INFINITY, INFINITY};
        int chosen[2] = {-1, -1};
        for (int k = table->npole - 1; k >= 0; k--) {
            const struct ema_pole *p = &table->table[k];
            int stable = p->stable_frequency && p->stable_damping;
            double away = fabs(cabs(table->pole[k]) / (TWO_PI * pick_hz[i]) - 1), zeta = damping_of(table->pole[k]);
            if (away > PICK_REACH || !(zeta > 0 && zeta < OVERDAMPED))
                continue;
            /* rounded up a little, so that the higher order wins among poles that agree */
            if (stable && away < 0.8 * best[0] - 1e-4) {
                best[0] = away;
                chosen[0] = k;
            }
            if (away < 0.8 * best[1] - 1e-4) {
                best[1] = away;
                chosen[1] = k;
            }
        }
        int k = chosen[0] >= 0 ? chosen[0] : chosen[1];
        unstable[i] = chosen[0] < 0;
        pole[i] = k >= 0 ? table->pole[k] : TWO_PI * pick_hz[i] * CMPLX(-0.01, 1);
    }
}

void stabilisation_assign(const struct stabilisation *table, int nmode, const double complex *pole)
{
    for (int k = 0; k < table->npole; k++) {
        double best = INFINITY;
        for (int r = 0; r < nmode; r++) {
            double d = distance(table, table->pole[k], pole[r]);
            if (d < best) {
                best = d;
                table->table[k].mode = r + 1;
            }
        }
    }
}
