/* Which measurement would settle an ambiguity: the models that cannot be told apart by these data are asked for what was not
 * measured yet, and where they differ most against the noise. */
#include "diagnose/diagnose.h"

#define MORE_MODES 3 /* above the highest measured one */

struct future { /* of one model */
    int count;
    double hz[32];
};

/* Where two models can be told apart: a mode that was not measured, in one of the states. */
struct difference {
    int state, mode;     /* from 0 */
    double hz[2], apart; /* in standard deviations of a measured frequency there */
};

/* Frequencies of the model of a refit in one state up to some modes beyond those measured. */
static int foresee(struct pool *pool, const struct job *job, const double *x, int count, struct future *future)
{
    struct rotor_model model;
    struct prediction p;
    struct pool matrices; /* of a solid they are large beside what is wanted of them */
    pool_open(&matrices, pool->allocator);
    int failed, status = model_open(&matrices, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, 1,
                                    &model, &failed);
    future->count = count;
    if (!status)
        status = prediction_new(&matrices, &model.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, model.equations.nrigid + count,
                                0, &p);
    if (!status)
        status = prediction_compute(&p, x);
    for (int k = 0; k < count && !status; k++)
        future->hz[k] = prediction_hz(&p, model.equations.nrigid + k);
    pool_close(&matrices);
    return status;
}

static double typical_noise(const struct job *job)
{
    double sum = 0;
    for (int k = 0; k < job->measurement.nmode; k++)
        sum += job->measurement.frequency_std[k] * job->measurement.frequency_std[k];
    return sqrt(sum / job->measurement.nmode);
}

/* What the shapes lack, as the beginning of a sentence; "" where they are fitted. */
static const char *shapes_missing(const struct job *job)
{
    if (job_fits_shapes(job))
        return "";
    return job->measurement.shape ? "state the noise of the shapes (*NOISE, SHAPE=), so that they count; "
                                  : "measure mode shapes (some 30 points or more along the rotor, *NOISE, SHAPE=); ";
}

static const char *sentence(struct engine *engine, const struct candidate *first, const struct candidate *second,
                            const struct difference *difference)
{
    const struct state *state = &engine->states.state[difference->state];
    const struct job *job = &state->job;
    struct pool *pool = engine->pool;
    const char *shapes = shapes_missing(job);
    const char *one = candidate_label(pool, first), *two = candidate_label(pool, second);
    if (difference->apart < 1)
        return pool_format(pool, "%smore modes will not separate %s from %s; %s", shapes, one, two, first->cause->check);
    return pool_format(pool,
                       "%smeasure mode %d%s%s: %.6g Hz if it is %s, %.6g Hz if it is %s (%.1f standard deviations apart); or %s",
                       shapes, difference->mode + 1, state->name ? " of state " : "", state->name ? state->name : "",
                       difference->hz[0], one, difference->hz[1], two, difference->apart, first->cause->check);
}

static int highest_mode(const struct job *job, const int *number)
{
    int highest = 0;
    for (int k = 0; k < job->measurement.nmode; k++)
        highest = number[k] > highest ? number[k] : highest;
    return highest;
}

/* The largest difference of two models in state s, whose measured modes have `number` and `holdout`, where it is more than
 * `most`. */
static void find_difference(const struct job *job, int s, const int *number, const int *holdout, const struct future future[2],
                            int modes, struct difference *most)
{
    double noise = typical_noise(job);
    for (int k = 0; k < modes; k++) {
        int measured = 0;
        for (int m = 0; m < job->measurement.nmode; m++)
            measured |= number[m] == k + 1 && !holdout[m];
        double apart = fabs(future[0].hz[k] - future[1].hz[k]) / (noise * future[0].hz[k]);
        if (!measured && apart > most->apart)
            *most = (struct difference){s, k, {future[0].hz[k], future[1].hz[k]}, apart};
    }
}

/* Where two models differ most in the frequencies of all states. 0 where one of them cannot be foreseen, -1 where memory is out.
 */
static int compare_two(struct engine *engine, const struct possible *model, struct difference *most)
{
    const struct states *states = &engine->states;
    *most = (struct difference){0};
    for (int s = 0, mode = 0; s < states->nstate; mode += states->state[s].job.measurement.nmode, s++) {
        struct future future[2];
        int known = 1, top = highest_mode(&states->state[s].job, engine->number + mode) + MORE_MODES, modes = top < 32 ? top : 32;
        for (int m = 0; m < 2 && known; m++) {
            struct pool scratch;
            pool_open(&scratch, engine->pool->allocator);
            const struct state *state = &model[m].states->state[s];
            double *x = state_values(&scratch, state, model[m].x);
            int status = x ? foresee(&scratch, &state->job, x, modes, &future[m]) : ROTID_ERROR_MEMORY;
            pool_close(&scratch);
            known = !status;
            if (status == ROTID_ERROR_MEMORY)
                return -1;
        }
        if (known)
            find_difference(&states->state[s].job, s, engine->number + mode, engine->holdout + mode, future, modes, most);
    }
    return 1;
}

const char *advise_between(struct engine *engine, int count, const struct possible *model)
{
    struct difference most;
    if (count < 2)
        return pool_format(engine->pool, "%smore modes and more points along the rotor; %s", shapes_missing(engine->job),
                           count ? model[0].cause->cause->check
                                 : "the geometry, masses and materials of the deck are worth checking");
    return compare_two(engine, model, &most) < 0 ? NULL : sentence(engine, model[0].cause, model[1].cause, &most);
}
