#include "ema/ema.h"

#include <math.h>

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
