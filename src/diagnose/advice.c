/* Which measurement would settle an ambiguity: the models that cannot be told apart by these data are asked for what was not
 * measured yet, and where they differ most against the noise. */
#include <math.h>
#include <string.h>

#include "diagnose/advice.h"
#include "diagnose/leave_out.h"
#include "diagnose/refit.h"
#include "diagnose/round.h"
#include "modal/prediction.h"
#include "model/model.h"

#define MORE_MODES 3 /* above the highest measured one */
#define MOST_SET   6

struct future { /* of one model */
    int count;
    double hz[32];
};

/* Frequencies of the model of a refit up to some modes beyond those measured. */
static int foresee(struct pool *pool, const struct job *job, const double *x, int count, struct future *future)
{
    struct rotor_model model;
    struct prediction p;
    int failed, status = model_open(pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, 1, &model,
                                    &failed);
    future->count = count;
    if (!status)
        status =
            prediction_new(pool, &model.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, model.equations.nrigid + count, 0, &p);
    if (!status)
        status = prediction_compute(&p, x);
    for (int k = 0; k < count && !status; k++)
        future->hz[k] = prediction_hz(&p, model.equations.nrigid + k);
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

static const char *sentence(struct engine *engine, const struct candidate *first, const struct candidate *second, int mode,
                            double hz_first, double hz_second, double apart)
{
    const struct job *job = &engine->job;
    struct pool *pool = engine->pool;
    const char *shapes = shapes_missing(job);
    const char *one = candidate_label(pool, first), *two = candidate_label(pool, second);
    if (!one || !two)
        return NULL;
    if (apart < 1)
        return pool_format(pool, "%smore modes will not separate %s from %s; %s", shapes, one, two, first->cause->check);
    return pool_format(pool,
                       "%smeasure mode %d: %.6g Hz if it is %s, %.6g Hz if it is %s (%.1f standard deviations apart); or %s",
                       shapes, mode, hz_first, one, hz_second, two, apart, first->cause->check);
}

const char *advise(struct engine *engine, const struct diagnosis_round *round, const struct round_result *last)
{
    const struct job *job = &engine->job;
    struct future future[MOST_SET];
    const struct candidate *member[MOST_SET];
    int count = 0, highest = 0, set = round->result.set > 1 ? round->result.set : 2;
    for (int k = 0; k < job->measurement.nmode; k++)
        highest = engine->number[k] > highest ? engine->number[k] : highest;
    int modes = highest + MORE_MODES < 32 ? highest + MORE_MODES : 32;
    for (int i = 0; last && i < round->ncandidate && i < set && count < MOST_SET; i++) {
        if (round->candidate[i].refit < 0)
            continue;
        const struct refit *refit = &last->refit[round->candidate[i].refit];
        struct pool scratch;
        pool_open(&scratch, engine->pool->allocator);
        if (!foresee(&scratch, &refit->job, refit->fit->x, modes, &future[count]))
            member[count++] = &round->candidate[i];
        pool_close(&scratch);
    }
    if (count < 2 || !round->result.set)
        return pool_format(engine->pool, "%smore modes and more points along the rotor; %s", shapes_missing(job),
                           count ? member[0]->cause->check : "the geometry, masses and materials of the deck are worth checking");
    int best_mode = highest;
    double best = 0, noise = typical_noise(job);
    for (int k = 0; k < modes; k++) {
        int measured = 0;
        for (int m = 0; m < job->measurement.nmode; m++)
            measured |= engine->number[m] == k + 1 && !engine->holdout[m];
        double apart = fabs(future[0].hz[k] - future[1].hz[k]) / (noise * future[0].hz[k]);
        if (!measured && apart > best) {
            best = apart;
            best_mode = k;
        }
    }
    int k = best_mode < modes ? best_mode : modes - 1;
    return sentence(engine, member[0], member[1], k + 1, future[0].hz[k], future[1].hz[k], best);
}
