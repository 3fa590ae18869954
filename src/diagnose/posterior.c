/* One posterior over explanations: sets of causes of the catalogue, each perhaps with something else beside it.
 *
 *   prior    nothing 0.50, one cause 0.45, two 0.035, three 0.001; alike over the kinds of causes, then over the targets of a
 *            kind, then over all states (1/2) and each alone; something else: a factor 0.05
 *   search   a beam: the most probable sets that were not expanded yet are scanned for one more cause, each addition is scored
 *            by the evidence of its columns, the most promising are fitted, as is the set with one cause less and, where no
 *            single cause leaves nothing, pairs of columns (scan_pairs.c), and scored by laplace.c, until none is left within
 *            WITHIN of the best; what was not fitted enters by its columns; widths that are free are integrated at last
 *            (over_width.c); something else comes beside the likeliest, where it leads beside every single cause
 *   run-up   measured critical speeds multiply each of the likeliest by their probability under it (runup_learn)
 *   verdict  UNEXPLAINED: something else above one half; NAMED: marginals of VERDICT_NAMED and more, placed in one interval;
 *            ADEQUATE: nothing leads, no cause above HARMLESS, the odds of the rest less than ODDS times those before; else
 *            AMBIGUOUS */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/base.h"
#include "diagnose/diagnose.h"
#include "fit/fit.h"
#include "running/running.h"

#define DATA_KINDS     7   /* of faults of channels: gain, sign, place, line, swap, copy, dead */
#define FAULTS         24  /* proposed beside a set */
#define BEAM           4   /* sets expanded in a pass */
#define FITTED         8   /* fits of a pass, the first three times as many */
#define PAIRS          8   /* of causes that are proposed together */
#define WITHIN         7.0 /* of the best, in ln P */
#define ELSE_MOST      3   /* sets of a size */
#define ELSE_PRIOR     0.05
#define LINEAR         10.0 /* of ln Z: by columns alone no set gains more over one that explains the data */
#define ROOM           4096
#define LEAST_SHARE    1e-7 /* of an explanation whose causes count for the marginals */
#define LEAST_MARGINAL 0.001
#define LISTED_SHARE   0.99
#define HARMLESS       0.2  /* a cause below it is none */
#define ODDS           3.0  /* of anything over nothing, times those before */
#define SUSPECTED      10.0 /* times: a cause that the user suspects */
#define RUNUP_MOST     12   /* explanations that measured critical speeds judge, those within WITHIN */
#define EXCLUDED       0.05 /* of the probability of another explanation */
#define LN_2PI         1.83787706640934548
#define NARROW         1e-3  /* share of a normal between its bounds: below, it is flat there */
#define NEAR_PLACE     0.125 /* of the length: half of the interval of a place that is named */

static const double set_prior[MOST_MEMBERS + 1] = {0.50, 0.45, 0.035, 0.001};

/* ---- sets */

/* One name: whatever its variant, and whoever asked for it. */
static int is_fault(const struct candidate *c)
{
    return c->cause->class == CAUSE_DATA;
}

static int same_cause(const struct candidate *a, const struct candidate *b)
{
    int same = a->cause == b->cause && a->state == b->state;
    if (!same || !is_fault(a)) /* of two channels that are one, whichever is the copy */
        return same && !strcmp(a->target, b->target);
    return (a->sensor[0] == b->sensor[0] && a->sensor[1] == b->sensor[1]) ||
           (a->sensor[0] == b->sensor[1] && a->sensor[1] == b->sensor[0]);
}

static int same_model(const struct candidate *a, const struct candidate *b)
{
    return same_cause(a, b) && !strcmp(a->target, b->target) && !memcmp(a->fixed, b->fixed, sizeof a->fixed) &&
           a->effect.variant == b->effect.variant && a->result.suspect == b->result.suspect &&
           (!a->result.suspect || !strcmp(a->effect.name, b->effect.name));
}

/* Of those with a place near it, too: far from there it is another one. */
static int same_name(const struct posterior *p, const struct candidate *a, const struct candidate *b)
{
    int place = a->cause->place;
    return same_cause(a, b) && (place < 0 || fabs(a->effect.value[place] - b->effect.value[place]) < NEAR_PLACE * p->length);
}

static int has(const struct posterior *p, const struct explanation *e, const struct candidate *c)
{
    for (int m = 0; m < e->nmember; m++)
        if (same_name(p, &e->member[m], c))
            return 1;
    return 0;
}

static int same_set(const struct explanation *a, const struct explanation *b)
{
    int same = a->nmember == b->nmember && a->something_else == b->something_else;
    for (int m = 0; m < a->nmember && same; m++) {
        int balance = 0;
        for (int k = 0; k < a->nmember; k++)
            balance += same_model(&a->member[k], &a->member[m]) - same_model(&b->member[k], &a->member[m]);
        same = !balance;
    }
    return same;
}

static struct explanation *find(const struct posterior *p, const struct explanation *e)
{
    for (int i = 0; i < p->count; i++)
        if (same_set(&p->item[i], e))
            return &p->item[i];
    return NULL;
}

/* Whether a set stands where a larger one does not have its causes: its fit may have ended in another minimum. */
static int stands_elsewhere(const struct posterior *p, const struct explanation *set, const struct explanation *larger)
{
    int all = 1;
    for (int m = 0; m < set->nmember; m++)
        all &= has(p, larger, &set->member[m]);
    return !all && set->refit && !set->again;
}

/* ---- priors */

/* How many faults of its kind there are; *kinds: of all that channels can have. */
static int faults_alike(const struct posterior *p, const struct candidate *c)
{
    int count = 0;
    for (int s = 0; s < p->states->nstate; s++) {
        const struct job *job = &p->states->state[s].job;
        int n = job_fits_shapes(job) ? job->rotor.nsensor : 0;
        count += !c->sensor[0]                              ? 4 * (n > 0) /* shift, scale, both, from the other end */
                 : !c->sensor[1]                            ? n
                 : strcmp(c->cause->id, "sensor_swap") == 0 ? n * (n - 1) / 2
                                                            : n * (n - 1);
    }
    return count > 0 ? count : 1;
}

/* ln of the probability of a cause among all single ones. */
static double cause_prior(const struct posterior *p, const struct candidate *c)
{
    const struct scan *scan = p->base;
    int targets = 0, alone = 0;
    if (is_fault(c))
        return -log((double)p->nkind * faults_alike(p, c));
    for (int i = 0; i < scan->ncandidate; i++) {
        const struct scan_candidate *s = &scan->candidate[i];
        if (s->cause != c->cause || s->suspect)
            continue;
        targets += s->state < 0;
        alone += s->state >= 0 && !strcmp(s->target, c->target);
    }
    double share = 1.0 / p->nkind / (targets > 0 ? targets : 1);
    if (alone)
        share *= c->state < 0 ? 0.5 : 0.5 / alone;
    return log(share * (c->result.suspect ? SUSPECTED : 1));
}

double posterior_log_prior(int nmember, int something_else)
{
    double sum = log(set_prior[nmember]) + (something_else ? log(ELSE_PRIOR) : log1p(-ELSE_PRIOR));
    for (int m = 1; m < nmember; m++) /* a set has no order */
        sum += log(m + 1);
    return sum;
}

static double prior_of(const struct posterior *p, const struct explanation *e)
{
    double sum = posterior_log_prior(e->nmember, e->something_else);
    for (int m = 0; m < e->nmember; m++)
        sum += cause_prior(p, &e->member[m]);
    return sum;
}

/* ---- the list */

static struct explanation *append(struct posterior *p, const struct explanation *e)
{
    if (p->count == p->room)
        return NULL;
    p->item[p->count] = *e;
    return &p->item[p->count++];
}

static int room_for_moduli(struct pool *pool, int nown, struct evidence *evidence)
{
    evidence->mean = POOL_ARRAY(pool, double, nown + 1);
    evidence->std = POOL_ARRAY(pool, double, nown + 1);
    return evidence->mean && evidence->std ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static const struct rotid_fit_result *fit_of(const struct engine *engine, const struct explanation *e)
{
    return e->refit ? e->refit->fit : engine->fit;
}

static const struct states *states_of_explanation(const struct engine *engine, const struct explanation *e)
{
    return e->refit ? &e->refit->states : &engine->states;
}

/* column [2 * MOST_MEMBERS]: those of the faults of a set, *nfault */
static int columns_of_faults(const struct engine *engine, const struct explanation *e, struct fault_column *column, int *nfault)
{
    int status = ROTID_OK;
    *nfault = 0;
    for (int m = 0; m < e->nmember && !status; m++)
        if (is_fault(&e->member[m]))
            status = fault_columns(engine->pool, states_of_explanation(engine, e), engine->number, engine->holdout,
                                   fit_of(engine, e), e->data, &e->member[m], column, nfault);
    return status;
}

static int score(struct engine *engine, struct posterior *p, const struct scan *else_scan, struct explanation *e)
{
    struct fault_column column[2 * MOST_MEMBERS];
    const struct states *states = states_of_explanation(engine, e);
    int nfault = 0, status = e->evidence.mean ? ROTID_OK : room_for_moduli(engine->pool, engine->nown, &e->evidence);
    if (!status)
        status = columns_of_faults(engine, e, column, &nfault);
    if (!status)
        status = evidence_of_fit(e->data, states, engine->nown, fit_of(engine, e), e->nmember, e->member, nfault, column,
                                 else_scan, &e->evidence);
    e->evidence.log_z += e->outside;
    e->evidence.log_stated += e->outside;
    e->evidence.log_exact += e->outside;
    e->evidence.log_else += e->outside;
    if (status == ROTID_ERROR_ARGUMENT) { /* a solid whose data are others */
        e->evidence.log_z = e->evidence.log_stated = e->evidence.log_exact = e->evidence.log_else = -INFINITY;
        status = ROTID_OK;
    }
    if (e->nmember && e->member[e->nmember - 1].cause->place >= 0 && e->refit) {
        double more = evidence_of_other_place(e->refit);
        e->evidence.log_z += more;
        e->evidence.log_stated += more;
        e->evidence.log_exact += more;
    }
    e->log_prior = prior_of(p, e);
    e->log_posterior = e->evidence.log_z + e->log_prior;
    return status;
}

/* The values of a fit in the members, found by the names of their effects. */
static void take_values(const struct engine *engine, const struct refit *refit, struct candidate *c)
{
    c->result.refitted = 1;
    c->result.chi2 = refit->chi2;
    c->result.chi2_drop = engine->fit->chi2 - refit->chi2;
    c->other_chi2 = refit->other_chi2;
    c->other_place = refit->other_place;
    if (is_fault(c))
        return;
    const struct state *home = &refit->states.state[c->home];
    int e = effect_named(home, c->effect.name);
    if (e >= 0)
        candidate_values(refit, home, e, c);
}

/* ---- proposals */

enum { ADDS_FAULT = -1, ANEW = -2 };

struct proposal {
    int parent, candidate; /* number in the list; of the parent's scan; ADDS_FAULT: of the measurement; ANEW: from
                             the base, one cause less or two */
    struct scan *scan;
    double gain; /* of ln Z over the parent, linear */
    struct explanation set;
};

/* ln of the mean over places and widths, and the item that counts most. */
static double gain_of(const struct states *states, const struct scan *scan, int index, int *best)
{
    const struct scan_candidate *c = &scan->candidate[index];
    double sum = -INFINITY, most = -INFINITY;
    *best = c->best;
    if (!c->count)
        return c->promise / 2;
    for (int i = c->first; i < c->first + c->count; i++) {
        double one = evidence_of_item(scan, &states->state[c->home].job.rotor, i);
        sum = log_sum(sum, one);
        if (one > most) {
            most = one;
            *best = i;
        }
    }
    return sum - log(c->count);
}

/* ln Z of a single cause by its columns alone where the fit goes no further than they do: then the sum over all places and widths
 * counts, not the normal about the best one. */
static void prefer_columns(const struct states *states, const struct scan *scan, int index, const struct explanation *parent,
                           struct explanation *e)
{
    const struct scan_candidate *c = &scan->candidate[index];
    int best;
    if (c->best < 0 || !e->refit)
        return;
    double drop = scan->item[c->best].drop, fitted = scan->chi2 - e->refit->chi2;
    if (fabs(drop - fitted) > 1 || fitted > 30)
        return;
    double columns = parent->evidence.log_exact + gain_of(states, scan, index, &best), more = columns - e->evidence.log_exact;
    if (e->evidence.log_stated > e->evidence.log_exact + 1 || fabs(e->evidence.log_z - e->evidence.log_exact) > 3)
        return; /* it leaves something, or the noise is another one: columns know neither */
    e->evidence.log_exact += more;
    e->evidence.log_stated += more;
    e->evidence.log_z += more;
    e->log_posterior += more;
    e->by_columns = 1;
}

/* A cause whose columns lie within those of the unknowns: no fit tells it from what it was added to. */
static int is_inseparable(const struct proposal *p)
{
    const struct scan_candidate *c = p->candidate < 0 ? NULL : &p->scan->candidate[p->candidate];
    return c && c->count && c->best < 0;
}

/* Those that can be fitted before the others. */
static int by_gain(const void *a, const void *b)
{
    const struct proposal *one = a, *two = b;
    if (is_inseparable(one) != is_inseparable(two))
        return is_inseparable(one) - is_inseparable(two);
    double first = one->set.log_posterior, second = two->set.log_posterior;
    return (first < second) - (first > second);
}

/* Whether a cause in one state alone is the same in all: no other state in which it could act has modes that are fitted. */
static int is_common(const struct engine *engine, const struct scan *scan, int index)
{
    const struct scan_candidate *c = &scan->candidate[index], *all = NULL;
    for (int i = 0; i < scan->ncandidate && c->state >= 0 && !all; i++)
        if (scan->candidate[i].state < 0 && scan->candidate[i].cause == c->cause && !strcmp(scan->candidate[i].target, c->target))
            all = &scan->candidate[i];
    int others = 0;
    for (int s = 0, mode = 0; all && s < engine->states.nstate; mode += engine->states.state[s].job.measurement.nmode, s++)
        for (int k = 0; k < engine->states.state[s].job.measurement.nmode && s != c->state && all->in[s]; k++)
            others += !engine->holdout[mode + k];
    return all && !others;
}

static double best_stated(const struct posterior *p)
{
    double best = -INFINITY;
    for (int i = 0; i < p->count; i++)
        if (p->item[i].refit || !p->item[i].nmember)
            best = fmax(best, p->item[i].evidence.log_exact + p->item[i].log_prior);
    return best;
}

/* All positions count from the other end. */
static int is_turned(const struct candidate *c)
{
    return is_fault(c) && !c->sensor[0] && c->effect.value[2] >= 0.5;
}

/* A channel has one fault. */
static int has_fault_there(const struct explanation *e, const struct candidate *c)
{
    int found = 0;
    for (int m = 0; m < e->nmember; m++)
        for (int k = 0; k < 2 && is_fault(&e->member[m]) && e->member[m].home == c->home; k++)
            found |= e->member[m].sensor[k] == c->sensor[0] || (c->sensor[1] && e->member[m].sensor[k] == c->sensor[1]);
    return found;
}

/* Faults of the measurement as additions to a set. */
static int propose_faults(struct engine *engine, struct posterior *p, int parent, struct scan *scan, struct proposal *proposal,
                          int most, int *count)
{
    const struct explanation *from = &p->item[parent];
    struct fault_proposal fault[FAULTS];
    int found, status = faults_propose(engine->pool, states_of_explanation(engine, from), engine->number, engine->holdout,
                                       fit_of(engine, from), from->data, scan, FAULTS, fault, &found);
    for (int i = 0; i < found && *count < most && !status; i++) {
        struct proposal one = {.parent = parent, .candidate = ADDS_FAULT, .scan = scan, .gain = fault[i].gain, .set = *from};
        struct explanation *set = &one.set;
        if (has_fault_there(from, &fault[i].fault) || (parent && is_turned(&fault[i].fault))) /* others are added to that */
            continue;
        set->member[set->nmember++] = fault[i].fault;
        set->outside += fault[i].outside;
        set->refit = NULL;
        set->scan = NULL;
        set->expanded = 0;
        set->log_prior = prior_of(p, set);
        set->evidence.log_z += one.gain;
        set->evidence.log_stated = set->evidence.log_exact = from->evidence.log_exact + one.gain;
        set->evidence.log_else = -INFINITY;
        set->log_posterior = set->evidence.log_exact + set->log_prior;
        if (!find(p, set))
            proposal[(*count)++] = one;
    }
    return status;
}

/* A set of physical causes with one less: what led to it may not be needed any more. A set that was fitted is so again where the
 * larger one has a cause at another place. */
static void propose_removals(const struct posterior *p, int parent, struct proposal *proposal, int most, int *count)
{
    const struct explanation *from = &p->item[parent];
    for (int m = 0; m < from->nmember && from->nmember > 1 && *count < most; m++) {
        struct proposal one = {.parent = parent, .candidate = ANEW, .set = *from};
        struct explanation *set = &one.set;
        int physical = 1;
        set->nmember--;
        for (int k = m; k < set->nmember; k++)
            set->member[k] = from->member[k + 1];
        for (int k = 0; k < from->nmember; k++)
            physical &= !is_fault(&from->member[k]) && !from->member[k].cause->solid;
        set->refit = NULL;
        set->scan = NULL;
        set->expanded = 0;
        set->log_prior = prior_of(p, set);
        set->log_posterior = from->evidence.log_exact + set->log_prior; /* worth a fit */
        struct explanation *known = find(p, set);
        if (physical && (!known || stands_elsewhere(p, known, from)))
            proposal[(*count)++] = one;
    }
}

/* The additions to a set, behind the *count there are. */
static int propose(struct engine *engine, struct posterior *p, int parent, struct scan *scan, struct proposal *proposal, int most,
                   int *count)
{
    const struct explanation *from = &p->item[parent];
    const struct states *states = states_of_explanation(engine, from);
    for (int i = 0; i < scan->ncandidate && *count < most; i++) {
        struct proposal one = {.parent = parent, .candidate = i, .scan = scan, .set = *from};
        int best;
        if (is_common(engine, scan, i))
            continue;
        one.set.member[one.set.nmember++] = candidate_listed(scan, i);
        one.set.refit = NULL;
        one.set.scan = NULL;
        one.set.expanded = 0;
        one.gain = gain_of(states, scan, i, &best);
        one.set.log_prior = prior_of(p, &one.set);
        one.set.evidence.log_stated = one.set.evidence.log_exact = from->evidence.log_exact + one.gain;
        one.set.evidence.log_z = from->evidence.log_z - from->evidence.log_stated + one.set.evidence.log_stated;
        one.set.evidence.log_else = -INFINITY;
        one.set.log_posterior = one.set.evidence.log_stated + one.set.log_prior;
        int status = room_for_moduli(engine->pool, engine->nown, &one.set.evidence);
        if (status)
            return status;
        const struct scan_item *item = best < 0 ? NULL : &scan->item[best];
        for (int q = 0; q < engine->nown; q++) {
            double shift = item && isfinite(scan->shift[q + (ptrdiff_t)best * scan->nfree])
                               ? item->amplitude * scan->shift[q + (ptrdiff_t)best * scan->nfree]
                               : 0;
            one.set.evidence.mean[q] =
                fmin(fmax(from->evidence.mean[q] - shift, states->bounds[q].lower), states->bounds[q].upper);
            one.set.evidence.std[q] = from->evidence.std[q];
        }
        struct candidate *member = &one.set.member[one.set.nmember - 1];
        if (item) {
            member->effect = item->effect;
            if (!member->fixed[member->cause->size])
                member->effect.value[member->cause->size] += item->amplitude * item->unit;
        }
        if (find(p, &one.set))
            continue;
        proposal[(*count)++] = one;
    }
    return ROTID_OK;
}

/* The cause of an item of the scan at this amplitude. */
static struct candidate cause_of_item(const struct scan *scan, int item, double amplitude)
{
    const struct scan_item *i = &scan->item[item];
    struct candidate c = candidate_listed(scan, i->candidate);
    const char *name = c.effect.name;
    c.effect = i->effect;
    c.effect.name = name;
    if (!c.fixed[c.cause->size])
        c.effect.value[c.cause->size] += amplitude * i->unit;
    return c;
}

/* Two causes at once beside the base, behind the *count there are. */
static int propose_pairs(struct engine *engine, struct posterior *p, struct scan *scan, struct proposal *proposal, int most,
                         int *count)
{
    const struct explanation *from = &p->item[0];
    struct scan_pair pair[PAIRS];
    int found, status = scan_pairs(engine->pool, scan, PAIRS, pair, &found);
    for (int i = 0; i < found && *count < most && !status; i++) {
        struct proposal one = {.parent = 0, .candidate = ANEW, .scan = scan, .gain = pair[i].drop / 2, .set = *from};
        struct explanation *set = &one.set;
        for (int m = 0; m < 2; m++)
            set->member[set->nmember++] = cause_of_item(scan, pair[i].item[m], pair[i].amplitude[m]);
        struct effect *second = &set->member[1].effect;
        if (!strcmp(second->name, set->member[0].effect.name) &&
            !(second->name = pool_format(engine->pool, "%s_2", second->name)))
            return ROTID_ERROR_MEMORY;
        set->refit = NULL;
        set->scan = NULL;
        set->expanded = 0;
        set->log_prior = prior_of(p, set);
        set->log_posterior = from->evidence.log_exact + one.gain + set->log_prior;
        if (!find(p, set))
            proposal[(*count)++] = one;
    }
    return status;
}

struct task {
    const struct engine *engine;
    struct posterior *p;
    struct proposal *proposal;
    struct refit *refit;
    struct evidence_data **data; /* of its own where a fault was put right */
    struct pool *pool;
};

/* The set fitted anew from the model without a cause, from the values that its causes have. */
static int refit_set(struct pool *pool, const struct engine *e, const struct explanation *set, const double *x,
                     struct refit *refit)
{
    struct states states = e->states;
    rotid_fit_result *fit = NULL;
    int status = states_started_at(pool, &e->states, x, &states);
    *refit = (struct refit){.chi2 = INFINITY, .other_chi2 = NAN, .other_place = NAN};
    for (int m = 0; m < set->nmember && !status; m++) {
        const struct candidate *c = &set->member[m];
        status = states_with_effect(pool, &states, NULL, &c->effect, c->cause, c->fixed, c->in, &states);
    }
    if (!status)
        status = refit_states(pool, &states, e->number, e->holdout, e->environment, &fit);
    if (!status)
        status = refit_keep(pool, &states, fit, refit);
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

static int fit_task(void *context, int index, int worker)
{
    struct task *t = context;
    const struct engine *e = t->engine;
    const struct proposal *proposal = &t->proposal[index];
    const struct explanation *parent = &t->p->item[proposal->parent];
    const struct states *states = states_of_explanation(e, parent);
    double *deck = POOL_ARRAY(&t->pool[index], double, states->nparameter);
    (void)worker;
    if (!deck)
        return ROTID_ERROR_MEMORY;
    t->data[index] = parent->data;
    if (proposal->candidate == ANEW)
        return refit_set(&t->pool[index], e, &proposal->set, fit_of(e, parent)->x, &t->refit[index]);
    if (proposal->candidate == ADDS_FAULT)
        return fault_refit(&t->pool[index], states, e->nown, e->number, e->holdout, fit_of(e, parent), e->environment,
                           &t->proposal[index].set.member[proposal->set.nmember - 1], &t->refit[index], &t->data[index]);
    const double *x = fit_of(e, parent)->x;
    for (int p = 0; p < states->nparameter; p++)
        deck[p] = p < e->nown ? e->deck_start[p] : x[p];
    return refit_cause(&t->pool[index], states, e->number, e->holdout, x, deck, proposal->scan, proposal->candidate,
                       e->environment, &t->refit[index]);
}

/* Fits the first `count` proposals and enters them; the others enter by their columns. */
static int fit_proposals(struct engine *engine, struct round_result *result, struct posterior *p, struct proposal *proposal,
                         int count)
{
    struct refit *refit = result->refit + result->nrefit;
    struct task task = {engine,
                        p,
                        proposal,
                        refit,
                        POOL_ARRAY(engine->pool, struct evidence_data *, count),
                        POOL_ARRAY(engine->pool, struct pool, count)};
    if (result->nrefit + count > result->room || !task.pool || !task.data)
        return ROTID_ERROR_MEMORY;
    result->nrefit += count;
    for (int i = 0; i < count; i++)
        pool_open(&task.pool[i], engine->pool->allocator);
    int status = parallel_for(engine->threads, count, fit_task, &task);
    for (int i = 0; i < count; i++)
        pool_absorb(engine->pool, &task.pool[i]);
    for (int i = 0; i < count && !status; i++) {
        struct explanation e = proposal[i].set;
        if (!refit[i].fit)
            continue;
        e.refit = &refit[i];
        e.data = task.data[i];
        e.evidence = (struct evidence){0};
        for (int m = 0; m < e.nmember; m++)
            take_values(engine, &refit[i], &e.member[m]);
        status = score(engine, p, NULL, &e);
        if (!status && proposal[i].candidate >= 0)
            prefer_columns(states_of_explanation(engine, &p->item[proposal[i].parent]), proposal[i].scan, proposal[i].candidate,
                           &p->item[proposal[i].parent], &e);
        struct explanation *known = find(p, &e);
        if (known) {
            known->again = e.again = 1;
            if (!status && e.log_posterior > known->log_posterior)
                *known = e;
        } else if (!status && !append(p, &e)) {
            status = ROTID_ERROR_MEMORY;
        }
    }
    return status;
}

/* ---- the search */

static int explains(const struct engine *engine, const struct posterior *p, const struct explanation *e)
{
    return fit_explains(p->base, e->data, fit_of(engine, e));
}

/* Whether a single cause or none leaves no more than noise. */
static int is_explained(const struct engine *engine, const struct posterior *p)
{
    int any = 0;
    for (int i = 0; i < p->count && !any; i++)
        any = (p->item[i].refit || !p->item[i].nmember) && explains(engine, p, &p->item[i]);
    return any;
}

static int has_fit(const struct explanation *e)
{
    return (e->refit || !e->nmember) && !e->something_else;
}

/* The next set to expand: the most probable that has a fit; where even the best leaves more than noise those far behind it too,
 * but solids, whose scans and fits take their time. */
static int next_parent(const struct engine *engine, const struct posterior *p, int taken)
{
    int best = -1, lead = -1;
    for (int i = 0; i < p->count; i++)
        if (has_fit(&p->item[i]) && (lead < 0 || p->item[i].log_posterior > p->item[lead].log_posterior))
            lead = i;
    if (lead < 0)
        return -1;
    int explained = explains(engine, p, &p->item[lead]);
    double least = p->item[lead].log_posterior - WITHIN;
    for (int i = 0; i < p->count; i++) {
        const struct explanation *e = &p->item[i];
        int solid = 0;
        for (int m = 0; m < e->nmember; m++)
            solid |= e->member[m].cause->solid;
        if (has_fit(e) && !e->expanded && !(solid && (explained || e->log_posterior < least)) &&
            (best < 0 || e->log_posterior > p->item[best].log_posterior))
            best = i;
    }
    return best >= 0 && (p->item[best].log_posterior >= least || (taken < BEAM && !explained)) ? best : -1;
}

static int enter_singles(struct engine *engine, const struct round_result *result, struct posterior *p)
{
    const struct scan *scan = &result->scan;
    struct explanation e = {.data = p->data};
    int status = score(engine, p, NULL, &e);
    if (!status)
        append(p, &e);
    for (int i = 0; i < result->nrefit && !status; i++) {
        const struct refit *refit = &result->refit[i];
        int index = result->candidate[i];
        if (!refit->fit || is_common(engine, scan, index))
            continue;
        struct candidate member = candidate_listed(scan, index);
        const struct rotor *rotor = &refit->states.state[member.home].job.rotor;
        if (!member.cause->solid)
            member.effect.name = rotor->effect[rotor->neffect - 1].name;
        take_values(engine, refit, &member);
        if (is_unweighed_accelerometer(&engine->states.state[member.home].job, &member.effect))
            continue;
        e = (struct explanation){.nmember = 1, .refit = refit, .data = p->data};
        e.member[0] = member;
        status = score(engine, p, NULL, &e);
        if (!status)
            prefer_columns(&engine->states, scan, index, &p->item[0], &e);
        if (!status && !find(p, &e))
            append(p, &e);
    }
    return status;
}

/* A set that several parents lead to stays once, from where it promises most. Returns how many there are. */
static int keep_first(struct proposal *proposal, int count)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        int known = 0;
        for (int k = 0; k < kept && !known; k++)
            known = same_set(&proposal[k].set, &proposal[i].set);
        if (!known)
            proposal[kept++] = proposal[i];
    }
    return kept;
}

static int expand(struct engine *engine, struct round_result *result, struct posterior *p, int pass, int *more)
{
    struct pool *pool = engine->pool;
    int parent, taken = 0, count = 0, fits = 0, most = BEAM * (result->scan.ncandidate + 8 + FAULTS + MOST_MEMBERS) + PAIRS,
                status = ROTID_OK;
    struct proposal *proposal = POOL_ARRAY(pool, struct proposal, most);
    if (!proposal)
        return ROTID_ERROR_MEMORY;
    *more = 0;
    while (taken < (pass ? BEAM : 1) && !status && (parent = pass ? next_parent(engine, p, taken) : 0) >= 0) {
        struct explanation *from = &p->item[parent];
        from->expanded = 1;
        taken++;
        propose_removals(p, parent, proposal, most, &count);
        if (from->nmember == MOST_MEMBERS)
            continue;
        struct scan *scan = parent ? POOL_NEW(pool, struct scan) : &result->scan;
        from->scan = scan;
        if (!scan)
            return ROTID_ERROR_MEMORY;
        if (parent)
            status = scan_run(pool, &from->refit->states, engine->number, engine->holdout, from->refit->fit->x, SCAN_ALL, scan);
        if (!status)
            status = propose(engine, p, parent, scan, proposal, most, &count);
        if (!status)
            status = propose_faults(engine, p, parent, scan, proposal, most, &count);
    }
    if (!status && !pass && !is_explained(engine, p))
        status = propose_pairs(engine, p, &result->scan, proposal, most, &count);
    if (status || !count)
        return status;
    qsort(proposal, (size_t)count, sizeof *proposal, by_gain);
    count = keep_first(proposal, count);
    double best = best_stated(p);
    while (fits < count && fits < (pass ? FITTED : 3 * FITTED) && proposal[fits].set.log_posterior > best - WITHIN &&
           !is_inseparable(&proposal[fits]))
        fits++;
    status = fit_proposals(engine, result, p, proposal, fits);
    for (int i = fits; i < count && !status; i++) {
        struct explanation *e = &proposal[i].set;
        if (proposal[i].candidate == ANEW || proposal[i].gain > LINEAR || !explains(engine, p, &p->item[proposal[i].parent]))
            continue;
        e->log_posterior = e->evidence.log_z + e->log_prior;
        if (!find(p, e))
            append(p, e);
    }
    *more = fits > 0 || !pass;
    return status;
}

static int by_posterior(const void *a, const void *b)
{
    double one = ((const struct explanation *)a)->log_posterior, two = ((const struct explanation *)b)->log_posterior;
    return (one < two) - (one > two);
}

/* The first cause of a set whose width is free; NULL: none, or its ln Z is over all widths already. */
static const struct candidate *free_width(const struct explanation *e)
{
    for (int m = 0; m < e->nmember && e->refit && !e->by_columns; m++)
        if (e->member[m].cause->width >= 0 && !e->member[m].fixed[e->member[m].cause->width])
            return &e->member[m];
    return NULL;
}

/* Evidence over the widths that are free, of the sets that count. What it is to a zone it is in the likeliest set that has it;
 * the others take it from there. */
static int integrate_widths(struct engine *engine, struct posterior *p)
{
    struct fault_column column[2 * MOST_MEMBERS];
    double best = -INFINITY, *more = POOL_ARRAY(engine->pool, double, p->count + 1);
    if (!more)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < p->count; i++)
        best = fmax(best, p->item[i].log_posterior);
    for (int i = 0, from; i < p->count; i++) {
        struct explanation *e = &p->item[i];
        const struct candidate *zone = e->log_posterior > best - WITHIN ? free_width(e) : NULL;
        for (from = 0; zone && from < i; from++)
            if (more[from] && free_width(&p->item[from]) && same_model(free_width(&p->item[from]), zone) &&
                same_name(p, free_width(&p->item[from]), zone))
                break;
        if (!zone)
            continue;
        double before = e->evidence.log_z;
        struct strip_case strips = {.states = &e->refit->states,
                                    .fit = e->refit->fit,
                                    .number = engine->number,
                                    .holdout = engine->holdout,
                                    .nown = engine->nown,
                                    .nmember = e->nmember,
                                    .member = e->member,
                                    .fault = column,
                                    .environment = engine->environment};
        int status = from < i ? ROTID_OK : columns_of_faults(engine, e, column, &strips.nfault);
        if (!status && from == i)
            status = evidence_over_widths(engine->pool, e->data, &strips, &e->evidence);
        if (status)
            return status;
        more[i] = from < i ? more[from] : e->evidence.log_z - before;
        e->evidence.log_z = before + more[i];
        e->log_posterior += more[i];
    }
    return ROTID_OK;
}

/* Something else beside set i of the list; *best: raised to its ln P. */
static int add_else_beside(struct engine *engine, struct posterior *p, int i, double *best)
{
    struct explanation e = p->item[i];
    int status = ROTID_OK;
    e.evidence = (struct evidence){0};
    if (!e.scan) {
        struct scan *scan = POOL_NEW(engine->pool, struct scan);
        status = scan ? scan_run(engine->pool, states_of_explanation(engine, &e), engine->number, engine->holdout,
                                 fit_of(engine, &e)->x, SCAN_FIELDS, scan)
                      : ROTID_ERROR_MEMORY;
        e.scan = scan;
    }
    if (!status)
        status = score(engine, p, e.scan, &e);
    e.something_else = 1;
    e.log_prior = prior_of(p, &e);
    e.log_posterior = e.evidence.log_else + e.log_prior;
    if (status || !isfinite(e.log_posterior))
        return status;
    *best = fmax(*best, e.log_posterior);
    append(p, &e);
    return ROTID_OK;
}

/* Something else beside the likeliest sets; where it leads, beside every cause that was fitted, as what is likely alone need not
 * be so beside it. */
static int add_something_else(struct engine *engine, struct posterior *p)
{
    int listed = p->count, status = ROTID_OK, tried[MOST_MEMBERS + 1] = {0};
    double best = -INFINITY;
    for (int pass = 0; pass < 2 && !status && (!pass || best > p->item[0].log_posterior); pass++) {
        memset(tried, 0, sizeof tried);
        for (int i = 0; i < listed && !status; i++) {
            int n = p->item[i].nmember, rank = !n || p->item[i].refit ? tried[n]++ : -1;
            if (pass ? n == 1 && rank >= ELSE_MOST : rank >= 0 && rank < ELSE_MOST)
                status = add_else_beside(engine, p, i, &best);
        }
    }
    return status;
}

/* ---- what follows of the list */

static int by_probability(const void *a, const void *b)
{
    double one = ((const struct marginal *)a)->probability, two = ((const struct marginal *)b)->probability;
    return (one < two) - (one > two);
}

int posterior_marginals(struct pool *pool, struct posterior *p)
{
    int room = 0;
    for (int i = 0; i < p->count; i++)
        room += p->item[i].probability > LEAST_SHARE ? p->item[i].nmember : 0;
    p->marginal = POOL_ARRAY(pool, struct marginal, room + 1);
    if (!p->marginal)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < p->count; i++) {
        const struct explanation *e = &p->item[i];
        p->something_else += e->something_else ? e->probability : 0;
        p->nothing += !e->nmember && !e->something_else ? e->probability : 0;
        for (int m = 0; m < e->nmember && e->probability > LEAST_SHARE; m++) {
            int known = 0;
            for (int k = 0; k < m; k++) /* twice in one set */
                known |= same_name(p, &e->member[m], &e->member[k]);
            for (int j = 0; j < p->nmarginal && !known; j++)
                if (same_name(p, &p->marginal[j].cause, &e->member[m])) {
                    p->marginal[j].probability += e->probability;
                    known = 1;
                }
            if (!known)
                p->marginal[p->nmarginal++] = (struct marginal){e->member[m], e->probability};
        }
    }
    p->something_else = fmin(1, p->something_else); /* rounding */
    qsort(p->marginal, (size_t)p->nmarginal, sizeof *p->marginal, by_probability);
    while (p->nmarginal && p->marginal[p->nmarginal - 1].probability < LEAST_MARGINAL)
        p->nmarginal--;
    for (int j = 0; j < p->nmarginal; j++)
        p->marginal[j].probability = fmin(1, p->marginal[j].probability); /* rounding */
    return ROTID_OK;
}

double posterior_of_cause(const struct posterior *p, const struct candidate *c)
{
    double sum = 0;
    for (int i = 0; i < p->nmarginal; i++)
        sum += same_cause(&p->marginal[i].cause, c) ? p->marginal[i].probability : 0;
    return fmin(1, sum);
}

/* Probability of unknown q below x, cut at its bounds. */
static double share_below(const struct posterior *p, const rotid_parameter *bounds, int q, double x)
{
    double sum = 0;
    for (int i = 0; i < p->count; i++) {
        double mean = p->item[i].evidence.mean[q], std = p->item[i].evidence.std[q], root = std * sqrt(2);
        if (!(std > 0)) {
            sum += x >= mean ? p->item[i].probability : 0;
            continue;
        }
        double least = erfc(-(bounds->lower - mean) / root), most = erfc(-(bounds->upper - mean) / root);
        if (most > least)
            sum += p->item[i].probability * (erfc(-(x - mean) / root) - least) / (most - least);
    }
    return sum;
}

static double quantile(const struct posterior *p, const rotid_parameter *bounds, int q, double share)
{
    double lower = bounds->lower, upper = bounds->upper;
    for (int i = 0; i < 100 && upper - lower > 1e-9 * fabs(upper); i++) {
        double middle = lower > 0 && upper > 10 * lower ? sqrt(lower * upper) : (lower + upper) / 2;
        *(share_below(p, bounds, q, middle) < share ? &lower : &upper) = middle;
    }
    return (lower + upper) / 2;
}

/* Mean and deviation of unknown q in an explanation: of its normal, cut at the bounds as for the quantiles. With a, b the bounds
 * from the mean over the deviation s, f the normal density and F = P(a < z < b): the mean moves by s (f(a) - f(b))/F, and
 *   variance/s^2 = 1 + (a f(a) - b f(b))/F - ((f(a) - f(b))/F)^2. */
static void cut_moments(const struct evidence *e, const rotid_parameter *bounds, int q, double *mean, double *std)
{
    *mean = e->mean[q];
    *std = e->std[q];
    if (!(*std > 0))
        return;
    double a = (bounds->lower - *mean) / *std, b = (bounds->upper - *mean) / *std,
           inside = (erfc(-b / sqrt(2)) - erfc(-a / sqrt(2))) / 2, at_a = exp(-a * a / 2 - LN_2PI / 2),
           at_b = exp(-b * b / 2 - LN_2PI / 2);
    double shift = (at_a - at_b) / inside, spread = 1 + (a * at_a - b * at_b) / inside - shift * shift;
    int flat = inside < NARROW && fabs(a) < 1 && fabs(b) < 1;
    if (inside < NARROW && !flat)
        return; /* bounds in the tail of a normal that a run-up moved */
    *mean = flat ? (bounds->lower + bounds->upper) / 2 : *mean + shift * *std;
    *std = flat ? (bounds->upper - bounds->lower) / sqrt(12) : *std * sqrt(fmax(0, spread));
}

void posterior_average(const struct posterior *p, const rotid_parameter *bounds, int q, double *mean, double *std, double *lower,
                       double *upper)
{
    double sum = 0, square = 0;
    double own, spread;
    for (int i = 0; i < p->count; i++) {
        cut_moments(&p->item[i].evidence, bounds, q, &own, &spread);
        sum += p->item[i].probability * own;
    }
    for (int i = 0; i < p->count; i++) {
        cut_moments(&p->item[i].evidence, bounds, q, &own, &spread);
        square += p->item[i].probability * ((own - sum) * (own - sum) + spread * spread);
    }
    *mean = sum;
    *std = sqrt(square);
    *lower = quantile(p, bounds, q, 0.025);
    *upper = quantile(p, bounds, q, 0.975);
}

static int summarise(struct engine *engine, struct posterior *p)
{
    int status = posterior_marginals(engine->pool, p);
    p->averaged = POOL_ARRAY(engine->pool, rotid_averaged_parameter, p->nown + 1);
    if (status || !p->averaged)
        return ROTID_ERROR_MEMORY;
    for (int q = 0; q < p->nown; q++) {
        const rotid_parameter *bounds = &engine->out->judged.bounds[q];
        rotid_averaged_parameter *to = &p->averaged[p->naveraged++];
        *to = (rotid_averaged_parameter){.name = bounds->name, .unit = bounds->unit};
        posterior_average(p, bounds, q, &to->value, &to->std, &to->ci95[0], &to->ci95[1]);
    }
    return ROTID_OK;
}

/* Probabilities of the list, and what follows. */
static int weigh(struct engine *engine, struct posterior *p)
{
    double sum = -INFINITY;
    qsort(p->item, (size_t)p->count, sizeof *p->item, by_posterior);
    for (int i = 0; i < p->count; i++)
        sum = log_sum(sum, p->item[i].log_posterior);
    for (int i = 0; i < p->count; i++)
        p->item[i].probability = exp(p->item[i].log_posterior - sum);
    p->something_else = p->nothing = 0;
    p->nmarginal = p->naveraged = 0;
    return summarise(engine, p);
}

/* Measured critical speeds, which no fit has seen, multiply the probability of each explanation by theirs under it. Those too
 * improbable to be asked share what they had. */
static int learn_of_runup(struct engine *engine, struct posterior *p)
{
    const struct states *deck = &engine->out->given;
    struct message_list quiet;
    int asked = 0, status = ROTID_OK;
    double before = -INFINITY, after = -INFINITY, log_z[RUNUP_MOST];
    if (!deck->machine || !deck->machine->nrunup || deck->machine->runup_held)
        return ROTID_OK;
    message_open(&quiet, engine->pool);
    for (; asked < p->count && asked < RUNUP_MOST; asked++) {
        struct explanation *e = &p->item[asked];
        struct evidence own = e->evidence; /* whose moduli others may share */
        struct pool scratch;
        if (e->log_posterior < p->item[0].log_posterior - WITHIN)
            break;
        status = engine_stage(engine, "measured critical speeds of explanation", asked + 1);
        if (!status)
            status = room_for_moduli(engine->pool, p->nown, &own);
        if (status)
            return status;
        memcpy(own.mean, e->evidence.mean, (size_t)p->nown * sizeof *own.mean);
        memcpy(own.std, e->evidence.std, (size_t)p->nown * sizeof *own.std);
        e->evidence = own;
        pool_open(&scratch, engine->pool->allocator);
        status = runup_learn(&scratch, deck, states_of_explanation(engine, e), fit_of(engine, e), p->nown, e->evidence.mean,
                             e->evidence.std, &log_z[asked], &e->runup_chi2);
        pool_close(&scratch);
        if (status == ROTID_ERROR_MEMORY)
            return status;
        if (status)
            log_z[asked] = -INFINITY;
        before = log_sum(before, e->log_posterior);
        after = log_sum(after, e->log_posterior + log_z[asked]);
    }
    for (int i = 0; i < p->count; i++)
        p->item[i].at_rest = p->item[i].probability;
    for (int i = 0; i < asked && isfinite(after); i++)
        p->item[i].log_posterior += log_z[i] + before - after;
    p->has_runup = isfinite(after);
    status = weigh(engine, p);
    p->runup_p = chi_square_tail(p->item[0].runup_chi2, deck->machine->nrunup);
    return status;
}

int posterior_run(struct engine *engine, struct round_result *result, struct posterior *p)
{
    int status, more = 1;
    *p = (struct posterior){.room = ROOM,
                            .base = &result->scan,
                            .item = POOL_ARRAY(engine->pool, struct explanation, ROOM),
                            .states = &engine->states,
                            .nown = engine->nown,
                            .length = rotor_length(&engine->job->rotor),
                            .nothing_prior = set_prior[0] * (1 - ELSE_PRIOR)};
    if (!p->item)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < engine->states.nstate; s++)
        if (job_fits_shapes(&engine->states.state[s].job))
            p->nkind = DATA_KINDS;
    for (int i = 0; i < catalogue_count(); i++) {
        int listed = 0;
        for (int j = 0; j < result->scan.ncandidate; j++)
            listed |= result->scan.candidate[j].cause == catalogue_item(i);
        p->nkind += listed;
    }
    status = evidence_open(engine->pool, &engine->states, engine->number, engine->holdout, &p->data);
    if (!status)
        status = enter_singles(engine, result, p);
    for (int pass = 0; pass < SEARCH_PASSES && more && !status; pass++) {
        status = engine_stage(engine, "search of explanations, pass", pass + 1);
        if (!status)
            status = expand(engine, result, p, pass, &more);
    }
    if (status)
        return status;
    qsort(p->item, (size_t)p->count, sizeof *p->item, by_posterior);
    status = integrate_widths(engine, p);
    qsort(p->item, (size_t)p->count, sizeof *p->item, by_posterior);
    if (!status)
        status = add_something_else(engine, p);
    if (!status)
        status = weigh(engine, p);
    return status ? status : learn_of_runup(engine, p);
}

/* ---- the verdict */

/* Whether nearly all of the place lies in one interval: by the profile of chi2 where the fit's own is too long, since towards an
 * end of the rotor a place says less and less. Statuses of memory and cancellation only. */
static int is_placed(const struct engine *engine, const struct explanation *e, const struct candidate *c, int *placed)
{
    const struct state *state = &e->refit->states.state[c->home];
    int place = c->cause->place, known = place < 0 || c->fixed[place];
    double length = rotor_length(&state->job.rotor), interval[2];
    *placed = known || !(e->refit->other_chi2 - e->refit->chi2 < 6);
    if (known || !*placed || !isfinite(c->std[place]) || 1.96 * c->std[place] < NEAR_PLACE * length)
        return ROTID_OK;
    int p = effect_unknown(state, effect_named(state, c->effect.name), place),
        status = p < 0 ? ROTID_OK : place_interval(engine, &e->refit->states, e->refit->fit, p, interval);
    if (!status)
        *placed = p >= 0 && interval[1] - interval[0] < 2 * NEAR_PLACE * length;
    return status;
}

/* The likeliest explanation with a fit that has all of these, and no more where `only`; physical ones beside no fault. */
static const struct explanation *model_with(const struct posterior *p, int count, const struct candidate *named, int only)
{
    for (int i = 0; i < p->count; i++) {
        int all = p->item[i].refit != NULL && (!only || p->item[i].nmember == count);
        for (int j = 0; j < count && all; j++)
            all = has(p, &p->item[i], &named[j]);
        for (int m = 0; m < p->item[i].nmember && all && !is_fault(&named[0]); m++)
            all = !is_fault(&p->item[i].member[m]);
        if (all)
            return &p->item[i];
    }
    return NULL;
}

/* Probability of the sets that hold both. */
static double together(const struct posterior *p, const struct candidate *a, const struct candidate *b)
{
    double sum = 0;
    for (int i = 0; i < p->count; i++)
        sum += has(p, &p->item[i], a) && has(p, &p->item[i], b) ? p->item[i].probability : 0;
    return sum;
}

/* The causes to be named [*count]. Statuses of memory and cancellation only. */
static int choose_names(const struct engine *engine, const struct posterior *p, struct candidate *named, int *count)
{
    int status = ROTID_OK, placed;
    for (int i = 0; i < p->nmarginal && p->marginal[i].probability >= VERDICT_NAMED && *count < MOST_MEMBERS && !status; i++) {
        const struct candidate *c = &p->marginal[i].cause;
        int joint = !is_fault(c);
        for (int j = 0; j < *count; j++)
            joint &= together(p, &named[j], c) >= VERDICT_NAMED;
        const struct explanation *with = joint ? model_with(p, 1, c, 0) : NULL;
        int m = 0;
        while (with && m < with->nmember && !same_name(p, &with->member[m], c))
            m++;
        if (!with || m == with->nmember)
            continue;
        status = is_placed(engine, with, &with->member[m], &placed);
        if (!status && placed)
            named[(*count)++] = with->member[m];
    }
    return status;
}

int posterior_take_faults(struct engine *engine, const struct posterior *p, int *changed)
{
    int status = ROTID_OK;
    *changed = 0;
    for (int i = 0; i < p->nmarginal && p->marginal[i].probability >= VERDICT_NAMED && !status; i++) {
        const struct candidate *c = &p->marginal[i].cause;
        const struct explanation *with = is_fault(c) ? model_with(p, 1, c, 0) : NULL;
        for (int m = 0; with && m < with->nmember; m++)
            if (same_cause(&with->member[m], c)) {
                struct marginal *more = POOL_ARRAY(engine->pool, struct marginal, engine->nfault + 1);
                status = more ? fault_correct(engine, &with->member[m]) : ROTID_ERROR_MEMORY;
                if (status)
                    return status;
                if (engine->nfault)
                    memcpy(more, engine->fault, (size_t)engine->nfault * sizeof *more);
                more[engine->nfault++] = (struct marginal){with->member[m], p->marginal[i].probability};
                engine->fault = more;
                *changed = 1;
            }
        if (with && !c->sensor[0])
            break; /* where the sensors are decides what else they say */
    }
    return status;
}

/* The model of what was named: with nothing else, unless that is next to excluded beside the likeliest one that has it all. */
static const struct explanation *model_of(const struct posterior *p, int count, const struct candidate *named)
{
    const struct explanation *whole = count ? model_with(p, count, named, 0) : NULL,
                             *alone = count ? model_with(p, count, named, 1) : NULL;
    return alone && alone->probability > EXCLUDED * whole->probability ? alone : whole;
}

/* What was named, and what stands beside it, becomes part of the model. */
static int accept(struct engine *engine, const struct posterior *p, const struct explanation *model, int count,
                  const struct candidate *named)
{
    struct diagnosis *out = engine->out;
    struct states states = model->refit->states;
    rotid_fit_result *fit = NULL;
    int status = ROTID_OK;
    out->likely_probability = model->probability;
    for (int m = 0; m < model->nmember && !status; m++) {
        int is_named = 0;
        for (int i = 0; i < count; i++)
            is_named |= same_name(p, &named[i], &model->member[m]);
        struct candidate *cause = is_named ? &out->cause[out->ncause++] : &out->likely[out->nlikely++];
        *cause = model->member[m];
        cause->result.refitted = 1;
        status = discrepancy_add(engine->pool, cause, &states);
    }
    if (!status)
        status = refit_states(engine->pool, &states, engine->number, engine->holdout, engine->environment, &fit);
    if (status)
        return status;
    if (engine->fit != out->base.fit)
        rotid_fit_free(engine->fit);
    engine->fit = fit;
    status = states_started_at(engine->pool, &states, fit->x, &engine->states);
    if (!status)
        engine_look_at(engine, 0);
    return status;
}

/* The rest of what shares 0.99, as alternatives. */
static void list_alternatives(struct diagnosis *out, const struct posterior *p)
{
    double shown = 0;
    for (int i = 0, set = 0; i < p->count && shown < LISTED_SHARE; shown += p->item[i++].probability) {
        if (!p->item[i].nmember || p->item[i].something_else)
            continue;
        set++;
        for (int m = 0; m < p->item[i].nmember; m++) {
            struct candidate *listed = &out->alternative[out->nalternative++];
            *listed = p->item[i].member[m];
            listed->set = set;
            listed->probability = p->item[i].probability;
        }
    }
}

/* What would tell the two likeliest sets apart that were fitted, each by a cause that the other one has not. */
static const char *advice(struct engine *engine, const struct posterior *p)
{
    struct possible model[2] = {{0}};
    const struct explanation *first = NULL;
    int count = 0;
    for (int i = 0; i < p->count && count < 2; i++) {
        const struct explanation *e = &p->item[i];
        const struct candidate *own = NULL;
        for (int m = 0; m < e->nmember && e->refit && !e->something_else; m++)
            if (!first || !has(p, first, &e->member[m]))
                own = &e->member[m];
        for (int m = 0; m < (first ? first->nmember : 0) && own; m++)
            if (!has(p, e, &first->member[m]))
                model[0].cause = &first->member[m];
        if (!own)
            continue;
        model[count++] = (struct possible){own, &e->refit->states, e->refit->fit->x};
        first = first ? first : e;
    }
    return advise_between(engine, count, model);
}

/* Faults that were taken out of the data before the last search stand among the marginals. */
static int list_faults(const struct engine *engine, struct posterior *p)
{
    struct marginal *all = POOL_ARRAY(engine->pool, struct marginal, engine->nfault + p->nmarginal + 1);
    if (!all)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < engine->nfault; i++)
        all[i] = engine->fault[i];
    for (int i = 0; i < p->nmarginal; i++)
        all[engine->nfault + i] = p->marginal[i];
    p->marginal = all;
    p->nmarginal += engine->nfault;
    return ROTID_OK;
}

int posterior_kind(double something_else, int named, int nothing_leads, double largest, double nothing, double prior)
{
    if (something_else > 0.5)
        return ROTID_UNEXPLAINED;
    if (named)
        return ROTID_NAMED;
    return nothing_leads && largest <= HARMLESS && (1 - nothing) / nothing < ODDS * (1 - prior) / prior ? ROTID_ADEQUATE
                                                                                                        : ROTID_AMBIGUOUS;
}

int posterior_verdict(struct engine *engine, struct posterior *p)
{
    struct diagnosis *out = engine->out;
    rotid_verdict *verdict = &out->result.verdict;
    const struct explanation *lead = &p->item[0], *model = NULL;
    struct candidate named[MOST_MEMBERS];
    int count = 0, status = ROTID_OK;
    out->cause = POOL_ARRAY(engine->pool, struct candidate, DIAGNOSE_MOST_CAUSES + 1);
    out->likely = POOL_ARRAY(engine->pool, struct candidate, MOST_MEMBERS);
    out->alternative = POOL_ARRAY(engine->pool, struct candidate, (size_t)p->count * MOST_MEMBERS + 1);
    if (!out->cause || !out->likely || !out->alternative)
        return ROTID_ERROR_MEMORY;
    if (verdict->confident)
        status = choose_names(engine, p, named, &count);
    if (status)
        return status;
    model = model_of(p, count, named);
    verdict->something_else = p->something_else;
    verdict->kind = posterior_kind(p->something_else, model != NULL, !lead->nmember && !lead->something_else,
                                   p->nmarginal ? p->marginal[0].probability : 0, p->nothing, p->nothing_prior);
    verdict->adequate_after = verdict->kind == ROTID_ADEQUATE || (verdict->kind == ROTID_NAMED && explains(engine, p, model));
    if (verdict->kind == ROTID_AMBIGUOUS)
        list_alternatives(out, p);
    if (!verdict->adequate_after && !(verdict->next_measurement = advice(engine, p)))
        return ROTID_ERROR_MEMORY;
    status = verdict->kind == ROTID_NAMED && model ? accept(engine, p, model, count, named) : ROTID_OK;
    return status ? status : list_faults(engine, p);
}
