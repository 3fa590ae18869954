#include "ema/ema.h"
#include "linalg/linalg.h"

#define ZOOM_LEAST_LINES 150
#define MOST_LINES       5000
#define MOST_PARTS       20
#define PART_ORDER       60

struct part {
    struct stabilisation table;
    int count;
    double complex *candidate;
    double low, high; /* rad/s, what counts */
};

static int compute_part(struct pool *pool, const struct ema_band *band, int order, double decay,
                        const struct ema_options *options, struct part *part)
{
    int status = stabilisation_compute(pool, band, order, decay, options, &part->table);
    if (status == ROTID_OK)
        status = stabilisation_candidates(pool, &part->table, &part->count, &part->candidate);
    if (status != ROTID_OK)
        return status;
    int kept = 0;
    for (int k = 0; k < part->count; k++)
        if (cimag(part->candidate[k]) >= part->low && cimag(part->candidate[k]) <= part->high)
            part->candidate[kept++] = part->candidate[k];
    part->count = kept;
    return ROTID_OK;
}

/* The poles of all parts, order by order. */
static int merge_tables(struct pool *pool, int nparts, const struct part *part, struct stabilisation *table)
{
    size_t all = 0;
    for (int i = 0; i < nparts; i++)
        all += (size_t)part[i].table.npole;
    *table = part[0].table;
    table->npole = 0;
    table->first = POOL_ARRAY(pool, int, table->norder + 1);
    table->pole = POOL_ARRAY(pool, double complex, all);
    table->table = POOL_ARRAY(pool, struct ema_pole, all);
    if (!table->first || !table->pole || !table->table)
        return ROTID_ERROR_MEMORY;
    for (int o = 0; o < table->norder; o++) {
        /* parts stand in rising frequency, the whole band comes first: it is merged in on the way */
        int next = table->npole, whole = part[0].table.first[o], end = part[0].table.first[o + 1];
        for (int i = 1; i <= nparts; i++) {
            const struct stabilisation *from = &part[i < nparts ? i : 0].table;
            for (int k = i < nparts && o < from->norder ? from->first[o] : 0;
                 i < nparts && o < from->norder && k < from->first[o + 1]; k++) {
                double at = cimag(from->pole[k]);
                if (at < part[i].low || at > part[i].high)
                    continue;
                for (; whole < end && cimag(part[0].table.pole[whole]) < at; whole++, next++) {
                    table->pole[next] = part[0].table.pole[whole];
                    table->table[next] = part[0].table.table[whole];
                }
                table->pole[next] = from->pole[k];
                table->table[next] = from->table[k];
                table->table[next++].part = i;
            }
        }
        for (; whole < end; whole++, next++) {
            table->pole[next] = part[0].table.pole[whole];
            table->table[next] = part[0].table.table[whole];
        }
        table->npole = next;
        table->first[o + 1] = next;
    }
    return ROTID_OK;
}

/* A candidate that another part has already: within a half-power bandwidth. */
static int is_known(int count, const double complex *known, double complex pole)
{
    for (int k = 0; k < count; k++)
        if (cabs(known[k] - pole) < 2 * fmax(fabs(creal(pole)), fabs(creal(known[k]))))
            return 1;
    return 0;
}

/* First lines of the parts, falling; the last one is 0. edge [MOST_PARTS + 1], edge[0] = nline. Returns their number. */
static int split(const struct ema_band *band, int *edge)
{
    int parts = 0, end = band->nline;
    edge[0] = end;
    while (parts < MOST_PARTS && end > 0) {
        int first = ema_band_line(band, band->omega[end - 1] / 2);
        first = end - first > MOST_LINES ? end - MOST_LINES : first;
        /* what is too short for a part of its own goes with its neighbour */
        if (end - first < ZOOM_LEAST_LINES)
            first = end - ZOOM_LEAST_LINES;
        if (first < ZOOM_LEAST_LINES || parts + 1 == MOST_PARTS)
            first = 0;
        end = edge[++parts] = first;
    }
    return parts;
}

/* Octaves from the upper end down, of 150 to 5000 lines, 20 at most, each with a tenth more on both sides, of which only the
 * poles of its own middle and a fiftieth around it count; order 60 at most in each. *table: all poles, order by order; candidate
 * [*count] rising, found in one of them, once. options: complete. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_ERROR_EIGEN. */
static int zoom_compute(struct pool *pool, const struct ema_band *band, double decay, const struct ema_options *options,
                        struct stabilisation *table, int *count, double complex **candidate)
{
    int edge[MOST_PARTS + 1], parts = split(band, edge), nparts = parts > 1 ? parts + 1 : 1;
    struct part *part = POOL_ARRAY(pool, struct part, nparts);
    if (!part)
        return ROTID_ERROR_MEMORY;
    part[0].low = band->low;
    part[0].high = band->high;
    int status = compute_part(pool, band, options->order, decay, options, &part[0]), all = part[0].count;
    for (int i = 1; status == ROTID_OK && i < nparts; i++) {
        struct ema_band zoomed;
        int first = edge[parts - i + 1], last = edge[parts - i] - 1, length = last - first + 1;
        double margin = (band->omega[last] - band->omega[first]) / 50;
        part[i].low = band->omega[first] - margin;
        part[i].high = band->omega[last] + margin;
        first = first - length / 10 > 0 ? first - length / 10 : 0;
        last = last + length / 10 < band->nline ? last + length / 10 : band->nline - 1;
        struct pool scratch; /* the copy of the part is the largest thing of all, and no longer wanted afterwards */
        pool_open(&scratch, pool->allocator);
        status = ema_band_part(&scratch, band, first, last - first + 1, &zoomed);
        if (status == ROTID_OK)
            status =
                compute_part(pool, &zoomed, options->order < PART_ORDER ? options->order : PART_ORDER, decay, options, &part[i]);
        pool_close(&scratch);
        all += part[i].count;
    }
    if (status != ROTID_OK)
        return status;
    *count = 0;
    *candidate = POOL_ARRAY(pool, double complex, all);
    if (!*candidate)
        return ROTID_ERROR_MEMORY;
    /* the parts know better than the whole, which comes last; within one part two poles are two */
    for (int i = 1; i <= nparts; i++) {
        const struct part *from = &part[i < nparts ? i : 0];
        int before = *count;
        for (int k = 0; k < from->count; k++)
            if (!is_known(before, *candidate, from->candidate[k]))
                (*candidate)[(*count)++] = from->candidate[k];
    }
    sort_poles((size_t)*count, *candidate);
    return merge_tables(pool, nparts, part, table);
}

#define PROMINENCE 4    /* over the median */
#define APART      0.01 /* relative: two peaks closer than this are one, with noise on it */
#define PICK_REACH 0.02

static double height(const struct ema_band *band, int i)
{
    double sum = 0;
    for (int c = 0; c < band->nchannel; c++)
        sum += fabs(cimag(band->h[i + (ptrdiff_t)c * band->nline]));
    return sum;
}

static double power(const struct ema_band *band, int i)
{
    double sum = 0;
    for (int c = 0; c < band->nchannel; c++) {
        double size = cabs(band->h[i + (ptrdiff_t)c * band->nline]);
        sum += size * size;
    }
    return sum;
}

/* Where sum |H|^2 falls through half its peak, walking from line i by step; NaN where the band ends first. */
static double half_power(const struct ema_band *band, int i, int step)
{
    double half = power(band, i) / 2, before = 2 * half;
    for (int k = i + step; k >= 0 && k < band->nline; k += step) {
        double now = power(band, k);
        if (now <= half)
            return band->omega[k - step] + (band->omega[k] - band->omega[k - step]) * (before - half) / (before - now);
        before = now;
    }
    return NAN;
}

/* Highest line within relative `reach` of omega, by sum |Im H|. */
static int highest(const double *sum, const struct ema_band *band, double omega, double reach)
{
    int best = -1, end = ema_band_line(band, omega * (1 + reach));
    for (int i = ema_band_line(band, omega * (1 - reach)); i < end; i++)
        if (best < 0 || sum[i] > sum[best])
            best = i;
    return best;
}

static int find_peaks(const struct ema_band *band, const double *sum, double median, int *peak)
{
    int count = 0;
    for (int i = 1; i + 1 < band->nline; i++)
        if (sum[i] > sum[i - 1] && sum[i] >= sum[i + 1] && sum[i] > PROMINENCE * median &&
            highest(sum, band, band->omega[i], APART) == i)
            peak[count++] = i;
    return count;
}

/* Vertex of the parabola through the line and its neighbours. */
static double vertex(const struct ema_band *band, const double *sum, int i)
{
    if (i == 0 || i + 1 == band->nline)
        return band->omega[i];
    double a = sum[i - 1], b = sum[i], c = sum[i + 1], curve = a - 2 * b + c;
    double shift = curve < 0 ? fmin(fmax((a - c) / (2 * curve), -0.5), 0.5) : 0;
    return band->omega[i] + shift * (shift > 0 ? band->omega[i + 1] - band->omega[i] : band->omega[i] - band->omega[i - 1]);
}

static void fill_mode(const struct ema_band *band, const double *sum, int i, double decay, struct ema_mode *mode)
{
    double w = vertex(band, sum, i), zeta = (half_power(band, i, 1) - half_power(band, i, -1)) / (2 * w) - decay / w;
    double spacing = (band->omega[i + 1 < band->nline ? i + 1 : i] - band->omega[i > 0 ? i - 1 : i]) / 2;
    modes_of_pole(CMPLX(-(isnan(zeta) ? 0 : zeta) * w, w * sqrt(fmax(1 - (isnan(zeta) ? 0 : zeta * zeta), 0))), NULL, mode);
    mode->frequency_hz = w / TWO_PI;
    mode->damping = zeta;
    mode->frequency_std = spacing / sqrt(12) / TWO_PI;
    double measured = isnan(zeta) ? NAN : zeta * w + decay;
    for (int k = 0; k < band->nchannel; k++) {
        ptrdiff_t at = i + (ptrdiff_t)k * band->nline;
        int c = band->channel[k];
        /* at resonance the accelerance is -omega^2 A/(-Re lambda), A imaginary */
        mode->residue[c] = -I * cimag(band->h[at]) * (isnan(measured) ? 1 : measured) / (w * w);
        if (band->variance)
            mode->residue_std[c] = sqrt(band->variance[at] / 2) * (isnan(measured) ? 1 : measured) / (w * w);
    }
}

/* Frequencies are the local maxima of sum_c |Im H_c| (accelerance; Re of mobility is the same up to omega), parabola through the
 * three highest lines: above four times the median of the sum, and above all others within `apart` of it. shape is the imaginary
 * part at the peak, damping (f_b - f_a)/(2 f) from the half-power points of sum |H_c|^2, NaN where they lie outside the band.
 * With picks, the largest line within 2 % of each. Residues: A = Im H/(i omega^2) zeta omega, as if the mode stood alone.
 * Standard deviations from the variance: of the shape sqrt(variance/2) at the line; of the frequency (line spacing)/sqrt(12),
 * what a line spectrum resolves. out->mode is made here. ROTID_OK or ROTID_ERROR_MEMORY. */
static int picking_compute(struct pool *pool, const struct ema_band *band, const struct ema_options *options, double decay,
                           struct ema *out)
{
    double *sum = POOL_ARRAY(pool, double, band->nline), *sorted = POOL_ARRAY(pool, double, band->nline);
    int *peak = POOL_ARRAY(pool, int, band->nline + (options->npick > 0 ? options->npick : 0)), count = 0;
    if (!sum || !sorted || !peak)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < band->nline; i++)
        sum[i] = sorted[i] = height(band, i);
    sort_doubles((size_t)band->nline, sorted);
    if (options->npick > 0) {
        for (int k = 0; k < options->npick; k++) {
            int i = highest(sum, band, TWO_PI * options->pick_hz[k], PICK_REACH), at = count;
            for (int r = 0; r < count && i >= 0; r++)
                if (peak[r] == i)
                    i = -1;
            if (i < 0)
                continue;
            for (; at > 0 && peak[at - 1] > i; at--)
                peak[at] = peak[at - 1];
            peak[at] = i;
            count++;
        }
    } else {
        count = find_peaks(band, sum, sorted[band->nline / 2], peak);
    }
    int status = modes_new(pool, count, 0, out);
    for (int r = 0; status == ROTID_OK && r < count; r++)
        fill_mode(band, sum, peak[r], decay, &out->mode[r]);
    out->std_from_impacts = band->variance != NULL;
    for (int c = 0; status == ROTID_OK && c < out->nfrf; c++)
        out->lower[c] = out->upper[c] = 0; /* nothing is left over where nothing is fitted */
    return status;
}

#define TRIAL_LINES      600
#define GUARD_ITERATIONS 12
#define START            1.5 /* half-power bandwidths beyond the end of the band */
#define FAR              2
#define WORTH            0.02 /* least share of what is left that a guard has to explain */

/* -2 log likelihood but for a constant: flat weights have their sigma from what is left. */
static double badness(const struct modal_fit *fit)
{
    double sum = 0;
    for (int c = 0; c < fit->nchannel; c++)
        sum += fit->weight ? fit->chi2[c] : 4 * fit->nline * log(fit->sigma[c]);
    return sum;
}

/* All poles refined together on some of the lines. */
static int guard_fit_all(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                         int nline, const int *line, int count, double complex *pole, double *bad)
{
    struct modal_fit fit;
    struct refinement refinement;
    struct pool scratch;
    pool_open(&scratch, pool->allocator);
    int status = refinement_open(&scratch, band, nline, line, 0, band->nchannel, count, pole, threads, &fit, &refinement);
    if (!status)
        status = refine_poles(&fit, GUARD_ITERATIONS, environment, &refinement);
    for (int r = 0; r < count && !status; r++)
        pole[r] = fit.pole[r] * fit.scale;
    if (!status)
        *bad = badness(&fit);
    pool_close(&scratch);
    return status;
}

/* A guard that comes into the band by more than its own half bandwidth, or grows, explains something else. */
static int is_outside(const struct ema_band *band, double complex pole)
{
    double half = -creal(pole);
    return half > 0 && (cimag(pole) < band->low + half || cimag(pole) > band->high - half) && cimag(pole) > 0;
}

/* Whether a guard is so far, an octave from the band, that the lines do not tell its place: they tell what it adds there. Refined
 * on, it would wander until its columns are those of L and U. */
static int guard_is_far(const struct ema_band *band, double complex pole)
{
    return cabs(pole) < band->low / FAR || cabs(pole) > band->high * FAR;
}

/* Where the next one is tried: beyond the outermost pole at that end, as damped as the mode next to it. */
static double complex beyond(const struct ema_band *band, int nmode, int nguard, const double complex *pole, int above)
{
    int nearest = 0;
    for (int r = 1; r < nmode; r++)
        if (above ? cimag(pole[r]) > cimag(pole[nearest]) : cimag(pole[r]) < cimag(pole[nearest]))
            nearest = r;
    double end = above ? band->high : band->low, zeta = -creal(pole[nearest]) / cabs(pole[nearest]), width = 2 * zeta * end;
    for (int r = nmode; r < nmode + nguard; r++)
        end = above ? fmax(end, cimag(pole[r])) : fmin(end, cimag(pole[r]));
    return CMPLX(-width / 2, above ? end + START * width : fmax(end - START * width, end / 2));
}

/* The residual terms L and U stand for modes far away; the flank of one close to the band is none of them, and bends the modes
 * next to it: on a rotor with a mode 5 % above the band by a percent of their half bandwidth, ten times what the noise does. So a
 * pole is put beyond an end of the band and fitted with the others, and stays where the fit gets better than chance allows: sum
 * chi2 falls by more than 2 n + 12 sqrt(n) + 30 for n channels. Again until none earns its place. Guards are no modes: where they
 * end is what suits the band best, and nothing is reported of them. pole [nmode + GUARD_MOST] in: nmode candidates; out: *nguard
 * more behind them. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_STOP_CANCELLED. */
static int guard_poles(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                       int nmode, double complex *pole, int *nguard)
{
    struct pool scratch;
    int n = band->nchannel, tries[2] = {0, 0}, status = ROTID_OK;
    double bad, least = 2 * n + 12 * sqrt(n) + 30;
    *nguard = 0;
    if (!nmode)
        return ROTID_OK;
    pool_open(&scratch, pool->allocator);
    int *line = POOL_ARRAY(&scratch, int, band->nline);
    double complex *trial = POOL_ARRAY(&scratch, double complex, nmode + GUARD_MOST);
    if (!line || !trial)
        status = ROTID_ERROR_MEMORY;
    int nline = status ? 0 : modal_fit_lines(band, nmode, pole, FIT_WIDTHS, TRIAL_LINES, line);
    if (!status)
        status = guard_fit_all(pool, band, threads, environment, nline, line, nmode, pole, &bad);
    for (int above = 1; *nguard < GUARD_MOST && !status && tries[0] + tries[1] < 2; above = !above) {
        if (tries[above])
            continue;
        double with;
        int count = nmode + *nguard;
        memcpy(trial, pole, (size_t)count * sizeof *trial);
        trial[count] = beyond(band, nmode, *nguard, pole, above);
        status = guard_fit_all(pool, band, threads, environment, nline, line, count + 1, trial, &with);
        tries[above] = status || bad - with < fmax(least, WORTH * (band->variance ? bad : 2.0 * nline * n));
        for (int r = nmode; r <= count; r++)
            tries[above] |= !is_outside(band, trial[r]);
        if (tries[above])
            continue;
        memcpy(pole, trial, (size_t)(count + 1) * sizeof *pole);
        bad = with;
        tries[!above] = 0; /* the other end may gain by it */
        ++*nguard;
    }
    pool_close(&scratch);
    return status;
}

#define HALF_WIDTH       30  /* lines: the variance is then known to a tenth */
#define BLOCK            128 /* lines at a time */
#define EULER            0.5772156649015329
#define NOISE_ITERATIONS 4

/* log |H - model|^2 of the channels on a block of lines, from their columns at these lines, 2 lines times nlinear. rows [2 lines
 * * nchannel] is workspace. */
static void residual(const struct ema_band *band, const struct modal_fit *fit, int first, int lines, const double *columns,
                     double *rows, double *square)
{
    for (int c = 0; c < band->nchannel; c++) {
        const double complex *h = band->h + (ptrdiff_t)c * band->nline + first;
        double *to = rows + (ptrdiff_t)2 * lines * c;
        for (int i = 0; i < lines; i++) {
            to[i] = creal(h[i]);
            to[i + lines] = cimag(h[i]);
        }
    }
    product_subtract(2 * lines, band->nchannel, fit->nlinear, columns, fit->linear, rows);
    for (int c = 0; c < band->nchannel; c++) {
        const double *from = rows + (ptrdiff_t)2 * lines * c;
        double *to = square + (ptrdiff_t)c * band->nline + first;
        for (int i = 0; i < lines; i++)
            to[i] = log(fmax(from[i] * from[i] + from[i + lines] * from[i + lines], 1e-300));
    }
}

/* exp(mean log + Euler's constant): the mean of |noise|^2 where that is exponentially distributed, and hardly moved by a spike or
 * by what the model misses in the few lines of a peak, which would take the weight from the lines that tell most. */
static void smooth_logarithm(int n, const double *raw, double *smooth)
{
    double sum = 0, largest = -INFINITY;
    for (int i = 0, first = 0, last = -1; i < n; i++) {
        for (; last < i + HALF_WIDTH && last + 1 < n; sum += raw[last])
            last++;
        for (; first < i - HALF_WIDTH; first++)
            sum -= raw[first];
        smooth[i] = exp(sum / (last - first + 1) + EULER);
        largest = fmax(largest, smooth[i]);
    }
    for (int i = 0; i < n; i++)
        smooth[i] = fmax(smooth[i], fmax(1e-16 * largest, 1e-300));
}

static int fit_all(struct pool *scratch, const struct ema_band *band, int threads, const rotid_environment *environment, int n,
                   const double complex *pole, struct modal_fit *fit)
{
    struct refinement refinement;
    int *line = POOL_ARRAY(scratch, int, band->nline);
    if (!line)
        return ROTID_ERROR_MEMORY;
    int nline = modal_fit_lines(band, n, pole, FIT_WIDTHS, selection_lines(band, n, EARN_PRODUCTS), line);
    int status = refinement_open(scratch, band, nline, line, 0, band->nchannel, n, pole, threads, fit, &refinement);
    if (status != ROTID_OK)
        return status;
    return refine_poles(fit, NOISE_ITERATIONS, environment, &refinement);
}

/* band->variance := |H - model|^2 averaged (in the logarithm) over 30 lines on each side, the model fitted with the poles pole
 * [n] as start (which stay): flat weights where there is no variance yet, else those. One number a channel would let the worst
 * misfit of the band decide on the weakest mode of it. Nothing is done for n = 0. ROTID_OK, ROTID_ERROR_MEMORY or
 * ROTID_STOP_CANCELLED. */
static int noise_from_residual(struct pool *pool, struct ema_band *band, int threads, const rotid_environment *environment, int n,
                               const double complex *pole)
{
    struct pool scratch;
    struct modal_fit fit;
    size_t lines = (size_t)band->nline;
    if (n == 0)
        return ROTID_OK;
    pool_open(&scratch, pool->allocator);
    double *square = POOL_ARRAY(&scratch, double, lines), *nu = POOL_ARRAY(&scratch, double, BLOCK);
    double *variance = band->variance ? band->variance : POOL_ARRAY(pool, double, lines *(size_t)band->nchannel);
    double *columns = POOL_ARRAY(&scratch, double, 2 * (size_t)BLOCK * (2 * (size_t)n + 4));
    double *rows = POOL_ARRAY(&scratch, double, 2 * (size_t)BLOCK * (size_t)band->nchannel);
    int status = square && variance && nu && columns && rows ? fit_all(&scratch, band, threads, environment, n, pole, &fit)
                                                             : ROTID_ERROR_MEMORY;
    for (int first = 0; status == ROTID_OK && first < band->nline; first += BLOCK) {
        int count = band->nline - first < BLOCK ? band->nline - first : BLOCK;
        for (int i = 0; i < count; i++)
            nu[i] = band->omega[first + i] / fit.scale;
        modal_fit_columns(count, nu, n, fit.pole, columns);
        residual(band, &fit, first, count, columns, rows, variance);
    }
    for (int c = 0; status == ROTID_OK && c < band->nchannel; c++) {
        memcpy(square, variance + (size_t)c * lines, lines * sizeof *square);
        smooth_logarithm(band->nline, square, variance + (size_t)c * lines);
    }
    if (status == ROTID_OK)
        band->variance = variance;
    pool_close(&scratch);
    return status;
}

#define LEAST_LINES   16
#define LARGEST_ORDER 120
#define ITERATIONS    40
#define NEAR_WIDTHS   3
#define SUSPECT       2
#define NOT_PICKED    (-1)

struct extraction {
    struct pool *pool;
    const struct frf_set *set;
    struct ema_options options;
    const rotid_environment *environment;
    int first, last; /* lines of the set in the band */
    int *usable;
    struct ema_points points;
    struct ema_band band;
    int stated; /* the lines came with a variance */
    int ncandidate;
    double complex *candidate;
    int *quality_flags; /* [ncandidate] of picks, or NOT_PICKED; NULL without picks */
    struct ema *out;
};

static void set_defaults(struct ema_options *o, int nline)
{
    if (!(o->frequency_tolerance > 0))
        o->frequency_tolerance = 0.002;
    if (!(o->damping_tolerance > 0))
        o->damping_tolerance = 0.05;
    if (o->threads < 1)
        o->threads = 1;
    int most = 2 * nline / 3;
    if (o->order <= 0)
        o->order = LARGEST_ORDER;
    o->order = o->order < most ? o->order : most;
    o->order = o->order < 2 ? 2 : o->order;
}

static int find_lines(struct extraction *job)
{
    const struct frf_set *set = job->set;
    const struct ema_options *o = &job->options;
    job->last = set->nline;
    while (job->first < job->last &&
           (set->frequency_hz[job->first] <= 0 || (o->low_hz > 0 && set->frequency_hz[job->first] < o->low_hz)))
        job->first++;
    while (job->last > job->first && o->high_hz > 0 && set->frequency_hz[job->last - 1] > o->high_hz)
        job->last--;
    for (int i = job->first + 1; i < job->last; i++)
        if (!(set->frequency_hz[i] > set->frequency_hz[i - 1]))
            return ROTID_ERROR_ARGUMENT;
    return job->last - job->first >= LEAST_LINES ? ROTID_OK : ROTID_ERROR_ARGUMENT;
}

static int prepare(struct extraction *job)
{
    int n = job->set->nfrf, status = n > 0 ? find_lines(job) : ROTID_ERROR_ARGUMENT, alive = 0;
    if (status != ROTID_OK)
        return status;
    set_defaults(&job->options, job->last - job->first);
    job->out->nfrf = n;
    job->out->channel = POOL_ARRAY(job->pool, struct ema_channel, n);
    job->usable = POOL_ARRAY(job->pool, int, n);
    if (!job->out->channel || !job->usable)
        return ROTID_ERROR_MEMORY;
    status = shapes_points(job->pool, job->set, &job->points, job->out);
    if (status == ROTID_OK)
        status = channels_check(job->pool, job->set, job->first, job->last, job->out->channel, job->usable);
    for (int c = 0; status == ROTID_OK && c < n; c++)
        alive += job->usable[c];
    if (status == ROTID_OK && !alive)
        status = ROTID_ERROR_ARGUMENT;
    if (status == ROTID_OK)
        status = ema_band_new(job->pool, job->set, job->first, job->last, job->usable, &job->band);
    job->stated = job->band.variance != NULL;
    return status;
}

/* Candidates from the stabilisation table, or what the user picked. */
static int find_candidates(struct extraction *job, struct stabilisation *table)
{
    const struct ema_options *o = &job->options;
    struct ema *out = job->out;
    int status = zoom_compute(job->pool, &job->band, job->set->window_decay, o, table, &job->ncandidate, &job->candidate);
    if (status != ROTID_OK)
        return status;
    out->order = table->order;
    out->npole = table->npole;
    out->pole = table->table;
    return status;
}

/* Keeps the candidates that earn their place: refined, or where no refinement is wanted as they came. */
static int earn(struct extraction *job)
{
    int *from = POOL_ARRAY(job->pool, int, job->ncandidate);
    double complex *pole = POOL_ARRAY(job->pool, double complex, job->ncandidate);
    if (!from || !pole)
        return ROTID_ERROR_MEMORY;
    int status = ROTID_OK;
    if (!job->stated) {
        status = selection_screen(job->pool, &job->band, job->options.threads, job->environment, &job->ncandidate, job->candidate,
                                  from);
        if (status == ROTID_OK)
            status = noise_from_residual(job->pool, &job->band, job->options.threads, job->environment, job->ncandidate,
                                         job->candidate);
    }
    memcpy(pole, job->candidate, (size_t)job->ncandidate * sizeof *pole);
    if (status == ROTID_OK)
        status = selection_earn(job->pool, &job->band, job->options.threads, job->environment, &job->ncandidate, pole, from);
    for (int r = 0; status == ROTID_OK && r < job->ncandidate; r++)
        job->candidate[r] = job->options.no_refinement ? job->candidate[from[r]] : pole[r];
    if (status == ROTID_OK)
        status = local_merge(job->pool, &job->band, &job->ncandidate, job->candidate);
    if (status == ROTID_OK && !job->stated)
        status =
            noise_from_residual(job->pool, &job->band, job->options.threads, job->environment, job->ncandidate, job->candidate);
    return status;
}

/* What the user picked joins what was found, or marks it where the pole of the table for that frequency is the same to half a
 * half-power bandwidth. The modes that were not picked stay in the fit, where they are not mistaken for residuals, and are not
 * reported. */
static int add_picks(struct extraction *job, const struct stabilisation *table)
{
    int npick = job->options.npick, found = job->ncandidate, all = found;
    double complex *pick = POOL_ARRAY(job->pool, double complex, npick);
    double complex *pole = POOL_ARRAY(job->pool, double complex, found + npick);
    int *unstable = POOL_ARRAY(job->pool, int, npick);
    job->quality_flags = POOL_ARRAY(job->pool, int, found + npick);
    if (!pick || !pole || !unstable || !job->quality_flags)
        return ROTID_ERROR_MEMORY;
    stabilisation_picks(table, npick, job->options.pick_hz, pick, unstable);
    for (int r = 0; r < found; r++) {
        pole[r] = job->candidate[r];
        job->quality_flags[r] = NOT_PICKED;
    }
    for (int i = 0; i < npick; i++) {
        int same = -1;
        for (int r = 0; r < found && same < 0; r++)
            if (fabs(cimag(pole[r]) - cimag(pick[i])) < fmax(fabs(creal(pole[r])), fabs(creal(pick[i]))))
                same = r;
        if (same < 0) {
            same = all;
            pole[all++] = pick[i];
        }
        job->quality_flags[same] = unstable[i] ? EMA_UNSTABLE : 0;
    }
    job->candidate = pole;
    job->ncandidate = all;
    return ROTID_OK;
}

static int fit_modes(struct extraction *job)
{
    struct modal_fit fit;
    struct refinement refinement;
    const struct ema_band *band = &job->band;
    struct ema *out = job->out;
    int n = job->ncandidate, nguard = 0, status = ROTID_OK, *line = POOL_ARRAY(job->pool, int, band->nline);
    double complex *pole = POOL_ARRAY(job->pool, double complex, n + GUARD_MOST);
    if (!line || !pole)
        return ROTID_ERROR_MEMORY;
    memcpy(pole, job->candidate, (size_t)n * sizeof *pole);
    if (!job->options.no_refinement)
        status = guard_poles(job->pool, band, job->options.threads, job->environment, n, pole, &nguard);
    n += nguard;
    if (status == ROTID_OK)
        status = modes_new(job->pool, n, job->options.per_point, out);
    if (status != ROTID_OK || n == 0)
        return status;
    int nline = modal_fit_lines(band, n, pole, FIT_WIDTHS, selection_lines(band, n, FIT_PRODUCTS), line);
    status = refinement_open(job->pool, band, nline, line, 0, band->nchannel, n, pole, job->options.threads, &fit, &refinement);
    if (status != ROTID_OK)
        return status;
    for (int r = 0; r < n; r++) {
        fit.loose[r] = r >= n - nguard;
        fit.held[r] = fit.loose[r] && guard_is_far(band, pole[r]);
    }
    status = refine_poles(&fit, job->options.no_refinement ? 0 : ITERATIONS, job->environment, &refinement);
    if (status != ROTID_OK)
        return status;
    if (job->options.no_refinement)
        refinement_add_step(n, &refinement);
    out->refined = refinement.iterations;
    out->std_from_impacts = job->stated;
    double *gain = POOL_ARRAY(job->pool, double, n);
    status = gain ? impacts_spread(job->pool, job->set, job->first, band, line, &fit, gain) : ROTID_ERROR_MEMORY;
    if (status != ROTID_OK)
        return status;
    modes_from_fit(band, &fit, &refinement, job->set->window_decay, out);
    /* what is not reported goes behind, where the synthesis still finds it */
    struct ema_mode *behind = POOL_ARRAY(job->pool, struct ema_mode, n);
    int reported = 0, others = 0, *suspect = POOL_ARRAY(job->pool, int, n);
    double *common = POOL_ARRAY(job->pool, double, (size_t)n *(size_t)band->nchannel);
    if (!behind || !suspect || !common)
        return ROTID_ERROR_MEMORY;
    modal_fit_local_noise(&fit, n, NEAR_WIDTHS, common);
    for (int r = 0; r < n; r++) {
        double complex at = fit.pole[r] * fit.scale;
        int inside = r < n - nguard && !refinement.moved[r] && cimag(at) >= band->low && cimag(at) <= band->high;
        if (r >= n - nguard || (job->quality_flags ? job->quality_flags[r] == NOT_PICKED : !inside)) {
            behind[others++] = out->mode[r];
            continue;
        }
        struct ema_mode mode = out->mode[r];
        mode.quality_flags |= job->quality_flags ? job->quality_flags[r] : 0;
        /* the scores of the channels tell cheaply whether they agree on the frequency */
        suspect[reported] = refinement.widened[(ptrdiff_t)2 * r + 1] > SUSPECT;
        for (int k = 0; k < band->nchannel; k++)
            /* reported <= r: what has been read is written over */
            common[k + (ptrdiff_t)reported * band->nchannel] =
                common[k + (ptrdiff_t)r * band->nchannel] * (fit.weight ? 1 : fit.sigma[k] * fit.sigma[k]);
        out->mode[reported++] = mode;
    }
    if (others)
        memcpy(out->mode + reported, behind, (size_t)others * sizeof *behind);
    out->nmode = reported;
    out->nguard = others;
    return per_point_frequencies(job->pool, band, job->set->window_decay, suspect, common, gain, job->environment, out);
}

static int finish(struct extraction *job)
{
    struct ema *out = job->out;
    double complex *work = POOL_ARRAY(job->pool, double complex, job->points.nreference);
    if (!work)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < out->nmode; r++)
        shapes_of_mode(job->set, &job->points, job->usable, out, &out->mode[r], work);
    for (int r = 0; r < out->nmode; r++) {
        if (out->mode[r].modal_mass < 0)
            out->mode[r].quality_flags |= EMA_NEGATIVE_MASS;
        if (job->options.no_refinement) /* nobody asked for it */
            out->mode[r].quality_flags &= ~EMA_NOT_REFINED;
    }
    int status = modes_judge(job->pool, &job->band, job->set->window_decay, out);
    if (status != ROTID_OK)
        return status;
    return channels_compare(job->pool, job->set, job->first, job->last, job->usable, out);
}

ORDER_BY(by_frequency_of_mode, struct ema_mode, it->frequency_hz, 0)

static int extract(struct extraction *job, struct stabilisation *table)
{
    int status = find_candidates(job, table);
    if (status == ROTID_OK && environment_cancelled(job->environment))
        status = ROTID_STOP_CANCELLED;
    if (status == ROTID_OK)
        status = earn(job);
    if (status != ROTID_OK)
        return status;
    sort_poles((size_t)job->ncandidate, job->candidate);
    if (job->options.npick > 0)
        status = add_picks(job, table);
    if (status != ROTID_OK)
        return status;
    status = fit_modes(job);
    if (status != ROTID_OK)
        return status;
    qsort(job->out->mode, (size_t)job->out->nmode, sizeof *job->out->mode, by_frequency_of_mode);
    double complex *pole = POOL_ARRAY(job->pool, double complex, job->out->nmode);
    if (!pole)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < job->out->nmode; r++)
        pole[r] = job->out->mode[r].pole - job->set->window_decay;
    stabilisation_assign(table, job->out->nmode, pole);
    return ROTID_OK;
}

int ema_compute(struct pool *pool, const struct frf_set *set, const struct ema_options *options,
                const rotid_environment *environment, struct ema *out)
{
    struct stabilisation table = {0};
    struct extraction job = {.pool = pool, .set = set, .environment = environment, .out = out};
    if (options)
        job.options = *options;
    *out = (struct ema){0};
    int status = prepare(&job);
    if (status == ROTID_OK && environment_cancelled(environment))
        status = ROTID_STOP_CANCELLED;
    if (status == ROTID_OK && job.options.method == EMA_QUADRATURE)
        status = picking_compute(pool, &job.band, &job.options, set->window_decay, out);
    else if (status == ROTID_OK)
        status = extract(&job, &table);
    if (status == ROTID_OK)
        status = finish(&job);
    for (int c = 0; c < set->nfrf; c++)
        if (!c || set->frf[c].averages < out->impacts)
            out->impacts = set->frf[c].averages;
    return status;
}
