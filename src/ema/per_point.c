#include "ema/ema.h"
#include "linalg/linalg.h"

#define REACH         0.012
#define REACH_WIDTHS  3 /* half-power bandwidths */
#define MOST_REACH    0.05
#define FRINGE        12 /* half bandwidths around the search that belong to the window */
#define LEAST_LINES   24
#define MOST_LINES    700
#define ITERATIONS    25
#define MERGE_REACH   0.02
#define MOST_TOGETHER 6
#define LEAST_MPC     0.4
#define LEAST_GAIN    0.1 /* share of chi2, or log of the variance: below it noise decides */

/* How far from the common pole a channel's own is looked for: 1.2 % of the frequency, which a 30 g accelerometer makes on a
 * beam of 6 kg, or three half-power bandwidths where these are wider, 5 % at most. */
static double local_reach(double complex pole)
{
    double w = cabs(pole);
    return fmin(fmax(REACH * w, REACH_WIDTHS * 2 * fabs(creal(pole))), MOST_REACH * w);
}

/* Lines of [low, high], at least LEAST_LINES around its middle, thinned to MOST_LINES. */
static int window_lines(const struct ema_band *band, double low, double high, int *line)
{
    int first = ema_band_line(band, low), last = ema_band_line(band, high), middle = ema_band_line(band, (low + high) / 2);
    if (last - first < LEAST_LINES) {
        first = middle - LEAST_LINES / 2;
        last = middle + LEAST_LINES / 2;
    }
    first = first > 0 ? first : 0;
    last = last < band->nline ? last : band->nline;
    int step = 1 + (last - first) / MOST_LINES, n = 0;
    for (int i = first; i < last; i += step)
        line[n++] = i;
    return n;
}

/* Best of the places start + j half around it, by chi2. */
static void search(struct modal_fit *fit, double reach)
{
    double complex start = fit->pole[0], best = start;
    double half = fmax(fabs(creal(start)), 1e-7), least = INFINITY;
    int steps = (int)fmin(ceil(reach / fit->scale / half), 400);
    for (int j = -steps; j <= steps; j++) {
        fit->pole[0] = start + CMPLX(0, j * half);
        double chi2 = modal_fit_evaluate(fit, MODAL_FIT_LINEAR);
        if (chi2 < least) {
            least = chi2;
            best = fit->pole[0];
        }
    }
    fit->pole[0] = best;
}

static void take_off(struct modal_fit *fit, const double complex *rest)
{
    for (int i = 0; i < fit->nline; i++) {
        fit->y[i] -= creal(rest[i]);
        fit->y[i + fit->nline] -= cimag(rest[i]);
    }
    fit->yy[0] = product_dot(2 * fit->nline, fit->y, fit->y);
}

/* Poles together [n] on the lines of one channel, less rest [nline] (NULL: nothing); the first of them is asked for. */
static int fit_window(struct pool *scratch, const struct ema_band *band, int k, int nline, const int *line,
                      const double complex *rest, int n, const double complex *together, int searched, double reach,
                      struct local_pole *out)
{
    struct modal_fit fit;
    struct refinement refinement;
    *out = (struct local_pole){.chi2 = NAN, .pole = CMPLX(NAN, NAN), .residue = CMPLX(NAN, NAN), .residue_std = NAN};
    if (2 * nline < 2 * (4 * n + 4))
        return ROTID_OK;
    int status = refinement_open(scratch, band, nline, line, k, 1, n, together, 1, &fit, &refinement);
    if (status != ROTID_OK)
        return status;
    if (rest)
        take_off(&fit, rest);
    if (searched)
        search(&fit, reach);
    (void)refine_poles(&fit, ITERATIONS, NULL, &refinement);
    out->chi2 = fit.weight ? fit.chi2[0] : fit.sigma[0] * fit.sigma[0] * fit.chi2[0];
    out->noise = out->chi2 / (2 * nline - fit.nlinear - 2 * n);
    residue_of_mode(&fit, 0, 0, refinement.covariance, &out->residue, &out->residue_std);
    out->pole = fit.pole[0] * fit.scale;
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++)
            out->covariance[i + 2 * j] = refinement.covariance[i + (ptrdiff_t)j * 2 * n] * fit.scale * fit.scale;
    double apart = fabs(cimag(out->pole) - cimag(together[0])), spread = sqrt(fmax(out->covariance[3], out->covariance[0]));
    out->known = !refinement.moved[0] && apart < 1.2 * reach && creal(out->pole) < 0 && spread < -creal(out->pole) &&
                 cabs(out->residue) > (searched ? 4 : 3) * out->residue_std;
    return ROTID_OK;
}

/* The accelerance of modes that are not fitted along. */
static void synthesise_rest(const struct ema_band *band, int nline, const int *line, int nmode, const double complex *pole,
                            const double complex *residue, const int *fitted, double complex *rest)
{
    for (int i = 0; i < nline; i++) {
        double complex s = I * band->omega[line[i]], sum = 0;
        for (int r = 0; r < nmode; r++)
            if (!fitted[r] && !isnan(creal(residue[r])))
                sum += residue[r] / (s - pole[r]) + conj(residue[r]) / (s - conj(pole[r]));
        rest[i] = s * s * sum;
    }
}

/* The pole of channel k of the band alone near pole[which], the modes pole [nmode] being all that there are: modes within twice
 * the window are fitted along with it. residue [nmode] of that channel: what the modes further away add is taken off first; NULL:
 * it is left to the residual terms, which bends the residue by parts in a thousand. Where no mode is near, every place within
 * local_reach is tried first, in steps of half a bandwidth. known needs |A| above 4 standard deviations where the place was
 * searched for, 3 where not. ROTID_OK or ROTID_ERROR_MEMORY. */
static int local_fit(const struct pool *pool, const struct ema_band *band, int k, int nmode, const double complex *pole,
                     const double complex *residue, int which, struct local_pole *out)
{
    struct pool scratch;
    double complex together[MOST_TOGETHER] = {pole[which]};
    double reach = local_reach(pole[which]), half = fabs(creal(pole[which])), centre = cimag(pole[which]);
    double window = reach + FRINGE * half;
    int n = 1, status = ROTID_ERROR_MEMORY;
    pool_open(&scratch, pool->allocator);
    int *line = POOL_ARRAY(&scratch, int, band->nline), *fitted = POOL_ARRAY(&scratch, int, nmode);
    double complex *rest = POOL_ARRAY(&scratch, double complex, band->nline);
    if (line && fitted && rest) {
        fitted[which] = 1;
        for (int r = 0; r < nmode; r++)
            if (r != which && fabs(cimag(pole[r]) - centre) < 2 * window && n < MOST_TOGETHER) {
                together[n++] = pole[r];
                fitted[r] = 1;
            }
        int nline = window_lines(band, centre - (n > 1 ? 2 : 1) * window, centre + (n > 1 ? 2 : 1) * window, line);
        if (residue)
            synthesise_rest(band, nline, line, nmode, pole, residue, fitted, rest);
        status = fit_window(&scratch, band, k, nline, line, residue ? rest : NULL, n, together, n == 1, reach, out);
    }
    pool_close(&scratch);
    return status;
}

static int fit_common(struct pool *scratch, const struct ema_band *flat, int n, const double complex *together, double window,
                      double complex *common)
{
    struct modal_fit fit;
    struct refinement refinement;
    int *line = POOL_ARRAY(scratch, int, flat->nline);
    if (!line)
        return ROTID_ERROR_MEMORY;
    int nline = window_lines(flat, cimag(together[0]) - window, cimag(together[0]) + window, line);
    if (2 * nline < 2 * (4 * n + 4))
        return ROTID_OK;
    int status = refinement_open(scratch, flat, nline, line, 0, flat->nchannel, n, together, 1, &fit, &refinement);
    if (status != ROTID_OK)
        return status;
    fit.equal = 1;
    (void)refine_poles(&fit, ITERATIONS, NULL, &refinement);
    if (!refinement.moved[0])
        *common = fit.pole[0] * fit.scale;
    return ROTID_OK;
}

/* The common pole of all channels near pole[which], all weighted alike, so that those that respond most decide: where the model
 * is wrong, noise does not tell what to trust. *common := NaN where that fails. ROTID_OK or ROTID_ERROR_MEMORY. */
static int local_common(const struct pool *pool, const struct ema_band *band, int nmode, const double complex *pole, int which,
                        double complex *common)
{
    struct pool scratch;
    struct ema_band flat = *band;
    double complex together[MOST_TOGETHER] = {pole[which]};
    double window = local_reach(pole[which]) + FRINGE * fabs(creal(pole[which]));
    int n = 1;
    flat.variance = NULL;
    *common = CMPLX(NAN, NAN);
    for (int r = 0; r < nmode; r++)
        if (r != which && fabs(cimag(pole[r]) - cimag(pole[which])) < 2 * window && n < MOST_TOGETHER)
            together[n++] = pole[r];
    pool_open(&scratch, pool->allocator);
    int status = fit_common(&scratch, &flat, n, together, n > 1 ? 2 * window : window, common);
    pool_close(&scratch);
    return status;
}

/* Common poles [n] against one a channel over the same window. *one := the median of the channels' poles where that is better,
 * else NaN; *none: nor are they modes. */
static int compare(struct pool *scratch, const struct ema_band *band, int n, const double complex *cluster, double complex *one,
                   int *none)
{
    struct modal_fit fit;
    struct refinement refinement;
    double low = cimag(cluster[0]), high = cimag(cluster[n - 1]), half = 0;
    for (int r = 0; r < n; r++)
        half = fmax(half, fabs(creal(cluster[r])));
    double complex middle = CMPLX(-half, (low + high) / 2);
    double reach = fmax((high - low) / 2 + 2 * half, 0.5 * local_reach(middle)), window = reach + FRINGE * half;
    int *line = POOL_ARRAY(scratch, int, band->nline);
    double complex *residue = POOL_ARRAY(scratch, double complex, band->nchannel);
    double *re = POOL_ARRAY(scratch, double, band->nchannel), *im = POOL_ARRAY(scratch, double, band->nchannel);
    *one = CMPLX(NAN, NAN);
    *none = 0;
    if (!line || !re || !im || !residue)
        return ROTID_ERROR_MEMORY;
    int nline = window_lines(band, cimag(middle) - window, cimag(middle) + window, line);
    if (2 * nline < 2 * (4 * n + 4))
        return ROTID_OK;
    int status = refinement_open(scratch, band, nline, line, 0, band->nchannel, n, cluster, 1, &fit, &refinement);
    if (status != ROTID_OK)
        return status;
    (void)refine_poles(&fit, ITERATIONS, NULL, &refinement);
    double gain = 0, sum = 0;
    int known = 0;
    for (int k = 0; k < band->nchannel; k++) {
        struct local_pole alone;
        double common = fit.weight ? fit.chi2[k] : fit.sigma[k] * fit.sigma[k] * fit.chi2[k];
        struct pool inner;
        pool_open(&inner, scratch->allocator);
        status = fit_window(&inner, band, k, nline, line, NULL, 1, &middle, 1, reach, &alone);
        pool_close(&inner);
        if (status != ROTID_OK)
            return status;
        sum += fit.weight ? alone.chi2 : 2 * nline;
        gain += fit.weight ? common - alone.chi2 : 2 * nline * log(fmax(common, 1e-300) / fmax(alone.chi2, 1e-300));
        if (alone.known) {
            residue[known] = alone.residue;
            re[known] = creal(alone.pole);
            im[known++] = cimag(alone.pole);
        }
    }
    /* peaks of several channels that have nothing to do with each other have no phase in common */
    *none = gain > LEAST_GAIN * sum && known > 2 && mode_phase_collinearity(known, residue) < LEAST_MPC;
    if (gain > LEAST_GAIN * sum && known > 0 && !*none)
        *one = CMPLX(median_of((size_t)known, re), median_of((size_t)known, im));
    return ROTID_OK;
}

int local_merge(const struct pool *pool, const struct ema_band *band, int *count, double complex *pole)
{
    int kept = 0;
    for (int first = 0, last; first < *count; first = last) {
        for (last = first + 1; last < *count; last++)
            if (cimag(pole[last]) - cimag(pole[last - 1]) > MERGE_REACH * cabs(pole[last]))
                break;
        int n = last - first, none = 0;
        double complex one = CMPLX(NAN, NAN);
        if (n > 1 && n <= MOST_TOGETHER && band->nchannel > 1) {
            struct pool scratch;
            pool_open(&scratch, pool->allocator);
            int status = compare(&scratch, band, n, pole + first, &one, &none);
            pool_close(&scratch);
            if (status != ROTID_OK)
                return status;
        }
        if (none)
            continue;
        if (isnan(creal(one))) {
            memmove(pole + kept, pole + first, (size_t)n * sizeof *pole);
            kept += n;
        } else {
            pole[kept++] = one;
        }
    }
    *count = kept;
    return ROTID_OK;
}

#define SCATTER        3      /* standard deviations */
#define MEDIAN_STD     1.2533 /* of a median over that of a mean */
#define ALONE_WIDTHS   3
#define LESS           (2.0 / 3)
#define SCATTER_WIDTHS 0.02 /* half bandwidths: less changes a residue by less than a thousandth */

/* Standard deviation of what scatters normally, from the median distance to the median: a channel whose own fit went astray does
 * not count. sorted [known] is overwritten. */
static double robust_scatter(int known, double centre, double *sorted)
{
    for (int k = 0; k < known; k++)
        sorted[k] = fabs(sorted[k] - centre);
    return 1.4826 * median_of((size_t)known, sorted);
}

/* Scatter of the imaginary parts of the channels that know their pole, as it is and over their standard deviations. Returns the
 * number of those channels. */
static int scatter(int n, const struct local_pole *local, double *sorted, double *rms, double *chi)
{
    int known = 0;
    for (int k = 0; k < n; k++)
        if (local[k].known)
            sorted[known++] = cimag(local[k].pole);
    *rms = *chi = 0;
    if (known < 2)
        return known;
    double centre = median_of((size_t)known, sorted);
    *rms = robust_scatter(known, centre, sorted);
    known = 0;
    for (int k = 0; k < n; k++)
        if (local[k].known)
            sorted[known++] = (cimag(local[k].pole) - centre) / sqrt(fmax(local[k].covariance[3], 1e-300));
    *chi = robust_scatter(known, 0, sorted);
    return known;
}

/* Frequency and damping as medians of the channels, with the deviation of a median. */
static void median_frequency(int n, const struct local_pole *local, double decay, int known, double *sorted,
                             struct ema_mode *mode)
{
    struct ema_mode one;
    double centre[2], std[2];
    for (int which = 0; which < 2; which++) {
        int count = 0;
        for (int k = 0; k < n; k++)
            if (local[k].known) {
                modes_of_pole(local[k].pole + decay, NULL, &one);
                sorted[count++] = which ? one.damping : one.frequency_hz;
            }
        centre[which] = median_of((size_t)known, sorted);
        std[which] = MEDIAN_STD * robust_scatter(known, centre[which], sorted) / sqrt(known);
    }
    double w = TWO_PI * centre[0];
    modes_of_pole(w * CMPLX(-centre[1], sqrt(1 - centre[1] * centre[1])), NULL, mode);
    mode->frequency_std = std[0];
    mode->damping_std = std[1];
}

static int take_local(struct pool *pool, const struct ema_band *band, const struct local_pole *local, double decay, int known,
                      double *sorted, struct ema *out, struct ema_mode *mode)
{
    mode->local_pole = POOL_ARRAY(pool, double complex, out->nfrf);
    if (!mode->local_pole)
        return ROTID_ERROR_MEMORY;
    for (int c = 0; c < out->nfrf; c++)
        mode->local_pole[c] = CMPLX(NAN, NAN);
    for (int k = 0; k < band->nchannel; k++)
        if (local[k].known) {
            int c = band->channel[k];
            mode->local_pole[c] = local[k].pole + decay;
            mode->residue[c] = local[k].residue;
            mode->residue_std[c] = local[k].residue_std;
        }
    median_frequency(band->nchannel, local, decay, known, sorted, mode);
    return ROTID_OK;
}

/* Neither one pole for all nor one for each describes such a peak: a pole as other programs take it, deviations as they are. */
static int take_common(struct pool *pool, const struct ema_band *band, int nmode, const double complex *pole, int r, double decay,
                       struct ema_mode *mode)
{
    double complex common;
    double frequency_std = mode->frequency_std, damping_std = mode->damping_std;
    int status = local_common(pool, band, nmode, pole, r, &common);
    if (status != ROTID_OK || isnan(creal(common)))
        return status;
    modes_of_pole(common + decay, NULL, mode);
    mode->frequency_std = frequency_std;
    mode->damping_std = damping_std;
    return ROTID_OK;
}

static void take_points(const struct ema_band *band, const struct local_pole *local, double decay, const struct ema *out,
                        struct ema_mode *mode)
{
    for (int p = 0; p < out->npoint; p++) {
        double sum = 0, weight = 0;
        for (int k = 0; k < band->nchannel; k++) {
            struct ema_mode one;
            if (out->channel_point[band->channel[k]] != p || !local[k].known)
                continue;
            modes_of_pole(local[k].pole + decay, local[k].covariance, &one);
            double w = 1 / fmax(one.frequency_std * one.frequency_std, 1e-300);
            sum += w * one.frequency_hz;
            weight += w;
        }
        mode->point_frequency_hz[p] = weight > 0 ? sum / weight : NAN;
        mode->point_frequency_std[p] = weight > 0 ? 1 / sqrt(weight) : NAN;
    }
}

/* A mass that moves shifts a peak and leaves its width: where the widths disagree by more than half in a fifth of the channels,
 * something else is wrong with the peak, and one pole a channel would be no better. */
static int same_width(int n, const struct local_pole *local, int known, double *sorted)
{
    int count = 0, alike = 0;
    for (int k = 0; k < n; k++)
        if (local[k].known)
            sorted[count++] = -creal(local[k].pole) / cabs(local[k].pole);
    sort_doubles((size_t)known, sorted);
    double median = sorted[known / 2];
    for (int k = 0; k < known; k++)
        alike += fabs(sorted[k] / median - 1) < 0.5;
    return 5 * alike >= 4 * known;
}

/* One channel alone does not tell two modes that overlap apart. */
static int stands_alone(int nmode, const double complex *pole, int r)
{
    for (int s = 0; s < nmode; s++)
        if (s != r && fabs(cimag(pole[s]) - cimag(pole[r])) < ALONE_WIDTHS * 2 * fmax(fabs(creal(pole[s])), fabs(creal(pole[r]))))
            return 0;
    return 1;
}

/* Whether poles of their own explain the channels better; else the scatter is that of a local fit among neighbours. */
static int leaves_less(int n, const struct local_pole *local, const double *common)
{
    double together = 0, alone = 0;
    for (int k = 0; k < n; k++)
        if (local[k].known) {
            together += common[k];
            alone += local[k].noise;
        }
    return alone < LESS * together;
}

struct channel { /* its own view of all modes, those beyond the band behind */
    int nmode;
    double complex *pole, *residue;
};

static void view(const struct ema *out, int c, double decay, struct channel *channel)
{
    for (int r = 0; r < channel->nmode; r++) {
        const struct ema_mode *mode = &out->mode[r];
        int own = mode->local_pole && !isnan(creal(mode->local_pole[c]));
        channel->pole[r] = (own ? mode->local_pole[c] : mode->pole) - decay;
        channel->residue[r] = mode->residue[c];
    }
}

struct work {
    struct pool *pool;
    const struct ema_band *band;
    double decay;
    const double *common, *gain;
    double complex *pole; /* [nmode + nguard] common ones */
    struct channel channel;
    struct local_pole *local; /* [nchannel] */
    double *sorted;           /* [nchannel] */
    struct ema *out;
};

/* One mode in every channel, and what follows. informed: the residues of all modes are known. */
static int one_mode(struct work *w, int informed, int r)
{
    const struct ema_band *band = w->band;
    struct ema *out = w->out;
    struct ema_mode *mode = &out->mode[r];
    double chi, rms;
    for (int k = 0; k < band->nchannel; k++) {
        view(out, band->channel[k], w->decay, &w->channel);
        w->channel.pole[r] = w->pole[r];
        int status =
            local_fit(w->pool, band, k, w->channel.nmode, w->channel.pole, informed ? w->channel.residue : NULL, r, &w->local[k]);
        if (status != ROTID_OK)
            return status;
        w->local[k].residue_std = hypot(w->local[k].residue_std, sqrt(w->gain[r]) * cabs(w->local[k].residue));
    }
    if (mode->point_frequency_hz)
        take_points(band, w->local, w->decay, out, mode);
    int known = scatter(band->nchannel, w->local, w->sorted, &rms, &chi);
    if (known < 2 || !stands_alone(out->nmode, w->pole, r) ||
        !leaves_less(band->nchannel, w->local, w->common + (ptrdiff_t)r * band->nchannel) || !(chi > SCATTER) ||
        !(rms > SCATTER_WIDTHS * fabs(creal(w->pole[r]))))
        return ROTID_OK;
    mode->quality_flags |= EMA_DOUBLE_PEAK;
    return same_width(band->nchannel, w->local, known, w->sorted)
               ? take_local(w->pool, band, w->local, w->decay, known, w->sorted, out, mode)
               : take_common(w->pool, band, out->nmode, w->pole, r, w->decay, mode);
}

/* L and U of a channel for poles of its own: least squares of what its modes leave, L - omega^2 U. */
static void refit_rest(struct work *w, int k)
{
    const struct ema_band *band = w->band;
    int c = band->channel[k];
    double one = 0, square = 0, fourth = 0, top = band->high * band->high;
    double complex left = 0, right = 0;
    view(w->out, c, w->decay, &w->channel);
    for (int i = 0; i < band->nline; i++) {
        ptrdiff_t at = i + (ptrdiff_t)k * band->nline;
        double weight = band->variance ? 1 / band->variance[at] : 1, x = -band->omega[i] * band->omega[i] / top;
        double complex s = I * band->omega[i], sum = 0;
        for (int r = 0; r < w->channel.nmode; r++)
            if (!isnan(creal(w->channel.residue[r])))
                sum += w->channel.residue[r] / (s - w->channel.pole[r]) +
                       conj(w->channel.residue[r]) / (s - conj(w->channel.pole[r]));
        double complex rest = band->h[at] - s * s * sum;
        one += weight;
        square += weight * x;
        fourth += weight * x * x;
        left += weight * rest;
        right += weight * x * rest;
    }
    double determinant = one * fourth - square * square;
    if (!(determinant > 1e-12 * one * fourth))
        return;
    w->out->lower[c] = (fourth * left - square * right) / determinant;
    w->out->upper[c] = (one * right - square * left) / determinant / top;
}

static int has_local(const struct ema *out)
{
    for (int r = 0; r < out->nmode; r++)
        if (out->mode[r].local_pole)
            return 1;
    return 0;
}

int per_point_frequencies(struct pool *pool, const struct ema_band *band, double decay, const int *suspect, const double *common,
                          const double *gain, const rotid_environment *environment, struct ema *out)
{
    int all = out->nmode + out->nguard;
    struct work w = {.pool = pool,
                     .band = band,
                     .decay = decay,
                     .common = common,
                     .gain = gain,
                     .pole = POOL_ARRAY(pool, double complex, all),
                     .channel = {all, POOL_ARRAY(pool, double complex, all), POOL_ARRAY(pool, double complex, all)},
                     .local = POOL_ARRAY(pool, struct local_pole, band->nchannel),
                     .sorted = POOL_ARRAY(pool, double, band->nchannel),
                     .out = out};
    if (!w.local || !w.pole || !w.sorted || !w.channel.pole || !w.channel.residue)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < all; r++)
        w.pole[r] = out->mode[r].pole - decay;
    /* twice: the first time the other modes are known by poles that do not suit the channel */
    for (int informed = 0; informed < 2; informed++)
        for (int r = 0; r < out->nmode; r++) {
            if (!suspect[r] && !out->mode[r].point_frequency_hz)
                continue;
            if (environment_cancelled(environment))
                return ROTID_STOP_CANCELLED;
            environment_progress(environment, "frequency of each point", r);
            int status = one_mode(&w, informed, r);
            if (status != ROTID_OK)
                return status;
        }
    for (int k = 0; k < band->nchannel && has_local(out); k++)
        refit_rest(&w, k);
    return ROTID_OK;
}
