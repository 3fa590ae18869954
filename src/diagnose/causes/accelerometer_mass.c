/* The mass of the accelerometer itself. FIXED: it stays at one sensor. MOVING: it goes from sensor to sensor; without a frequency
 * per point the measured frequency is the mean over all places, which to first order is that of mass/nsensor at every sensor. */
#include "diagnose/causes/causes.h"

enum { MOVING, FIXED };

static int point(const struct effect *effect, const struct rotor *rotor, int i, int p, struct effect_point *point)
{
    int fixed = effect->variant == FIXED, sensor = fixed ? effect->target : i;
    if (sensor < 0 || sensor >= rotor->nsensor || (fixed && i > 0))
        return 0;
    double share = fixed ? 1 : 1.0 / rotor->nsensor;
    *point =
        (struct effect_point){.z = p < 0 ? rotor->sensor[sensor].position : 0, .mass = p < 0 ? share * effect->value[0] : share};
    return 1;
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)effect, (void)p;
    *lower = 0;
    *upper = fmin(0.2, heaviest_overlooked(rotor)); /* kg: no accelerometer with its cable and magnet weighs more */
}

static const struct effect_kind kind = {
    .id = "accelerometer_mass", .nparameter = 1, .parameter = {{"mass", "kg"}}, .at_sensor = 1, .point = point};

const struct cause_kind cause_accelerometer_mass = {
    .id = "accelerometer_mass",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_SENSOR,
    .effect = &kind,
    .parameter = {{.typical = 0.05, .one_sided = 1, PRIOR_NORMAL(0.05)}},
    NO_PLACE,
    .variant = {"MOVING", "FIXED"},
    .variant_option = "MOUNT",
    .bounds = bounds,
    .value = {"mass", "kg"},
    .sentence = "the mass of the accelerometer is not in the model",
    .check = "repeat one measurement with a second accelerometer beside the first, or weigh it with its cable",
};
