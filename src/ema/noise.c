#include "ema/noise.h"

#include <math.h>
#include <string.h>

#include "ema/modal_fit.h"
#include "ema/refine.h"
#include "ema/selection.h"
#include "linalg/product.h"

#define HALF_WIDTH 30  /* lines: the variance is then known to a tenth */
#define BLOCK      128 /* lines at a time */
#define EULER      0.5772156649015329
#define ITERATIONS 4

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
