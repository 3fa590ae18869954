/* A channel reads gain times the truth in every mode: wrong calibration of one accelerometer. */
#include "diagnose/causes/causes.h"

static int correct(struct pool *pool, struct job *job, const struct correction *correction)
{
    (void)pool;
    int s = sensor_find(job, correction->sensor[0]);
    if (s < 0 || !job->measurement.shape || !(isfinite(correction->value) && correction->value > 0))
        return ROTID_ERROR_ARGUMENT;
    shapes_multiply(job, s, 1 / correction->value);
    return ROTID_OK;
}

const struct cause_kind cause_sensor_gain = {
    .id = "sensor_gain",
    .class = CAUSE_DATA,
    .target = TARGET_SENSOR,
    .parameter = {{.neutral = 1,
                   .typical = 1.2,
                   PRIOR_LOGNORMAL(0.5)}}, /* sensitivities are mistaken by some tens of percent, or by a factor */
    .place = -1,
    .width = -1,
    .lower = 0.01, /* beyond these the channel is dead or overloaded, not miscalibrated */
    .upper = 100,
    .value = {"gain", "1"},
    .correct = correct,
    .sentence = "a channel with a wrong gain",
    .check = "check the sensitivity entered for this channel, and exchange its accelerometer with a neighbour's",
};
