#include "ema/selection.h"

#include <math.h>

#include "ema/modal_fit.h"
#include "ema/real_mode.h"
#include "ema/refine.h"
#include "ema/residues.h"

#define LEAST_SHARE 0.05
#define OVERDAMPED  0.2
#define MOST_UNCERTAIN 0.2
#define LEAST_MPC 0.4
#define VISIBLE 12 /* |A|^2/var: chance reaches that once in four hundred */
#define NOISE_WIDTHS 3
#define ITERATIONS  8
#define CLOSE       4 /* half-power bandwidths: neighbours that may spoil each other */

int selection_lines(const struct ema_band *band, int nmode, double products)
{
    double columns = 4 * nmode + 5, lines = products / (2 * columns * columns * band->nchannel);
    return (int)fmin(fmax(lines, fmax(40 * nmode, 1000)), band->nline);
}

/* sum |A|^2/var over the channels; *share: largest |A g|/|H| at the mode; *seen_in: channels that show it */
static double significance(const struct ema_band *band, const struct modal_fit *fit, int r, double *share, int *seen_in,
                           double complex *residue)
{
    int q = fit->nlinear, at = ema_band_line(band, cimag(fit->pole[r]) * fit->scale);
    at = at < band->nline ? at : band->nline - 1;
    if (at > 0 && cimag(fit->pole[r]) * fit->scale - band->omega[at - 1] < band->omega[at] - cimag(fit->pole[r]) * fit->scale)
        at--;
    double nu = band->omega[at] / fit->scale, sum = 0;
    *share = 0;
    *seen_in = 0;
    for (int c = 0; c < fit->nchannel; c++) {
        const double *x = fit->linear + (ptrdiff_t)c * q, *spread = fit->spread + (ptrdiff_t)c * q * q;
        double a = x[2 * r], b = x[2 * r + 1];
        double vaa = spread[2 * r + (ptrdiff_t)(2 * r) * q], vbb = spread[2 * r + 1 + (ptrdiff_t)(2 * r + 1) * q];
        double vab = spread[2 * r + 1 + (ptrdiff_t)(2 * r) * q], determinant = vaa * vbb - vab * vab;
        if (fit->singular[c] || !(determinant > 0))
            continue;
        double one = (a * a * vbb - 2 * a * b * vab + b * b * vaa) / determinant;
        /* what is left around the mode may exceed the noise of the channel: the noise of a line spectrum, or of a weak hammer */
        one /= fmax(modal_fit_local_noise(fit, c, r, NOISE_WIDTHS), 1);
        sum += one;
        double size = cabs(CMPLX(a, b) / (I * nu - fit->pole[r])) * nu * nu, seen = cabs(band->h[at + (ptrdiff_t)c * band->nline]);
        /* a channel where the mode cannot be told from noise says nothing */
        if (one > VISIBLE && seen > 0) {
            *share = fmax(*share, size / seen);
            residue[*seen_in] = CMPLX(a, b);
            (*seen_in)++;
        }
    }
    return sum;
}

/* How badly mode r fails, 0 where it does not. */
static double failure(const struct ema_band *band, const struct modal_fit *fit, const struct refinement *refinement, int r,
                      double *strength, double complex *residue)
{
    int p = 2 * fit->nmode, n = fit->nchannel;
    double complex pole = fit->pole[r] * fit->scale;
    int seen_in;
    double half = fabs(creal(fit->pole[r])), share, limit = 2 * n + 12 * sqrt(n) + 30;
    double variance = 0;
    for (int j = 2 * r; j < 2 * r + 2; j++) {
        /* what the channels disagree about makes a mode no less real: it may move from point to point */
        double widened = refinement->widened[j];
        variance = fmax(variance, refinement->covariance[j + (ptrdiff_t)j * p] / (widened * widened));
        if (isnan(refinement->covariance[j + (ptrdiff_t)j * p]))
            return 2.5;
    }
    *strength = significance(band, fit, r, &share, &seen_in, residue);
    int at = ema_band_line(band, cimag(pole));
    at = at < 1 ? 1 : at > band->nline - 1 ? band->nline - 1 : at;
    double spacing = band->omega[at] - band->omega[at - 1];
    if (refinement->moved[r] || half > OVERDAMPED * cabs(fit->pole[r]) || cimag(pole) < band->low || cimag(pole) > band->high ||
        2 * half * fit->scale < 0.2 * spacing)
        return 3;
    if (sqrt(variance) > MOST_UNCERTAIN * half)
        return 2.5;
    if (*strength <= limit)
        return 2 - *strength / limit;
    return share < LEAST_SHARE || (n >= 3 && seen_in < 2) ||
                   (seen_in > 2 && mode_phase_collinearity(seen_in, residue) < LEAST_MPC)
               ? 0.5
               : 0;
}

static int is_close(const struct modal_fit *fit, int a, int b)
{
    double width = 2 * fmax(fabs(creal(fit->pole[a])), fabs(creal(fit->pole[b])));
    return fabs(cimag(fit->pole[a]) - cimag(fit->pole[b])) < CLOSE * width;
}

/* One fit of all; keep [count] := 0 for what goes: of neighbours the weakest only, since it may be what spoils the other. */
static int judge(struct pool *scratch, const struct ema_band *band, int threads, const rotid_environment *environment, int first,
                 int count, double complex *pole, int *keep, int *dropped)
{
    struct modal_fit fit;
    struct refinement refinement;
    int *line = POOL_ARRAY(scratch, int, band->nline);
    double *bad = POOL_ARRAY(scratch, double, count), *strength = POOL_ARRAY(scratch, double, count);
    double complex *residue = POOL_ARRAY(scratch, double complex, band->nchannel);
    if (!line || !bad || !strength || !residue)
        return ROTID_ERROR_MEMORY;
    int nline = modal_fit_lines(band, count, pole, FIT_WIDTHS, selection_lines(band, count, EARN_PRODUCTS), line);
    int status = modal_fit_new(scratch, band, nline, line, 0, band->nchannel, count, threads, &fit);
    if (status == ROTID_OK)
        status = refinement_new(scratch, &fit, &refinement);
    if (status != ROTID_OK)
        return status;
    for (int r = 0; r < count; r++)
        fit.pole[r] = pole[r] / fit.scale;
    status = refine_poles(&fit, first ? 0 : ITERATIONS, environment, &refinement);
    if (status != ROTID_OK)
        return status;
    for (int r = 0; r < count; r++)
        bad[r] = failure(band, &fit, &refinement, r, &strength[r], residue);
    *dropped = 0;
    for (int r = 0; r < count; r++) {
        keep[r] = bad[r] == 0;
        for (int s = 0; s < count && !keep[r]; s++)
            if (s != r && is_close(&fit, r, s) && bad[s] > 0 && (strength[s] < strength[r] || (strength[s] == strength[r] && s < r)))
                keep[r] = 1;
        *dropped += !keep[r];
    }
    for (int r = 0; r < count; r++)
        if (bad[r] == 0)
            pole[r] = fit.pole[r] * fit.scale;
    return ROTID_OK;
}

int selection_earn(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                   int *count, double complex *pole, int *candidate)
{
    for (int r = 0; r < *count; r++)
        candidate[r] = r;
    /* the first round takes the poles as they come, which is quick; every later one leaves one out at least, or is the last */
    for (int dropped = 1, first = 1; dropped && *count;) {
        struct pool scratch;
        pool_open(&scratch, pool->allocator);
        int *keep = POOL_ARRAY(&scratch, int, *count);
        /* no more unknowns than two thirds of the lines can carry: the last candidates are the ones at the upper end */
        int most = (2 * band->nline * 2 / 3 - 4) / 4;
        *count = *count < most ? *count : most > 0 ? most : 0;
        int status = !keep ? ROTID_ERROR_MEMORY : judge(&scratch, band, threads, environment, first, *count, pole, keep, &dropped);
        dropped += first;
        first = 0;
        int kept = 0;
        for (int r = 0; status == ROTID_OK && r < *count; r++)
            if (keep[r]) {
                candidate[kept] = candidate[r];
                pole[kept++] = pole[r];
            }
        pool_close(&scratch);
        if (status != ROTID_OK)
            return status;
        *count = kept;
    }
    return ROTID_OK;
}
