/* E and G of a group that is not identified. */
#include "diagnose/causes/causes.h"

static int field(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                 struct effect_field *out)
{
    (void)rotor;
    if (span->group != effect->target)
        return 0;
    return scale_stiffness(p < 0 ? effect->value[0] : 1, p, out);
}

static const struct effect_kind kind = {.id = "stiffness", .nparameter = 1, .parameter = {{"factor", "1"}}, .field = field};

const struct cause_kind cause_stiffness = {
    .id = "stiffness",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_GROUP,
    .effect = &kind,
    .parameter = {{.neutral = 1, .typical = 1.05, PRIOR_NORMAL(0.2)}},
    NO_PLACE,
    .limit_of = "stiffness_local",
    .applies = applies_to_known_group,
    FACTOR_ROUGHLY_KNOWN,
    .widest = 4,
    .sentence = "a part with another stiffness than stated",
    .check = "measure the modulus of a sample, or identify E of this part with the others",
};
