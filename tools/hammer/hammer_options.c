#include "hammer_options.h"

#include <math.h>

struct hammer_options hammer_options_default(void)
{
    return (struct hammer_options){.rate = 8192,
                                   .band_hz = 3200,
                                   .pretrigger = 0.01,
                                   .impacts = 3,
                                   .pulse_short = 2e-4,
                                   .pulse_long = 4e-4,
                                   .force = 1000,
                                   .force_spread = 0.2,
                                   .suspension_damping = 0.05,
                                   .dampings = 6,
                                   .damping = {6.008e-3, 9.205e-3, 1.592e-2, 1.045e-2, 1.935e-2, 1.893e-2}};
}

static int between(double value, double low, double high)
{
    return value >= low && value <= high; /* false where it is no number */
}

int hammer_options_check(const struct hammer_options *o, const struct hide_message *m)
{
    if (!between(o->rate, 100, 1e6))
        return hide_fail(m, HAMMER_INPUT, "--rate %g: expected 100 to 1e6 Hz", o->rate);
    if (!(o->band_hz > 0 && o->band_hz <= HAMMER_EDGE * o->rate))
        return hide_fail(m, HAMMER_INPUT, "--band %g: expected above 0 and at most 0.4 of the rate, %g Hz", o->band_hz,
                         HAMMER_EDGE * o->rate);
    if (!between(o->pretrigger, 0, 10) ||
        !(o->seconds == 0 || (o->seconds > o->pretrigger && o->seconds * o->rate <= HAMMER_MOST_COUNT)))
        return hide_fail(m, HAMMER_INPUT,
                         "--seconds %g, --pretrigger %g: expected more than the pretrigger and at most %d samples", o->seconds,
                         o->pretrigger, HAMMER_MOST_COUNT);
    if (o->impacts < 1 || o->impacts > 100)
        return hide_fail(m, HAMMER_INPUT, "--impacts %d: expected 1 to 100", o->impacts);
    if (!(o->pulse_short > 0 && o->pulse_short <= o->pulse_long && o->pulse_long < 0.1))
        return hide_fail(m, HAMMER_INPUT, "--pulse %g:%g: expected two durations in rising order, below 0.1 s", o->pulse_short,
                         o->pulse_long);
    if (!(o->force > 0 && isfinite(o->force)) || !between(o->force_spread, 0, 0.9))
        return hide_fail(m, HAMMER_INPUT, "--force %g, spread %g: expected above 0 N, and 0 to 0.9", o->force, o->force_spread);
    if (!between(o->sensor_mass, 0, 1e3))
        return hide_fail(m, HAMMER_INPUT, "--sensor-mass %g: expected 0 to 1000 kg", o->sensor_mass);
    if (!between(o->noise, 0, 1e3) || !between(o->force_noise, 0, 1e3) || !between(o->floor, 0, 1))
        return hide_fail(m, HAMMER_INPUT, "expected noise of 0 to 1000, and a floor of 0 to 1");
    if (!between(o->double_hits, 0, 1) || !between(o->clipped, 0, 1))
        return hide_fail(m, HAMMER_INPUT, "expected probabilities of 0 to 1");
    if (!between(o->drift, 0, 0.1))
        return hide_fail(m, HAMMER_INPUT, "--drift %g: expected 0 to 0.1", o->drift);
    if (!between(o->suspension_damping, 1e-6, 0.99) || o->dampings < 1 || o->dampings > HAMMER_MOST_DAMPING)
        return hide_fail(m, HAMMER_INPUT, "expected damping ratios of 1e-6 to 0.99, 1 to %d of them", HAMMER_MOST_DAMPING);
    for (int k = 0; k < o->dampings; k++)
        if (!between(o->damping[k], 1e-6, 0.99))
            return hide_fail(m, HAMMER_INPUT, "damping ratio %g: expected 1e-6 to 0.99", o->damping[k]);
    return HAMMER_OK;
}

int hammer_faults_check(const struct hammer_options *o, const struct hide_rotor *rotor, const struct hide_message *m)
{
    for (int i = 0; i < o->faults; i++) {
        const struct hammer_fault *f = &o->fault[i];
        if (hide_find_sensor(rotor, f->id) < 0)
            return hide_fail(m, HAMMER_INPUT, "--fault at %ld: expected a sensor of the deck", f->id);
        if (f->kind == HAMMER_DUPLICATE && (hide_find_sensor(rotor, f->other) < 0 || f->other == f->id))
            return hide_fail(m, HAMMER_INPUT, "--fault duplicate of %ld: expected another sensor of the deck", f->other);
        if (f->kind == HAMMER_LOOSE && !between(f->value, 10, HAMMER_EDGE * o->rate))
            return hide_fail(m, HAMMER_INPUT, "--fault loose at %g Hz: expected 10 Hz to 0.4 of the rate", f->value);
        if (f->kind == HAMMER_GAIN && !(isfinite(f->value) && f->value != 0))
            return hide_fail(m, HAMMER_INPUT, "--fault gain of %g: expected a number other than zero", f->value);
    }
    return HAMMER_OK;
}
