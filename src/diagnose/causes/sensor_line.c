/* All positions of the sensors at once: counted from the other end, from a wrong origin, with a wrong length. The distance from
 * the end that they are counted from is shift + scale z, z the stated position. */
#include "diagnose/causes/causes.h"

static int correct(struct pool *pool, struct job *job, const struct correction *correction)
{
    struct rotor *rotor = &job->rotor;
    const struct sensor_line line = {
        .shift = correction->value, .scale = correction->more[0], .flip = correction->more[1] >= 0.5};
    double length = rotor_length(rotor), *z = POOL_ARRAY(pool, double, rotor->nsensor);
    int n = rotor->nsensor;
    if (!z)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < n; i++)
        z[i] = rotor->sensor[i].position;
    if (!isfinite(line.shift) || !(line.scale > 0) || !sensor_line_fits(&line, length, n, z))
        return ROTID_ERROR_ARGUMENT;
    for (int i = 0; i < n; i++)
        rotor->sensor[i].position = fmin(fmax(sensor_line_place(&line, length, z[i]), 0), length);
    for (int i = 0; line.flip && i < n - 1 - i; i++)
        sensors_exchange(job, i, n - 1 - i);
    return ROTID_OK;
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    double length = rotor_length(rotor);
    (void)effect;
    *lower = p == 0 ? -length : p == 1 ? 0.1 : 0;
    *upper = p == 0 ? length : p == 1 ? 10 : 1;
}

const struct cause_kind cause_sensor_line = {
    .id = "sensor_line",
    .class = CAUSE_DATA,
    .target = TARGET_NONE,
    /* an origin off by a flange or two, a length by a tape read wrongly */
    .parameter = {{.neutral = 0, .typical = 0.02, PRIOR_OF_BOUND(0.03)},
                  {.neutral = 1, .typical = 1.02, PRIOR_LOGNORMAL(0.03)},
                  {.neutral = 0, .typical = 1}},
    NO_PLACE,
    .bounds = bounds,
    .value = {"shift", "m"},
    .more = {{"scale", "1"}, {"flip", "1"}},
    .correct = correct,
    .sentence = "positions of all sensors counted from the other end, from a wrong origin, or with a wrong length",
    .check = "measure the positions of the first and the last sensor from the left end",
};
