/* The density of a group. */
#include "diagnose/causes/causes.h"

static int field(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                 struct effect_field *out)
{
    (void)rotor;
    if (span->group != effect->target)
        return 0;
    double value = p < 0 ? effect->value[0] : 1;
    *out = (struct effect_field){p < 0, p < 0, value};
    return 1;
}

static const struct effect_kind kind = {.id = "density", .nparameter = 1, .parameter = {{"factor", "1"}}, .field = field};

const struct cause_kind cause_density = {
    .id = "density",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_GROUP,
    .effect = &kind,
    .parameter = {{.neutral = 1, .typical = 1.05, PRIOR_NORMAL(0.1)}},
    NO_PLACE,
    FACTOR_ROUGHLY_KNOWN,
    .widest = 2,
    .sentence = "a density other than stated",
    .check = "weigh the part",
};
