#include "diagnose/diagnose.h"

#define FAR_RATE  3.0  /* chi2 a degree of freedom: what leaves less is near enough for a fit */
#define FEWER     0.5  /* times what the others leave */
#define AS_WELL   2.0  /* with the modes that were left out */
#define PLACES    16   /* along the rotor */
#define SIZES     12   /* at most, of each candidate */
#define MOST_FITS 6    /* of the trials that come nearest */
#define OFF_HZ    0.02 /* of a frequency, and */
#define OFF_SHAPE 0.05 /* of 1 - MAC: what the parameters of the deck still put right */
#define STEPS     6    /* of the way from no effect to a bound; and with a place */
#define STEPS_AT  4
static const double shares[STEPS] = {0.1, 0.2, 0.35, 0.5, 0.65, 0.85};
static const double shares_at_places[STEPS_AT] = {0.03, 0.1, 0.3, 0.8};

struct trial {
    struct effect effect;
    double cost; /* INFINITY where there is none */
};

struct trials {
    const struct engine *engine;
    const struct scan *scan;
    const struct job_measurement *measured; /* with the modes that were left out */
    struct trial *best;                     /* [ncandidate] */
    struct pool *pool;                      /* [ncandidate] */
};

/* The sizes to try, of factors the way in their logarithm. Returns how many. */
static int sizes_of(const struct cause_kind *cause, const struct rotor *rotor, const struct effect *effect, double *size)
{
    double lower, upper, neutral = cause->parameter[cause->size].neutral;
    int count = 0, place = cause->place >= 0, steps = place ? STEPS_AT : STEPS;
    const double *share = place ? shares_at_places : shares;
    cause_bounds(cause, rotor, effect, cause->size, &lower, &upper);
    for (int side = 0; side < 2; side++) {
        double bound = side ? lower : upper;
        if (bound == neutral || (side && cause->parameter[cause->size].one_sided > 0) ||
            (!side && cause->parameter[cause->size].one_sided < 0))
            continue;
        for (int i = 0; i < steps; i++)
            size[count++] =
                lower > 0 && neutral > 0 ? neutral * pow(bound / neutral, share[i]) : neutral + share[i] * (bound - neutral);
    }
    return count;
}

/* How far the model with the effect is from the data, the modes paired anew: frequencies but for a factor that all have, and 1 -
 * MAC. spectrum: in, that of a trial near by, or without modes; out, that of the model, without modes where it has none. */
static int cost_of(struct pool *pool, const struct trials *trials, const struct effect *effect, struct spectrum *spectrum,
                   double *cost)
{
    const struct engine *e = trials->engine;
    const struct spectrum near = *spectrum;
    struct job job = *e->job;
    struct comparison compared;
    struct message_list quiet;
    *cost = INFINITY;
    message_open(&quiet, pool);
    job.measurement = *trials->measured;
    job.rotor.effect = POOL_COPY(pool, e->job->rotor.effect, job.rotor.neffect, 1);
    if (!job.rotor.effect)
        return ROTID_ERROR_MEMORY;
    job.rotor.effect[job.rotor.neffect++] = *effect;
    *spectrum = (struct spectrum){0};
    int status = spectrum_try(pool, job.models, &job.rotor, job.unknowns.nparameter, job.unknowns.parameter, e->deck_start,
                              comparison_candidates(&job), near.phi ? &near : NULL, spectrum);
    if (!status)
        status = comparison_make(pool, &job, spectrum, &quiet, &compared);
    if (status)
        return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
    double sum = 0, square = 0, shapes = 0;
    int count = 0;
    for (int k = 0; k < job.measurement.nmode; k++) {
        if (job.measurement.holdout[k] || compared.number[k] > spectrum->count)
            continue;
        double off = log(spectrum->full_hz[compared.number[k] - 1] / job.measurement.frequency_hz[k]);
        sum += off;
        square += off * off;
        count++;
        shapes += isfinite(compared.mac[k]) ? 1 - compared.mac[k] : 0;
    }
    *cost = (square - (count ? sum * sum / count : 0)) / (OFF_HZ * OFF_HZ) + shapes / OFF_SHAPE;
    return ROTID_OK;
}

static int try_candidate(void *context, int index, int worker)
{
    struct trials *trials = context;
    const struct scan_candidate *c = &trials->scan->candidate[index];
    const struct rotor *rotor = &trials->engine->job->rotor;
    double size[SIZES], cost;
    int place = c->cause->place, steps = place < 0 ? STEPS : STEPS_AT, status = ROTID_OK;
    (void)worker;
    trials->best[index].cost = INFINITY;
    if (c->cause->solid || c->suspect || !c->cause->effect->nparameter)
        return ROTID_OK;
    int sizes = sizes_of(c->cause, rotor, &c->effect, size), places = place < 0 ? 1 : PLACES;
    struct pool scratch[2]; /* of a trial, and of the one before, whose modes it begins with */
    struct spectrum spectrum = {0};
    for (int i = 0; i < 2; i++)
        pool_open(&scratch[i], trials->pool[index].allocator);
    for (int i = 0; i < sizes * places && !status; i++) {
        struct effect effect = c->effect;
        int at = i / sizes;
        effect.value[c->cause->size] = size[i % sizes];
        if (place >= 0)
            effect.value[place] = rotor_length(rotor) * (at + 0.5) / PLACES;
        if (i % steps == 0) /* at another place, or on the other side of no effect */
            spectrum = (struct spectrum){0};
        pool_close(&scratch[i % 2]);
        status = cost_of(&scratch[i % 2], trials, &effect, &spectrum, &cost);
        if (!status && cost < trials->best[index].cost)
            trials->best[index] = (struct trial){effect, cost};
    }
    for (int i = 0; i < 2; i++)
        pool_close(&scratch[i]);
    return status;
}

/* The modes of the job paired with those of its model at x, its effects as they stand. */
static int pair_at(struct engine *engine, const struct job *job, const double *x, struct comparison *compared)
{
    struct job own = *job;
    struct spectrum spectrum;
    struct message_list quiet;
    message_open(&quiet, engine->pool);
    own.unknowns.nparameter = engine->job->unknowns.nparameter;
    int status = spectrum_compute_parts(engine->pool, own.models, &own.rotor, own.unknowns.nparameter, own.unknowns.parameter, x,
                                        ROTID_GUYAN, comparison_candidates(&own), SPECTRUM_REDUCED, &spectrum);
    return status ? status : comparison_make(engine->pool, &own, &spectrum, &quiet, compared);
}

/* The fit from a trial with the pairing beside it; *rate INFINITY where there is none. */
static int fit_trial(struct engine *engine, const struct scan_candidate *c, const struct trial *trial,
                     const struct job_measurement *measured, double *rate, int **number, struct effect *effect)
{
    struct job job;
    struct state state;
    struct comparison paired;
    rotid_fit_result *fit = NULL;
    *rate = INFINITY;
    int status = job_with_effect(engine->pool, engine->job, engine->deck_start, &trial->effect, c->cause, NULL, &job);
    job.measurement = *measured;
    if (!status)
        status = pair_at(engine, &job, engine->deck_start, &paired);
    if (!status)
        status = refit_job(engine->pool, &job, paired.number, measured->holdout, engine->environment, &fit);
    if (!status && fit->dof > 0) {
        const struct states states = states_of(&job, &state);
        *rate = fit->chi2 / fit->dof;
        *number = paired.number;
        effect_at(states.state, job.rotor.neffect - 1, fit->x, effect);
    }
    rotid_fit_free(fit);
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

/* Of the single causes and of none. */
static double least_rate(const struct engine *engine, const struct posterior *p)
{
    double rate = INFINITY;
    for (int i = 0; i < p->count; i++) {
        const struct explanation *e = &p->item[i];
        const rotid_fit_result *fit = explanation_fit(engine, e);
        if (!e->something_else && (e->refit ? e->nmember == 1 && !candidate_is_fault(&e->member[0]) : !e->nmember) &&
            fit->dof > 0)
            rate = fmin(rate, fit->chi2 / fit->dof);
    }
    return rate;
}

/* The trials that come nearest, fitted; the best goes to the engine. */
static int fit_nearest(struct engine *engine, const struct trials *trials, double rate, int *changed)
{
    const struct scan *scan = trials->scan;
    struct far_start *found = POOL_NEW(engine->pool, struct far_start);
    int *number = NULL, status = found ? ROTID_OK : ROTID_ERROR_MEMORY;
    double least = engine->dropped ? AS_WELL * fmax(1, rate) : FEWER * rate;
    for (int fits = 0; fits < MOST_FITS && !status; fits++) {
        int next = -1, *own = NULL;
        double one = INFINITY;
        struct effect effect = {0};
        for (int i = 0; i < scan->ncandidate; i++)
            if (isfinite(trials->best[i].cost) && (next < 0 || trials->best[i].cost < trials->best[next].cost))
                next = i;
        if (next < 0)
            break;
        status = fit_trial(engine, &scan->candidate[next], &trials->best[next], trials->measured, &one, &own, &effect);
        trials->best[next].cost = INFINITY;
        if (status || !(one < least))
            continue;
        least = one;
        number = own;
        *found = (struct far_start){scan->candidate[next].cause, effect};
    }
    if (status || !number)
        return status;
    engine->far = found;
    *changed = 1;
    return pairing_adopt(engine, trials->measured, number);
}

int far_starts_search(struct engine *engine, const struct round_result *result, const struct posterior *posterior, int *changed)
{
    const struct job_measurement now = engine->job->measurement;
    struct trials trials = {engine, &result->scan, &now, POOL_ARRAY(engine->pool, struct trial, result->scan.ncandidate),
                            POOL_ARRAY(engine->pool, struct pool, result->scan.ncandidate)};
    double rate = least_rate(engine, posterior);
    *changed = 0;
    if (engine->searched_far || engine->states.nstate > 1 || engine->job->options.solid || !(rate > FAR_RATE || engine->dropped))
        return ROTID_OK;
    engine->searched_far = 1;
    if (!trials.best || !trials.pool)
        return ROTID_ERROR_MEMORY;
    if (engine->dropped && now.ncorrection == engine->measured.ncorrection)
        trials.measured = &engine->measured;
    for (int i = 0; i < result->scan.ncandidate; i++)
        pool_open(&trials.pool[i], engine->pool->allocator);
    int status = parallel_for(engine->threads, result->scan.ncandidate, try_candidate, &trials);
    for (int i = 0; i < result->scan.ncandidate; i++)
        pool_absorb(engine->pool, &trials.pool[i]);
    return status ? status : fit_nearest(engine, &trials, rate, changed);
}
