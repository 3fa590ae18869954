/* A spring that is stiffer or softer than stated. */
#include "diagnose/causes/causes.h"

static void on_spring(const struct effect *effect, int p, struct effect_spring *change)
{
    *change = (struct effect_spring){.factor = p < 0 ? effect->value[0] : 1};
}

static const struct effect_kind kind = {.id = "support", .nparameter = 1, .parameter = {{"factor", "1"}}, .spring = on_spring};

const struct cause_kind cause_support = {
    .id = "support",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_SPRING,
    .effect = &kind,
    .parameter = {{.neutral = 1, .typical = 2, PRIOR_LOGNORMAL(1.6)}}, /* slings and blocks are guessed to a factor of five */
    NO_PLACE,
    .limit_of = "support_extra",
    .applies = applies_to_felt_spring,
    .lower = 0.01,
    .upper = 100,
    .widest = 100,
    .sentence = "a support stiffer or softer than stated",
    .check = "measure the frequency of the rotor swinging on its supports, or hang it on softer ones",
};
