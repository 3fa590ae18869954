/* What the effects of a rotor (beam/effect.h) do to axis, tie rods and springs: products of their factors, and how one parameter
 * moves the product. */
#ifndef ROTID_BEAM_EFFECTS_H
#define ROTID_BEAM_EFFECTS_H

#include "beam/beam.h"

/* Room for the factors of a beam whose mesh is built, and their first values. ROTID_OK or ROTID_ERROR_MEMORY. */
int effects_open(struct pool *pool, struct beam *beam);

/* Computes beam->factor anew, where there is one. */
void effects_refresh(struct beam *beam);

/* Derivative of the factors of element e with respect to a parameter of an effect, divided by the factors; 0 where they do not
 * depend on it. */
int effects_axis_rate(const struct beam *beam, struct parameter parameter, int e, struct effect_factors *rate);

/* Factors of a tie rod and of a spring. */
struct effect_bundle effects_on_tierod(const struct rotor *rotor, int tierod);
double effects_on_spring(const struct rotor *rotor, int spring);

/* Their derivatives; 0 where they do not depend on the parameter. as_rods of *d stays 0. */
int effects_tierod_derivative(const struct rotor *rotor, struct parameter parameter, int tierod, struct effect_bundle *d);
int effects_spring_derivative(const struct rotor *rotor, struct parameter parameter, int spring, double *d);

#endif
