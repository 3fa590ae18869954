#include "ema/guard.h"

#include <math.h>
#include <string.h>

#include "ema/modal_fit.h"
#include "ema/refine.h"
#include "ema/selection.h"

#define TRIAL_LINES 2048
#define ITERATIONS  12
#define START       1.5 /* half-power bandwidths beyond the end of the band */

/* -2 log likelihood but for a constant: flat weights have their sigma from what is left. */
static double badness(const struct modal_fit *fit)
{
    double sum = 0;
    for (int c = 0; c < fit->nchannel; c++)
        sum += fit->weight ? fit->chi2[c] : 4 * fit->nline * log(fit->sigma[c]);
    return sum;
}

/* All poles refined together on some of the lines. */
static int fit_all(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                   int nline, const int *line, int count, double complex *pole, double *bad)
{
    struct modal_fit fit;
    struct refinement refinement;
    struct pool scratch;
    pool_open(&scratch, pool->allocator);
    int status = modal_fit_new(&scratch, band, nline, line, 0, band->nchannel, count, threads, &fit);
    if (!status)
        status = refinement_new(&scratch, &fit, &refinement);
    for (int r = 0; r < count && !status; r++)
        fit.pole[r] = pole[r] / fit.scale;
    if (!status)
        status = refine_poles(&fit, ITERATIONS, environment, &refinement);
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

/* Where the next one is tried: as damped as the mode next to that end. */
static double complex beyond(const struct ema_band *band, int nmode, const double complex *pole, int above)
{
    int nearest = 0;
    for (int r = 1; r < nmode; r++)
        if (above ? cimag(pole[r]) > cimag(pole[nearest]) : cimag(pole[r]) < cimag(pole[nearest]))
            nearest = r;
    double end = above ? band->high : band->low, zeta = -creal(pole[nearest]) / cabs(pole[nearest]);
    double half = zeta * end, at = above ? end + 2 * START * half : end - 2 * START * half;
    return CMPLX(-half, at > 0.5 * end ? at : 0.5 * end);
}

int guard_poles(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
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
        status = fit_all(pool, band, threads, environment, nline, line, nmode, pole, &bad);
    for (int above = 1; *nguard < GUARD_MOST && !status && tries[0] + tries[1] < 2; above = !above) {
        if (tries[above])
            continue;
        double with;
        int count = nmode + *nguard;
        memcpy(trial, pole, (size_t)count * sizeof *trial);
        trial[count] = beyond(band, nmode, pole, above);
        status = fit_all(pool, band, threads, environment, nline, line, count + 1, trial, &with);
        tries[above] = status || bad - with < least;
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
