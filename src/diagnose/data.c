/* The data that are judged: a copy of the job's, with a noise, without what cannot be judged, and without faults. */
#include "diagnose/diagnose.h"

#define ASSUMED_FREQUENCY_NOISE 0.003 /* of a hammer test with care, where the deck states none */
#define LEAST_MODES             3     /* fewer cannot carry a name: with two moduli free nothing is left over */
#define LEAST_SPAN              0.5   /* of the rotor's length, by the sensors */

/* The shapes and their noise: the rest of what was read is never changed. */
static int copy_raw(struct pool *pool, struct job *job)
{
    struct job_raw *raw = POOL_NEW(pool, struct job_raw);
    size_t components = (size_t)job->measurement.raw->nsensor * (size_t)job->measurement.nmode;
    if (!raw)
        return ROTID_ERROR_MEMORY;
    *raw = *job->measurement.raw;
    job->measurement.raw = raw;
    if (!raw->shape)
        return ROTID_OK;
    raw->shape = POOL_COPY(pool, raw->shape, components, 0);
    raw->shape_std = POOL_COPY(pool, raw->shape_std, components, 0);
    return raw->shape && raw->shape_std ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int data_copy(struct pool *pool, struct job *job)
{
    struct job_measurement *m = &job->measurement;
    size_t components = (size_t)job->rotor.nsensor * (size_t)m->nmode;
    job->rotor.sensor = POOL_COPY(pool, job->rotor.sensor, job->rotor.nsensor, 0);
    job->rotor.effect = POOL_COPY(pool, job->rotor.effect, job->rotor.neffect, 0);
    job->unknowns.suspect = POOL_COPY(pool, job->unknowns.suspect, job->unknowns.nsuspect, 0);
    m->number = POOL_COPY(pool, m->number, m->nmode, 0);
    m->frequency_hz = POOL_COPY(pool, m->frequency_hz, m->nmode, 0);
    m->damping = POOL_COPY(pool, m->damping, m->nmode, 0);
    m->frequency_std = POOL_COPY(pool, m->frequency_std, m->nmode, 0);
    m->holdout = POOL_COPY(pool, m->holdout, m->nmode, 0);
    if (m->shape) {
        m->shape = POOL_COPY(pool, m->shape, components, 0);
        m->shape_std = POOL_COPY(pool, m->shape_std, components, 0);
    }
    if (m->point_frequency_hz) {
        m->point_frequency_hz = POOL_COPY(pool, m->point_frequency_hz, components, 0);
        m->point_frequency_std = POOL_COPY(pool, m->point_frequency_std, components, 0);
    }
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : m->raw ? copy_raw(pool, job) : ROTID_OK;
}

int data_add_finding(struct engine *engine, const rotid_data_finding *finding)
{
    struct diagnosis *out = engine->out;
    rotid_data_finding *more = POOL_COPY(engine->pool, out->result.data_findings, out->result.ndata_findings, 1);
    if (!more || !finding->text)
        return ROTID_ERROR_MEMORY;
    more[out->result.ndata_findings] = *finding;
    more[out->result.ndata_findings].state = engine->state;
    more[out->result.ndata_findings++].unit = catalogue_find(finding->id)->value.unit;
    out->result.data_findings = more;
    return ROTID_OK;
}

int data_add_pairing(struct engine *engine, int first, int second, const char *text)
{
    int *mode = POOL_ARRAY(engine->pool, int, 2);
    if (!mode)
        return ROTID_ERROR_MEMORY;
    mode[0] = first;
    mode[1] = second;
    const rotid_data_finding finding = {
        .id = "mode_pairing", .nmodes = second ? 2 : 1, .modes = mode, .value = NAN, .std = NAN, .chi2_drop = NAN, .text = text};
    return data_add_finding(engine, &finding);
}

void data_remove_mode(struct job *job, int k)
{
    struct job_measurement *m = &job->measurement;
    ptrdiff_t nsensor = job->rotor.nsensor;
    size_t behind = (size_t)(m->nmode - k - 1);
    memmove(m->number + k, m->number + k + 1, behind * sizeof *m->number);
    memmove(m->holdout + k, m->holdout + k + 1, behind * sizeof *m->holdout);
    const struct {
        double *value;
        ptrdiff_t rows; /* of a mode */
    } of[] = {{m->frequency_hz, 1},
              {m->damping, 1},
              {m->frequency_std, 1},
              {m->shape, nsensor},
              {m->shape ? m->shape_std : NULL, nsensor},
              {m->point_frequency_hz, nsensor},
              {m->point_frequency_std, nsensor}};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++)
        if (of[i].value)
            memmove(of[i].value + k * of[i].rows, of[i].value + (k + 1) * of[i].rows,
                    behind * (size_t)of[i].rows * sizeof *of[i].value);
    m->nmode--;
}

void data_remove_double(struct job *job, int k)
{
    data_remove_mode(job, k);
    for (int l = k; l < job->measurement.nmode; l++)
        job->measurement.number[l]--;
}

#define DOUBLE_HZ  0.03 /* apart, of two modes that are one */
#define DOUBLE_MAC 0.8

/* Whether the model has two modes of this shape side by side itself, as bars in slots do: where it stands before any fit, at up
 * to twice the distance. */
static int has_both(const struct spectrum *s, int nsensor, const double *shape)
{
    int found = 0;
    for (int j = 0, alike = 0; j < s->count && s->nmaster == nsensor; j++) {
        int before = alike;
        alike = rotid_mac(nsensor, s->shape + (ptrdiff_t)j * nsensor, shape) >= DOUBLE_MAC;
        found |= before && alike && s->full_hz[j] <= (1 + 2 * DOUBLE_HZ) * s->full_hz[j - 1];
    }
    return found;
}

/* A nearly axisymmetric rotor has each mode twice: two measured modes of one shape and nearly one frequency. The second goes. */
static int drop_doubles(struct engine *engine, const struct spectrum *model)
{
    struct job *job = engine->job;
    int nsensor = job->rotor.nsensor;
    for (int k = 1; k < job->measurement.nmode && job->measurement.shape && nsensor > 3; k++) {
        const double *shape = job->measurement.shape + (ptrdiff_t)k * nsensor;
        double apart = job->measurement.frequency_hz[k] / job->measurement.frequency_hz[k - 1] - 1;
        if (fabs(apart) > DOUBLE_HZ || rotid_mac(nsensor, shape - nsensor, shape) < DOUBLE_MAC || has_both(model, nsensor, shape))
            continue;
        int status = data_add_pairing(
            engine, job->measurement.number[k - 1], job->measurement.number[k],
            pool_format(engine->pool,
                        "measured modes %d and %d (%.6g and %.6g Hz) have one shape: a mode measured twice, or the pair of a "
                        "rotor that is not quite round; the second is left out",
                        job->measurement.number[k - 1], job->measurement.number[k], job->measurement.frequency_hz[k - 1],
                        job->measurement.frequency_hz[k]));
        if (status)
            return status;
        data_remove_double(job, k--); /* another one may follow it */
    }
    return ROTID_OK;
}

/* Beside the model where it stands before any fit: no wrong modulus moves all modes alike by 2 pi, 30 or 1000, and a diagnosis of
 * numbers in another unit is refused; modes that were measured twice go. */
static int look_at_modes(struct engine *engine)
{
    struct job *job = engine->job;
    struct spectrum spectrum;
    struct message_list said;
    struct pool scratch;
    double *x = parameter_starts(engine->pool, job->unknowns.nparameter, job->unknowns.bounds), factor = 0;
    if (!x)
        return ROTID_ERROR_MEMORY;
    pool_open(&scratch, engine->pool->allocator);
    message_open(&said, &scratch); /* what is no error, the base fit says */
    int status = spectrum_compute_parts(&scratch, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, x,
                                        ROTID_REDUCTION_NONE, comparison_highest(job), job->options.solid ? SPECTRUM_COARSE : 0,
                                        &spectrum);
    if (!status)
        factor = check_units(job, &spectrum, 1, &said);
    for (size_t i = 0; i < said.count && factor > 0; i++)
        message_add(engine->notes, said.item[i].severity, job->deck, 1, 1, "%s", said.item[i].text);
    if (!status)
        status = factor > 0 ? ROTID_ERROR_ARGUMENT : drop_doubles(engine, &spectrum);
    pool_close(&scratch);
    return status;
}

/* Share of the rotor that the sensors of a state cover. */
static double covered(const struct rotor *rotor)
{
    return rotor->nsensor ? (rotor->sensor[rotor->nsensor - 1].position - rotor->sensor[0].position) / rotor_length(rotor) : 1;
}

/* The most that the sensors of a state cover whose shapes are fitted; 1 where none are. */
static double most_covered(const struct states *states)
{
    double most = 0;
    int any = 0;
    for (int s = 0; s < states->nstate; s++) {
        const struct job *job = &states->state[s].job;
        if (!job_fits_shapes(job))
            continue;
        any = 1;
        most = fmax(most, covered(&job->rotor));
    }
    return any ? most : 1;
}

/* What keeps the data from carrying a name, said once. fitted: modes */
static void judge_amount(struct engine *engine, int fitted)
{
    int *confident = &engine->out->result.verdict.confident;
    double share = most_covered(&engine->states);
    *confident = 1;
    if (fitted < LEAST_MODES) {
        *confident = 0;
        message_warn(engine->notes, "%d fitted mode%s are too few to name a cause, expected at least %d", fitted,
                     fitted == 1 ? "" : "s", LEAST_MODES);
    }
    if (engine->out->result.noise.frequency_assumed) {
        *confident = 0;
        message_warn(engine->notes,
                     "the deck states no noise of the frequencies (*NOISE, FREQUENCY=): %.2g %% are assumed, so only relative "
                     "statements can be made",
                     100 * ASSUMED_FREQUENCY_NOISE);
    }
    if (share < LEAST_SPAN) {
        *confident = 0;
        message_warn(engine->notes,
                     "the sensors cover %.0f %% of the rotor, expected at least %.0f %%: what lies elsewhere cannot be placed",
                     100 * share, 100 * LEAST_SPAN);
    }
}

/* The state at hand: its own copies of the data, their noise, no mode twice. */
static int prepare_state(struct engine *engine)
{
    struct job *job = engine->job;
    if (!job->measurement.nmode)
        return message_refuse(engine->notes, ROTID_ERROR_ARGUMENT, job->deck, 1, 1,
                              "the deck has no measured modes%s%s, expected *MODES or *MEASURED",
                              engine->state ? " in state " : "", engine->state ? engine->state : "");
    int known = job_knows_frequency_noise(job), status = data_copy(engine->pool, job);
    if (status)
        return status;
    job->options.fit.functional = ROTID_LIKELIHOOD;
    job->options.fit.reduction = ROTID_REDUCTION_NONE;
    job->options.fit.derivative = ROTID_NELSON;
    if (!known) {
        engine->out->result.noise.frequency_assumed = 1;
        for (int k = 0; k < job->measurement.nmode; k++)
            if (!isfinite(job->measurement.frequency_std[k]))
                job->measurement.frequency_std[k] = ASSUMED_FREQUENCY_NOISE;
    }
    return look_at_modes(engine);
}

int data_prepare(struct engine *engine, const struct states *states)
{
    int fitted = 0, shapes = 0, nparameter = engine->nown = states->nparameter, status = engine_take_states(engine, states);
    engine->deck_start = parameter_starts(engine->pool, nparameter, states->bounds);
    if (status || !engine->deck_start)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < states->nstate && !status; s++) {
        engine_look_at(engine, s);
        status = prepare_state(engine);
        if (status)
            return status;
        fitted += job_fitted(engine->job, engine->job->measurement.holdout);
        shapes |= job_fits_shapes(engine->job);
    }
    engine_look_at(engine, 0);
    if (!shapes && fitted <= nparameter)
        return message_refuse(
            engine->notes, ROTID_ERROR_ARGUMENT, engine->job->deck, 1, 1,
            "%d %s for %d parameters leave no degree of freedom to test the model, expected more modes, or shapes with *NOISE, "
            "SHAPE=",
            fitted, fitted == 1 ? "frequency" : "frequencies", nparameter);
    judge_amount(engine, fitted);
    engine->nprepared = engine->out->result.ndata_findings;
    return ROTID_OK;
}
