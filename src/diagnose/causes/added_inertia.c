/* The diametral inertia of a disk is another one than stated, often none. At most it is that of its mass on a ring as wide as the
 * rotor is long, m (L/2)^2/2; a disk without mass is taken to weigh what the rotor weighs. */
#include "diagnose/causes/causes.h"

static int point(const struct effect *effect, const struct rotor *rotor, int i, int p, struct effect_point *point)
{
    if (i > 0)
        return 0;
    *point =
        (struct effect_point){.z = p < 0 ? rotor->disk[effect->target].position : 0, .inertia = p < 0 ? effect->value[0] : 1};
    return 1;
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)p;
    const struct disk *disk = &rotor->disk[effect->target];
    double length = rotor_length(rotor);
    *lower = -disk->diametral;
    *upper = (disk->mass > 0 ? disk->mass : rotor_mass(rotor)) * length * length / 8;
}

static const struct effect_kind kind = {
    .id = "added_inertia", .nparameter = 1, .parameter = {{"inertia", "kg.m2"}}, .at_disk = 1, .point = point};

const struct cause_kind cause_added_inertia = {
    .id = "added_inertia",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_DISK,
    .effect = &kind,
    .parameter = {{.typical = 0.01, PRIOR_OF_BOUND(0.3)}},
    NO_PLACE,
    .bounds = bounds,
    .sentence = "a disk with another diametral inertia than stated",
    .check = "compute the inertia from a drawing of the disk, or swing it on two wires",
};
