/* The diametral inertia of a disk is another one than stated, often none; the polar one, which a test at rest does not know,
 * stays. At most it is that of its mass on a ring as wide as the rotor is long, m (L/2)^2/2; a disk without mass is taken to
 * weigh what the rotor weighs. */
#include "diagnose/causes/causes.h"

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)p;
    const struct disk *disk = &rotor->disk[effect->target];
    double length = rotor_length(rotor);
    *lower = -disk->diametral;
    *upper = (disk->mass > 0 ? disk->mass : rotor_mass(rotor)) * length * length / 8;
}

static const struct effect_kind kind = {
    .id = "added_inertia", .nparameter = 1, .parameter = {{"inertia", "kg.m2"}}, .at_disk = 1};

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
