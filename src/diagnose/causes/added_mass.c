/* A lumped mass that the model does not have. */
#include "diagnose/causes/cause.h"
#include "diagnose/causes/shared.h"

static int point(const struct effect *effect, const struct rotor *rotor, int i, int p, struct effect_point *point)
{
    (void)rotor;
    if (i > 0)
        return 0;
    *point = (struct effect_point){.z = p < 0 ? effect->value[1] : p == 1, .mass = p < 0 ? effect->value[0] : p == 0};
    return 1;
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)effect;
    *lower = 0;
    *upper = p == 0 ? 0.03 * rotor_mass(rotor) : rotor_length(rotor);
}

static const struct effect_kind kind = {
    .id = "added_mass", .nparameter = 2, .parameter = {{"mass", "kg"}, {"z", "m"}}, .point = point};

const struct cause_kind cause_added_mass = {
    .id = "added_mass",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_NONE,
    .effect = &kind,
    .parameter = {{.typical = 1, .one_sided = 1}, {0}},
    .place = 1,
    .width = -1,
    .bounds = bounds,
    .widest = 4, /* a tenth of a rotor and more */
    .sentence = "a mass that is on the rotor and not in the model",
    .check = "weigh the rotor, and look for what was fixed to it there",
};
