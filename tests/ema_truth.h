/* Transfer functions of known modes, summed in closed form and independently of src/ema. */
#ifndef ROTID_TESTS_EMA_TRUTH_H
#define ROTID_TESTS_EMA_TRUTH_H

#include "ema/ema.h"

#define TRUTH_MODES  40
#define TRUTH_POINTS 80

struct truth {
    int nmode, npoint, drive; /* drive: point of the force */
    double frequency_hz[TRUTH_MODES], damping[TRUTH_MODES], mass[TRUTH_MODES];
    double phi[TRUTH_MODES][TRUTH_POINTS];
    double moving_mass; /* at each point while it is measured: f_j = f (1 - m phi_j^2/(2 M)) */
};

/* A free beam: f_r = f_1 ((2 r + 1)/3)^2, shapes of the free-free bar at npoint even places, mass 1 of each mode. */
void truth_beam(int nmode, int npoint, int drive, double f1, double damping, struct truth *truth);

/* Lines low, low + step, ...; every point over the drive; noise: standard deviation of complex noise over the rms |H| of its
 * channel, 0 none; stated as variance where with_variance. */
void truth_measure(struct pool *pool, const struct truth *truth, enum frf_quantity quantity, double low_hz, double step_hz,
                   int nline, double noise, int with_variance, struct random_stream *random, struct frf_set *set);

/* A cos + b cosh ... of mode r of a free-free bar at x in [0, 1], largest 1 at the ends. */
double truth_free_free(int r, double x);

#endif
