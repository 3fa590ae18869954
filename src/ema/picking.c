#include "ema/picking.h"

#include <math.h>

#include "base/order.h"
#include "ema/modes.h"

#define TWO_PI     6.283185307179586
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

int picking_compute(struct pool *pool, const struct ema_band *band, const struct ema_options *options, double decay,
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
