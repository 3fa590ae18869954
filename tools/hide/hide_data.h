/* The measurement: noise, and faults of the data. */
#ifndef HIDE_DATA_H
#define HIDE_DATA_H

#include "hide_random.h"
#include "hide_solve.h"

#define HIDE_MOST_ROWS (HIDE_MOST_MODES + HIDE_MOST_EFFECTS)

/* Noise of a case, of standard deviation 1. Rows are those of the modes, then one more for each mode that was measured twice. */
struct hide_noise {
    double frequency[HIDE_MOST_ROWS];
    double *shape; /* [HIDE_MOST_ROWS][sensors] */
};

int hide_noise_draw(uint64_t seed, const struct hide_rotor *rotor, double correlation, struct hide_noise *noise,
                    const struct hide_message *message);
void hide_noise_free(struct hide_noise *noise);

/* What was written down. */
struct hide_data {
    int rows, sensors;
    int origin[HIDE_MOST_ROWS];       /* true mode of the row's frequency, from 1; 0: not an elastic mode of its own */
    int shape_origin[HIDE_MOST_ROWS]; /* and of its shape */
    double hz[HIDE_MOST_ROWS];
    double *shape; /* [HIDE_MOST_ROWS][sensors]; NULL: none was measured */
};

/* Sensor positions as they are, with sensor_position; z[sensors]. */
void hide_true_positions(const struct hide_physics *physics, double *z);

/* What is written down of the solution: with `frequency_noise` and `shape_noise` times the noise (NULL: none), and the faults of
 * the data one after the other. shapes: 0 leaves them out. */
int hide_record(const struct hide_physics *physics, const struct hide_solution *solution, int shapes, double frequency_noise,
                double shape_noise, const struct hide_noise *noise, struct hide_data *data, const struct hide_message *message);
void hide_data_free(struct hide_data *data);

#endif
