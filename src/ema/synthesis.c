#include <math.h>

#include "ema/ema.h"

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
