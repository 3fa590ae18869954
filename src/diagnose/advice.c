/* Which measurement would settle an ambiguity: the models that cannot be told apart by these data are asked for what was not
 * measured yet, and where they differ most against the noise. */
#include "diagnose/diagnose.h"

#define MORE_MODES 3 /* above the highest measured one */

/* Where two models can be told apart: a mode that was not measured, in one of the states. */
struct difference {
    int state, mode;     /* from 0 */
    double hz[2], apart; /* in standard deviations of a measured frequency there */
};

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
static void find_difference(const struct job *job, int s, const int *number, const int *holdout, const struct spectrum model[2],
                            struct difference *most)
{
    double noise = typical_noise(job);
    for (int k = 0; k < model[0].count && k < model[1].count; k++) {
        int measured = 0;
        for (int m = 0; m < job->measurement.nmode; m++)
            measured |= number[m] == k + 1 && !holdout[m];
        double apart = fabs(model[0].full_hz[k] - model[1].full_hz[k]) / (noise * model[0].full_hz[k]);
        if (!measured && apart > most->apart)
            *most = (struct difference){s, k, {model[0].full_hz[k], model[1].full_hz[k]}, apart};
    }
}

/* Where two models differ most in the frequencies of all states up to some modes beyond those measured. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
static int compare_two(struct engine *engine, const struct possible *model, struct difference *most)
{
    const struct states *states = &engine->states;
    *most = (struct difference){0};
    for (int s = 0, mode = 0; s < states->nstate; mode += states->state[s].job.measurement.nmode, s++) {
        int modes = highest_mode(&states->state[s].job, engine->number + mode) + MORE_MODES, status = ROTID_OK;
        struct spectrum spectrum[2];
        struct pool scratch;
        pool_open(&scratch, engine->pool->allocator);
        for (int m = 0; m < 2 && !status; m++) {
            const struct job *job = &model[m].states->state[s].job;
            double *x = state_values(&scratch, &model[m].states->state[s], model[m].x);
            status = x ? spectrum_try(&scratch, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, x,
                                      modes, NULL, &spectrum[m])
                       : ROTID_ERROR_MEMORY;
        }
        if (!status)
            find_difference(&states->state[s].job, s, engine->number + mode, engine->holdout + mode, spectrum, most);
        pool_close(&scratch);
        if (status == ROTID_ERROR_MEMORY)
            return status;
    }
    return ROTID_OK;
}

const char *advise_between(struct engine *engine, int count, const struct possible *model)
{
    struct difference most;
    if (count < 2)
        return pool_format(engine->pool, "%smore modes and more points along the rotor; %s", shapes_missing(engine->job),
                           count ? model[0].cause->cause->check
                                 : "the geometry, masses and materials of the deck are worth checking");
    return compare_two(engine, model, &most) ? NULL : sentence(engine, model[0].cause, model[1].cause, &most);
}
