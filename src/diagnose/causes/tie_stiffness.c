/* E of the tie rods, and their G with it: threads and washers make them softer than the steel they are of. */
#include "diagnose/causes/causes.h"

static void on_tierod(const struct effect *effect, int p, struct effect_bundle *bundle)
{
    *bundle = (struct effect_bundle){.young = p < 0 ? effect->value[0] : 1, .tension = p < 0};
}

static const struct effect_kind kind = {
    .id = "tie_stiffness", .nparameter = 1, .parameter = {{"factor", "1"}}, .tierod = on_tierod};

const struct cause_kind cause_tie_stiffness = {
    .id = "tie_stiffness",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_TIEROD,
    .effect = &kind,
    .parameter = {{.neutral = 1, .typical = 0.8, PRIOR_NORMAL(0.3)}},
    NO_PLACE,
    .lower = 0.05,
    .upper = 2, /* two rods more or a diameter 20 % larger are 1.2 to 1.4 */
    .widest = 3,
    .sentence = "tie rods that hold the ends together less or more stiffly than stated",
    .check = "check diameter, thread and washers of the rods, and measure their stretch while tightening",
};
