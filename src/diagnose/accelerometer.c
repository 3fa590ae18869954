/* The accelerometer that goes from sensor to sensor, weighed by the frequencies at each of them, and put into the judged model.
 */
#include "diagnose/diagnose.h"
#include "fit/fit.h"

#define ROOM   2.0
#define UNSURE 0.02 /* of the change of a shape: by the moduli that the fit has not found yet, and by the mass */
#define NODE   0.1  /* of the largest component: closer to a node the hammer hardly moves the mode */

/* Where the data of sensor s stand in the raw ones, which a correction may have put elsewhere. */
static int raw_sensor(const struct job *job, int s)
{
    int id = job->rotor.sensor[s].id, raw = 0;
    for (int c = job->measurement.ncorrection - 1; c >= 0; c--) {
        const struct correction *correction = &job->measurement.correction[c];
        if (!strcmp(correction->id, "sensor_swap") && (correction->sensor[0] == id || correction->sensor[1] == id))
            id = correction->sensor[correction->sensor[0] == id];
    }
    while (raw + 1 < job->measurement.raw->nsensor && job->measurement.raw->sensor[raw].id != id)
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

static double *raw_value(struct job *job, int std, int s, int k)
{
    const struct job_raw *raw = job->measurement.raw;
    return raw ? &(std ? raw->shape_std : raw->shape)[raw_sensor(job, s) + (ptrdiff_t)k * raw->nsensor] : NULL;
}

/* The model has the mass spread over all sensors, so a shape that is free of the accelerometer gets what that does to it. */
static void spread_mass(struct job *job, const struct weighing *w, int m, double mass)
{
    int k = w->columns.mode[m].k;
    const double *phi = w->phi + (ptrdiff_t)m * w->npoint, *spread = w->spread + (ptrdiff_t)m * w->npoint;
    double *shape = job->measurement.shape + (ptrdiff_t)k * w->npoint, product = 0, square = 0;
    for (int s = 0; s < w->npoint; s++)
        if (isfinite(shape[s])) {
            product += shape[s] * phi[s];
            square += phi[s] * phi[s];
        }
    for (int s = 0; s < w->npoint; s++) {
        double *raw = raw_value(job, 0, s, k), more = product / square * mass * spread[s];
        if (!isfinite(shape[s]))
            continue;
        shape[s] += more;
        if (raw)
            *raw += more;
    }
}

/* What the mass does to the shapes: with the accelerometer at j the residue is that of the unloaded rotor times 1 + c,
 * c = -m phi_j^2 + m q_jj + m q_je phi_j/phi_e to first order, where q is what the other modes have between the sensor j and the
 * place e of the hammer. Where that is known, and no node of the mode, the residue is put right exactly (moving_mass_residue),
 * with room for a share of the change. Else q_je is
 * about q_jj; all of it is smooth along the rotor, and the noise is taken as independent: hence twice m (phi^2 + |q|), so that
 * what looks like a cause stays below its threshold. Returns how many modes were put right. */
static int loaded_shapes_correct(struct job *job, const struct weighing *w, double mass)
{
    int corrected = 0;
    for (int m = 0; m < w->nmode && job_fits_shapes(job); m++) {
        int k = w->columns.mode[m].k;
        const double *phi = w->phi + (ptrdiff_t)m * w->npoint;
        double largest = 0;
        for (int s = 0; s < w->npoint; s++)
            if (isfinite(job->measurement.shape[s + (ptrdiff_t)k * w->npoint]))
                largest = fmax(largest, fabs(phi[s]));
        int known = w->hammer >= 0 && fabs(phi[w->hammer]) > NODE * largest;
        corrected += known;
        for (int s = 0; s < w->npoint && largest > 0; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * w->npoint, model = s + (ptrdiff_t)m * w->npoint;
            double *raw_std = raw_value(job, 1, s, k), *raw = raw_value(job, 0, s, k),
                   size = mass * (w->square[model] + fabs(w->others[model])), share = fabs(phi[s]) / largest;
            if (!isfinite(job->measurement.shape[at]))
                continue;
            if (!known) {
                widen(&job->measurement.shape_std[at], raw_std, ROOM * size * share);
                continue;
            }
            double change = moving_mass_residue(mass, w->square[model], w->others[model], w->bend[model], w->across[model],
                                                w->across_bend[model], phi[s] / phi[w->hammer]);
            job->measurement.shape[at] /= change;
            if (raw)
                *raw /= change;
            widen(&job->measurement.shape_std[at], raw_std, UNSURE * fabs(change - 1) * share);
        }
        if (known)
            spread_mass(job, w, m, mass);
    }
    return corrected;
}

/* A mass that the frequencies cannot tell from none moves the shapes all the same: room for the largest one they do not exclude.
 */
static void loaded_shapes_allow(struct job *job, const struct weighing *w, double mass)
{
    for (int m = 0; m < w->nmode && job_fits_shapes(job); m++) {
        int k = w->columns.mode[m].k;
        const double *phi = w->phi + (ptrdiff_t)m * w->npoint;
        double largest = largest_magnitude(w->npoint, phi);
        for (int s = 0; s < w->npoint && largest > 0; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * w->npoint, model = s + (ptrdiff_t)m * w->npoint;
            if (isfinite(job->measurement.shape[at]))
                widen(&job->measurement.shape_std[at], raw_value(job, 1, s, k),
                      mass * (w->square[model] + fabs(w->others[model])) * fabs(phi[s]) / largest);
        }
    }
}

#define LEAST_MASS   2e-4 /* kg: the lightest accelerometers with their cable */
#define NOT_EXCLUDED 2.0  /* standard deviations */
#define PLAUSIBLE    0.05 /* kg: an accelerometer with cable and magnet on a test of this kind */
#define MOST_FACTOR  1e3  /* of noise_level */

int is_moving_accelerometer(const struct effect *effect)
{
    const struct cause_kind *cause = catalogue_of(effect);
    return cause && !strcmp(cause->id, "accelerometer_mass") && effect->target < 0;
}

static int open_weighing(struct pool *pool, const struct engine *engine, struct weighing *w)
{
    int status = columns_open(pool, engine->job, engine->number, engine->holdout, NULL, engine->fit->x, &w->columns);
    if (status)
        return status;
    w->nmode = w->columns.nmode;
    w->npoint = engine->job->rotor.nsensor;
    size_t count = (size_t)w->nmode * (size_t)w->npoint;
    double **arrays[] = {&w->hz, &w->std, &w->square, &w->others, &w->phi, &w->bend, &w->across, &w->across_bend, &w->spread};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        *arrays[i] = POOL_ARRAY(pool, double, count);
    w->order = POOL_ARRAY(pool, double, w->npoint);
    w->hammer = -1;
    for (int s = 0; s < w->npoint; s++)
        if (engine->job->measurement.hammer && engine->job->rotor.sensor[s].id == engine->job->measurement.hammer)
            w->hammer = s;
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
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

/* One mode as the accelerometer turns it: with its cluster, within which it shows the same mass. */
struct turning {
    int members;
    const double *phi, *m_phi; /* [size * members] */
};

/* out := (K - lambda M)^+ of the force that is `one` at dof `at` (-1: nowhere) plus M times `vector` (NULL: none), of all modes
 * but this one and those close to it. work [size]. */
static void answer_without(struct nelson_band *nelson, const struct prediction *p, const struct turning *mode, int at,
                           const double *vector, double *work, double *out)
{
    static const double zero[CLUSTER_MOST];
    memset(work, 0, (size_t)p->size * sizeof *work);
    if (vector)
        matrix_multiply(&p->m, 1, vector, work);
    if (at >= 0)
        work[at] += 1;
    nelson_band_solve(nelson, 1, mode->members, mode->phi, mode->m_phi, work, zero, out);
}

/* phi, phi^2, what the other modes add at the sensors of one mode, and how that changes with lambda. vector [(CLUSTER_MOST + 3) *
 * size] */
static void take_mode(struct weighing *w, int m, struct nelson_band *nelson, double *vector)
{
    const struct prediction *p = &w->columns.functional.prediction;
    const struct columns_mode *mode = &w->columns.mode[m];
    const int *master = w->columns.model.equations.master;
    int n = p->size;
    const double *phi = p->phi + (ptrdiff_t)mode->pair * n;
    double lambda = p->lambda[mode->pair], *m_phi = vector, *work = m_phi + (ptrdiff_t)CLUSTER_MOST * n, *answer = work + n,
           *second = answer + n;
    const struct turning turning = {mode->members, p->phi + (ptrdiff_t)mode->first * n, m_phi};
    matrix_multiply(&p->m, mode->members, turning.phi, m_phi);
    for (int s = 0; s < w->npoint; s++) {
        ptrdiff_t at = s + (ptrdiff_t)m * w->npoint;
        w->phi[at] = phi[master[s]];
        w->square[at] = phi[master[s]] * phi[master[s]];
        answer_without(nelson, p, &turning, master[s], NULL, work, answer);
        answer_without(nelson, p, &turning, -1, answer, work, second);
        w->others[at] = lambda * answer[master[s]];
        for (int t = 0; t < w->npoint; t++)
            w->spread[t + (ptrdiff_t)m * w->npoint] += phi[master[s]] * lambda * answer[master[t]] / w->npoint;
        w->bend[at] = lambda * lambda * second[master[s]];
        if (w->hammer >= 0) {
            w->across[at] = lambda * answer[master[w->hammer]];
            w->across_bend[at] = lambda * lambda * second[master[w->hammer]];
        }
    }
}

static int take_modes(struct pool *pool, const struct engine *engine, struct weighing *w)
{
    const struct prediction *p = &w->columns.functional.prediction;
    const struct job *job = engine->job;
    struct nelson_band nelson;
    double *vector = POOL_ARRAY(pool, double, (CLUSTER_MOST + 3) * (size_t)p->size);
    if (!vector)
        return ROTID_ERROR_MEMORY;
    int status = nelson_band_new(pool, &p->k, 1, &nelson);
    if (!status)
        nelson_band_begin(&nelson, &p->k, &p->m);
    for (int m = 0; m < w->nmode && !status; m++) {
        const struct columns_mode *mode = &w->columns.mode[m];
        ptrdiff_t from = (ptrdiff_t)mode->k * w->npoint, to = (ptrdiff_t)m * w->npoint;
        memcpy(w->hz + to, job->measurement.point_frequency_hz + from, (size_t)w->npoint * sizeof *w->hz);
        memcpy(w->std + to, job->measurement.point_frequency_std + from, (size_t)w->npoint * sizeof *w->std);
        status = nelson_band_prepare(&nelson, p->lambda[mode->pair], mode->members, p->phi + (ptrdiff_t)mode->first * p->size);
        if (!status)
            take_mode(w, m, &nelson, vector);
    }
    take_order(&job->rotor, w->order);
    return status;
}

static int add_mass(struct engine *engine, const struct weighing *w)
{
    static const int fixed[EFFECT_MOST_PARAMETERS] = {1, 1, 1, 1};
    const struct roving_accelerometer *moving = &engine->moving;
    struct job *job = engine->job;
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
    int corrected = loaded_shapes_correct(job, w, moving->mass);
    const rotid_data_finding finding = {
        .id = cause->id,
        .value = moving->mass,
        .std = moving->std,
        .chi2_drop = moving->chi2_drop,
        .text =
            pool_format(engine->pool,
                        "the accelerometer weighs %.4g g (%.4g to %.4g g) by %d frequencies at single sensors%s; it is part of "
                        "the model from here on, going from sensor to sensor, with the frequencies of this regression, and what "
                        "it does to the shapes is %s",
                        1e3 * moving->mass, 1e3 * (moving->mass - half), 1e3 * (moving->mass + half), moving->readings, drift,
                        corrected ? "taken out of them" : "added to their noise, in proportion to its mass")};
    int status = data_add_finding(engine, &finding);
    if (status)
        return status;
    for (int m = 0; m < w->nmode; m++) /* the mean of the readings has a second order that MOVING does not */
        if (isfinite(moving->spread_hz[m]))
            job->measurement.frequency_hz[w->columns.mode[m].k] = moving->spread_hz[m];
    status = job_with_effect(engine->pool, job, NULL, &effect, cause, fixed, job);
    engine_take_job(engine, job);
    return status;
}

/* The mean over a drift that is linear in the order of the points is off by no more than its spread. */
static int add_drift(struct engine *engine)
{
    const struct job *job = engine->job;
    double square = 0, spread = fabs(engine->moving.drift) / sqrt(12);
    for (int k = 0; k < job->measurement.nmode; k++)
        square += job->measurement.frequency_std[k] * job->measurement.frequency_std[k] / job->measurement.nmode;
    double factor = fmin(sqrt(1 + spread * spread / square), MOST_FACTOR);
    return data_correct_noise(
        engine, "FREQUENCY", factor, NAN,
        pool_format(
            engine->pool,
            "drift of the frequencies over the test: %+.2g %% from the first sensor to the last in all modes, as of a rotor "
            "that warms or settles; the noise of the frequencies is raised by its spread, %.2f times",
            100 * engine->moving.drift, factor));
}

static double most_mass(const struct rotor *rotor)
{
    const struct effect blank = {.kind = catalogue_find("accelerometer_mass")->effect, .target = -1};
    double least, most;
    catalogue_of(&blank)->bounds(rotor, &blank, 0, &least, &most);
    return most;
}

void data_note_readings(struct engine *engine)
{
    const struct roving_accelerometer *moving = &engine->moving;
    double most = most_mass(&engine->job->rotor);
    if (moving->dropped)
        message_warn(
            engine->notes,
            "%d of %d frequencies at single sensors contradict the others and do not count for the mass of the accelerometer",
            moving->dropped, moving->readings + moving->dropped);
    if (moving->found && moving->mass > most)
        message_warn(
            engine->notes,
            "the frequencies at single sensors fall as under a mass of %.3g kg, which no accelerometer here has (at most "
            "%.3g kg): they are not explained",
            moving->mass, most);
}

int data_weigh_accelerometer(struct engine *engine, int *changed)
{
    const struct job *job = engine->job;
    struct pool scratch;
    struct weighing w = {0};
    double most = most_mass(&job->rotor);
    *changed = 0;
    if (!job->measurement.point_frequency_hz)
        return ROTID_OK;
    for (int e = 0; e < job->rotor.neffect; e++)
        if (is_moving_accelerometer(&job->rotor.effect[e])) /* the deck knows it */
            return ROTID_OK;
    pool_open(&scratch, engine->pool->allocator);
    int status = open_weighing(&scratch, engine, &w);
    if (!status)
        status = take_modes(&scratch, engine, &w);
    const struct roving_data data = {.nmode = w.nmode,
                                     .npoint = w.npoint,
                                     .hz = w.hz,
                                     .std = w.std,
                                     .square = w.square,
                                     .others = w.others,
                                     .bend = w.bend,
                                     .order = w.order,
                                     .least_mass = LEAST_MASS};
    if (!status)
        status = weigh_roving_accelerometer(&scratch, &data, &engine->moving);
    if (!status && engine->moving.found && engine->moving.mass <= most) {
        status = add_mass(engine, &w);
        *changed = 1;
    } else if (!status && engine->moving.usable) {
        double bound = fmin(fmax(engine->moving.mass, 0) + NOT_EXCLUDED * engine->moving.std, PLAUSIBLE);
        loaded_shapes_allow(engine->job, &w, bound);
        *changed = bound > 0 && job_fits_shapes(engine->job);
    }
    pool_close(&scratch);
    if (!status && engine->moving.drifts) {
        status = add_drift(engine);
        *changed = 1;
    }
    return status;
}
