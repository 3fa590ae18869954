#include "run/run.h"

#include <math.h>

static double square(double complex value)
{
    return creal(value) * creal(value) + cimag(value) * cimag(value);
}

void frf_sums_add(struct frf_sums *sums, int n, const double complex *measured, const double complex *synthesised)
{
    for (int l = 0; l < n; l++) {
        double complex m = measured[l], h = synthesised[l];
        if (!isfinite(creal(m)) || !isfinite(cimag(m)) || !isfinite(creal(h)) || !isfinite(cimag(h)))
            continue;
        sums->cross += conj(h) * m;
        sums->conjugate += h * m;
        sums->measured += square(m);
        sums->synthesised += square(h);
        sums->lines++;
    }
}

void frf_sums_join(struct frf_sums *sums, const struct frf_sums *other)
{
    sums->cross += other->cross;
    sums->conjugate += other->conjugate;
    sums->measured += other->measured;
    sums->synthesised += other->synthesised;
    sums->lines += other->lines;
}

static double ratio(const struct frf_sums *sums, double complex cross)
{
    return sums->measured > 0 && sums->synthesised > 0 ? square(cross) / sums->measured / sums->synthesised : NAN;
}

double frf_sums_frac(const struct frf_sums *sums)
{
    return ratio(sums, sums->cross);
}

double frf_sums_frac_conjugate(const struct frf_sums *sums)
{
    return ratio(sums, sums->conjugate);
}

double frf_sums_scale(const struct frf_sums *sums)
{
    return sums->synthesised > 0 ? creal(sums->cross) / sums->synthesised : NAN;
}

double frf_sums_level(const struct frf_sums *sums)
{
    return sums->measured > 0 && sums->synthesised > 0 ? 10 * log10(sums->measured / sums->synthesised) : NAN;
}
