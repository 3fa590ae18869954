/* A sensor that sits elsewhere than stated, by a shift along the axis. */
#include "diagnose/causes/causes.h"

/* Whether sensor s at z has a node of its own. ROTID_OK or ROTID_ERROR_MEMORY. */
static int stands_alone(struct pool *scratch, const struct rotor *stated, int s, double z, int *alone)
{
    struct rotor rotor = *stated;
    rotor.sensor = POOL_COPY(scratch, stated->sensor, rotor.nsensor, 0);
    if (!rotor.sensor)
        return ROTID_ERROR_MEMORY;
    rotor.sensor[s].position = z; /* the mesh does not mind their order */
    return model_sensor_alone(scratch, &rotor, s, alone);
}

static double element_length_at(const struct rotor *rotor, double z)
{
    const struct segment *segment = &rotor->segment[rotor_segment_at(rotor, z)];
    return segment->length / segment->elements;
}

#define STEP  0.011 /* of an element: a node nearer than 0.01 would be shared */
#define TRIES 200   /* two elements to either side */

/* The place nearest to z, first in the direction of the shift, where the sensor does not share a node with another one. */
static int free_place(struct pool *pool, const struct rotor *rotor, int s, double shift, double *place)
{
    double length = rotor_length(rotor), z = fmin(fmax(rotor->sensor[s].position + shift, 0), length),
           step = (shift < 0 ? -STEP : STEP) * element_length_at(rotor, z);
    int status = ROTID_OK, alone = 0;
    for (int i = 0; i <= 2 * TRIES && !status && !alone; i++) {
        struct pool scratch;
        int steps = (i + 1) / 2;
        *place = z + (i % 2 ? step : -step) * steps;
        if (*place < 0 || *place > length)
            continue;
        pool_open(&scratch, pool->allocator);
        status = stands_alone(&scratch, rotor, s, *place, &alone);
        pool_close(&scratch);
    }
    return status ? status : alone ? ROTID_OK : ROTID_ERROR_ARGUMENT;
}

static int correct(struct pool *pool, struct job *job, const struct correction *correction)
{
    struct sensor *sensor = job->rotor.sensor;
    int s = sensor_find(job, correction->sensor[0]);
    double z;
    if (s < 0 || !isfinite(correction->value))
        return ROTID_ERROR_ARGUMENT;
    int status = free_place(pool, &job->rotor, s, correction->value, &z);
    if (status)
        return status;
    sensor[s].position = z;
    for (; s > 0 && sensor[s - 1].position > z; s--)
        sensors_exchange(job, s - 1, s);
    for (; s + 1 < job->rotor.nsensor && sensor[s + 1].position < z; s++)
        sensors_exchange(job, s, s + 1);
    return ROTID_OK;
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)effect, (void)p;
    *upper = rotor_length(rotor);
    *lower = -*upper;
}

const struct cause_kind cause_sensor_position = {
    .id = "sensor_position",
    .class = CAUSE_DATA,
    .target = TARGET_SENSOR,
    .parameter = {{.neutral = 0, .typical = 0.02, PRIOR_OF_BOUND(0.02), .gross = 0.1}}, /* of the length */
    NO_PLACE,
    .bounds = bounds,
    .value = {"shift", "m"},
    .correct = correct,
    .sentence = "a sensor at another position than stated",
    .check = "measure the position of this accelerometer from the left end",
};
