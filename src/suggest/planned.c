#include "suggest/suggest.h"

#define SAME 1e-9 /* of the length: two positions that are one */

static int find(const struct rotor *rotor, double z)
{
    for (int s = 0; s < rotor->nsensor; s++)
        if (fabs(rotor->sensor[s].position - z) <= SAME * rotor_length(rotor))
            return s;
    return -1;
}

int planned_sensors(struct pool *pool, const struct job *from, int n, const double *z, struct job *to)
{
    struct rotor rotor = from->rotor;
    const struct rotor *old = &from->rotor;
    int next = 1;
    struct sensor *sensor = POOL_ARRAY(pool, struct sensor, n);
    rotor.effect = POOL_ARRAY(pool, struct effect, rotor.neffect);
    if (!sensor || !rotor.effect)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < old->nsensor; s++)
        next = old->sensor[s].id >= next ? old->sensor[s].id + 1 : next;
    for (int s = 0; s < n; s++) {
        int there = find(old, z[s]);
        sensor[s] = (struct sensor){there < 0 ? next++ : old->sensor[there].id, z[s]};
    }
    rotor.sensor = sensor;
    rotor.nsensor = n;
    for (int e = 0; e < rotor.neffect; e++) {
        rotor.effect[e] = old->effect[e];
        int at = rotor.effect[e].target;
        if (rotor.effect[e].kind->at_sensor && at >= 0)
            rotor.effect[e].target = find(&rotor, old->sensor[at].position);
    }
    *to = *from;
    to->rotor = rotor;
    to->measurement = (struct job_measurement){0};
    return ROTID_OK;
}

static int number_of(const struct planned *plan, int k)
{
    return plan->number ? plan->number[k] : k + 1;
}

static int measure(struct pool *pool, struct pool *scratch, const struct job *source, const double *x, const struct planned *plan,
                   struct job *to)
{
    int highest = 0, n = source->rotor.nsensor, modes = plan->modes;
    struct spectrum s;
    for (int k = 0; k < modes; k++)
        highest = number_of(plan, k) > highest ? number_of(plan, k) : highest;
    int status =
        spectrum_compute_parts(scratch, source->models, &source->rotor, source->unknowns.nparameter, source->unknowns.parameter,
                               x, ROTID_REDUCTION_NONE, highest, plan->coarse && source->options.solid ? SPECTRUM_COARSE : 0, &s);
    if (status || s.count < highest)
        return status ? status : ROTID_ERROR_ARGUMENT;
    struct job_measurement m = {.nmode = modes,
                                .paired = 1,
                                .number = POOL_ARRAY(pool, int, modes),
                                .holdout = POOL_ARRAY(pool, int, modes),
                                .frequency_hz = POOL_ARRAY(pool, double, modes),
                                .frequency_std = POOL_ARRAY(pool, double, modes),
                                .damping = POOL_ARRAY(pool, double, modes)};
    if (plan->shape_std > 0 && n > 0) {
        m.shape = POOL_ARRAY(pool, double, (size_t)n *(size_t)modes);
        m.shape_std = POOL_ARRAY(pool, double, (size_t)n *(size_t)modes);
    }
    if (!m.number || !m.holdout || !m.frequency_hz || !m.frequency_std || !m.damping || pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < modes; k++) {
        m.number[k] = number_of(plan, k);
        m.frequency_hz[k] = s.full_hz[m.number[k] - 1];
        m.frequency_std[k] = plan->frequency_std;
        m.damping[k] = NAN;
        for (int i = 0; i < n && m.shape; i++) {
            m.shape[i + (ptrdiff_t)k * n] = s.shape[i + (ptrdiff_t)(m.number[k] - 1) * n];
            m.shape_std[i + (ptrdiff_t)k * n] = plan->shape_std;
        }
    }
    to->measurement = m;
    to->options.fit.functional = ROTID_LIKELIHOOD;
    to->options.fit.reduction = ROTID_REDUCTION_NONE;
    to->options.fit.derivative = ROTID_NELSON;
    return ROTID_OK;
}

int planned_measure(struct pool *pool, const struct job *source, const double *x, const struct planned *plan, struct job *to)
{
    struct pool scratch; /* of the modes alone what is measured stays */
    pool_open(&scratch, pool->allocator);
    int status = measure(pool, &scratch, source, x, plan, to);
    pool_close(&scratch);
    return status;
}

int planned_on_coarse(struct pool *pool, struct job *job)
{
    job->held = NULL;
    return job->options.solid ? mesh_hold_as_it_is(pool, job, comparison_highest(job)) : ROTID_OK;
}

int planned_test(struct pool *pool, const struct job *job, const double *x, int n, const double *z, const struct planned *plan,
                 struct job *to)
{
    const struct weighed *stated = &job->measurement.weighed;
    struct mass_properties mass;
    int status = planned_sensors(pool, job, n, z, to);
    if (!status)
        status = planned_measure(pool, to, x, plan, to);
    if (!status)
        status = model_weigh(pool, to->models, &to->rotor, to->unknowns.nparameter, to->unknowns.parameter, x, &mass);
    if (!status)
        to->measurement.weighed = (struct weighed){mass.mass, stated->mass_std, mass.center, stated->centre_std};
    return status;
}
