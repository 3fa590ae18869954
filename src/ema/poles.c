#include "ema/ema.h"

#include <math.h>
#include <stdlib.h>

ORDER_BY(by_frequency, double complex, cimag(*it), 0)

void sort_poles(size_t count, double complex *pole)
{
    if (count)
        qsort(pole, count, sizeof *pole, by_frequency);
}

void residue_of_mode(const struct modal_fit *fit, int c, int r, const double *covariance, double complex *residue,
                     double *residue_std)
{
    int q = fit->nlinear, p = 2 * fit->nmode;
    const double *x = fit->linear + (ptrdiff_t)c * q, *mix = fit->mix + (ptrdiff_t)c * q * p + (ptrdiff_t)2 * r;
    const double *spread = fit->spread + (ptrdiff_t)c * q * q;
    double complex a = CMPLX(x[(ptrdiff_t)2 * r], x[(ptrdiff_t)2 * r + 1]) / fit->scale;
    double size = cabs(a), u[2] = {size > 0 ? creal(a) / size : 1, size > 0 ? cimag(a) / size : 0}, variance = 0;
    *residue = fit->singular[c] ? CMPLX(NAN, NAN) : a;
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++)
            variance += u[j] * u[k] * spread[(ptrdiff_t)2 * r + j + (ptrdiff_t)(2 * r + k) * q];
    for (int k = 0; covariance && k < p; k++) {
        double left = u[0] * mix[(ptrdiff_t)k * q] + u[1] * mix[(ptrdiff_t)k * q + 1];
        for (int j = 0; j < p; j++)
            variance +=
                left * covariance[j + (ptrdiff_t)k * p] * (u[0] * mix[(ptrdiff_t)j * q] + u[1] * mix[(ptrdiff_t)j * q + 1]);
    }
    *residue_std = fit->singular[c] ? NAN : sqrt(fmax(variance, 0)) / fit->scale;
}

#define TWO_PI 6.283185307179586

void ema_synthesise(const struct ema *ema, const struct frf_set *set, int c, int with_residuals, int n,
                    const double *frequency_hz, double complex *h)
{
    for (int i = 0; i < n; i++)
        h[i] = 0;
    /* in real arithmetic: complex division and product of C guard against infinities at ten times the cost */
    for (int r = 0; r < ema->nmode + ema->nguard; r++) {
        double complex residue = ema->mode[r].residue[c], pole = ema->mode[r].pole - set->window_decay;
        if (ema->mode[r].local_pole && !isnan(creal(ema->mode[r].local_pole[c])))
            pole = ema->mode[r].local_pole[c] - set->window_decay;
        double a = creal(pole), b = cimag(pole), p = creal(residue), q = cimag(residue);
        for (int i = 0; i < n; i++) {
            double omega = TWO_PI * frequency_hz[i], below = omega - b, above = omega + b;
            double d = 1 / (a * a + below * below), e = 1 / (a * a + above * above);
            /* (p + i q) (-a - i below) d + (p - i q) (-a - i above) e */
            h[i] += CMPLX((q * below - p * a) * d - (p * a + q * above) * e, -(q * a + p * below) * d + (q * a - p * above) * e);
        }
    }
    for (int i = 0; i < n; i++) {
        double omega = TWO_PI * frequency_hz[i];
        if (with_residuals && omega > 0)
            h[i] += -ema->lower[c] / (omega * omega) + ema->upper[c];
        for (int p = 0; p < (int)set->quantity; p++)
            h[i] *= I * omega + set->window_decay;
    }
}
