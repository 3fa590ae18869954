/* A channel with reversed sign: an accelerometer mounted the other way round, or a reversed direction in the table of channels.
 */
#include "diagnose/causes/causes.h"

static int correct(struct pool *pool, struct job *job, const struct correction *correction)
{
    (void)pool;
    int s = sensor_find(job, correction->sensor[0]);
    if (s < 0 || !job->measurement.shape)
        return ROTID_ERROR_ARGUMENT;
    shapes_multiply(job, s, -1);
    return ROTID_OK;
}

const struct cause_kind cause_sensor_sign = {
    .id = "sensor_sign",
    .class = CAUSE_DATA,
    .target = TARGET_SENSOR,
    NO_PLACE,
    .secant = 1,
    .correct = correct,
    .sentence = "a channel with reversed sign",
    .check = "look which way this accelerometer points, and at its direction in the table of channels",
};
