/* A channel that repeats another one: what it says about its own place is nothing, so it counts as not measured. */
#include "diagnose/causes/causes.h"

static int correct(struct pool *pool, struct job *job, const struct correction *correction)
{
    (void)pool;
    int s = sensor_find(job, correction->sensor[0]);
    if (s < 0 || !job->measurement.shape)
        return ROTID_ERROR_ARGUMENT;
    shapes_scale(job);
    for (int k = 0; k < job->measurement.nmode; k++)
        job->measurement.shape[s + (ptrdiff_t)k * job->rotor.nsensor] = NAN;
    shapes_rescale(job);
    return ROTID_OK;
}

const struct cause_kind cause_duplicate_channel = {
    .id = "duplicate_channel",
    .class = CAUSE_DATA,
    .target = TARGET_SENSORS,
    NO_PLACE,
    .secant = 1,
    .correct = correct,
    .sentence = "a channel that repeats another one",
    .check = "tap beside the first of the two: its channel alone should answer most",
};
