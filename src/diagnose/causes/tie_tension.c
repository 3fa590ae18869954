/* The tension of the tie rods. */
#include "diagnose/causes/causes.h"

static void on_tierod(const struct effect *effect, int p, struct effect_bundle *bundle)
{
    *bundle = (struct effect_bundle){.young = p < 0, .tension = p < 0 ? effect->value[0] : 1};
}

static int applies(const struct rotor *rotor, int target, const int *identified)
{
    (void)identified;
    return rotor->tierod[target].tension != 0;
}

static const struct effect_kind kind = {
    .id = "tie_tension", .nparameter = 1, .parameter = {{"factor", "1"}}, .tierod = on_tierod};

const struct cause_kind cause_tie_tension = {
    .id = "tie_tension",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_TIEROD,
    .effect = &kind,
    .parameter = {{.neutral = 1, .typical = 0.5, PRIOR_NORMAL(0.5)}},
    NO_PLACE,
    .applies = applies,
    .lower = 0,
    .upper = 2,
    .sentence = "tie rods tightened less or more than stated",
    .check = "measure the tension of the rods, by torque, stretch or their own frequency",
};
