/* The mass of an accelerometer that goes from point to point, by what it does to the frequencies measured there. */
#ifndef ROTID_DIAGNOSE_ROVING_ACCELEROMETER_H
#define ROTID_DIAGNOSE_ROVING_ACCELEROMETER_H

#include "base/pool.h"

/* A mass m at point j turns f_k into f_kj = f_k sqrt(1 - x), where
 *   x (1 - (1 - x) m (q - x c)) = (1 - x) m s,
 * s_kj = phi_kj^2 of the mass-normalised mode, q_kj = lambda_k sum over i != k of phi_ij^2/(lambda_i - lambda_k), the response of
 * the other modes there, and c_kj = lambda_k^2 sum of phi_ij^2/(lambda_i - lambda_k)^2, how it changes with the frequency: exact
 * but for its second derivative. To first order x = m s. */
struct roving_data {
    int nmode, npoint;
    const double *hz, *std; /* [npoint * nmode] Hz, NaN: no reading */
    const double *square;   /* [npoint * nmode] s [1/kg] */
    const double *others;   /* [npoint * nmode] q [1/kg] */
    const double *bend;     /* [npoint * nmode] c [1/kg], NULL: 0 */
    const double *order;    /* [npoint] from -0.5, the first point of the test, to 0.5, the last */
    double least_mass;      /* kg: nothing lighter is an accelerometer */
};

struct roving_accelerometer {
    int usable; /* the readings can tell a mass from a drift, with three degrees of freedom left; otherwise all else is zero */
    int found, drifts;
    int readings, dropped, dof;
    double mass, std;        /* kg, the latter widened by the scatter where that is more than stated */
    double scale;            /* that factor, at least 1 */
    double chi2_drop;        /* by the mass, beside a drift */
    double z, threshold;     /* mass/std, and what it has to exceed */
    double drift, drift_std; /* relative change of all frequencies from the first point to the last */
    double smallest;         /* kg: found nine times in ten */
    double *spread_hz; /* [nmode] f_k with mass/npoint at every point, f_k/sqrt(1 + m mean of s), in the middle of the test; NaN
                          where the mode has no reading. On the pool. */
};

/* Regression of ln f_kj, with one m, one f_k a mode, and one drift that is linear in the order of the points and the same in all
 * modes, so that a drift is never taken for a mass. Readings that contradict the others are dropped (point_drop_outliers).
 * Found: z beyond the threshold that noise passes 5 times in 1000 by Student's distribution, and twice that where the drift
 * alone explains more than the mass alone; still beyond noise (5 %) with any one point left out, so that no single accelerometer
 * that sat badly makes a mass; and no lighter than least_mass. drifts: the drift is beyond what noise makes 5 times in 1000.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
int weigh_roving_accelerometer(struct pool *pool, const struct roving_data *data, struct roving_accelerometer *out);

/* x of a mass at a point. */
double moving_mass_shift(double mass, double square, double others, double bend);

/* What a mass at point j does to the residue of mode k between that point and another one, e: the loaded over the unloaded
 * phi_kj phi_ke. across: q of the pair (j, e), across_bend its c; share = phi_kj/phi_ke. To first order
 * 1 - m s + m q + m q_je phi_j/phi_e. */
double moving_mass_residue(double mass, double square, double others, double bend, double across, double across_bend,
                           double share);

#endif
