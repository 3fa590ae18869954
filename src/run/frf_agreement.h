/* How far synthesised transfer functions are from measured ones. */
#ifndef ROTID_RUN_FRF_AGREEMENT_H
#define ROTID_RUN_FRF_AGREEMENT_H

#include "base/complex.h"

/* Sums over lines, and over functions where they are added up: H^ measured, H synthesised. Begin with zeros. */
struct frf_sums {
    double complex cross;         /* sum conj(H) H^ */
    double complex conjugate;     /* sum H H^ */
    double measured, synthesised; /* sum |H^|^2, sum |H|^2 */
    long long lines;
};

/* Adds n lines; those where H^ or H is not finite are left out. */
void frf_sums_add(struct frf_sums *sums, int n, const double complex *measured, const double complex *synthesised);

/* Adds what another one holds. */
void frf_sums_join(struct frf_sums *sums, const struct frf_sums *other);

/* Frequency response assurance criterion |sum conj(H^) H|^2/(sum |H^|^2 sum |H|^2) in [0, 1]; NaN where one of them vanishes.
 * Free of scale and sign. */
double frf_sums_frac(const struct frf_sums *sums);

/* The same with the conjugate of H: higher where the measurement has the other sign of time. */
double frf_sums_frac_conjugate(const struct frf_sums *sums);

/* Real a of least sum |H^ - a H|^2: 1 for the same mass and sign, below 0 where the sign of one direction is the other one. */
double frf_sums_scale(const struct frf_sums *sums);

/* Level of H^ over H, 10 log10(sum |H^|^2/sum |H|^2) [dB]. */
double frf_sums_level(const struct frf_sums *sums);

#endif
