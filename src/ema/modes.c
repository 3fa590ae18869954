#include "ema/ema.h"

#include <math.h>

#include "base/base.h"

#define TWO_PI 6.283185307179586

#define CLOSE_WIDTHS   3 /* half-power bandwidths */
#define EDGE_WIDTHS    2
#define LEAST_MPC      0.8
#define MOST_MPD       20 /* degrees */
#define WEAK_THRESHOLD 3  /* standard deviations of the strongest residue */

static int set_nan(struct pool *pool, size_t count, double **array)
{
    *array = POOL_ARRAY(pool, double, count);
    for (size_t i = 0; *array && i < count; i++)
        (*array)[i] = NAN;
    return *array != NULL;
}

static int set_complex_nan(struct pool *pool, size_t count, double complex **array)
{
    *array = POOL_ARRAY(pool, double complex, count);
    for (size_t i = 0; *array && i < count; i++)
        (*array)[i] = CMPLX(NAN, NAN);
    return *array != NULL;
}

int modes_new(struct pool *pool, int nmode, int per_point, struct ema *out)
{
    size_t nfrf = (size_t)out->nfrf, npoint = (size_t)out->npoint;
    out->nmode = nmode;
    out->mode = POOL_ARRAY(pool, struct ema_mode, nmode);
    if (!out->mode || !set_complex_nan(pool, nfrf, &out->lower) || !set_complex_nan(pool, nfrf, &out->upper))
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < nmode; r++) {
        struct ema_mode *mode = &out->mode[r];
        mode->frequency_std = mode->damping_std = mode->modal_mass = mode->peak_signal_to_noise = mode->nearest_hz = NAN;
        if (!set_complex_nan(pool, nfrf, &mode->residue) || !set_nan(pool, nfrf, &mode->residue_std) ||
            !set_nan(pool, npoint, &mode->shape) || !set_nan(pool, npoint, &mode->shape_std) ||
            !set_complex_nan(pool, npoint, &mode->complex_shape) ||
            (per_point &&
             (!set_nan(pool, npoint, &mode->point_frequency_hz) || !set_nan(pool, npoint, &mode->point_frequency_std))))
            return ROTID_ERROR_MEMORY;
    }
    return ROTID_OK;
}

void modes_of_pole(double complex pole, const double *covariance, struct ema_mode *mode)
{
    double w = cabs(pole), zeta = w > 0 ? -creal(pole) / w : 0;
    mode->pole = pole;
    mode->frequency_hz = w / TWO_PI;
    mode->damping = zeta;
    mode->frequency_std = mode->damping_std = NAN;
    if (!covariance || !(w > 0))
        return;
    double dw[2] = {creal(pole) / w, cimag(pole) / w}, dz[2] = {(-1 - zeta * dw[0]) / w, -zeta * dw[1] / w};
    double vw = 0, vz = 0;
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++) {
            vw += dw[j] * dw[k] * covariance[j + 2 * k];
            vz += dz[j] * dz[k] * covariance[j + 2 * k];
        }
    mode->frequency_std = sqrt(fmax(vw, 0)) / TWO_PI;
    mode->damping_std = sqrt(fmax(vz, 0));
    if (isnan(vw) || isnan(vz))
        mode->frequency_std = mode->damping_std = NAN;
}

void modes_from_fit(const struct ema_band *band, const struct modal_fit *fit, const struct refinement *refinement, double decay,
                    struct ema *out)
{
    int p = 2 * fit->nmode;
    for (int r = 0; r < fit->nmode; r++) {
        double block[4];
        for (int k = 0; k < 2; k++)
            for (int j = 0; j < 2; j++)
                block[j + 2 * k] =
                    refinement->covariance[(ptrdiff_t)2 * r + j + (ptrdiff_t)(2 * r + k) * p] * fit->scale * fit->scale;
        modes_of_pole(fit->pole[r] * fit->scale + decay, block, &out->mode[r]);
        if (refinement->moved[r] || !refinement->converged)
            out->mode[r].quality_flags |= EMA_NOT_REFINED;
    }
    for (int k = 0; k < fit->nchannel; k++) {
        int c = band->channel[k];
        const double *x = fit->linear + (ptrdiff_t)k * fit->nlinear;
        if (fit->singular[k])
            continue;
        out->lower[c] = CMPLX(x[p], x[p + 1]);
        out->upper[c] = CMPLX(x[p + 2], x[p + 3]) / (fit->scale * fit->scale);
        for (int r = 0; r < fit->nmode; r++)
            residue_of_mode(fit, k, r, refinement->covariance, &out->mode[r].residue[c], &out->mode[r].residue_std[c]);
    }
}

static double mac_of(int n, const double complex *a, const double complex *b)
{
    double aa = 0, bb = 0;
    double complex ab = 0;
    for (int i = 0; i < n; i++) {
        if (isnan(creal(a[i])) || isnan(creal(b[i])))
            continue;
        aa += creal(a[i] * conj(a[i]));
        bb += creal(b[i] * conj(b[i]));
        ab += conj(a[i]) * b[i];
    }
    return aa > 0 && bb > 0 ? creal(ab * conj(ab)) / (aa * bb) : 0;
}

static double half_power_hz(const struct ema_mode *mode)
{
    return 2 * fabs(mode->damping) * mode->frequency_hz;
}

static double signal_to_noise(const struct ema_band *band, const struct ema_mode *mode, double *sorted)
{
    int at = ema_band_line(band, cimag(mode->pole));
    at = at < band->nline ? at : band->nline - 1;
    for (int k = 0; k < band->nchannel; k++) {
        ptrdiff_t i = at + (ptrdiff_t)k * band->nline;
        sorted[k] = cabs(band->h[i]) / sqrt(band->variance[i]);
    }
    return median_of((size_t)band->nchannel, sorted);
}

int modes_judge(struct pool *pool, const struct ema_band *band, double decay, struct ema *out)
{
    int n = out->nmode;
    double *sorted = POOL_ARRAY(pool, double, band->nchannel);
    out->mac = POOL_ARRAY(pool, double, (size_t)n *(size_t)n);
    if (!sorted || !out->mac)
        return ROTID_ERROR_MEMORY;
    for (int r = 0; r < n; r++) {
        struct ema_mode *mode = &out->mode[r];
        double width = half_power_hz(mode) + decay * 2 / TWO_PI, strongest = 0;
        int known = 0;
        for (int s = 0; s < n; s++) {
            double apart = fabs(out->mode[s].frequency_hz - mode->frequency_hz);
            out->mac[s + (ptrdiff_t)r * n] = mac_of(out->npoint, out->mode[s].complex_shape, mode->complex_shape);
            if (s != r && !(fabs(mode->nearest_hz - mode->frequency_hz) <= apart))
                mode->nearest_hz = out->mode[s].frequency_hz;
            if (s != r && apart < CLOSE_WIDTHS * fmax(width, half_power_hz(&out->mode[s])))
                mode->quality_flags |= EMA_CLOSE;
        }
        for (int c = 0; c < out->nfrf; c++) {
            known |= isfinite(mode->residue_std[c]);
            if (cabs(mode->residue[c]) > strongest * mode->residue_std[c])
                strongest = cabs(mode->residue[c]) / mode->residue_std[c];
        }
        if (known && strongest < WEAK_THRESHOLD)
            mode->quality_flags |= EMA_WEAK;
        if (mode->mpc < LEAST_MPC || mode->mpd > MOST_MPD)
            mode->quality_flags |= EMA_COMPLEX;
        if (mode->damping < 0)
            mode->quality_flags |= EMA_NEGATIVE_DAMPING;
        if (mode->frequency_hz - band->low / TWO_PI < EDGE_WIDTHS * width ||
            band->high / TWO_PI - mode->frequency_hz < EDGE_WIDTHS * width)
            mode->quality_flags |= EMA_EDGE;
        if (band->variance)
            mode->peak_signal_to_noise = signal_to_noise(band, mode, sorted);
    }
    return ROTID_OK;
}
