#include "ema/ema.h"

#include <math.h>
#include <string.h>

#include "base/base.h"
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

int local_fit(const struct pool *pool, const struct ema_band *band, int k, int nmode, const double complex *pole,
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

int local_common(const struct pool *pool, const struct ema_band *band, int nmode, const double complex *pole, int which,
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
