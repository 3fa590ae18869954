/* Two channels whose positions were exchanged in the table or at the amplifier. The noise goes with the channel. */
#include "diagnose/causes/causes.h"

static int correct(struct pool *pool, struct job *job, const struct correction *correction)
{
    (void)pool;
    int a = sensor_find(job, correction->sensor[0]), b = sensor_find(job, correction->sensor[1]);
    if (a < 0 || b < 0 || a == b || !job->measurement.shape)
        return ROTID_ERROR_ARGUMENT;
    shapes_exchange(job, a, b);
    return ROTID_OK;
}

const struct cause_kind cause_sensor_swap = {
    .id = "sensor_swap",
    .class = CAUSE_DATA,
    .target = TARGET_SENSORS,
    NO_PLACE,
    .secant = 1,
    .correct = correct,
    .sentence = "two channels that are exchanged",
    .check = "follow the cables of both channels, and tap beside each accelerometer",
};
