/* The stabilisation table and what it proposes. */
#ifndef ROTID_EMA_STABILISATION_H
#define ROTID_EMA_STABILISATION_H

#include "ema/band.h"
#include "ema/ema.h"

struct stabilisation {
    int norder, step, order; /* orders step, 2 step, ..., order */
    int *first;              /* [norder + 1] into pole and table */
    int npole;
    double complex *pole;   /* [npole] as measured, the window's decay still in */
    struct ema_pole *table; /* [npole] the decay taken off */
};

/* LSCF of every even order up to `order`, and for each pole whether the order before has one within frequency_tolerance and
 * damping_tolerance (relative). ROTID_OK, ROTID_ERROR_MEMORY or ROTID_ERROR_EIGEN. */
int stabilisation_compute(struct pool *pool, const struct ema_band *band, int order, double decay, double frequency_tolerance,
                          double damping_tolerance, int threads, struct stabilisation *out);

/* Candidates for modes. A physical pole comes back at order after order, so poles are followed: a track takes the nearest
 * decaying pole of damping below 0.2 that lies within frequency_tolerance, and four times damping_tolerance, which a weak mode
 * needs; it may miss one order. Tracks over at least an eighth of the orders and four of them are candidates, and so is what
 * several tracks one after the other make of one pole. Its value is the mean over the later half of the track.
 * pole [*count], on the pool, rising. ROTID_OK or ROTID_ERROR_MEMORY. */
int stabilisation_candidates(struct pool *pool, const struct stabilisation *table, double frequency_tolerance,
                             double damping_tolerance, int *count, double complex **pole);

/* For each frequency that a user picked the stable pole nearest to it within 2 %, of the highest order that has one; else any
 * decaying pole, else the frequency itself with damping 0.01; unstable [npick] tells where there was no stable one. */
void stabilisation_picks(const struct stabilisation *table, int npick, const double *pick_hz, double complex *pole,
                         int *unstable);

/* Marks each pole of the table that stands for one of the modes: nearest, within both tolerances (damping fourfold). */
void stabilisation_assign(const struct stabilisation *table, int nmode, const double complex *pole, double frequency_tolerance,
                          double damping_tolerance);

#endif
