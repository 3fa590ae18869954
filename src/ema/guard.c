#include "ema/guard.h"

#include <math.h>
#include <string.h>

#include "ema/modal_fit.h"
#include "ema/refine.h"
#include "ema/selection.h"

#define TRIAL_LINES 600
#define ITERATIONS  12
#define START       1.5 /* half-power bandwidths beyond the end of the band */
#define FAR         2
#define WORTH       0.02 /* least share of what is left that a guard has to explain */

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
    int status = refinement_open(&scratch, band, nline, line, 0, band->nchannel, count, pole, threads, &fit, &refinement);
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

int guard_is_far(const struct ema_band *band, double complex pole)
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
        trial[count] = beyond(band, nmode, *nguard, pole, above);
        status = fit_all(pool, band, threads, environment, nline, line, count + 1, trial, &with);
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
