/* One round: scan, bootstrap, refits of what is promising, evidence, decision. */
#include <math.h>

#include "base/parallel.h"
#include "diagnose/as_solid.h"
#include "diagnose/bootstrap.h"
#include "diagnose/clean.h"
#include "diagnose/evidence.h"
#include "diagnose/refit.h"
#include "diagnose/round.h"
#include "diagnose/scan.h"

#define MOST_REFITS 16
#define WORTH       3.0  /* a promised drop below this is noise */
#define SHARE       0.25 /* of the best promise: a rival of cosine 0.5 keeps so much */

struct refits {
    const struct engine *engine;
    struct round_result *result;
    const double *deck; /* [nparameter] the starts of the deck, of causes that were named their values */
    struct pool *pool;  /* [nrefit] one a task: pools are not shared between threads */
};

static int refit_task(void *context, int index, int worker)
{
    struct refits *refits = context;
    const struct engine *e = refits->engine;
    (void)worker;
    return refit_candidate(&refits->pool[index], &e->job, e->number, e->holdout, e->fit->x, refits->deck, &refits->result->scan,
                           refits->result->candidate[index], e->environment, &refits->result->refit[index]);
}

/* Candidates worth a nonlinear fit, the most promising first, and every suspect. */
static int choose(const struct scan *scan, double threshold, int *chosen)
{
    int count = 0;
    double least = fmax(WORTH, fmin(threshold / 2, SHARE * scan->largest));
    for (int rank = 0; rank < scan->ncandidate; rank++) {
        int best = -1;
        for (int i = 0; i < scan->ncandidate; i++) {
            int taken = 0;
            for (int j = 0; j < count; j++)
                taken |= chosen[j] == i;
            if (!taken && (best < 0 || scan_best_drop(scan, i) > scan_best_drop(scan, best)))
                best = i;
        }
        if (best < 0 || scan_best_drop(scan, best) < least || count == MOST_REFITS)
            break;
        chosen[count++] = best;
    }
    for (int i = 0; i < scan->ncandidate; i++) {
        int taken = 0;
        for (int j = 0; j < count; j++)
            taken |= chosen[j] == i;
        if (!taken && scan->candidate[i].suspect && scan->candidate[i].best >= 0)
            chosen[count++] = i;
    }
    return count;
}

static int run_refits(struct engine *engine, struct round_result *result)
{
    struct pool *pool = engine->pool;
    double *deck = POOL_ARRAY(pool, double, engine->job.unknowns.nparameter);
    struct refits refits = {engine, result, deck, POOL_ARRAY(pool, struct pool, result->nrefit)};
    result->refit = POOL_ARRAY(pool, struct refit, result->nrefit);
    if (!deck || !refits.pool || !result->refit) {
        result->nrefit = 0;
        return ROTID_ERROR_MEMORY;
    }
    for (int p = 0; p < engine->job.unknowns.nparameter; p++)
        deck[p] = p < engine->nown ? engine->deck_start[p] : engine->fit->x[p];
    for (int i = 0; i < result->nrefit; i++)
        pool_open(&refits.pool[i], pool->allocator);
    int status = parallel_for(engine->threads, result->nrefit, refit_task, &refits);
    for (int i = 0; i < result->nrefit; i++)
        pool_absorb(pool, &refits.pool[i]);
    return status;
}

/* Coloured noise, seen in what the best refit leaves; the round is then to be repeated with the noise raised. */
static int check_colour(struct engine *engine, const struct round_result *result, int *changed)
{
    int best = -1;
    *changed = 0;
    for (int i = 0; i < result->nrefit; i++)
        if (result->refit[i].fit && (best < 0 || result->refit[i].chi2 < result->refit[best].chi2))
            best = i;
    int status = data_colour(engine, &result->scan, best < 0 ? result->scan.r : result->refit[best].fit->r, changed);
    if (status || !*changed)
        return status;
    rotid_fit_result *fit = NULL;
    status = refit_job(engine->pool, &engine->job, engine->number, engine->holdout, engine->environment, &fit);
    if (status)
        return status;
    if (engine->fit != engine->out->base.fit)
        rotid_fit_free(engine->fit);
    engine->fit = fit;
    return ROTID_OK;
}

static int run_once(struct engine *engine, struct diagnosis_round *round, struct round_result *result, int *again)
{
    struct pool *pool = engine->pool;
    *round = (struct diagnosis_round){0};
    *result = (struct round_result){0};
    *again = 0;
    int status = engine_stage(engine, "scan, round", engine->out->nround + 1);
    if (!status && engine->base_scan) { /* nothing has changed since the data were checked */
        result->scan = *engine->base_scan;
        engine->base_scan = NULL;
    } else if (!status) {
        status = scan_run(pool, &engine->job, engine->number, engine->holdout, engine->fit->x, &result->scan);
    }
    engine_step(engine, "scan");
    const struct scan *scan = &result->scan;
    if (!status)
        status =
            bootstrap_run(pool, scan, engine->replicates, engine->seed, engine->threads, engine->environment, &result->bootstrap);
    engine_step(engine, "bootstrap");
    if (status)
        return status;
    const struct bootstrap *b = &result->bootstrap;
    round->result.chi2 = scan->chi2;
    round->result.chi2_frequency = scan->chi2_frequency;
    round->result.frequencies = scan->nfrequency;
    round->result.dof = scan->dof;
    round->result.largest = scan->largest;
    round->result.threshold = b->threshold;
    round->result.p_scan = b->p_scan;
    round->result.p_frequency = b->p_frequency;
    round->result.p_total = b->p_total;
    int adequate = scan->largest <= b->threshold && b->p_frequency > BLOCK_LEVEL && b->p_total > BLOCK_LEVEL;
    result->candidate = POOL_ARRAY(pool, int, scan->ncandidate);
    if (!result->candidate)
        return ROTID_ERROR_MEMORY;
    if (!adequate) {
        status = scan_solid(pool, &engine->job, engine->number, engine->holdout, engine->fit->x, &result->scan,
                            engine->out->nround ? NULL : engine->notes);
        engine_step(engine, "scan");
    }
    if (status)
        return status;
    result->nrefit = adequate ? 0 : choose(scan, b->threshold, result->candidate);
    status = engine_stage(engine, "fits of candidates, round", engine->out->nround + 1);
    if (!status)
        status = run_refits(engine, result);
    engine_step(engine, "refits");
    if (!status && !adequate)
        status = check_colour(engine, result, again);
    if (status || *again)
        return status;
    status = evidence_collect(engine, result, round);
    engine_step(engine, "held out");
    if (status)
        return status;
    if (adequate)
        round->result.kind = ROTID_ADEQUATE;
    return ROTID_OK;
}

int round_run(struct engine *engine, struct diagnosis_round *round, struct round_result *result)
{
    int again, status = run_once(engine, round, result, &again);
    if (status || !again)
        return status;
    round_free(result);
    return run_once(engine, round, result, &again);
}

void round_free(struct round_result *result)
{
    for (int i = 0; i < result->nrefit; i++)
        if (result->refit)
            rotid_fit_free(result->refit[i].fit);
    result->nrefit = 0;
}
