/* One round: scan, bootstrap, refits of what is promising, evidence, decision. */
#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#include "base/base.h"
#include "diagnose/causes/causes.h"
#include "linalg/linalg.h"

#define SAME  0.98 /* of two unit columns, their cosine squared: one of them does what both do */
#define APART 0.06 /* of the rotor's length: two places of one cause */

/* Largest drop of the unit columns i and j with product g, their steps within bounds; *u, *v: the steps. */
static double best_along_edge(double b_free, double b_fixed, double g, double fixed, double lower, double upper, double *step)
{
    *step = fmin(fmax(-(b_free + g * fixed), lower), upper);
    return -2 * (b_free * *step + b_fixed * fixed) - *step * *step - fixed * fixed - 2 * g * *step * fixed;
}

static double pair_drop(const struct scan_item *i, const struct scan_item *j, double b_i, double b_j, double g, double *u,
                        double *v)
{
    double lower[2] = {i->lower * i->norm, j->lower * j->norm}, upper[2] = {i->upper * i->norm, j->upper * j->norm};
    double rest = 1 - g * g, best = 0;
    *u = -(b_i - g * b_j) / rest;
    *v = -(b_j - g * b_i) / rest;
    if (*u >= lower[0] && *u <= upper[0] && *v >= lower[1] && *v <= upper[1])
        return -b_i * *u - b_j * *v;
    *u = *v = 0;
    for (int edge = 0; edge < 4; edge++) { /* a convex function of two steps: its least value lies on an edge of their box */
        int of_second = edge & 1;
        double fixed = edge & 2 ? upper[of_second] : lower[of_second], free;
        double drop = of_second ? best_along_edge(b_i, b_j, g, fixed, lower[0], upper[0], &free)
                                : best_along_edge(b_j, b_i, g, fixed, lower[1], upper[1], &free);
        if (drop > best) {
            best = drop;
            *u = of_second ? free : fixed;
            *v = of_second ? fixed : free;
        }
    }
    return best;
}

static int searched(const struct scan_candidate *c)
{
    int count = 0;
    for (int p = 0; p < cause_parameters(&c->effect); p++)
        count += !c->fixed[p];
    return count ? count : 1;
}

static double place_of(const struct scan *scan, int item)
{
    const struct scan_item *i = &scan->item[item];
    int place = scan->candidate[i->candidate].cause->place;
    return place < 0 ? NAN : i->effect.value[place];
}

/* Products of the columns of two candidates, from their first items on, [leading * ...]. */
struct products {
    const double *gram;
    int leading, from_first, from_second;
    int in_one_state; /* one of the two acts in one state alone, in which the other one acts too */
};

/* The best items of the candidates a and b together. */
static double best_items(const struct scan *scan, const struct products *p, const double *along, int a, int b, double apart,
                         struct scan_set *set)
{
    const struct scan_candidate *first = &scan->candidate[a], *second = &scan->candidate[b];
    int one = a == b || (p->in_one_state && first->cause == second->cause && first->effect.target == second->effect.target);
    double best = 0;
    for (int i = first->first; i < first->first + first->count; i++)
        for (int j = a == b ? i + 1 : second->first; j < second->first + second->count; j++) {
            double g = p->gram[i - p->from_first + (ptrdiff_t)(j - p->from_second) * p->leading], u, v;
            if (!scan->item[i].usable || !scan->item[j].usable || g * g > SAME)
                continue;
            if (one && fabs(place_of(scan, i) - place_of(scan, j)) < apart)
                continue;
            double drop = pair_drop(&scan->item[i], &scan->item[j], along[i], along[j], g, &u, &v);
            if (drop <= best)
                continue;
            best = drop;
            *set = (struct scan_set){.count = 2,
                                     .candidate = {a, b},
                                     .item = {i, j},
                                     .amplitude = {u / scan->item[i].norm, v / scan->item[j].norm},
                                     .drop = drop};
        }
    return best;
}

/* A pair into the list of the best ones, which is kept in order. */
static void enter(const struct scan *scan, const struct scan_set *pair, int most, struct scan_set *set, int *count)
{
    double score =
        PARAMETER_PENALTY * (searched(&scan->candidate[pair->candidate[0]]) + searched(&scan->candidate[pair->candidate[1]])) -
        pair->drop;
    int at = *count < most ? (*count)++ : most;
    for (; at > 0; at--) {
        const struct scan_set *other = &set[at - 1];
        if (PARAMETER_PENALTY *
                    (searched(&scan->candidate[other->candidate[0]]) + searched(&scan->candidate[other->candidate[1]])) -
                other->drop <=
            score)
            break;
        if (at < most)
            set[at] = *other;
    }
    if (at < most)
        set[at] = *pair;
}

/* Whether a cause acts in one state, though others have its target. */
static int is_single(const struct scan *scan, int candidate)
{
    return scan->candidate[candidate].state >= 0;
}

/* The pair of a and b, if they make one, into the list. */
static void try_pair(const struct states *states, const struct scan *scan, const struct products *products, const double *along,
                     int a, int b, int most, struct scan_set *set, int *count)
{
    const struct rotor *rotor = &states->state[scan->candidate[a].home].job.rotor;
    struct scan_set pair = {0};
    int left = scan->dof - searched(&scan->candidate[a]) - searched(&scan->candidate[b]);
    if (left >= LEAST_RESIDUALS && scan_allows(states, scan, a, b) &&
        best_items(scan, products, along, a, b, APART * rotor_length(rotor), &pair) > 0)
        enter(scan, &pair, most, set, count);
}

/* Of causes that act in all states that have them, which stand first; the products are one matrix. */
static int choose_common(struct pool *pool, const struct states *states, const struct scan *scan, const double *along, int most,
                         struct scan_set *set, int *count)
{
    int n = 0, ncommon = 0;
    while (ncommon < scan->ncandidate && !is_single(scan, ncommon))
        n += scan->candidate[ncommon++].count;
    double *gram = POOL_ARRAY(pool, double, (size_t)n *(size_t)n);
    if (!gram)
        return ROTID_ERROR_MEMORY;
    if (n)
        product_gram(n, scan->nrow, scan->column, gram);
    const struct products products = {gram, n, 0, 0, 0};
    for (int a = 0; a < ncommon; a++)
        for (int b = a; b < ncommon; b++)
            try_pair(states, scan, &products, along, a, b, most, set, count);
    return ROTID_OK;
}

/* Of causes of which one or both act in one state alone. There are many more of these, and the products of all of them would not
 * be worth their room: those of two candidates at a time. */
static int choose_single(struct pool *pool, const struct states *states, const struct scan *scan, const double *along, int most,
                         struct scan_set *set, int *count)
{
    size_t largest = 0;
    for (int a = 0; a < scan->ncandidate; a++)
        largest = (size_t)scan->candidate[a].count > largest ? (size_t)scan->candidate[a].count : largest;
    double *gram = POOL_ARRAY(pool, double, largest *largest);
    if (!gram)
        return ROTID_ERROR_MEMORY;
    for (int a = 0; a < scan->ncandidate; a++)
        for (int b = a; b < scan->ncandidate; b++) {
            const struct scan_candidate *first = &scan->candidate[a], *second = &scan->candidate[b];
            if (!(is_single(scan, a) || is_single(scan, b)) || !first->count || !second->count)
                continue;
            const struct products products = {gram, first->count, first->first, second->first,
                                              states_meet(states->nstate, first->in, second->in)};
            product_transposed(first->count, second->count, scan->nrow, scan->column + (ptrdiff_t)first->first * scan->nrow,
                               scan->column + (ptrdiff_t)second->first * scan->nrow, gram);
            try_pair(states, scan, &products, along, a, b, most, set, count);
        }
    return ROTID_OK;
}

int pairs_choose(struct pool *pool, const struct states *states, const struct scan *scan, int most, struct scan_set *set,
                 int *count)
{
    double *along = POOL_ARRAY(pool, double, scan->nitem);
    int single = 0;
    *count = 0;
    if (!along)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < scan->nitem; i++)
        along[i] = product_dot(scan->nrow, scan->column + (ptrdiff_t)i * scan->nrow, scan->r);
    int status = choose_common(pool, states, scan, along, most, set, count);
    if (!status && states->nstate > 1)
        status = choose_single(pool, states, scan, along, most, set + *count, &single);
    *count += single;
    return status;
}

/* The candidate of a scan that is candidate c of another one, -1 where it has none. */
static int same_candidate(const struct scan *scan, const struct scan_candidate *c)
{
    for (int i = 0; i < scan->ncandidate; i++) {
        const struct scan_candidate *own = &scan->candidate[i];
        if (own->cause == c->cause && own->effect.target == c->effect.target && own->effect.variant == c->effect.variant &&
            own->state == c->state && own->suspect == c->suspect)
            return i;
    }
    return -1;
}

/* The partners that promise most beside a cause, in score. */
static void enter_partners(const struct states *states, const struct scan *scan, struct scan *beside, struct scan_set from,
                           int most, struct scan_set *set, int *count)
{
    for (int entered = 0; entered < most;) {
        int best = -1;
        double score = 0;
        for (int i = 0; i < beside->ncandidate; i++) {
            double worth = scan_best_drop(beside, i) - PARAMETER_PENALTY * searched(&beside->candidate[i]);
            if (beside->candidate[i].best >= 0 && worth > score) {
                best = i;
                score = worth;
            }
        }
        if (best < 0)
            return;
        const struct scan_candidate *partner = &beside->candidate[best];
        const struct scan_item *item = &beside->item[partner->best];
        int a = from.candidate[0], b = same_candidate(scan, partner);
        beside->candidate[best].best = -1;
        if (b < 0 || !scan_allows(states, scan, a, b) ||
            scan->dof - searched(&scan->candidate[a]) - searched(&scan->candidate[b]) < LEAST_RESIDUALS)
            continue;
        from.candidate[1] = b;
        from.drop = item->drop;
        from.start[1] = item->effect;
        from.start[1].name = scan->candidate[b].effect.name;
        if (!scan->candidate[b].fixed[partner->cause->size])
            from.start[1].value[partner->cause->size] += item->amplitude * item->unit;
        set[(*count)++] = from;
        entered++;
    }
}

/* The same where one of the two causes is known well enough to be in the model: *effect of `candidate`, with the states' own
 * parameters at x [nparameter], both of a fit, since columns at no effect say little of large ones. The scan is made again there,
 * and the `most` partners that promise most, in score, go behind the *count sets. ROTID_OK or ROTID_ERROR_MEMORY. */
static int pairs_beside(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
                        const struct scan *scan, int candidate, const struct effect *effect, int most, struct scan_set *set,
                        int *count)
{
    const struct scan_candidate *c = &scan->candidate[candidate];
    struct pool scratch;
    struct states with;
    struct scan beside = {0};
    pool_open(&scratch, pool->allocator);
    int status = states_with_effect(&scratch, states, x, effect, c->cause, c->fixed, c->in, &with);
    double *start = POOL_ARRAY(&scratch, double, status ? 0 : with.nparameter);
    if (!status && !start)
        status = ROTID_ERROR_MEMORY;
    for (int p = 0; !status && p < with.nparameter; p++)
        start[p] = with.bounds[p].start;
    if (!status)
        status = scan_run(&scratch, &with, number, holdout, start, &beside);
    if (!status)
        enter_partners(states, scan, &beside, (struct scan_set){.count = 2, .candidate = {candidate}, .x = x, .start = {*effect}},
                       most, set, count);
    pool_close(&scratch);
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK; /* no such model: no partner */
}

/* The level of the noise of the shapes: judged by what the best model so far leaves, said, used from there on. */

#define MUCH_LESS 0.7  /* of the stated noise */
#define WHOLE     1.5  /* chi2 a degree of freedom: with more, noise is not all that is left */
#define NOISIER   3.0  /* beyond any misjudgement: then it is the model that is wrong, in ways no cause has */
#define SHARED    0.45 /* correlation of neighbours; 0.08 is the error of its estimate, 0.2 what a smooth misfit adds */
#define LITTLE    2.0  /* chi2 a residual: with more, it is not noise that is left */
#define SLIGHT    0.05 /* excess of the smooth part of the noise that changes no verdict */

/* A cause that is an approximation, or an accelerometer that went from sensor to sensor, stands in the model already, and the
 * stated noise holds what it leaves. */
static int allows_for_more(const struct rotor *rotor)
{
    for (int e = 0; e < rotor->neffect; e++) {
        const struct cause_kind *cause = catalogue_of(&rotor->effect[e]);
        if (cause &&
            (cause->discrepancy_frequency > 0 || cause->discrepancy_shape > 0 || is_moving_accelerometer(&rotor->effect[e])))
            return 1;
    }
    return 0;
}

/* Not where the best model leaves more than that noise: then it is the model that is wrong. The stated noise is kept where it is
 * a little too large: a user may have allowed for what a model leaves. chi2: of the shapes, a degree of freedom. */
static int is_misstated(const struct engine *engine, const struct noise_estimate *noise, double chi2)
{
    if (!noise->usable || !noise->misstated || chi2 > WHOLE * noise->factor * noise->factor)
        return 0;
    if (noise->factor < 1)
        return noise->factor < MUCH_LESS && !engine->job->measurement.has_noise_floor && !allows_for_more(&engine->job->rotor);
    return noise->factor < NOISIER;
}

/* The level of the noise by what no cause can produce. */
static int check_noise(struct engine *engine, const struct scan *scan, const double *r, struct noise_estimate *noise)
{
    int first = scan->nfrequency, rows = scan->nrow - first, columns = scan->nbasis + scan->nitem;
    *noise = (struct noise_estimate){.factor = 1};
    double *part = POOL_ARRAY(engine->pool, double, (size_t)(rows > 0 ? rows : 0) * (size_t)columns);
    if (!part)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < columns && rows > 0; j++) {
        const double *column = j < scan->nbasis ? scan->basis + (ptrdiff_t)j * scan->nrow
                                                : scan->column + (ptrdiff_t)(j - scan->nbasis) * scan->nrow;
        memcpy(part + (ptrdiff_t)j * rows, column + first, (size_t)rows * sizeof *part);
    }
    return rows > 0 ? noise_check(engine->pool, rows, columns, r + first, part, noise) : ROTID_OK;
}

/* Correlation between neighbours and level of the noise from differences, which a smooth misfit hardly touches: first differences
 * have the variance 2 sigma^2 (1 - rho), second ones (3 - rho) times that. rho NaN where there are too few. */
static void neighbours(const struct engine *engine, const double *r, double *rho, double *sigma)
{
    const struct job *job = engine->job;
    double first = 0, second = 0;
    int nsensor = job->rotor.nsensor, row = 0, nfirst = 0, nsecond = 0;
    for (int k = 0; k < job->measurement.nmode; k++)
        row += !engine->holdout[k];
    for (int k = 0; k < job->measurement.nmode; k++) {
        int run = 0; /* neighbours in a row that were measured */
        for (int s = 0; s < nsensor && !engine->holdout[k]; s++) {
            if (!isfinite(job->measurement.shape[s + (ptrdiff_t)k * nsensor])) {
                run = 0;
                continue;
            }
            double d1 = run > 0 ? r[row] - r[row - 1] : 0, d2 = run > 1 ? r[row] - 2 * r[row - 1] + r[row - 2] : 0;
            first += d1 * d1;
            second += d2 * d2;
            nfirst += run > 0;
            nsecond += run > 1;
            run++;
            row++;
        }
    }
    *rho = *sigma = NAN;
    if (nsecond < 50 || !(first > 0))
        return;
    first /= nfirst;
    *rho = fmin(3 - second / nsecond / first, 0.9);
    *sigma = sqrt(first / (2 * (1 - *rho)));
}

/* Factor on the noise of smooth shapes where neighbours share it, 1 where they do not: the spectrum of such noise rises to
 * (1 + rho)/(1 - rho) towards long waves. Only where the fit has left little else. */
static double shared_noise(const struct engine *engine, const double *r, double chi2)
{
    double rho, sigma;
    neighbours(engine, r, &rho, &sigma);
    if (!(rho > SHARED) || chi2 > LITTLE)
        return 1;
    return fmin(fmax(1, sigma * sqrt((1 + rho) / (1 - rho))), NOISIER);
}

/* r [nrow of the scan] is the residual that the best candidate leaves, or that of the base. Where the noise differs from the
 * stated one beyond chance, or neighbouring sensors share it, which looks like physics to the scan, the judged data get the level
 * that is there, with a finding: the round has to be repeated, *changed. Behind the fits: the second-order part of a large effect
 * looks like noise. */
static int noise_settle(struct engine *engine, const struct scan *scan, const double *r, int *changed)
{
    struct noise_estimate noise;
    const struct job *job = engine->job;
    *changed = 0;
    if (engine->coloured || !job_fits_shapes(job))
        return ROTID_OK;
    int status = check_noise(engine, scan, r, &noise);
    if (status)
        return status;
    int dof = scan->dof - scan->nfrequency;
    double chi2 = 0;
    for (int i = scan->nfrequency; i < scan->nrow; i++)
        chi2 += r[i] * r[i] / (dof > 0 ? dof : 1);
    double shared = shared_noise(engine, r, chi2);
    int coloured = shared > 1 + SLIGHT;
    if (!coloured && !is_misstated(engine, &noise, chi2))
        return ROTID_OK;
    double factor = coloured ? shared : noise.factor;
    const char *text = pool_format(
        engine->pool,
        coloured ? "neighbouring sensors share their noise: its smooth part is %.2f times the stated level, which is used"
                 : "the noise of the shapes is %.2f times the stated one, which is used",
        factor);
    engine->coloured |= coloured;
    *changed = 1;
    double *base = engine->out->judged.state->job.measurement
                       .shape_std; /* another array where a cause has added its discrepancy to the judged one */
    for (ptrdiff_t i = 0; i < (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode && base != job->measurement.shape_std; i++)
        base[i] *= factor;
    status = data_correct_noise(engine, "SHAPE", factor, coloured ? NAN : noise.std, text);
    engine->out->judged.state->job.measurement.correction = job->measurement.correction;
    engine->out->judged.state->job.measurement.ncorrection = job->measurement.ncorrection;
    return status;
}

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
