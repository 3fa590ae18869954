/* Rods coupled as rods where the deck has the wall of a tube: slender rods at a pitch radius do not resist the shearing of the
 * bundle. There is nothing to identify. */
#include "diagnose/causes/causes.h"

static void on_tierod(const struct effect *effect, int p, struct effect_bundle *bundle)
{
    (void)effect, (void)p;
    *bundle = (struct effect_bundle){.young = 1, .tension = 1, .as_rods = 1};
}

static int applies(const struct rotor *rotor, int target, const int *identified)
{
    (void)identified;
    return rotor->tierod[target].model == BUNDLE_TUBE;
}

static const struct effect_kind kind = {.id = "tie_shear", .nparameter = 0, .tierod = on_tierod};

const struct cause_kind cause_tie_shear = {
    .id = "tie_shear",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_TIEROD,
    .effect = &kind,
    NO_PLACE,
    .secant = 1,
    .applies = applies,
    .sentence = "tie rods that act as single rods, not as the wall of a tube that resists shear",
    .check = "change MODEL=TUBE of the tie rods to MODEL=RODS",
};
