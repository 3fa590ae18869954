/* A spring of the deck that acts elsewhere than stated: a bearing is as long as a tenth of the rotor or a knife edge was measured
 * from another end. A support that is farther off than an eighth of the rotor is another one: support_extra. */
#include "diagnose/causes/causes.h"

static void on_spring(const struct effect *effect, int p, struct effect_spring *change)
{
    *change = (struct effect_spring){.factor = p < 0, .shift = p < 0 ? effect->value[0] : 1};
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)p;
    double length = rotor_length(rotor), z = rotor->spring[effect->target].position;
    *lower = fmax(-length / 8, -z);
    *upper = fmin(length / 8, length - z);
}

static const struct effect_kind kind = {
    .id = "support_position", .nparameter = 1, .parameter = {{"shift", "m"}}, .spring = on_spring, .moves_springs = 1};

const struct cause_kind cause_support_position = {
    .id = "support_position",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_SPRING,
    .effect = &kind,
    .parameter = {{.typical = 0.01, PRIOR_OF_BOUND(0.3)}},
    NO_PLACE,
    .applies = applies_to_felt_spring,
    .bounds = bounds,
    .sentence = "a support at another position than stated",
    .check = "measure where the rotor really rests, from both ends",
};
