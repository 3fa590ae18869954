#include <math.h>

#include "ema/ema.h"

#define TWO_PI 6.283185307179586

void ema_synthesise(const struct ema *ema, const struct frf_set *set, int c, int with_residuals, int n,
                    const double *frequency_hz, double complex *h)
{
    for (int i = 0; i < n; i++) {
        double omega = TWO_PI * frequency_hz[i];
        double complex s = I * omega, sum = 0;
        for (int r = 0; r < ema->nmode + ema->nguard; r++) {
            double complex a = ema->mode[r].residue[c], pole = ema->mode[r].pole - set->window_decay;
            if (ema->mode[r].local_pole && !isnan(creal(ema->mode[r].local_pole[c])))
                pole = ema->mode[r].local_pole[c] - set->window_decay;
            sum += a / (s - pole) + conj(a) / (s - conj(pole));
        }
        if (with_residuals && omega > 0)
            sum += -ema->lower[c] / (omega * omega) + ema->upper[c];
        for (int p = 0; p < (int)set->quantity; p++)
            sum *= s + set->window_decay;
        h[i] = sum;
    }
}
