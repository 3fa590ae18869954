/* One round: scan, bootstrap, refits of what is promising, evidence, decision. */
#include <math.h>

#include "base/parallel.h"
#include "diagnose/as_solid.h"
#include "diagnose/base.h"
#include "diagnose/bootstrap.h"
#include "diagnose/decide.h"
#include "diagnose/evidence.h"
#include "diagnose/far_starts.h"
#include "diagnose/faults.h"
#include "diagnose/noise_level.h"
#include "diagnose/pairing.h"
#include "diagnose/pairs.h"
#include "diagnose/refit.h"
#include "diagnose/round.h"
#include "diagnose/scan.h"

#define MOST_REFITS         16
#define MOST_PAIRS          16 /* the true one is seldom the first of the linear list: where effects are large its fit shows it */
#define MOST_PAIRS_OF_SOLID 6
#define PARTNERS            3    /* of a cause that has been fitted */
#define MOST_PASSES         5    /* of a round, each with better data */
#define WORTH               3.0  /* a promised drop below this is noise */
#define SHARE               0.25 /* of the best promise: a rival of cosine 0.5 keeps so much */

struct refits {
    const struct engine *engine;
    struct round_result *result;
    const double *deck; /* [nparameter] the starts of the deck, of causes that were named their values */
    int first;
    struct pool *pool; /* one a task: pools are not shared between threads */
};

static int refit_task(void *context, int index, int worker)
{
    struct refits *refits = context;
    const struct engine *e = refits->engine;
    (void)worker;
    int i = refits->first + index;
    return refit_set(&refits->pool[index], &e->states, e->number, e->holdout, e->fit->x, refits->deck, &refits->result->scan,
                     &refits->result->set[i], e->environment, &refits->result->refit[i]);
}

/* Candidates worth a nonlinear fit, the most promising first, and every suspect. */
static int choose(const struct scan *scan, double threshold, struct scan_set *set)
{
    int count = 0;
    double least = fmax(WORTH, fmin(threshold / 2, SHARE * scan->largest));
    for (int rank = 0; rank < scan->ncandidate; rank++) {
        int best = -1;
        for (int i = 0; i < scan->ncandidate; i++) {
            int taken = 0;
            for (int j = 0; j < count; j++)
                taken |= set[j].candidate[0] == i;
            if (!taken && (best < 0 || scan_best_drop(scan, i) > scan_best_drop(scan, best)))
                best = i;
        }
        if (best < 0 || scan_best_drop(scan, best) < least || count == MOST_REFITS)
            break;
        set[count++] = (struct scan_set){.count = 1, .candidate = {best}};
    }
    for (int i = 0; i < scan->ncandidate; i++) {
        int taken = 0;
        for (int j = 0; j < count; j++)
            taken |= set[j].candidate[0] == i;
        if (!taken && ((scan->candidate[i].suspect && scan->candidate[i].best >= 0) || scan->candidate[i].far))
            set[count++] = (struct scan_set){.count = 1, .candidate = {i}};
    }
    return count;
}

/* Fits the `count` sets behind those that are fitted already. */
static int run_refits(struct engine *engine, struct round_result *result, int count)
{
    struct pool *pool = engine->pool;
    double *deck = POOL_ARRAY(pool, double, engine->states.nparameter);
    struct refits refits = {engine, result, deck, result->nrefit, POOL_ARRAY(pool, struct pool, count)};
    if (!deck || !refits.pool)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < engine->states.nparameter; p++)
        deck[p] = p < engine->nown ? engine->deck_start[p] : engine->fit->x[p];
    for (int i = 0; i < count; i++)
        pool_open(&refits.pool[i], pool->allocator);
    result->nrefit += count;
    int status = parallel_for(engine->threads, count, refit_task, &refits);
    for (int i = 0; i < count; i++)
        pool_absorb(pool, &refits.pool[i]);
    return status;
}

/* The number of the best fit in score from `first` on that is not taken, -1 where there is none. */
static int best_refit(const struct round_result *result, int first, int besides)
{
    int best = -1;
    double least = INFINITY;
    for (int i = first; i < result->nrefit; i++) {
        const rotid_fit_result *fit = result->refit[i].fit;
        double score = fit ? fit->chi2 + PARAMETER_PENALTY * fit->n : INFINITY;
        if (score < least && i != besides) {
            least = score;
            best = i;
        }
    }
    return best;
}

/* Partners beside cause m of a fit, behind the `count` sets that are to be fitted. */
static int add_partners(struct engine *engine, struct round_result *result, int number, int m, int most, int *count)
{
    const struct refit *refit = &result->refit[number];
    const struct scan_set *set = &result->set[number];
    const struct scan_candidate *c = &result->scan.candidate[set->candidate[m]];
    if (c->cause->solid)
        return ROTID_OK;
    const struct rotor *rotor = &refit->states.state[c->home].job.rotor;
    return pairs_beside(engine->pool, &engine->states, engine->number, engine->holdout, refit->fit->x, &result->scan,
                        set->candidate[m], &rotor->effect[refit_effect(&result->scan, set, m, c->home, rotor)], most,
                        result->set + result->nrefit, count);
}

static int same_pair(const struct scan_set *a, const struct scan_set *b)
{
    return a->count == b->count && ((a->candidate[0] == b->candidate[0] && a->candidate[1] == b->candidate[1]) ||
                                    (a->candidate[0] == b->candidate[1] && a->candidate[1] == b->candidate[0]));
}

/* Of a pair that was fitted from several starts the best fit stays. */
static void merge_pairs(struct round_result *result, int first)
{
    int kept = first;
    for (int i = first; i < result->nrefit; i++) {
        int same = first;
        while (same < kept && !same_pair(&result->set[same], &result->set[i]))
            same++;
        int better = same == kept ||
                     (result->refit[i].fit && (!result->refit[same].fit || result->refit[i].chi2 < result->refit[same].chi2));
        if (same < kept)
            rotid_fit_free(result->refit[better ? same : i].fit);
        if (better) {
            result->set[same] = result->set[i];
            result->refit[same] = result->refit[i];
        }
        if (i != same) /* the next fits may be cancelled before they take its place */
            result->refit[i] = (struct refit){0};
        kept += same == kept;
    }
    result->nrefit = kept;
}

/* Pairs, where the best single cause does not explain the data. Where that is the rotor as a solid the rounds go on with it
 * first: it is no column that could be one of two. Columns without effects choose them, and columns beside the best single
 * causes; and where no pair explains the data, columns beside each cause of the best pair. */
static int run_pairs(struct engine *engine, struct round_result *result)
{
    const struct scan *scan = &result->scan;
    int first = result->nrefit, solid = engine->job->options.solid, best = best_refit(result, 0, -1), count = 0, beside = 0;
    if (best < 0 || scan->candidate[result->set[best].candidate[0]].cause->solid || fit_explains(scan, result->refit[best].fit))
        return ROTID_OK;
    int status = pairs_choose(engine->pool, &engine->states, scan, solid ? MOST_PAIRS_OF_SOLID : MOST_PAIRS,
                              result->set + result->nrefit, &count);
    int second = best_refit(result, 0, best);
    if (!status)
        status = add_partners(engine, result, best, 0, PARTNERS, &count);
    if (!status && second >= 0)
        status = add_partners(engine, result, second, 0, PARTNERS, &count);
    if (!status)
        status = run_refits(engine, result, count);
    if (status)
        return status;
    merge_pairs(result, first);
    best = best_refit(result, first, -1);
    if (best < 0 || solid || fit_explains(scan, result->refit[best].fit))
        return ROTID_OK;
    for (int m = 0; m < 2 && !status; m++)
        status = add_partners(engine, result, best, m, PARTNERS, &beside);
    if (!status)
        status = run_refits(engine, result, beside);
    if (!status)
        merge_pairs(result, first);
    return status;
}

/* The model before the round once more, its data having changed. */
static int fit_again(struct engine *engine)
{
    rotid_fit_result *fit = NULL;
    if (!engine->out->ncause)
        return base_again(engine);
    int status = refit_states(engine->pool, &engine->states, engine->number, engine->holdout, engine->environment, &fit);
    if (status)
        return status;
    if (engine->fit != engine->out->base.fit)
        rotid_fit_free(engine->fit);
    engine->fit = fit;
    return ROTID_OK;
}

/* The data judged by the best refits: pairing, channels, noise; the round is to be repeated where something was at fault. Pairing
 * and channels until a cause is named: beside the model that has it they were looked at. */
static int settle_data(struct engine *engine, struct round_result *result, int *changed)
{
    int best = -1, status = ROTID_OK;
    *changed = 0;
    if (!engine->out->ncause)
        status = pairing_settle(engine, result, changed);
    if (!status && !*changed && !engine->out->ncause)
        status = faults_settle(engine, result, changed);
    for (int i = 0; i < result->nrefit; i++)
        if (result->refit[i].fit && (best < 0 || result->refit[i].chi2 < result->refit[best].chi2))
            best = i;
    if (!status && !*changed)
        status = noise_settle(engine, &result->scan, best < 0 ? result->scan.r : result->refit[best].fit->r, changed);
    if (status || !*changed)
        return status;
    status = fit_again(engine);
    return status || engine->out->ncause ? status : pairing_note_again(engine);
}

/* The fits of a round. doubt: of the data, once they are there; *again: the data were at fault and are better now */
static int fit_round(struct engine *engine, struct diagnosis_round *round, struct round_result *result, int doubt, int *again)
{
    struct pool *pool = engine->pool;
    *round = (struct diagnosis_round){0};
    *result = (struct round_result){0};
    *again = 0;
    int status = engine_stage(engine, "scan, round", engine->out->nround + 1);
    if (!status)
        status = scan_run(pool, &engine->states, engine->number, engine->holdout, engine->fit->x, &result->scan);
    engine_step(engine, "scan");
    if (!status)
        far_starts_mark(engine, &result->scan);
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
    result->set = POOL_ARRAY(pool, struct scan_set, scan->ncandidate + 2 * MOST_PAIRS + 4 * PARTNERS);
    result->refit = POOL_ARRAY(pool, struct refit, scan->ncandidate + 2 * MOST_PAIRS + 4 * PARTNERS);
    if (!result->set || !result->refit)
        return ROTID_ERROR_MEMORY;
    if (!adequate) {
        status = scan_solid(pool, &engine->states, engine->number, engine->holdout, engine->fit->x, &result->scan,
                            engine->out->nround ? NULL : engine->notes);
        engine_step(engine, "scan");
    }
    if (status)
        return status;
    int single = adequate ? 0 : choose(scan, b->threshold, result->set);
    status = engine_stage(engine, "fits of candidates, round", engine->out->nround + 1);
    if (!status)
        status = run_refits(engine, result, single);
    engine_step(engine, "refits");
    if (!status && doubt && !adequate && !engine->out->ncause)
        status = far_starts_search(engine, result, again);
    engine_step(engine, "far starts");
    if (!status && *again)
        status = fit_again(engine);
    if (status || *again)
        return status;
    if (!adequate)
        status = run_pairs(engine, result);
    engine_step(engine, "pairs");
    if (!status && doubt)
        status = settle_data(engine, result, again);
    engine_step(engine, "data");
    if (status || *again)
        return status;
    round->result.kind = adequate ? ROTID_ADEQUATE : -1;
    return ROTID_OK;
}

static int run_once(struct engine *engine, struct diagnosis_round *round, struct round_result *result, int doubt, int *again)
{
    int status = fit_round(engine, round, result, doubt, again);
    if (status || *again)
        return status;
    int adequate = round->result.kind == ROTID_ADEQUATE;
    status = evidence_collect(engine, result, round);
    engine_step(engine, "held out");
    if (!status && adequate)
        round->result.kind = ROTID_ADEQUATE;
    return status;
}

int round_fit(struct engine *engine, struct diagnosis_round *round, struct round_result *result)
{
    int again;
    return fit_round(engine, round, result, 0, &again);
}

int round_settle(struct engine *engine)
{
    struct diagnosis_round round;
    struct round_result result = {0};
    int again = 1, status = ROTID_OK;
    for (int pass = 1; again && pass < MOST_PASSES && !status; pass++) {
        round_free(&result);
        status = fit_round(engine, &round, &result, 1, &again);
    }
    round_free(&result);
    return status;
}

int round_run(struct engine *engine, struct diagnosis_round *round, struct round_result *result)
{
    int again = 1, status = ROTID_OK;
    for (int pass = 1; again && !status; pass++) {
        round_free(result);
        status = run_once(engine, round, result, engine->states.nstate == 1 && pass < MOST_PASSES, &again);
    }
    return status;
}

void round_free(struct round_result *result)
{
    for (int i = 0; i < result->nrefit; i++)
        rotid_fit_free(result->refit[i].fit);
    result->nrefit = 0;
}
