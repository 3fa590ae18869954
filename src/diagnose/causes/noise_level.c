/* The stated noise is not that of the data: every standard deviation of a block times one factor. */
#include "diagnose/causes/causes.h"

static int correct(struct pool *pool, struct job *job, const struct correction *correction)
{
    (void)pool;
    int shape = correction->block && same_text(correction->block, "SHAPE"),
        frequency = correction->block && same_text(correction->block, "FREQUENCY");
    if (!(isfinite(correction->value) && correction->value > 0) || !(shape || frequency) || (shape && !job->measurement.shape))
        return ROTID_ERROR_ARGUMENT;
    ptrdiff_t count = shape ? (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode : job->measurement.nmode;
    double *std = shape ? job->measurement.shape_std : job->measurement.frequency_std;
    for (ptrdiff_t i = 0; i < count; i++)
        std[i] *= correction->value;
    return ROTID_OK;
}

const struct cause_kind cause_noise_level = {
    .id = "noise_level",
    .class = CAUSE_DATA,
    .target = TARGET_BLOCK,
    .parameter = {{.neutral = 1, .typical = 2}},
    .place = -1,
    .width = -1,
    .lower = 1e-3,
    .upper = 1e3,
    .value = {"factor", "1"},
    .correct = correct,
    .sentence = "noise that is stated too small or too large",
    .check = "repeat the measurement and compare the spread with the stated noise",
};
