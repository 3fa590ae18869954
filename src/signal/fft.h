/* Discrete Fourier transform of real samples, by kissfft in single precision.
 *
 * The data are scaled by a power of two to at most 1 in magnitude before they are rounded to single precision, so neither
 * overflow nor underflow depends on units. What single precision leaves: no line is off by more than FFT_ACCURACY sqrt(n sum
 * x^2), the largest that a line can be, and for the lengths of fft_length the mean square error over the lines is below (2e-7)^2
 * of their mean square. So what lies 130 dB below the root mean square of a spectrum drowns; converters of 24 bits resolve 110
 * dB. */
#ifndef ROTID_SIGNAL_FFT_H
#define ROTID_SIGNAL_FFT_H

#include "base/complex.h"
#include "base/pool.h"

#define FFT_LONGEST  (1 << 26) /* samples: an hour at 18 kHz; keeps every size an int with room to spare */
#define FFT_ACCURACY 1e-7      /* two roundings of 2^-24 */

struct fft { /* plan and workspace of one thread */
    int n;
    void *plan, *line;
    float *time;
};

/* The largest 2^a 3^b 5^c with a >= 1 that is not above n nor FFT_LONGEST: lengths that kissfft transforms in O(n log n) and
 * without allocating. It is never below 0.8 n for n >= 8. 0 where n < 2. */
int fft_length(long long n);

/* Room for transforms of n samples, on the pool. n even, 2 <= n <= FFT_LONGEST; a prime factor p above 5 costs O(n p).
 * ROTID_OK, ROTID_ERROR_ARGUMENT, ROTID_ERROR_MEMORY. */
int fft_open(struct pool *pool, int n, struct fft *fft);

/* X_k = sum_j x_j exp(-2 pi i jk/n), k = 0 ... n/2. x [n] finite, X [n/2 + 1]. */
void fft_real(struct fft *fft, const double *x, double complex *X);

#endif
