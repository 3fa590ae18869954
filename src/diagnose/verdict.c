/* The verdict: UNEXPLAINED: something else above one half; NAMED: marginals of VERDICT_NAMED and more, placed in one interval, in
 * the model that has nothing else or, where that is next to excluded, in the likeliest one; ADEQUATE: nothing leads, no cause
 * above VERDICT_HARMLESS, the odds of the rest less than ODDS times those before; else AMBIGUOUS. */
#include "diagnose/diagnose.h"
#include "fit/fit.h"

#define LISTED_SHARE 0.99
#define ODDS         3.0  /* of anything over nothing, times those before */
#define EXCLUDED     0.05 /* of the probability of another explanation */

/* Whether nearly all of the place lies in one interval, that of its profile. */
static int is_placed(const struct posterior *p, const struct candidate *c)
{
    int place = c->cause->place;
    return place < 0 || c->fixed[place] || !(c->ci_upper[place] - c->ci_lower[place] >= 2 * POSTERIOR_NEAR * p->length);
}

/* The likeliest explanation with a fit that has all of these, and no more where `only`; physical ones beside no fault. */
static const struct explanation *model_with(const struct posterior *p, int count, const struct candidate *named, int only)
{
    for (int i = 0; i < p->count; i++) {
        int all = p->item[i].refit != NULL && (!only || p->item[i].nmember == count);
        for (int j = 0; j < count && all; j++)
            all = posterior_has(p, &p->item[i], &named[j]);
        for (int m = 0; m < p->item[i].nmember && all && !candidate_is_fault(&named[0]); m++)
            all = !candidate_is_fault(&p->item[i].member[m]);
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
        sum += posterior_has(p, &p->item[i], a) && posterior_has(p, &p->item[i], b) ? p->item[i].probability : 0;
    return sum;
}

/* The causes to be named; returns how many. */
static int choose_names(const struct posterior *p, struct candidate *named)
{
    int count = 0;
    for (int i = 0; i < p->nmarginal && p->marginal[i].probability >= VERDICT_NAMED && count < MOST_MEMBERS; i++) {
        const struct candidate *c = &p->marginal[i].cause;
        int joint = !candidate_is_fault(c);
        for (int j = 0; j < count; j++)
            joint &= together(p, &named[j], c) >= VERDICT_NAMED;
        const struct explanation *with = joint ? model_with(p, 1, c, 0) : NULL;
        int at = -1, places = 0; /* twice near one place it is something wider */
        for (int m = 0; with && m < with->nmember; m++)
            if (posterior_same_name(p, &with->member[m], c)) {
                at = m;
                places++;
            }
        if (places == 1 && is_placed(p, &with->member[at]))
            named[count++] = with->member[at];
    }
    return count;
}

int posterior_take_faults(struct engine *engine, const struct posterior *p, int *changed)
{
    int status = ROTID_OK;
    *changed = 0;
    for (int i = 0; i < p->nmarginal && p->marginal[i].probability >= VERDICT_NAMED && !status; i++) {
        const struct candidate *c = &p->marginal[i].cause;
        const struct explanation *with = candidate_is_fault(c) ? model_with(p, 1, c, 0) : NULL;
        for (int m = 0; with && m < with->nmember; m++)
            if (posterior_same_cause(&with->member[m], c)) {
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
    for (int likely = 0; likely < 2; likely++) /* behind those that are named */
        for (int m = 0; m < model->nmember && !status; m++) {
            int is_named = 0;
            for (int i = 0; i < count; i++)
                is_named |= posterior_same_name(p, &named[i], &model->member[m]);
            if (is_named == likely)
                continue;
            struct candidate *cause = &out->cause[out->ncause + out->nlikely];
            *(likely ? &out->nlikely : &out->ncause) += 1;
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

static int has_cause(const struct explanation *e, const struct candidate *c)
{
    int found = 0;
    for (int m = 0; m < e->nmember; m++)
        found |= posterior_same_cause(&e->member[m], c);
    return found;
}

/* What would tell the two likeliest sets apart that were fitted, each by a cause that the other one has not anywhere. */
static const char *advice(struct engine *engine, const struct posterior *p)
{
    struct possible model[2] = {{0}};
    const struct explanation *first = NULL;
    int count = 0;
    for (int i = 0; i < p->count && count < 2; i++) {
        const struct explanation *e = &p->item[i];
        const struct candidate *own = NULL;
        for (int m = 0; m < e->nmember && e->refit && !e->something_else; m++)
            if (!first || !has_cause(first, &e->member[m]))
                own = &e->member[m];
        for (int m = 0; m < (first ? first->nmember : 0) && own; m++)
            if (!has_cause(e, &first->member[m]))
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
    return nothing_leads && largest <= VERDICT_HARMLESS && (1 - nothing) / nothing < ODDS * (1 - prior) / prior ? ROTID_ADEQUATE
                                                                                                                : ROTID_AMBIGUOUS;
}

int posterior_verdict(struct engine *engine, struct posterior *p)
{
    struct diagnosis *out = engine->out;
    rotid_verdict *verdict = &out->result.verdict;
    const struct explanation *lead = &p->item[0], *model = NULL;
    struct candidate named[MOST_MEMBERS];
    double largest = 0; /* of a cause, wherever it is */
    int count = 0, status = ROTID_OK;
    out->cause = POOL_ARRAY(engine->pool, struct candidate, DIAGNOSE_MOST_CAUSES + 1);
    out->alternative = POOL_ARRAY(engine->pool, struct candidate, (size_t)p->count * MOST_MEMBERS + 1);
    if (!out->cause || !out->alternative)
        return ROTID_ERROR_MEMORY;
    if (verdict->confident)
        count = choose_names(p, named);
    model = model_of(p, count, named);
    verdict->something_else = p->something_else;
    for (int i = 0; i < p->nmarginal; i++)
        largest = fmax(largest, posterior_of_cause(p, &p->marginal[i].cause));
    verdict->kind = posterior_kind(p->something_else, model != NULL, !lead->nmember && !lead->something_else, largest, p->nothing,
                                   p->nothing_prior);
    verdict->adequate_after =
        verdict->kind == ROTID_ADEQUATE || (verdict->kind == ROTID_NAMED && explanation_explains(engine, p, model));
    if (verdict->kind == ROTID_AMBIGUOUS)
        list_alternatives(out, p);
    if (!verdict->adequate_after && !(verdict->next_measurement = advice(engine, p)))
        return ROTID_ERROR_MEMORY;
    status = verdict->kind == ROTID_NAMED && model ? accept(engine, p, model, count, named) : ROTID_OK;
    return status ? status : list_faults(engine, p);
}
