/* The anti-alias filter, as partial fractions. */
#include <math.h>

#include "hammer.h"

static const double pi = 3.14159265358979323846;

#define ORDER     (2 * HAMMER_FILTER_PAIRS)
#define RIPPLE_DB 0.1 /* 80 dB down at 0.61 of the rate, which folds down to the end of the band */

/* Chebyshev poles of the first kind: all zeros lie at infinity, so that filter times accelerance has no direct term although the
 * accelerance grows with s^2 and its rest with s^8. */
void hammer_filter_open(double rate, struct hammer_filter *filter)
{
    double edge = 2 * pi * HAMMER_EDGE * rate, spread = asinh(1 / sqrt(pow(10, RIPPLE_DB / 10) - 1)) / ORDER;
    double complex *p = filter->pole;
    for (int i = 0; i < HAMMER_FILTER_PAIRS; i++) {
        double angle = pi * (2 * i + 1) / (2 * ORDER);
        p[i] = edge * CMPLX(-sinh(spread) * sin(angle), cosh(spread) * cos(angle));
    }
    for (int i = 0; i < HAMMER_FILTER_PAIRS; i++) {
        double complex residue = -p[i] * conj(p[i]) / (conj(p[i]) - p[i]);
        for (int j = 0; j < HAMMER_FILTER_PAIRS; j++)
            if (j != i)
                residue *= p[j] * conj(p[j]) / ((p[i] - p[j]) * (p[i] - conj(p[j])));
        filter->residue[i] = residue;
    }
}

/* The product, not the sum of the fractions, which would cancel far above the edge. */
double complex hammer_filter_at(const struct hammer_filter *filter, double complex s)
{
    double complex value = 1;
    for (int i = 0; i < HAMMER_FILTER_PAIRS; i++) {
        double complex p = filter->pole[i];
        value *= p * conj(p) / ((s - p) * (s - conj(p)));
    }
    return value;
}
