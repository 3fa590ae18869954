/* A group that is stiffer at its ends than in its middle, or the reverse: E and G times 1 + profile (xi^2 - 1/3), xi from -1 to 1
 * along it. The mean over the group stays. */
#include "diagnose/causes/causes.h"

static double shape(double xi)
{
    return xi * xi - 1.0 / 3;
}

static int field(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                 struct effect_field *out)
{
    return scale_along_group(effect, rotor, span, p, shape, out);
}

static const struct effect_kind kind = {
    .id = "stiffness_profile", .nparameter = 1, .parameter = {{"profile", "1"}}, .field = field};

const struct cause_kind cause_stiffness_profile = {
    .id = "stiffness_profile",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_GROUP,
    .effect = &kind,
    .parameter = {{.typical = 0.1, PRIOR_NORMAL(0.2)}},
    NO_PLACE,
    .limit_of = "stiffness_local",
    .lower = -0.9,
    .upper = 1.2,
    .sentence = "stiffness that differs between the ends and the middle of the group",
    .check = "measure the shapes at more points in the middle of the group, or the pressure along it",
};
