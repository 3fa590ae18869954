/* The accelerometer that goes from sensor to sensor, weighed by the frequencies at each of them, and put into the judged model.
 */
#include <math.h>
#include <string.h>

#include "diagnose/causes/catalogue.h"
#include "diagnose/causes/sensor.h"
#include "diagnose/engine.h"
#include "fit/quantile.h"
#include "linalg/matrix.h"
#include "modal/eigenvector_derivative.h"

#define LEAST_MASS  2e-4 /* kg: the lightest accelerometers with their cable */
#define ROOM        2.0
#define MOST_FACTOR 1e3 /* of noise_level */

struct weighing {
    struct columns columns; /* of the base: its fitted modes */
    int nmode, npoint;
    double *hz, *std, *square, *others, *order, *phi; /* as in struct moving_mass_data; phi [npoint * nmode] */
};

int is_moving_accelerometer(const struct effect *effect)
{
    const struct cause_kind *cause = catalogue_of(effect);
    return cause && !strcmp(cause->id, "accelerometer_mass") && effect->target < 0;
}

static int open_weighing(struct pool *pool, const struct engine *engine, struct weighing *w)
{
    int status = columns_open(pool, &engine->job, engine->number, engine->holdout, NULL, engine->fit->x, &w->columns);
    if (status)
        return status;
    w->nmode = w->columns.nmode;
    w->npoint = engine->job.rotor.nsensor;
    size_t count = (size_t)w->nmode * (size_t)w->npoint;
    double **arrays[] = {&w->hz, &w->std, &w->square, &w->others, &w->phi};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        if (!(*arrays[i] = POOL_ARRAY(pool, double, count)))
            return ROTID_ERROR_MEMORY;
    w->order = POOL_ARRAY(pool, double, w->npoint);
    return w->order ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The test went through the sensors by their ids: the place of each from -0.5 to 0.5. */
static void take_order(const struct rotor *rotor, double *order)
{
    for (int s = 0; s < rotor->nsensor; s++) {
        int before = 0;
        for (int t = 0; t < rotor->nsensor; t++)
            before += rotor->sensor[t].id < rotor->sensor[s].id;
        order[s] = rotor->nsensor > 1 ? (double)before / (rotor->nsensor - 1) - 0.5 : 0;
    }
}

/* phi, phi^2 and what the other modes add, lambda times the diagonal of (K - lambda M)^+, at the sensors of one mode. */
static void take_mode(struct weighing *w, int m, struct nelson_band *nelson, double *m_phi, double *right, double *answer)
{
    const struct prediction *p = &w->columns.functional.prediction;
    const struct columns_mode *mode = &w->columns.mode[m];
    int n = p->size;
    const double *phi = p->phi + (ptrdiff_t)mode->pair * n, zero = 0;
    matrix_multiply(&p->m, 1, phi, m_phi);
    for (int s = 0; s < w->npoint; s++) {
        ptrdiff_t at = s + (ptrdiff_t)m * w->npoint;
        int dof = w->columns.client.model.master[s];
        w->phi[at] = phi[dof];
        w->square[at] = phi[dof] * phi[dof];
        for (int i = 0; i < n; i++)
            right[i] = -phi[dof] * m_phi[i];
        right[dof] += 1;
        nelson_band_solve(nelson, 1, phi, m_phi, right, &zero, answer);
        w->others[at] = p->lambda[mode->pair] * answer[dof];
    }
}

static int take_modes(struct pool *pool, const struct engine *engine, struct weighing *w)
{
    const struct prediction *p = &w->columns.functional.prediction;
    const struct job *job = &engine->job;
    struct nelson_band nelson;
    double *vector = POOL_ARRAY(pool, double, 3 * (size_t)p->size);
    if (!vector)
        return ROTID_ERROR_MEMORY;
    int status = nelson_band_new(pool, &p->k, 1, &nelson);
    for (int m = 0; m < w->nmode && !status; m++) {
        const struct columns_mode *mode = &w->columns.mode[m];
        ptrdiff_t from = (ptrdiff_t)mode->k * w->npoint, to = (ptrdiff_t)m * w->npoint;
        memcpy(w->hz + to, job->point_frequency_hz + from, (size_t)w->npoint * sizeof *w->hz);
        memcpy(w->std + to, job->point_frequency_std + from, (size_t)w->npoint * sizeof *w->std);
        status = nelson_band_prepare(&nelson, &p->k, &p->m, p->lambda[mode->pair], p->phi + (ptrdiff_t)mode->pair * p->size);
        if (!status)
            take_mode(w, m, &nelson, vector, vector + p->size, vector + 2 * (ptrdiff_t)p->size);
    }
    take_order(&job->rotor, w->order);
    return status;
}

/* Where the data of sensor s stand in the raw ones, which a correction may have put elsewhere. */
static int raw_sensor(const struct job *job, int s)
{
    int id = job->rotor.sensor[s].id, raw = 0;
    for (int c = job->ncorrection - 1; c >= 0; c--) {
        const struct correction *correction = &job->correction[c];
        if (!strcmp(correction->id, "sensor_swap") && (correction->sensor[0] == id || correction->sensor[1] == id))
            id = correction->sensor[correction->sensor[0] == id];
    }
    while (raw + 1 < job->raw->nsensor && job->raw->sensor[raw].id != id)
        raw++;
    return raw;
}

/* The deviation, and that of the raw data, which a deck is written from, in proportion. */
static void widen(double *std, double *raw, double more)
{
    double before = *std;
    *std = hypot(before, more);
    if (raw && before > 0)
        *raw *= *std / before;
}

/* Room for what it does to the shapes: the residue of the loaded mode is that of the unloaded one times
 * 1 - m phi^2 + m q + m r phi_j/phi_e, where r is what the other modes have between the sensor and the place e of the hammer,
 * which nobody says; there it is about q. All of it is smooth along the rotor, and the noise is taken as independent: hence twice
 * m (phi^2 + |q|), so that what looks like a cause stays below its threshold. */
static void widen_noise(struct job *job, const struct weighing *w, double mass)
{
    for (int m = 0; m < w->nmode && job_fits_shapes(job); m++) {
        int k = w->columns.mode[m].k;
        double largest = 0;
        for (int s = 0; s < w->npoint; s++)
            if (isfinite(job->shape[s + (ptrdiff_t)k * w->npoint]))
                largest = fmax(largest, fabs(w->phi[s + (ptrdiff_t)m * w->npoint]));
        for (int s = 0; s < w->npoint && largest > 0; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * w->npoint, model = s + (ptrdiff_t)m * w->npoint;
            if (isfinite(job->shape[at]))
                widen(&job->shape_std[at],
                      job->raw ? &job->raw->shape_std[raw_sensor(job, s) + (ptrdiff_t)k * job->raw->nsensor] : NULL,
                      ROOM * mass * (w->square[model] + fabs(w->others[model])) * fabs(w->phi[model]) / largest);
        }
    }
}

static int add_mass(struct engine *engine, const struct weighing *w)
{
    static const int fixed[EFFECT_MOST_PARAMETERS] = {1, 1, 1, 1};
    const struct moving_mass *moving = &engine->moving;
    struct job *job = &engine->job;
    const struct cause_kind *cause = catalogue_find("accelerometer_mass");
    double half = quantile_student_95(moving->dof) * moving->std;
    const char *drift =
        moving->drifts ? pool_format(engine->pool, ", beside a drift of %+.2g %% over the test", 100 * moving->drift) : "";
    const struct effect effect = {.kind = cause->effect,
                                  .name = scan_free_name(engine->pool, &job->rotor, cause->id),
                                  .target = -1,
                                  .value = {moving->mass}};
    if (!effect.name || !drift)
        return ROTID_ERROR_MEMORY;
    const struct data_finding finding = {
        .cause = cause,
        .value = moving->mass,
        .std = moving->std,
        .chi2_drop = moving->chi2_drop,
        .text =
            pool_format(engine->pool,
                        "the accelerometer weighs %.3g g (%.3g to %.3g g) by %d frequencies at single sensors%s; it is part of "
                        "the model from here on, going from sensor to sensor, with the frequencies of this regression, and what "
                        "it does to the shapes is added to "
                        "their noise, in proportion to its mass",
                        1e3 * moving->mass, 1e3 * (moving->mass - half), 1e3 * (moving->mass + half), moving->readings, drift)};
    int status = data_add_finding(engine, &finding);
    if (status)
        return status;
    for (int m = 0; m < w->nmode; m++) /* the mean of the readings has a second order that MOVING does not */
        if (isfinite(moving->spread_hz[m]))
            job->frequency_hz[w->columns.mode[m].k] = moving->spread_hz[m];
    widen_noise(job, w, moving->mass);
    return job_with_effect(engine->pool, job, NULL, &effect, cause, fixed, job);
}

/* The mean over a drift that is linear in the order of the points is off by no more than its spread. */
static int add_drift(struct engine *engine)
{
    const struct job *job = &engine->job;
    double square = 0, spread = fabs(engine->moving.drift) / sqrt(12);
    for (int k = 0; k < job->nmode; k++)
        square += job->frequency_std[k] * job->frequency_std[k] / job->nmode;
    double factor = fmin(sqrt(1 + spread * spread / square), MOST_FACTOR);
    return data_correct_noise(
        engine, "FREQUENCY", factor, NAN,
        pool_format(
            engine->pool,
            "drift of the frequencies over the test: %+.2g %% from the first sensor to the last in all modes, as of a rotor "
            "that warms or settles; the noise of the frequencies is raised by its spread, %.2f times",
            100 * engine->moving.drift, factor));
}

static void note_readings(struct engine *engine, double most)
{
    const struct moving_mass *moving = &engine->moving;
    if (moving->dropped)
        message_add(
            engine->notes, SEVERITY_WARNING, NULL, 0, 0,
            "%d of %d frequencies at single sensors contradict the others and do not count for the mass of the accelerometer",
            moving->dropped, moving->readings + moving->dropped);
    if (moving->found && moving->mass > most)
        message_add(engine->notes, SEVERITY_WARNING, NULL, 0, 0,
                    "the frequencies at single sensors fall as under a mass of %.3g kg, which no accelerometer here has (at most "
                    "%.3g kg): they are not explained",
                    moving->mass, most);
}

int data_weigh_accelerometer(struct engine *engine, int *changed)
{
    const struct job *job = &engine->job;
    struct pool scratch;
    struct weighing w = {0};
    double least, most;
    *changed = 0;
    if (!job->point_frequency_hz)
        return ROTID_OK;
    for (int e = 0; e < job->rotor.neffect; e++)
        if (is_moving_accelerometer(&job->rotor.effect[e])) /* the deck knows it */
            return ROTID_OK;
    const struct effect blank = {.kind = catalogue_find("accelerometer_mass")->effect, .target = -1};
    catalogue_of(&blank)->bounds(&job->rotor, &blank, 0, &least, &most);
    pool_open(&scratch, engine->pool->allocator);
    int status = open_weighing(&scratch, engine, &w);
    if (!status)
        status = take_modes(&scratch, engine, &w);
    const struct moving_mass_data data = {.nmode = w.nmode,
                                          .npoint = w.npoint,
                                          .hz = w.hz,
                                          .std = w.std,
                                          .square = w.square,
                                          .others = w.others,
                                          .order = w.order,
                                          .least_mass = LEAST_MASS};
    if (!status)
        status = moving_mass(&scratch, &data, &engine->moving);
    if (!status)
        note_readings(engine, most);
    if (!status && engine->moving.found && engine->moving.mass <= most) {
        status = add_mass(engine, &w);
        *changed = 1;
    }
    pool_close(&scratch);
    if (!status && engine->moving.drifts) {
        status = add_drift(engine);
        *changed = 1;
    }
    return status;
}
