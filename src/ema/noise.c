#include "ema/noise.h"

#include <math.h>

#include "ema/modal_fit.h"
#include "ema/refine.h"
#include "ema/selection.h"

#define HALF_WIDTH 30 /* lines: the variance is then known to a tenth */
#define EULER      0.5772156649015329
#define ITERATIONS 4

/* log |H - model|^2 of channel c on all lines. */
static void residual(const struct ema_band *band, const struct modal_fit *fit, int c, double *square)
{
    const double *x = fit->linear + (ptrdiff_t)c * fit->nlinear, *rest = x + (ptrdiff_t)2 * fit->nmode;
    for (int i = 0; i < band->nline; i++) {
        double nu = band->omega[i] / fit->scale, re = 0, im = 0;
        for (int r = 0; r < fit->nmode; r++) {
            double a = creal(fit->pole[r]), b = cimag(fit->pole[r]), below = nu - b, above = nu + b;
            double d = 1 / (a * a + below * below), e = 1 / (a * a + above * above), p = x[(ptrdiff_t)2 * r],
                   q = x[(ptrdiff_t)2 * r + 1];
            /* (p + i q) (-a - i below) d + (p - i q) (-a - i above) e */
            re += (-p * a + q * below) * d + (-p * a - q * above) * e;
            im += (-q * a - p * below) * d + (q * a - p * above) * e;
        }
        double complex h = band->h[i + (ptrdiff_t)c * band->nline];
        double left = creal(h) + nu * nu * (re + rest[2]) - rest[0], quadrature = cimag(h) + nu * nu * (im + rest[3]) - rest[1];
        square[i] = log(fmax(left * left + quadrature * quadrature, 1e-300));
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
    return refine_poles(fit, ITERATIONS, environment, &refinement);
}

int noise_from_residual(struct pool *pool, struct ema_band *band, int threads, const rotid_environment *environment, int n,
                        const double complex *pole)
{
    struct pool scratch;
    struct modal_fit fit;
    size_t lines = (size_t)band->nline;
    if (n == 0)
        return ROTID_OK;
    pool_open(&scratch, pool->allocator);
    double *square = POOL_ARRAY(&scratch, double, lines);
    double *variance = band->variance ? band->variance : POOL_ARRAY(pool, double, lines *(size_t)band->nchannel);
    int status = square && variance ? fit_all(&scratch, band, threads, environment, n, pole, &fit) : ROTID_ERROR_MEMORY;
    for (int c = 0; status == ROTID_OK && c < band->nchannel; c++) {
        residual(band, &fit, c, square);
        smooth_logarithm(band->nline, square, variance + (size_t)c * lines);
    }
    if (status == ROTID_OK)
        band->variance = variance;
    pool_close(&scratch);
    return status;
}
