/* A rotational spring to the ground that the model does not have: a bearing or a bush so long that it holds the rotation, a
 * coupling. Up to twenty times EI/L, what turns the end of a shaft as long as the rotor: nearly a clamp. */
#include "diagnose/causes/causes.h"

static int point(const struct effect *effect, const struct rotor *rotor, int i, int p, struct effect_point *point)
{
    (void)rotor;
    return spring_anywhere(effect, i, p, 1, point);
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)effect;
    double length = rotor_length(rotor);
    *lower = 0;
    *upper = p == 0 ? 20 * mean_bending_stiffness(rotor) / length : length;
}

static const struct effect_kind kind = {
    .id = "support_rotation", .nparameter = 2, .parameter = {{"stiffness", "N.m/rad"}, {"z", "m"}}, .point = point};

const struct cause_kind cause_support_rotation = {
    .id = "support_rotation",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_NONE,
    .effect = &kind,
    .parameter = {{.typical = 1e6, .one_sided = 1, PRIOR_DECADES(3)}, {0}},
    .place = 1,
    .width = -1,
    .bounds = bounds,
    .sentence = "a rotational support that is not in the model",
    .check = "look for a long support there, or for a coupling that was left on",
};
