/* The search for explanations, a beam. Where the model does not explain the data the most promising single causes are fitted
 * first; then the most probable sets that were not expanded yet are scanned for one more cause, each addition is scored by the
 * evidence of its columns, the most promising are fitted, as is the set with one cause less and, where no single cause leaves
 * nothing, pairs of columns (scan_pairs.c), and scored by laplace.c, until none is left within SEARCH_WITHIN of the best. Each
 * place to which the starts of a cause lead is an explanation of its own. What was not fitted enters by its columns; places and
 * widths that are free are integrated over at last (profile.c); something else comes beside the likeliest, where it leads beside
 * every single cause. */
#include "diagnose/diagnose.h"
#include "fit/fit.h"

#define SINGLES    16   /* causes fitted before anything else, */
#define WORTH      3.0  /* with a promised drop above noise */
#define FAULTS     24   /* proposed beside a set */
#define BEAM       4    /* sets expanded in a pass */
#define FITTED     8    /* fits of a pass, the first three times as many */
#define PAIRS      8    /* of causes that are proposed together */
#define ELSE_MOST  3    /* sets of a size */
#define LINEAR     10.0 /* of ln Z: by columns alone no set gains more over one that explains the data */
#define ELSEWHERE  10   /* places along the rotor from which a cause is fitted, by frequencies alone */
#define OTHER_SIZE 4.0  /* times: of one that spans decades */
#define AT_END     1e-3 /* of the length */
#define PROFILES   24   /* of causes in sets that are */
#define OF_BEST    5.0  /* in ln P below the best one, at most */

/* Whether a set stands elsewhere than the same causes found beside another one: its fit may have ended in another minimum. */
static int stands_elsewhere(const struct posterior *p, const struct explanation *set, const struct explanation *found)
{
    int all = 1;
    for (int m = 0; m < set->nmember; m++)
        all &= posterior_has(p, found, &set->member[m]);
    return !all && set->refit && !set->again;
}

/* The values of a fit in the members, found by the names of their effects. */
static void take_values(const struct engine *engine, const struct refit *refit, struct candidate *c)
{
    c->result.refitted = 1;
    c->result.chi2 = refit->chi2;
    c->result.chi2_drop = engine->fit->chi2 - refit->chi2;
    if (candidate_is_fault(c))
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

/* A set that has got its members, of another one that was fitted. */
static void not_fitted(const struct posterior *p, struct explanation *set)
{
    set->refit = NULL;
    set->scan = NULL;
    set->expanded = 0;
    set->log_prior = posterior_prior_of(p, set);
}

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

/* A cause whose columns lie within those of the unknowns: no fit tells it from what it was added to. */
static int is_inseparable(const struct proposal *p)
{
    const struct scan_candidate *c = p->candidate < 0 ? NULL : &p->scan->candidate[p->candidate];
    return c && c->count && c->best < 0;
}

/* A single cause that is fitted whatever it promises: a suspect of the user, or one with a far start. */
static int is_asked(const struct proposal *p)
{
    const struct scan_candidate *c = p->candidate < 0 || p->parent ? NULL : &p->scan->candidate[p->candidate];
    return c && (c->far || (c->suspect && c->best >= 0));
}

/* Those that can be fitted before the others. */
ORDER_BY(by_gain, struct proposal, is_inseparable(it), -it->set.log_posterior)

/* Whether a cause in one state alone is the same in all: no other state in which it could act has modes that are fitted. */
static int is_common(const struct engine *engine, const struct scan *scan, int index)
{
    const struct scan_candidate *c = &scan->candidate[index], *all = NULL;
    for (int i = 0; i < scan->ncandidate && c->state >= 0 && !all; i++)
        if (scan->candidate[i].state < 0 && scan->candidate[i].cause == c->cause && scan->candidate[i].in[c->home] &&
            !strcmp(scan->candidate[i].target, c->target))
            all = &scan->candidate[i];
    int others = 0;
    for (int s = 0, mode = 0; all && s < engine->states.nstate; mode += engine->states.state[s].job.measurement.nmode, s++)
        if (s != c->state && all->in[s])
            others += job_fitted(&engine->states.state[s].job, engine->holdout + mode);
    return all && !others;
}

static int has_fit(const struct explanation *e)
{
    return (e->refit || !e->nmember) && !e->something_else;
}

static double best_stated(const struct posterior *p)
{
    double best = -INFINITY;
    for (int i = 0; i < p->count; i++)
        if (has_fit(&p->item[i]))
            best = fmax(best, p->item[i].evidence.log_exact + p->item[i].log_prior);
    return best;
}

/* All positions count from the other end. */
static int is_turned(const struct candidate *c)
{
    return candidate_is_fault(c) && !c->sensor[0] && c->effect.value[2] >= 0.5;
}

/* A channel has one fault. */
static int has_fault_there(const struct explanation *e, const struct candidate *c)
{
    int found = 0;
    for (int m = 0; m < e->nmember; m++)
        for (int k = 0; k < 2 && candidate_is_fault(&e->member[m]) && e->member[m].home == c->home; k++)
            found |= e->member[m].sensor[k] == c->sensor[0] || (c->sensor[1] && e->member[m].sensor[k] == c->sensor[1]);
    return found;
}

/* Faults of the measurement as additions to a set. */
static int propose_faults(struct engine *engine, struct posterior *p, int parent, struct scan *scan, struct proposal *proposal,
                          int most, int *count)
{
    const struct explanation *from = &p->item[parent];
    struct fault_proposal fault[FAULTS];
    int found, status = faults_propose(engine->pool, explanation_states(engine, from), engine->number, engine->holdout,
                                       explanation_fit(engine, from), from->data, scan, FAULTS, fault, &found);
    for (int i = 0; i < found && *count < most && !status; i++) {
        struct proposal one = {.parent = parent, .candidate = ADDS_FAULT, .scan = scan, .gain = fault[i].gain, .set = *from};
        struct explanation *set = &one.set;
        if (has_fault_there(from, &fault[i].fault) || (parent && is_turned(&fault[i].fault))) /* others are added to that */
            continue;
        set->member[set->nmember++] = fault[i].fault;
        set->outside += fault[i].outside;
        not_fitted(p, set);
        set->evidence.log_z += one.gain;
        set->evidence.log_stated = set->evidence.log_exact = from->evidence.log_exact + one.gain;
        set->evidence.log_else = -INFINITY;
        set->log_posterior = set->evidence.log_exact + set->log_prior;
        if (!posterior_find(p, set))
            proposal[(*count)++] = one;
    }
    return status;
}

/* Whether all of a set are effects of the rotor, so that it can be fitted anew from the base. */
static int is_of_beams(const struct explanation *e)
{
    int all = 1;
    for (int m = 0; m < e->nmember; m++)
        all &= !candidate_is_fault(&e->member[m]) && !e->member[m].cause->solid;
    return all;
}

/* A set of physical causes with one less: what led to it may not be needed any more. A set that was fitted is so again where the
 * larger one has a cause at another place. */
static void propose_removals(const struct posterior *p, int parent, struct proposal *proposal, int most, int *count)
{
    const struct explanation *from = &p->item[parent];
    for (int m = 0; m < from->nmember && from->nmember > 1 && *count < most; m++) {
        struct proposal one = {.parent = parent, .candidate = ANEW, .set = *from};
        struct explanation *set = &one.set;
        set->nmember--;
        for (int k = m; k < set->nmember; k++)
            set->member[k] = from->member[k + 1];
        not_fitted(p, set);
        set->log_posterior = from->evidence.log_exact + set->log_prior; /* worth a fit */
        struct explanation *known = posterior_find(p, set);
        if (!known || stands_elsewhere(p, known, set))
            proposal[(*count)++] = one;
    }
}

/* A set with a cause in its other form along the rotor, which takes the place of this one where it fits better. */
static void propose_forms(const struct posterior *p, int parent, struct proposal *proposal, int most, int *count)
{
    const struct explanation *from = &p->item[parent];
    for (int m = 0; m < from->nmember && *count < most; m++) {
        const struct candidate *c = &from->member[m];
        struct proposal one = {.parent = parent, .candidate = ANEW, .set = *from};
        if (!c->cause->reshape || c->effect.variant || c->result.suspect)
            continue;
        c->cause->reshape(&one.set.member[m].effect);
        not_fitted(p, &one.set);
        one.set.log_posterior = from->evidence.log_exact + one.set.log_prior; /* worth a fit */
        proposal[(*count)++] = one;
    }
}

/* The additions to a set, behind the *count there are. */
static int propose(struct engine *engine, struct posterior *p, int parent, struct scan *scan, struct proposal *proposal, int most,
                   int *count)
{
    const struct explanation *from = &p->item[parent];
    const struct states *states = explanation_states(engine, from);
    for (int i = 0; i < scan->ncandidate && *count < most; i++) {
        struct proposal one = {.parent = parent, .candidate = i, .scan = scan, .set = *from};
        int best;
        if (is_common(engine, scan, i))
            continue;
        one.set.member[one.set.nmember++] = candidate_listed(scan, i);
        not_fitted(p, &one.set);
        one.gain = gain_of(states, scan, i, &best);
        one.set.evidence.log_stated = one.set.evidence.log_exact = from->evidence.log_exact + one.gain;
        one.set.evidence.log_z = from->evidence.log_z - from->evidence.log_stated + one.set.evidence.log_stated;
        one.set.evidence.log_else = -INFINITY;
        one.set.log_posterior = one.set.evidence.log_stated + one.set.log_prior;
        int status = posterior_room(engine->pool, engine->nown, &one.set.evidence);
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
        if (item)
            one.set.member[one.set.nmember - 1].effect = scan_effect(scan, best, item->amplitude);
        if (!posterior_find(p, &one.set))
            proposal[(*count)++] = one;
    }
    return ROTID_OK;
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
        for (int m = 0; m < 2; m++) {
            struct candidate *member = &set->member[set->nmember++];
            *member = candidate_listed(scan, scan->item[pair[i].item[m]].candidate);
            member->effect = scan_effect(scan, pair[i].item[m], pair[i].amplitude[m]);
        }
        struct effect *second = &set->member[1].effect;
        if (!strcmp(second->name, set->member[0].effect.name) &&
            !(second->name = pool_format(engine->pool, "%s_2", second->name)))
            return ROTID_ERROR_MEMORY;
        not_fitted(p, set);
        set->log_posterior = from->evidence.log_exact + one.gain + set->log_prior;
        if (!posterior_find(p, set))
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

/* The set fitted anew from the model without a cause, from the values that its causes have. Where that ends above this model,
 * which it contains, fit is NULL. */
static int refit_set(struct pool *pool, const struct engine *e, const struct explanation *set, const double *x,
                     struct refit *refit)
{
    struct states states = e->states;
    rotid_fit_result *fit = NULL;
    int status = states_started_at(pool, &e->states, x, &states), is_nested = 1;
    *refit = (struct refit){.chi2 = INFINITY};
    for (int m = 0; m < set->nmember && !status; m++) {
        const struct candidate *c = &set->member[m];
        is_nested &= cause_has_free_size(c->cause, c->fixed);
        status = states_with_effect(pool, &states, NULL, &c->effect, c->cause, c->fixed, c->in, &states);
    }
    if (!status)
        status = refit_states(pool, &states, e->number, e->holdout, e->environment, &fit);
    if (!status && is_nested && fit->chi2 > e->fit->chi2 + REFIT_WORSE)
        rotid_fit_free(fit);
    else if (!status)
        status = refit_keep(pool, &states, fit, refit);
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

static int fit_task(void *context, int index, int worker)
{
    struct task *t = context;
    const struct engine *e = t->engine;
    const struct proposal *proposal = &t->proposal[index];
    const struct explanation *parent = &t->p->item[proposal->parent];
    const struct states *states = explanation_states(e, parent);
    struct refit *refit = &t->refit[2 * (ptrdiff_t)index];
    double *deck = POOL_ARRAY(&t->pool[index], double, states->nparameter);
    (void)worker;
    if (!deck)
        return ROTID_ERROR_MEMORY;
    t->data[index] = parent->data;
    if (proposal->candidate == ANEW)
        return refit_set(&t->pool[index], e, &proposal->set, explanation_fit(e, parent)->x, refit);
    if (proposal->candidate == ADDS_FAULT)
        return fault_refit(&t->pool[index], states, e->nown, e->number, e->holdout, explanation_fit(e, parent), e->environment,
                           &t->proposal[index].set.member[proposal->set.nmember - 1], refit, &t->data[index]);
    const double *x = explanation_fit(e, parent)->x;
    for (int p = 0; p < states->nparameter; p++)
        deck[p] = p < e->nown ? e->deck_start[p] : x[p];
    return refit_cause(&t->pool[index], states, e->number, e->holdout, x, deck, proposal->scan, proposal->candidate,
                       e->environment, refit);
}

/* Whether the place of a cause is within the interval of the other one: fits along a ridge end somewhere on it. A place without
 * an interval may be anywhere, but at an end of the rotor. */
static int is_within(const struct posterior *p, const struct candidate *a, const struct candidate *b)
{
    int place = b->cause->place;
    double z_b = b->effect.value[place];
    int at_end = !(z_b > AT_END * p->length && z_b < (1 - AT_END) * p->length);
    double z = a->effect.value[place];
    return isfinite(b->std[place]) ? z > b->ci_lower[place] && z < b->ci_upper[place] : !at_end;
}

/* The same cause at the same place. */
static int is_same(const struct posterior *p, const struct candidate *a, const struct candidate *b)
{
    return posterior_same_model(a, b) && (posterior_same_name(p, a, b) || (is_within(p, a, b) && is_within(p, b, a)));
}

/* The item with the same models at the same places, NULL: none. */
static struct explanation *find_there(const struct posterior *p, const struct explanation *e)
{
    for (int i = 0; i < p->count; i++) {
        int same = posterior_same_set(&p->item[i], e);
        for (int m = 0; m < e->nmember && same; m++) {
            int any = 0;
            for (int k = 0; k < e->nmember; k++)
                any |= is_same(p, &p->item[i].member[k], &e->member[m]);
            same = any;
        }
        if (same)
            return &p->item[i];
    }
    return NULL;
}

/* Enters a set by its fit, unless it is there with a better one: not in place of one with less chi2, as a saddle between two
 * places has a wide normal. */
static int enter(struct engine *engine, struct posterior *p, struct explanation *e)
{
    e->evidence = (struct evidence){0};
    for (int m = 0; m < e->nmember; m++)
        take_values(engine, e->refit, &e->member[m]);
    int status = posterior_score(engine, p, NULL, e);
    if (status)
        return status;
    struct explanation *known = find_there(p, e), *first = posterior_find(p, e);
    if (first)
        first->again = e->again = 1;
    if (known && e->log_posterior > known->log_posterior && !(known->refit && known->refit->chi2 < e->refit->chi2))
        *known = *e;
    return known || posterior_append(p, e) ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Fits the first `count` proposals and enters them. */
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
    if (result->nrefit + 2 * count > result->room || !task.pool || !task.data)
        return ROTID_ERROR_MEMORY;
    result->nrefit += 2 * count;
    for (int i = 0; i < count; i++)
        pool_open(&task.pool[i], engine->pool->allocator);
    int status = parallel_for(engine->threads, count, fit_task, &task);
    for (int i = 0; i < count; i++)
        pool_absorb(engine->pool, &task.pool[i]);
    for (int i = 0; i < 2 * count && !status; i++) {
        struct explanation e = proposal[i / 2].set;
        e.refit = &refit[i];
        e.data = task.data[i / 2];
        if (refit[i].fit)
            status = enter(engine, p, &e);
    }
    return status;
}

/* ---- the search */

/* Whether a single cause or none leaves no more than noise. */
static int is_explained(const struct engine *engine, const struct posterior *p)
{
    int any = 0;
    for (int i = 0; i < p->count && !any; i++)
        any = has_fit(&p->item[i]) && explanation_explains(engine, p, &p->item[i]);
    return any;
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
    int explained = explanation_explains(engine, p, &p->item[lead]);
    double least = p->item[lead].log_posterior - SEARCH_WITHIN;
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

/* A set that several parents lead to stays once, from where it promises most. Returns how many there are. */
static int keep_first(struct proposal *proposal, int count)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        int known = 0;
        for (int k = 0; k < kept && !known; k++)
            known = posterior_same_set(&proposal[k].set, &proposal[i].set);
        if (!known)
            proposal[kept++] = proposal[i];
    }
    return kept;
}

/* The single causes that promise most, where the model leaves more than noise, and those that are asked for. */
static int fit_singles(struct engine *engine, struct round_result *result, struct posterior *p)
{
    const struct scan *scan = &result->scan;
    int most = scan->ncandidate, count = 0, kept = 0, explained = explanation_explains(engine, p, &p->item[0]);
    struct proposal *proposal = POOL_ARRAY(engine->pool, struct proposal, most);
    int status = proposal ? propose(engine, p, 0, &result->scan, proposal, most, &count) : ROTID_ERROR_MEMORY;
    if (status)
        return status;
    qsort(proposal, (size_t)count, sizeof *proposal, by_gain);
    for (int i = 0; i < count; i++)
        if (is_asked(&proposal[i]) || (!explained && kept < SINGLES && scan_best_drop(scan, proposal[i].candidate) >= WORTH &&
                                       !is_inseparable(&proposal[i])))
            proposal[kept++] = proposal[i];
    return fit_proposals(engine, result, p, proposal, kept);
}

static int expand(struct engine *engine, struct round_result *result, struct posterior *p, int pass, int *more)
{
    struct pool *pool = engine->pool;
    int parent, taken = 0, count = 0, fits = 0, most = BEAM * (result->scan.ncandidate + 8 + FAULTS + 2 * MOST_MEMBERS) + PAIRS,
                status = ROTID_OK;
    struct proposal *proposal = POOL_ARRAY(pool, struct proposal, most);
    if (!proposal)
        return ROTID_ERROR_MEMORY;
    *more = 0;
    while (taken < (pass ? BEAM : 1) && !status && (parent = pass ? next_parent(engine, p, taken) : 0) >= 0) {
        struct explanation *from = &p->item[parent];
        from->expanded = 1;
        taken++;
        if (is_of_beams(from)) {
            propose_removals(p, parent, proposal, most, &count);
            propose_forms(p, parent, proposal, most, &count);
        }
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
    while (fits < count && fits < (pass ? FITTED : 3 * FITTED) && proposal[fits].set.log_posterior > best - SEARCH_WITHIN &&
           !is_inseparable(&proposal[fits]))
        fits++;
    status = fit_proposals(engine, result, p, proposal, fits);
    for (int i = fits; i < count && !status; i++) {
        struct explanation *e = &proposal[i].set;
        if (proposal[i].candidate == ANEW || proposal[i].gain > LINEAR ||
            !explanation_explains(engine, p, &p->item[proposal[i].parent]))
            continue;
        e->log_posterior = e->evidence.log_z + e->log_prior;
        if (!posterior_find(p, e))
            posterior_append(p, e);
    }
    *more = fits > 0 || !pass;
    return status;
}

/* The same set with its cause at another place within the valley of the first one is the first one. */
static void drop_same(struct posterior *p, int i, int m, const double valley[2])
{
    const struct candidate *c = &p->item[i].member[m];
    for (int j = i + 1; j < p->count; j++) {
        struct explanation *e = &p->item[j];
        int others = 1, inside = 0;
        if (!e->refit || !posterior_same_set(&p->item[i], e))
            continue;
        for (int k = 0; k < e->nmember; k++) {
            double z = e->member[k].effect.value[c->cause->place];
            if (posterior_same_model(&e->member[k], c))
                inside |= e->member[k].effect.variant == c->effect.variant && z >= valley[0] && z <= valley[1];
            else
                others &= posterior_has(p, &p->item[i], &e->member[k]);
        }
        if (others && inside)
            e->log_posterior = e->evidence.log_z = -INFINITY;
    }
}

/* More of ln Z, also for something else beside the set. */
static void add_evidence(struct explanation *e, double more)
{
    e->outside += more;
    e->evidence.log_z += more;
    e->log_posterior += more;
}

/* The profiles of the width and the place of member m of set i, where they are free: intervals into the member, the integral into
 * the evidence, but for a place beside a free width: at each width the normal knows the place well. */
static int profile_member(struct engine *engine, struct posterior *p, int i, int m)
{
    struct fault_column column[2 * MOST_MEMBERS];
    struct explanation *e = &p->item[i];
    struct candidate *c = &e->member[m];
    const struct state *home = &e->refit->states.state[c->home];
    const int component[2] = {c->cause->width, c->cause->place}, is_zone = component[0] >= 0 && !c->fixed[component[0]];
    struct profile_case profile = {.states = &e->refit->states,
                                   .fit = e->refit->fit,
                                   .number = engine->number,
                                   .holdout = engine->holdout,
                                   .nown = engine->nown,
                                   .nmember = e->nmember,
                                   .member = e->member,
                                   .fault = column,
                                   .environment = engine->environment};
    int status = explanation_faults(engine, e, column, &profile.nfault);
    for (int j = is_zone ? 0 : 1; j < 2 && !status; j++) {
        int q = c->fixed[component[j]] ? -1 : effect_unknown(home, effect_named(home, c->effect.name), component[j]);
        double valley[2] = {INFINITY, -INFINITY};
        struct evidence evidence = e->evidence; /* of the fit alone */
        evidence.log_z -= e->outside;
        if (q < 0 || (!j && !(profile.states->bounds[q].lower > 0)))
            continue;
        profile.data = j && is_zone ? NULL : e->data;
        status = profile_unknown(engine->pool, &profile, q, !j, &evidence, valley);
        add_evidence(e, evidence.log_z - (e->evidence.log_z - e->outside));
        c->ci_lower[component[j]] = profile.fit->ci_lower[q];
        c->ci_upper[component[j]] = profile.fit->ci_upper[q];
        if (j && !status)
            drop_same(p, i, m, valley);
    }
    return status;
}

/* Places and free widths of the sets that count by their profiles, each cause in the likeliest set that was fitted with it there:
 * the others take from there what that makes of the evidence, but for the last member of a set by columns, the mean over all
 * places. Of what is a solid beside beams, whose fits take a hundred times as long, the fit's own does. */
static int integrate(struct engine *engine, struct posterior *p)
{
    const struct candidate *found[PROFILES];
    double more[PROFILES], least = p->item[0].log_posterior - OF_BEST;
    int known = 0, k;
    for (int i = 0; i < p->count; i++) {
        struct explanation *e = &p->item[i];
        int is_foreign = e->refit && e->refit->states.state->job.options.solid != engine->job->options.solid,
            counts = e->log_posterior > least && e->refit;
        for (int m = 0; m < e->nmember - !e->refit && !is_foreign && isfinite(e->evidence.log_z); m++) {
            const struct candidate *c = &e->member[m];
            double before = e->outside;
            if (c->cause->place < 0)
                continue;
            for (k = 0; k < known; k++)
                if (posterior_same_model(found[k], c) && posterior_same_name(p, found[k], c))
                    break;
            if (k < known) {
                add_evidence(e, more[k]);
            } else if (counts && known < PROFILES) {
                int status = profile_member(engine, p, i, m);
                if (status)
                    return status;
                more[known] = e->outside - before;
                found[known++] = c;
            }
        }
    }
    return ROTID_OK;
}

/* Something else beside set i of the list; *best: raised to its ln P. near: a scan whose fields along the rotor do for it, or
 * NULL: they are looked for beside its own fit. */
static int add_else_beside(struct engine *engine, struct posterior *p, int i, const struct scan *near, double *best)
{
    struct explanation e = p->item[i];
    struct pool scratch; /* the columns of a scan are large beside what is wanted of them */
    struct scan own;
    int status = ROTID_OK;
    e.evidence = (struct evidence){0};
    pool_open(&scratch, engine->pool->allocator);
    if (!e.scan && !near)
        status = scan_run(&scratch, explanation_states(engine, &e), engine->number, engine->holdout,
                          explanation_fit(engine, &e)->x, SCAN_FIELDS, &own);
    if (!status)
        status = posterior_score(engine, p, e.scan ? e.scan : near ? near : &own, &e);
    pool_close(&scratch);
    e.something_else = 1;
    e.log_prior = posterior_prior_of(p, &e);
    e.log_posterior = e.evidence.log_else + e.log_prior;
    if (status || !isfinite(e.log_posterior))
        return status;
    *best = fmax(*best, e.log_posterior);
    posterior_append(p, &e);
    return ROTID_OK;
}

/* Something else beside the likeliest sets; where it leads, beside every cause that was fitted, as what is likely alone need not
 * be so beside it. Scans of solids take their time: the many have the fields of the base. */
static int add_something_else(struct engine *engine, struct posterior *p)
{
    int listed = p->count, status = ROTID_OK, tried[MOST_MEMBERS + 1] = {0};
    double best = -INFINITY;
    for (int pass = 0; pass < 2 && !status && (!pass || best > p->item[0].log_posterior); pass++) {
        memset(tried, 0, sizeof tried);
        for (int i = 0; i < listed && !status; i++) {
            int n = p->item[i].nmember, rank = !n || p->item[i].refit ? tried[n]++ : -1;
            if (pass ? n == 1 && rank >= ELSE_MOST : rank >= 0 && rank < ELSE_MOST)
                status = add_else_beside(engine, p, i, pass && engine->job->options.solid ? p->base : NULL, &best);
        }
    }
    return status;
}

/* A set whose cause stands elsewhere, as likely as it may be there: fitted from place z and so many times the size. */
static int enter_at(struct engine *engine, struct round_result *result, struct posterior *p, const struct explanation *from,
                    double z, double factor)
{
    struct explanation e = *from;
    struct candidate *c = &e.member[0];
    struct refit *refit = &result->refit[result->nrefit];
    if (result->nrefit == result->room)
        return ROTID_OK;
    c->effect.value[c->cause->place] = z;
    c->effect.value[c->cause->size] *= factor;
    e.scan = NULL;
    e.refit = refit;
    int status = refit_set(engine->pool, engine, &e, from->refit->fit->x, refit);
    if (status || !refit->fit)
        return status;
    status = enter(engine, p, &e);
    for (int i = 0; i < p->count && !status; i++)
        if (p->item[i].refit == refit) {
            result->nrefit++;
            return ROTID_OK;
        }
    rotid_fit_free(refit->fit);
    *refit = (struct refit){0};
    return status;
}

/* By frequencies alone a cause does the same at several places: likely ones are fitted from all over the rotor. */
static int enter_elsewhere(struct engine *engine, struct round_result *result, struct posterior *p)
{
    int status = ROTID_OK;
    double best = best_stated(p);
    for (int i = 0, listed = p->data->nblock || engine->job->options.solid ? 0 : p->count; i < listed; i++) {
        const struct explanation from = p->item[i];
        int place = from.nmember == 1 && from.refit ? from.member[0].cause->place : -1, again = 0;
        for (int k = 0; k < i; k++) /* of a cause with several places once */
            again |=
                p->item[k].log_posterior >= best - SEARCH_WITHIN && p->item[k].refit && posterior_same_set(&p->item[k], &from);
        if (place < 0 || again || from.member[0].fixed[place] || from.log_posterior < best - SEARCH_WITHIN)
            continue;
        const struct state *home = &from.refit->states.state[from.member[0].home];
        int q = effect_unknown(home, effect_named(home, from.member[0].effect.name), place),
            decades = from.member[0].cause->parameter[from.member[0].cause->size].prior == PRIOR_LOG_FLAT;
        for (int k = 0; k < ELSEWHERE && q >= 0 && !status; k++)
            for (int times = -decades; times <= decades && !status; times++) {
                const rotid_parameter *bounds = &from.refit->states.bounds[q];
                double share = (k + 0.5) / ELSEWHERE;
                status = enter_at(engine, result, p, &from, bounds->lower + share * (bounds->upper - bounds->lower),
                                  pow(OTHER_SIZE, times));
            }
        if (status)
            return status;
    }
    return ROTID_OK;
}

int search_run(struct engine *engine, struct round_result *result, struct posterior *p)
{
    struct explanation nothing = {.data = p->data};
    int more = 1, status = engine_stage(engine, "fits of candidates", 1);
    if (!status)
        status = posterior_score(engine, p, NULL, &nothing);
    if (!status)
        posterior_append(p, &nothing);
    if (!status)
        status = fit_singles(engine, result, p);
    for (int pass = 0; pass < SEARCH_PASSES && more && !status; pass++) {
        status = engine_stage(engine, "search of explanations, pass", pass + 1);
        if (!status)
            status = expand(engine, result, p, pass, &more);
    }
    if (!status)
        status = enter_elsewhere(engine, result, p);
    posterior_sort(p);
    if (!status)
        status = integrate(engine, p);
    posterior_sort(p);
    return status ? status : add_something_else(engine, p);
}
