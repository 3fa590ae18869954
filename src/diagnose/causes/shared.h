/* What several physical causes have in common. */
#ifndef ROTID_DIAGNOSE_CAUSES_SHARED_H
#define ROTID_DIAGNOSE_CAUSES_SHARED_H

#include "rotor/effect.h"

/* Gauss-Legendre rule on [-1, 1], exact to degree 7. */
#define GAUSS_POINTS 4
extern const double gauss_place[GAUSS_POINTS], gauss_weight[GAUSS_POINTS];

/* A factor f(z) on the stiffness along an element acts through the mean of its compliance 1/f: the factor of the element, 1/mean,
 * and its derivative -d(mean)/mean^2 where p >= 0. */
double factor_of_compliance(double mean, double dmean, int p);

/* Stiffness of group `effect->target` times 1 + value f(xi), xi from -1 to 1 along the group: a `field` hook but for the shape f.
 */
int scale_along_group(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                      double (*shape)(double xi), struct effect_field *field);

/* E and G times the factor (p < 0), or their derivative. Returns 1. */
int scale_stiffness(double factor, int p, struct effect_field *field);

/* Lower and upper bound of a factor on what is known roughly, whatever the target: 0.5 ... 1.5. */
void bounds_of_factor(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper);

/* EI of a segment without its holes, rings of layers included. */
double bending_stiffness(const struct rotor *rotor, int segment);

/* Over the axis the mean of EI, and the integral of (z - from)^n/EI: what the rotor as a whole gives way by. */
double mean_bending_stiffness(const struct rotor *rotor);
double bending_flexibility(const struct rotor *rotor, double from, int n);

/* kg: the heaviest thing that one may have forgotten. Of a large rotor 3 % of what it weighs by its dimensions; on a small one
 * what is fixed to it counts for more, since fixtures do not shrink with it: 10 kg, or a quarter of it. */
double heaviest_overlooked(const struct rotor *rotor);

/* A `point` hook but for what is held: a spring to the ground of stiffness value 0 at z, value 1. */
int spring_anywhere(const struct effect *effect, int i, int p, int rotational, struct effect_point *point);

/* Whether a spring has a stiffness. */
int applies_to_felt_spring(const struct rotor *rotor, int target, const int *identified);

/* Whether neither E nor G of a group is free. */
int applies_to_known_group(const struct rotor *rotor, int target, const int *identified);

#endif
