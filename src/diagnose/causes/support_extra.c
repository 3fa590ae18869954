/* A spring to the ground that the model does not have: a seal that touches, a cable, a stinger, a foam pad. Up to the modal
 * stiffness of the first free bending of a uniform shaft, 500 EI/L^3, at which it holds as firmly as the rotor bends: beyond,
 * the rotor has a support more and its modes are others. */
#include "diagnose/causes/causes.h"

static const double first_mode = 500.56; /* (4.730)^4 */

static int point(const struct effect *effect, const struct rotor *rotor, int i, int p, struct effect_point *point)
{
    (void)rotor;
    return spring_anywhere(effect, i, p, 0, point);
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)effect;
    double length = rotor_length(rotor);
    *lower = 0;
    *upper = p == 0 ? first_mode * mean_bending_stiffness(rotor) / (length * length * length) : length;
}

static const struct effect_kind kind = {
    .id = "support_extra", .nparameter = 2, .parameter = {{"stiffness", "N/m"}, {"z", "m"}}, .point = point};

const struct cause_kind cause_support_extra = {
    .id = "support_extra",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_NONE,
    .effect = &kind,
    .parameter = {{.typical = 1e6, .one_sided = 1, PRIOR_DECADES(3)}, {0}},
    .place = 1,
    .width = -1,
    .bounds = bounds,
    .sentence = "a lateral support that is not in the model",
    .check = "look for what touches the rotor there: a seal, a cable, a guard, the stand",
};
