/* The job of one run: what happens to data on their way, data that a model makes, starts; every draw by its name. */
#include "study/study.h"

/* Random numbers that have a name instead of a place in a sequence: what a replicate draws for one purpose, mode and sensor is
 * the same in every run of it, whatever the runs leave out or who computes them. Runs that differ in a variant, in the modes
 * fitted or in the sensors kept so see the same noise, and their difference is that of the variant. */

enum draw_purpose { DRAW_TRUTH = 1, DRAW_HIDDEN, DRAW_SENSOR, DRAW_FREQUENCY, DRAW_SHAPE, DRAW_START, DRAW_WEIGHT };

/* The output function of splitmix64 on state and key: a change of one bit changes half of the bits. */
static uint64_t mix(uint64_t state, uint64_t key)
{
    uint64_t z = state + 0x9E3779B97F4A7C15u + key;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

/* a, b: what it is drawn for, such as the number of the mode and the id of the sensor. */
static struct random_stream draw_stream(unsigned long seed, enum draw_purpose purpose, long long replicate, uint64_t a,
                                        uint64_t b)
{
    uint64_t state = mix(0, seed);
    state = mix(state, (uint64_t)purpose);
    state = mix(state, (uint64_t)replicate);
    state = mix(state, a);
    return (struct random_stream){mix(state, b)};
}

/* In (0, 1). */
static double uniform(const struct study *study, enum draw_purpose purpose, long replicate, uint64_t a, uint64_t b)
{
    struct random_stream stream = draw_stream(study->seed, purpose, replicate, a, b);
    return random_uniform(&stream);
}

#define STATE_NOISE 1000003u /* more than modes have numbers */

/* Mean 0, variance 1; of state s. */
static double normal(const struct study *study, enum draw_purpose purpose, long replicate, int s, int mode, int sensor)
{
    struct random_stream stream =
        draw_stream(study->seed, purpose, replicate, (uint64_t)mode + STATE_NOISE * (uint64_t)s, (uint64_t)sensor);
    return random_normal(&stream);
}

/* What happens to data on their way: faults of the measurement chain, noise, sensors that are not there. */

/* What is measured at single sensors beside the frequencies of the modes. */
static void forget_points(struct job *job)
{
    job->measurement.point_frequency_hz = job->measurement.point_frequency_std = NULL;
}

static void forget_shapes(struct job *job)
{
    job->measurement.shape = job->measurement.shape_std = NULL;
    forget_points(job);
}

static void forget_corrections(struct job *job)
{
    job->measurement.ncorrection = 0;
    job->measurement.raw = NULL;
}

static int is_fault(const struct truth *truth, const char *id)
{
    return truth && truth->cause && !truth->effect && !strcmp(truth->cause->id, id);
}

/* A fault of the measurement chain put into shapes or, with behind nonzero, what has to wait until their noise is there. */
static void experiment_fault(const struct truth *truth, int behind, struct job *job)
{
    if (!truth->cause || truth->effect || !job->measurement.shape || !truth->fault.nsensor)
        return;
    int a = sensor_find(job, truth->fault.sensor[0]),
        b = truth->fault.nsensor > 1 ? sensor_find(job, truth->fault.sensor[1]) : -1;
    for (int k = 0; k < job->measurement.nmode && a >= 0; k++) {
        double *shape = job->measurement.shape + (ptrdiff_t)k * job->rotor.nsensor, kept = shape[a];
        if (is_fault(truth, "sensor_gain") && !behind) {
            shape[a] *= truth->fault.value;
        } else if (is_fault(truth, "sensor_sign") && !behind) {
            shape[a] = -shape[a];
        } else if (is_fault(truth, "sensor_swap") && !behind && b >= 0) {
            shape[a] = shape[b];
            shape[b] = kept;
        } else if (is_fault(truth, "duplicate_channel") && behind && b >= 0) { /* it repeats the noise as well */
            shape[a] = shape[b];
        }
    }
}

/* What noise_level hides: the factor on the noise that is stated. */
static double factor(const struct truth *truth, const char *block)
{
    return is_fault(truth, "noise_level") && truth->fault.block && !strcmp(truth->fault.block, block) ? truth->fault.value : 1;
}

/* Measured data have a noise already, to which this one is added. */
static double stated(int from_model, double std, double level)
{
    return from_model || !isfinite(std) ? level : hypot(std, level);
}

/* Adds noise to the data of state s, which has draws of its own, and states it. */
static void experiment_noise(const struct study *study, const struct study_point *point, const struct truth *truth, int s,
                             struct job *job)
{
    const struct plan_item *noise = plan_at(study->plan, &point->cell, AXIS_NOISE);
    struct job_measurement *m = &job->measurement;
    struct weighed *weighed = &m->weighed;
    int from_model = truth != NULL, nsensor = job->rotor.nsensor;
    if (noise->frequency > 0 || noise->shape > 0) /* they would contradict the rest */
        forget_points(job);
    for (int k = 0; k < m->nmode && noise->frequency > 0; k++) {
        double level = noise->frequency * factor(truth, "FREQUENCY");
        m->frequency_hz[k] *= 1 + level * normal(study, DRAW_FREQUENCY, point->replicate, s, m->number[k], 0);
        m->frequency_std[k] = stated(from_model, m->frequency_std[k], noise->frequency);
    }
    for (int k = 0; k < m->nmode && m->shape && noise->shape > 0; k++) {
        double *shape = m->shape + (ptrdiff_t)k * nsensor, *std = m->shape_std + (ptrdiff_t)k * nsensor,
               largest = largest_magnitude(nsensor, shape), level = noise->shape * factor(truth, "SHAPE");
        for (int i = 0; i < nsensor; i++) {
            if (!isfinite(shape[i]))
                continue;
            shape[i] += level * largest * normal(study, DRAW_SHAPE, point->replicate, s, m->number[k], job->rotor.sensor[i].id);
            std[i] = stated(from_model, std[i], noise->shape);
        }
    }
    if (from_model) { /* 0: not weighed */
        weighed->mass += weighed->mass_std * normal(study, DRAW_WEIGHT, point->replicate, s, 0, 0);
        weighed->centre += weighed->centre_std * normal(study, DRAW_WEIGHT, point->replicate, s, 1, 0);
    }
    if (truth)
        experiment_fault(truth, 1, job);
}

/* The effects of a job, those of its rotor, then those of its suspects; NULL behind the last. */
static struct effect *effect_number(const struct job *job, int i)
{
    int suspect = i - job->rotor.neffect;
    return suspect < 0 ? &job->rotor.effect[i] : suspect < job->unknowns.nsuspect ? &job->unknowns.suspect[suspect].effect : NULL;
}

/* The sensor that an effect is about, -1 where it is about none, or all. */
static int sensor_of(const struct effect *effect)
{
    const struct cause_kind *cause = catalogue_of(effect);
    return cause && cause->target == TARGET_SENSOR ? effect->target : -1;
}

/* A sensor that an effect or the hidden fault is about stays. */
static int must_stay(const struct job *job, const struct truth *truth, int s)
{
    int id = job->rotor.sensor[s].id;
    for (int i = 0; effect_number(job, i); i++)
        if (sensor_of(effect_number(job, i)) == s)
            return 1;
    if (truth && truth->effect && sensor_of(truth->effect) >= 0)
        return truth->job.rotor.sensor[truth->effect->target].id == id;
    for (int i = 0; truth && truth->cause && !truth->effect && i < truth->fault.nsensor; i++)
        if (truth->fault.sensor[i] == id)
            return 1;
    return 0;
}

/* Which sensors stay: new_index [nsensor] of each, -1 of those that go. Returns how many, or ROTID_ERROR_MEMORY. The lots of a
 * replicate do not depend on how many are kept: fewer sensors are some of more. */
static int choose(struct pool *pool, const struct study *study, const struct study_point *point, const struct truth *truth,
                  const struct job *job, int *new_index)
{
    const struct plan_item *sensors = plan_at(study->plan, &point->cell, AXIS_SENSORS);
    int n = job->rotor.nsensor, left = 0;
    double *lot = POOL_ARRAY(pool, double, 2 * (size_t)n), limit = 0; /* of those that have to stay it is below 0 */
    if (!lot)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < n; s++)
        lot[s] = lot[n + s] =
            uniform(study, DRAW_SENSOR, point->replicate, (uint64_t)job->rotor.sensor[s].id, 0) - must_stay(job, truth, s);
    if (sensors->keep)
        limit = sensors->keep < n ? double_of_rank((size_t)n, (size_t)sensors->keep - 1, lot + n) : 1;
    for (int s = 0; s < n; s++)
        new_index[s] = lot[s] <= limit || (sensors->every && s % sensors->every == 0) ? left++ : -1;
    return left;
}

/* Rows of a matrix [n * nmode] that stay, in its place. */
static void leave_rows(int n, int nmode, const int *new_index, double *matrix)
{
    ptrdiff_t next = 0;
    for (int k = 0; k < nmode && matrix; k++)
        for (int s = 0; s < n; s++)
            if (new_index[s] >= 0)
                matrix[next++] = matrix[s + (ptrdiff_t)k * n];
}

/* Leaves the sensors of this run. */
static int experiment_sensors(struct pool *pool, const struct study *study, const struct study_point *point,
                              const struct truth *truth, struct job *job)
{
    const struct plan_item *sensors = plan_at(study->plan, &point->cell, AXIS_SENSORS);
    int n = job->rotor.nsensor;
    if (!n || !(sensors->keep || sensors->every))
        return ROTID_OK;
    int *new_index = POOL_ARRAY(pool, int, n);
    int left = new_index ? choose(pool, study, point, truth, job, new_index) : ROTID_ERROR_MEMORY;
    if (left < 0)
        return left;
    for (int i = 0; effect_number(job, i); i++)
        if (sensor_of(effect_number(job, i)) >= 0)
            effect_number(job, i)->target = new_index[sensor_of(effect_number(job, i))];
    /* noise is relative to the largest component, which may be one of those that go: it stays what it is in absolute terms */
    if (job->measurement.shape)
        shapes_scale(job);
    leave_rows(n, job->measurement.nmode, new_index, job->measurement.shape);
    leave_rows(n, job->measurement.nmode, new_index, job->measurement.shape_std);
    leave_rows(n, job->measurement.nmode, new_index, job->measurement.point_frequency_hz);
    leave_rows(n, job->measurement.nmode, new_index, job->measurement.point_frequency_std);
    for (int s = 0; s < n; s++)
        if (new_index[s] >= 0)
            job->rotor.sensor[new_index[s]] = job->rotor.sensor[s];
    job->rotor.nsensor = left;
    if (job->measurement.shape)
        shapes_rescale(job);
    if (sensor_find(job, job->measurement.hammer) < 0)
        job->measurement.hammer = 0;
    forget_corrections(job); /* they are in the data already, and what the deck read is of all sensors */
    return ROTID_OK;
}

/* Data that a model makes: its parameters and the hidden effect drawn, its modes at the sensors. */

#define FINER 4 /* cuts of each element: leaves a sixteenth of the error of the mesh */

static double draw(const struct study *study, enum draw_purpose purpose, long replicate, const char *name, double lower,
                   double upper)
{
    return upper > lower ? lower + uniform(study, purpose, replicate, digest_name(name), 0) * (upper - lower) : lower;
}

/* value: in the unit of the deck */
static void set(struct job *job, const char *names, double value)
{
    char name[PARAMETER_NAME];
    for (const char *next = names; next;) {
        struct parameter parameter;
        const char *unit;
        next = parameter_next_name(next, name);
        if (!parameter_find(&job->rotor, name, &parameter, &unit))
            parameter_state(&job->rotor, &parameter, value * deck_unit_of(&job->units, unit ? unit : ""));
    }
}

/* Every value is set in every run: the truth keeps nothing of the run before. */
static void draw_values(const struct study *study, long replicate, struct truth *truth)
{
    const struct plan *plan = study->plan;
    struct job *job = &truth->job;
    for (int p = 0; p < job->unknowns.nparameter; p++)
        parameter_state(&job->rotor, &job->unknowns.parameter[p], job->unknowns.bounds[p].start);
    for (int t = 0; t < plan->ntruth; t++)
        set(job, plan->truth[t].name,
            draw(study, DRAW_TRUTH, replicate, plan->truth[t].name, plan->truth[t].lower, plan->truth[t].upper));
    const struct effect_parameter_name *parameter;
    for (int p = 0; (parameter = truth_parameter(truth, p)); p++)
        *truth_value(truth, p) = draw(study, DRAW_HIDDEN, replicate, parameter->name, truth->lower[p], truth->upper[p]);
}

/* Where the sensors really are. Own arrays: a correction changes the order of the sensors and what refers to them. */
static int place_sensors(struct pool *pool, const struct truth *truth, struct job *job)
{
    *job = truth->job;
    forget_shapes(job);
    forget_corrections(job);
    if (!is_fault(truth, "sensor_position") && !is_fault(truth, "sensor_line"))
        return ROTID_OK;
    job->unknowns.nsuspect = 0;
    int status = data_copy(pool, job);
    return status ? status : correction_apply(pool, job, &truth->fault);
}

struct modes { /* elastic ones of a model at the sensors of its rotor */
    int count, nsensor;
    double *hz, *shape; /* [count], [nsensor * count] */
};

static int modes_room(struct pool *pool, int count, int nsensor, struct modes *modes)
{
    *modes =
        (struct modes){count, nsensor, POOL_ARRAY(pool, double, count), POOL_ARRAY(pool, double, (size_t)nsensor *(size_t)count)};
    return modes->hz && modes->shape ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Of the full model, discretised as `models` are. refine: cuts of each element. */
static int solve(struct models *models, const struct rotor *rotor, int refine, struct modes *modes)
{
    const double none = 0;
    struct pool scratch;
    struct prediction p;
    int failed, status = ROTID_ERROR_MEMORY;
    pool_open(&scratch, NULL);
    struct rotor_model *model = POOL_NEW(&scratch, struct rotor_model);
    if (model)
        status = model_open(&scratch, models, rotor, 0, NULL, refine, model, &failed);
    if (!status && model->equations.nrigid + modes->count > model->equations.n)
        status = ROTID_ERROR_ARGUMENT;
    if (!status)
        status = prediction_new(&scratch, &model->equations, ROTID_REDUCTION_NONE, ROTID_NELSON,
                                model->equations.nrigid + modes->count, 0, &p);
    if (!status)
        status = prediction_compute(&p, &none);
    for (int k = 0; k < modes->count && !status; k++) {
        modes->hz[k] = prediction_hz(&p, model->equations.nrigid + k);
        for (int s = 0; s < modes->nsensor; s++)
            modes->shape[s + (ptrdiff_t)k * modes->nsensor] = prediction_at_sensor(&p, model->equations.nrigid + k, s);
    }
    pool_close(&scratch);
    return status;
}

/* With an accelerometer that goes from sensor to sensor each records its own component as it is with the mass there, and the
 * frequency is the mean of all. The scale of a loaded mode is the one that brings it nearest to the one without that mass. */
static int solve_moving(struct pool *pool, struct models *models, const struct rotor *rotor, int refine, int effect,
                        struct modes *modes)
{
    int n = modes->nsensor;
    struct rotor with = *rotor;
    struct modes bare, loaded;
    with.effect = POOL_COPY(pool, rotor->effect, rotor->neffect, 0);
    if (!with.effect || modes_room(pool, modes->count, n, &bare) || modes_room(pool, modes->count, n, &loaded))
        return ROTID_ERROR_MEMORY;
    with.effect[effect].variant = 1; /* FIXED */
    with.effect[effect].target = -1; /* nowhere */
    int status = solve(models, &with, refine, &bare);
    for (int k = 0; k < modes->count; k++)
        modes->hz[k] = 0;
    for (int s = 0; s < n && !status; s++) {
        with.effect[effect].target = s;
        status = solve(models, &with, refine, &loaded);
        for (int k = 0; k < modes->count && !status; k++) {
            const double *a = loaded.shape + (ptrdiff_t)k * n, *b = bare.shape + (ptrdiff_t)k * n;
            double across = 0, square = 0;
            for (int i = 0; i < n; i++) {
                across += a[i] * b[i];
                square += a[i] * a[i];
            }
            modes->shape[s + (ptrdiff_t)k * n] = across / square * a[s];
            modes->hz[k] += loaded.hz[k] / n;
        }
    }
    return status;
}

/* Measured mode k is that of the model whose sensors those of `source` are. */
static void take_mode(const struct job *source, const struct modes *modes, int k, struct job *job)
{
    const double *made = modes->shape + (ptrdiff_t)(job->measurement.number[k] - 1) * modes->nsensor;
    double largest = largest_magnitude(modes->nsensor, made), sign = 1;
    job->measurement.frequency_hz[k] = modes->hz[job->measurement.number[k] - 1];
    if (!job->measurement.shape)
        return;
    double *shape = job->measurement.shape + (ptrdiff_t)k * job->rotor.nsensor;
    for (int s = modes->nsensor - 1; s >= 0; s--) /* no solver states a sign: that of the first sensor that moves by half of it */
        if (fabs(made[s]) >= largest / 2)
            sign = made[s] < 0 ? -1 : 1;
    for (int s = 0; s < job->rotor.nsensor; s++) {
        int there = sensor_find(source, job->rotor.sensor[s].id);
        if (isfinite(shape[s]))
            shape[s] = there >= 0 && largest > 0 ? sign * made[there] / largest : NAN;
    }
}

/* What scales read of the rotor, which an accelerometer that goes from sensor to sensor has left. */
static int weigh(struct pool *pool, const struct job *source, int moving, struct job *job)
{
    struct rotor rotor = source->rotor;
    struct mass_properties mass = {0};
    rotor.neffect -= moving;
    int status = model_weigh(pool, source->models, &rotor, 0, NULL, NULL, &mass);
    job->measurement.weighed.mass = mass.mass;
    job->measurement.weighed.centre = mass.center;
    return status;
}

/* The data of the job, which have their own arrays, become those of the model with the values drawn for a replicate, without
 * noise; shapes relative to their largest component. Values end in *truth. */
static int experiment_model(struct pool *pool, const struct study *study, long replicate, struct truth *truth,
                            struct message_list *messages, struct job *job)
{
    struct modes modes;
    struct job source;
    draw_values(study, replicate, truth);
    int status = place_sensors(pool, truth, &source), last = source.rotor.neffect - 1;
    if (status == ROTID_ERROR_ARGUMENT)
        message_add(messages, SEVERITY_ERROR, NULL, 0, 0, "the hidden shift puts the sensor onto another one");
    if (!status)
        status = modes_room(pool, comparison_highest(job), source.rotor.nsensor, &modes);
    /* a diagnosis refines its mesh until the error is below the noise, and would find what a coarse one leaves in the data */
    int refine = study->plan->command == PLAN_DIAGNOSE ? FINER : 1;
    int moving = truth->effect && truth->cause->target == TARGET_SENSOR && truth->effect->target < 0;
    if (!status)
        status = moving ? solve_moving(pool, source.models, &source.rotor, refine, last, &modes)
                        : solve(source.models, &source.rotor, refine, &modes);
    for (int k = 0; k < job->measurement.nmode && !status; k++)
        take_mode(&source, &modes, k, job);
    if (!status)
        status = weigh(pool, &source, moving, job);
    /* what else was measured is not that of this model */
    forget_points(job);
    forget_corrections(job);
    job->measurement.hammer = job->measurement.has_noise_floor = 0;
    if (!status)
        experiment_fault(truth, 0, job);
    return status;
}

/* The value of a parameter of the model that made the data, of a shared one the first; NaN where it has none of that name. */
static double true_value(struct rotor *rotor, const char *names)
{
    struct parameter parameter;
    const char *unit;
    char name[PARAMETER_NAME];
    (void)parameter_next_name(names, name);
    if (parameter_find(rotor, name, &parameter, &unit))
        return NAN;
    const struct material *material = parameter.kind == PARAMETER_G ? &rotor->group[parameter.index].material : NULL;
    return material ? material_shear_modulus(material) : *parameter_value(rotor, parameter);
}

/* Room for shapes where the deck has sensors and the plan a noise of shapes. */
static int add_shapes(struct pool *pool, const struct plan_item *noise, struct job *job)
{
    size_t components = (size_t)job->rotor.nsensor * (size_t)job->measurement.nmode;
    if (job->measurement.shape || !job->rotor.nsensor || isnan(noise->shape))
        return ROTID_OK;
    job->measurement.shape = POOL_ARRAY(pool, double, components); /* zeros: measured, and to be filled in */
    job->measurement.shape_std = pool_unknown(pool, components);
    return job->measurement.shape && job->measurement.shape_std ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* States, unknowns and data of this run alone. */
static int own_states(struct pool *pool, const struct plan *plan, const struct states *fitted, struct states *out)
{
    int status = states_copy(pool, fitted, out);
    out->bounds = POOL_COPY(pool, fitted->bounds, fitted->nparameter, 0);
    for (int s = 0; s < fitted->nstate && !status; s++) {
        struct job *job = &out->state[s].job;
        status = data_copy(pool, job);
        job->unknowns.bounds = POOL_COPY(pool, job->unknowns.bounds, job->unknowns.nparameter, 0);
        if (plan->shapes)
            continue;
        forget_shapes(job);
        forget_corrections(job);
    }
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : status;
}

static int from_model(struct pool *pool, struct jobs *jobs, const struct study_point *point, struct message_list *messages,
                      struct experiment *out)
{
    const struct plan *plan = jobs->study->plan;
    struct truth *truth;
    int status = jobs_truth(jobs, &point->cell, messages, &truth);
    if (status)
        return status;
    out->made_by = truth;
    out->truth = POOL_ARRAY(pool, double, out->states.nparameter);
    if (!out->truth)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < out->states.nstate && !status; s++) {
        const struct state *state = &out->states.state[s];
        struct job *job = &out->states.state[s].job;
        if (plan->shapes)
            status = add_shapes(pool, plan_at(plan, &point->cell, AXIS_NOISE), job);
        if (!status)
            status = experiment_model(pool, jobs->study, point->replicate, &truth[s], messages, job);
        for (int p = 0; p < job->unknowns.nparameter && !status; p++) {
            const char *name = job->unknowns.bounds[p].name;
            size_t length = state->name ? strlen(state->name) : 0;
            int own = p >= state->ncommon && length && !strncmp(name, state->name, length) && name[length] == ':';
            out->truth[state->unknown[p]] = true_value(&truth[s].job.rotor, own ? name + length + 1 : name);
        }
    }
    return status;
}

/* The start of this run, for all states and each. */
static void experiment_starts(const struct study *study, const struct study_point *point, struct states *states)
{
    const struct plan *plan = study->plan;
    long digits = point->start;
    for (int p = 0; p < states->nparameter && plan->spread > 0; p++) {
        rotid_parameter *bounds = &states->bounds[p];
        double inside = 1e-6 * (bounds->upper - bounds->lower), reach = plan->spread * fabs(bounds->start);
        double lower = fmax(bounds->start - reach, bounds->lower + inside),
               upper = fmin(bounds->start + reach, bounds->upper - inside);
        double along;
        if (plan->grid) {
            along = (double)(digits % plan->grid) / (plan->grid - 1);
            digits /= plan->grid;
        } else {
            along = uniform(study, DRAW_START, point->replicate, (uint64_t)point->start, digest_name(bounds->name));
        }
        double start = lower + along * (upper - lower);
        bounds->start = start != 0 ? start : inside; /* a start of zero is no scale */
    }
    for (int s = 0; s < states->nstate; s++)
        for (int p = 0; p < states->state[s].job.unknowns.nparameter; p++)
            states->state[s].job.unknowns.bounds[p].start = states->bounds[states->state[s].unknown[p]].start;
}

int experiment_make(struct pool *pool, struct jobs *jobs, const struct study_point *point, struct message_list *messages,
                    struct experiment *out)
{
    const struct study *study = jobs->study;
    const struct states *fitted;
    *out = (struct experiment){0};
    int status = jobs_fitted(jobs, &point->cell, messages, &fitted);
    if (!status)
        status = own_states(pool, study->plan, fitted, &out->states);
    if (!status && study->plan->from_model)
        status = from_model(pool, jobs, point, messages, out);
    if (status)
        return status;
    out->job = &out->states.state[0].job;
    for (int s = 0; s < out->states.nstate && !status; s++) {
        const struct truth *truth = out->made_by ? &out->made_by[s] : NULL;
        experiment_noise(study, point, truth, s, &out->states.state[s].job);
        status = experiment_sensors(pool, study, point, truth, &out->states.state[s].job);
    }
    if (status)
        return status;
    experiment_starts(study, point, &out->states);
    return ROTID_OK;
}
