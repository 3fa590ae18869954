/* What the effects of a rotor (rotor/effect.h) do together: products of their factors, and how one parameter moves the product.
 */
#ifndef ROTID_ROTOR_EFFECTS_H
#define ROTID_ROTOR_EFFECTS_H

#include "rotor/parameter.h"

/* Factors of one effect along a stretch of the axis, or their derivatives where p >= 0, with the return value of the hooks.
 * sections: nonzero for a beam, whose EI and kGS then follow e and g with the factors of sections among them. */
int effect_on_axis(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int sections, int p,
                   struct effect_field *factors);

/* The product over all effects. */
struct effect_field effects_on_axis(const struct rotor *rotor, const struct effect_span *span, int sections);

/* Derivative of those factors with respect to a parameter of an effect, divided by the factors; 0 where they do not depend on it.
 */
int effects_axis_rate(const struct rotor *rotor, struct parameter parameter, const struct effect_span *span, int sections,
                      struct effect_field *rate);

/* Factors of a tie rod. */
struct effect_bundle effects_on_tierod(const struct rotor *rotor, int tierod);

/* Their derivatives; 0 where they do not depend on the parameter. as_rods of *d stays 0. */
int effects_tierod_derivative(const struct rotor *rotor, struct parameter parameter, int tierod, struct effect_bundle *d);

/* Place and stiffness of a spring of the deck, without mass; and how they move with its own stiffness or with a parameter of an
 * effect, 0 where they do not. */
void effects_on_spring(const struct rotor *rotor, int spring, struct effect_point *point);
int effects_spring_derivative(const struct rotor *rotor, struct parameter parameter, int spring, struct effect_point *d);

/* Whether an effect may move it. */
int effects_move_spring(const struct rotor *rotor, int spring);

/* Force on the axis at z of a group [N], tension positive: its preload less what the tie rods press together there; and the
 * derivative, 0 where it does not depend on the parameter. */
double rotor_axial_force(const struct rotor *rotor, int group, double z);
double rotor_axial_force_derivative(const struct rotor *rotor, struct parameter parameter, double z);

#endif
