#include "signal/fft.h"

#include <kiss_fftr.h>
#include <math.h>

int fft_length(long long n)
{
    int best = 0;
    if (n > FFT_LONGEST)
        n = FFT_LONGEST;
    for (long long five = 2; five <= n; five *= 5)
        for (long long three = five; three <= n; three *= 3) {
            long long length = three;
            while (2 * length <= n)
                length *= 2;
            if (length > best)
                best = (int)length;
        }
    return best;
}

int fft_open(struct pool *pool, int n, struct fft *fft)
{
    size_t bytes = 0;
    if (n < 2 || n % 2 || n > FFT_LONGEST)
        return ROTID_ERROR_ARGUMENT;
    (void)kiss_fftr_alloc(n, 0, NULL, &bytes); /* only says how much it needs */
    *fft = (struct fft){.n = n, .plan = pool_get(pool, bytes, 1)};
    fft->time = POOL_ARRAY(pool, float, n);
    fft->line = POOL_ARRAY(pool, kiss_fft_cpx, n / 2 + 1);
    if (!fft->plan || !fft->time || !fft->line)
        return ROTID_ERROR_MEMORY;
    fft->plan = kiss_fftr_alloc(n, 0, fft->plan, &bytes);
    return fft->plan ? ROTID_OK : ROTID_ERROR_MEMORY;
}

void fft_real(struct fft *fft, const double *x, double complex *X)
{
    const kiss_fft_cpx *line = fft->line;
    double largest = 0;
    int exponent = 0;
    for (int j = 0; j < fft->n; j++)
        largest = fmax(largest, fabs(x[j]));
    (void)frexp(largest, &exponent);
    /* in two steps: the scale of the smallest numbers is itself too large for a double */
    double half = ldexp(1, -exponent / 2), other = ldexp(1, -exponent + exponent / 2);
    for (int j = 0; j < fft->n; j++)
        fft->time[j] = (float)(x[j] * half * other);
    kiss_fftr(fft->plan, fft->time, fft->line);
    for (int k = 0; k <= fft->n / 2; k++)
        X[k] = CMPLX((double)line[k].r / half / other, (double)line[k].i / half / other);
}
