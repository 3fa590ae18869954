#include "ema/ema.h"

#define LEAST_SHARE    0.05
#define OVERDAMPED     0.2
#define MOST_UNCERTAIN 0.2
#define LEAST_MPC      0.4
#define REAL_MPC       0.9
#define ATTACHED       0.05 /* of the median mode's highest peak */
#define TWIN_WIDTHS    0.5
#define SAME_WIDTHS    0.2
#define TWIN_MAC       0.9
#define VISIBLE        12 /* |A|^2/var: chance reaches that once in four hundred */
#define NOISE_WIDTHS   3
#define ITERATIONS     6
#define CLOSE          4 /* half-power bandwidths: neighbours that may spoil each other */
#define CLOSE_WEAK     1 /* of one that is weak: only two of one mode take all strength from each other */
#define SCREEN         0.2

int selection_lines(const struct ema_band *band, int nmode, double products)
{
    double columns = 4 * nmode + 5, lines = products / (2 * columns * columns * band->nchannel);
    return (int)fmin(fmax(lines, fmax(16 * nmode, 400)), band->nline);
}

enum round { SCREENING, AS_THEY_COME, REFINED };

/* What the best of very many places in the noise reaches by chance. */
static double limit(int n)
{
    return 2 * n + 12 * sqrt(n) + 30;
}

/* sum |A|^2/var over the channels; noise [nchannel]: left around the mode; *share: largest |A g|/|H| at the mode; *seen_in:
 * channels that show it */
static double significance(const struct ema_band *band, const struct modal_fit *fit, int r, const double *noise, double *share,
                           int *seen_in, double complex *residue)
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
        double a = x[(ptrdiff_t)2 * r], b = x[(ptrdiff_t)2 * r + 1];
        double vaa = spread[(ptrdiff_t)2 * r + (ptrdiff_t)2 * r * q],
               vbb = spread[(ptrdiff_t)2 * r + 1 + (ptrdiff_t)(2 * r + 1) * q];
        double vab = spread[(ptrdiff_t)2 * r + 1 + (ptrdiff_t)2 * r * q], determinant = vaa * vbb - vab * vab;
        if (fit->singular[c] || !(determinant > 0))
            continue;
        double one = (a * a * vbb - 2 * a * b * vab + b * b * vaa) / determinant;
        /* what is left around the mode may exceed the noise of the channel: the noise of a line spectrum, or of a weak hammer */
        one /= fmax(noise[c], 1);
        sum += one;
        double size = cabs(CMPLX(a, b) / (I * nu - fit->pole[r])) * nu * nu,
               seen = cabs(band->h[at + (ptrdiff_t)c * band->nline]);
        /* a channel where the mode cannot be told from noise says nothing */
        if (one > VISIBLE && seen > 0) {
            *share = fmax(*share, size / seen);
            residue[*seen_in] = CMPLX(a, b);
            (*seen_in)++;
        }
    }
    return sum;
}

/* Of the residues of a mode as they are, known or not. residue [nchannel] is workspace. */
static double collinearity(const struct modal_fit *fit, int r, double complex *residue)
{
    for (int c = 0; c < fit->nchannel; c++) {
        const double *x = fit->linear + (ptrdiff_t)2 * r + (ptrdiff_t)c * fit->nlinear;
        residue[c] = CMPLX(x[0], x[1]);
    }
    return mode_phase_collinearity(fit->nchannel, residue);
}

/* How badly mode r fails, 0 where it does not. */
static double failure(const struct ema_band *band, const struct modal_fit *fit, const struct refinement *refinement, int r,
                      const double *noise, double *strength, double complex *residue)
{
    int p = 2 * fit->nmode, n = fit->nchannel;
    double complex pole = fit->pole[r] * fit->scale;
    int seen_in;
    double half = fabs(creal(fit->pole[r])), share;
    double variance = 0;
    for (int j = 2 * r; j < 2 * r + 2; j++) {
        /* what the channels disagree about makes a mode no less real: it may move from point to point */
        double widened = refinement->widened[j];
        variance = fmax(variance, refinement->covariance[j + (ptrdiff_t)j * p] / (widened * widened));
        if (isnan(refinement->covariance[j + (ptrdiff_t)j * p]))
            return 2.5;
    }
    *strength = significance(band, fit, r, noise, &share, &seen_in, residue);
    int at = ema_band_line(band, cimag(pole));
    at = at < 1 ? 1 : at > band->nline - 1 ? band->nline - 1 : at;
    double spacing = band->omega[at] - band->omega[at - 1];
    if (refinement->moved[r] || half > OVERDAMPED * cabs(fit->pole[r]) || cimag(pole) < band->low || cimag(pole) > band->high ||
        2 * half * fit->scale < 0.2 * spacing)
        return 3;
    if (sqrt(variance) > MOST_UNCERTAIN * half)
        return 2.5;
    if (*strength <= limit(n))
        return 2 - *strength / limit(n);
    return share < LEAST_SHARE || (n >= 3 && seen_in < 2) ||
                   (seen_in > 2 && mode_phase_collinearity(seen_in, residue) < LEAST_MPC)
               ? 0.5
               : 0;
}

static int is_close(const struct modal_fit *fit, int a, int b, double widths)
{
    double width = 2 * fmax(fabs(creal(fit->pole[a])), fabs(creal(fit->pole[b])));
    return fabs(cimag(fit->pole[a]) - cimag(fit->pole[b])) < widths * width;
}

static double alike(const struct modal_fit *fit, int r, int s)
{
    double complex ab = 0;
    double aa = 0, bb = 0;
    for (int c = 0; c < fit->nchannel; c++) {
        const double *x = fit->linear + (ptrdiff_t)c * fit->nlinear;
        double complex a = CMPLX(x[(ptrdiff_t)2 * r], x[(ptrdiff_t)2 * r + 1]),
                       b = CMPLX(x[(ptrdiff_t)2 * s], x[(ptrdiff_t)2 * s + 1]);
        aa += creal(a * conj(a));
        bb += creal(b * conj(b));
        ab += conj(a) * b;
    }
    return aa > 0 && bb > 0 ? creal(ab * conj(ab)) / (aa * bb) : 1;
}

/* Two poles within half a half-power bandwidth of each other with one shape are one mode and its misfit; within a fifth the
 * shapes cannot be told apart. */
static void drop_close(const struct modal_fit *fit, int count, const double *strength, double *bad)
{
    for (int r = 0; r < count; r++)
        for (int s = r + 1; s < count; s++) {
            double width = 2 * fmin(fabs(creal(fit->pole[r])), fabs(creal(fit->pole[s])));
            double apart = fabs(cimag(fit->pole[r]) - cimag(fit->pole[s])) / width;
            if (bad[r] == 0 && bad[s] == 0 && (apart < SAME_WIDTHS || (apart < TWIN_WIDTHS && alike(fit, r, s) > TWIN_MAC)))
                bad[strength[r] < strength[s] ? r : s] = 1;
        }
}

/* A weak peak whose phases are not those of a normal mode belongs to something attached, not to the rotor. */
static void drop_attachments(const struct modal_fit *fit, int count, double *peak, double *sorted, double complex *residue,
                             double *bad)
{
    size_t good = 0;
    for (int r = 0; r < count; r++) {
        double nu = cimag(fit->pole[r]), half = fmax(fabs(creal(fit->pole[r])), 1e-300);
        peak[r] = 0;
        for (int c = 0; c < fit->nchannel; c++)
            peak[r] = fmax(peak[r], hypot(fit->linear[(ptrdiff_t)2 * r + (ptrdiff_t)c * fit->nlinear],
                                          fit->linear[(ptrdiff_t)2 * r + 1 + (ptrdiff_t)c * fit->nlinear]) *
                                        nu * nu / half);
        if (bad[r] == 0)
            sorted[good++] = peak[r];
    }
    sort_doubles(good, sorted);
    for (int r = 0; r < count; r++)
        if (bad[r] == 0 && fit->nchannel > 2 && peak[r] < ATTACHED * sorted[good / 2] && collinearity(fit, r, residue) < REAL_MPC)
            bad[r] = 0.4;
}

/* One fit of all; keep [count] := 0 for what goes: of neighbours the weakest only, since it may be what spoils the other. */
static int judge(struct pool *scratch, const struct ema_band *band, int threads, const rotid_environment *environment,
                 enum round round, int count, double complex *pole, int *keep, int *dropped)
{
    struct modal_fit fit;
    struct refinement refinement;
    int *line = POOL_ARRAY(scratch, int, band->nline);
    double *bad = POOL_ARRAY(scratch, double, count), *strength = POOL_ARRAY(scratch, double, count);
    double complex *residue = POOL_ARRAY(scratch, double complex, band->nchannel);
    double *peak = POOL_ARRAY(scratch, double, count), *sorted = POOL_ARRAY(scratch, double, count);
    double *noise = POOL_ARRAY(scratch, double, (size_t)count *(size_t)band->nchannel);
    if (!line || !bad || !strength || !residue || !peak || !sorted || !noise)
        return ROTID_ERROR_MEMORY;
    int nline = modal_fit_lines(band, count, pole, FIT_WIDTHS, selection_lines(band, count, EARN_PRODUCTS), line);
    int status = refinement_open(scratch, band, nline, line, 0, band->nchannel, count, pole, threads, &fit, &refinement);
    if (status != ROTID_OK)
        return status;
    status = refine_poles(&fit, round == REFINED ? ITERATIONS : 0, environment, &refinement);
    if (status != ROTID_OK)
        return status;
    modal_fit_local_noise(&fit, count, NOISE_WIDTHS, noise);
    for (int r = 0; r < count; r++)
        bad[r] = failure(band, &fit, &refinement, r, noise + (ptrdiff_t)r * band->nchannel, &strength[r], residue);
    for (int r = 0; r < count && round == SCREENING; r++)
        bad[r] = strength[r] < SCREEN * limit(band->nchannel);
    if (round != SCREENING)
        drop_close(&fit, count, strength, bad);
    if (round == REFINED)
        drop_attachments(&fit, count, peak, sorted, residue, bad);
    *dropped = 0;
    for (int r = 0; r < count; r++) {
        keep[r] = bad[r] == 0;
        double widths = strength[r] < limit(band->nchannel) ? CLOSE_WEAK : CLOSE;
        for (int s = 0; s < count && !keep[r]; s++)
            if (s != r && bad[s] > 0 && (strength[s] < strength[r] || (strength[s] == strength[r] && s < r)) &&
                is_close(&fit, r, s, widths))
                keep[r] = 1;
        *dropped += !keep[r];
    }
    for (int r = 0; r < count && round == REFINED; r++)
        if (bad[r] == 0)
            pole[r] = fit.pole[r] * fit.scale;
    return ROTID_OK;
}

/* Before the first round every pole is its own candidate. */
static void begin(int count, int *candidate)
{
    for (int r = 0; r < count; r++)
        candidate[r] = r;
}

/* One round on a pool of its own; *count becomes smaller by *dropped. */
static int weed(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                enum round round, int *count, double complex *pole, int *candidate, int *dropped)
{
    struct pool scratch;
    /* no more unknowns than two thirds of the lines can carry: the last candidates are the ones at the upper end */
    int most = (2 * band->nline * 2 / 3 - 4) / 4, kept = 0;
    *count = *count < most ? *count : most > 0 ? most : 0;
    *dropped = 0;
    if (*count == 0)
        return ROTID_OK;
    pool_open(&scratch, pool->allocator);
    int *keep = POOL_ARRAY(&scratch, int, *count);
    int status = !keep ? ROTID_ERROR_MEMORY : judge(&scratch, band, threads, environment, round, *count, pole, keep, dropped);
    for (int r = 0; status == ROTID_OK && r < *count; r++)
        if (keep[r]) {
            candidate[kept] = candidate[r];
            pole[kept++] = pole[r];
        }
    pool_close(&scratch);
    if (status == ROTID_OK)
        *count = kept;
    return status;
}

int selection_screen(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                     int *count, double complex *pole, int *candidate)
{
    int dropped;
    begin(*count, candidate);
    return weed(pool, band, threads, environment, SCREENING, count, pole, candidate, &dropped);
}

int selection_earn(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                   int *count, double complex *pole, int *candidate)
{
    int dropped;
    begin(*count, candidate);
    /* the first round takes the poles as they come, which is quick; every later one leaves one out at least, or is the last */
    int status = weed(pool, band, threads, environment, AS_THEY_COME, count, pole, candidate, &dropped);
    do {
        if (status == ROTID_OK)
            status = weed(pool, band, threads, environment, REFINED, count, pole, candidate, &dropped);
    } while (status == ROTID_OK && dropped && *count);
    return status;
}
