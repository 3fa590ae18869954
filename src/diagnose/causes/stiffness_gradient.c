/* A group whose stiffness rises from one end to the other: E and G times 1 + slope xi, xi from -1 to 1 along it. */
#include "diagnose/causes/causes.h"

static double shape(double xi)
{
    return xi;
}

static int field(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                 struct effect_field *out)
{
    return scale_along_group(effect, rotor, span, p, shape, out);
}

static const struct effect_kind kind = {
    .id = "stiffness_gradient", .nparameter = 1, .parameter = {{"slope", "1"}}, .field = field};

const struct cause_kind cause_stiffness_gradient = {
    .id = "stiffness_gradient",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_GROUP,
    .effect = &kind,
    .parameter = {{.typical = 0.1, PRIOR_NORMAL(0.2)}},
    NO_PLACE,
    .lower = -0.9,
    .upper = 0.9,
    .sentence = "stiffness that rises from one end of the group to the other",
    .check = "compare both ends of the group: pressing, temperature history, material batch; measure more points along it",
};
