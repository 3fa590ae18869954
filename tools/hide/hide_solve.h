/* Exact frequencies and shapes of a rotor with what is hidden in it. */
#ifndef HIDE_SOLVE_H
#define HIDE_SOLVE_H

#include "hide_model.h"

/* How many of the lowest two modes move the rotor on its supports, or freely, and so do not count as elastic. */
int hide_rigid_modes(const struct hide_physics *physics, int *rigid, const struct hide_message *message);

struct hide_solution {
    int modes, sensors, refine; /* how fine the stretches of varying stiffness had to be */
    double error;               /* estimated, of frequencies: relative */
    double hz[HIDE_MOST_MODES];
    double *shape; /* [modes][sensors] with the largest component +1 */
};

/* Elastic modes 1 ... modes at the places z[sensors]. Stretches are halved until that changes frequencies and shapes by little:
 * what is left is below 1e-5 of a frequency and 1e-4 of the largest component, or `error` says so. A moving accelerometer is
 * taken from sensor to sensor: the shape is put together from as many, and the frequency is their mean. Whatever it returns,
 * hide_solution_free. */
int hide_solve(const struct hide_physics *physics, int rigid, int modes, int sensors, const double *z,
               struct hide_solution *solution, const struct hide_message *message);
void hide_solution_free(struct hide_solution *solution);

#endif
