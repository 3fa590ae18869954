/* The shear coefficient of a group that is not identified; on an identified one it cannot be told from G. */
#include "diagnose/causes/causes.h"

static int section(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                   struct effect_section *out)
{
    (void)rotor;
    if (span->group != effect->target)
        return 0;
    *out = (struct effect_section){p < 0, p < 0 ? effect->value[0] : 1};
    return 1;
}

static const struct effect_kind kind = {
    .id = "shear_coefficient", .nparameter = 1, .parameter = {{"factor", "1"}}, .section = section};

const struct cause_kind cause_shear_coefficient = {
    .id = "shear_coefficient",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_GROUP,
    .effect = &kind,
    .parameter = {{.neutral = 1, .typical = 0.9, PRIOR_NORMAL(0.2)}},
    NO_PLACE,
    .applies = applies_to_known_group,
    FACTOR_ROUGHLY_KNOWN,
    .widest = 4,
    .sentence = "a part with another shear coefficient than its section has",
    .check = "compare with a solid model of the part under a lateral load",
};
