/* One posterior over explanations: sets of causes of the catalogue, each perhaps with something else beside it.
 *
 *   prior    nothing 0.50, one cause 0.45, two 0.035, three 0.001; alike over the kinds of causes, then over the targets of a
 *            kind, then over all states (1/2) and each alone; something else: a factor 0.05
 *   list     of the sets that the search (search.c) finds, each with its evidence (laplace.c), and what follows of their
 *            probabilities: marginals of causes, moduli averaged over all
 *   run-up   measured critical speeds multiply each of the likeliest by their probability under it (runup_learn) */
#include "diagnose/diagnose.h"
#include "fit/fit.h"
#include "running/running.h"

#define DATA_KINDS     7 /* of faults of channels: gain, sign, place, line, swap, copy, dead */
#define ELSE_PRIOR     0.05
#define ROOM           4096
#define LEAST_SHARE    1e-7 /* of an explanation whose causes count for the marginals */
#define LEAST_MARGINAL 0.001
#define SUSPECTED      10.0 /* times: a cause that the user suspects */
#define RUNUP_MOST     12   /* explanations that measured critical speeds judge, those within SEARCH_WITHIN */
#define NARROW         1e-3 /* share of a normal between its bounds: below, it is flat there */

static const double set_prior[MOST_MEMBERS + 1] = {0.50, 0.45, 0.035, 0.001};

/* ---- sets */

/* One name: whatever its variant, and whoever asked for it. */
int candidate_is_fault(const struct candidate *c)
{
    return c->cause->class == CAUSE_DATA;
}

int posterior_same_cause(const struct candidate *a, const struct candidate *b)
{
    /* states of other lengths have a place each: there it is another cause */
    int same = a->cause == b->cause && a->state == b->state && (!a->in || !b->in || a->in[b->home] || b->in[a->home]);
    if (!same || !candidate_is_fault(a)) /* of two channels that are one, whichever is the copy */
        return same && !strcmp(a->target, b->target);
    return (a->sensor[0] == b->sensor[0] && a->sensor[1] == b->sensor[1]) ||
           (a->sensor[0] == b->sensor[1] && a->sensor[1] == b->sensor[0]);
}

/* Whatever the form along the rotor. */
static int same_variant(const struct candidate *a, const struct candidate *b)
{
    int one = a->effect.variant, two = b->effect.variant;
    return one == two || (a->cause->reshape && one < 2 && two < 2);
}

int posterior_same_model(const struct candidate *a, const struct candidate *b)
{
    return posterior_same_cause(a, b) && !strcmp(a->target, b->target) && !memcmp(a->fixed, b->fixed, sizeof a->fixed) &&
           same_variant(a, b) && a->result.suspect == b->result.suspect &&
           (!a->result.suspect || !strcmp(a->effect.name, b->effect.name));
}

/* Of those with a place near it, too: far from there it is another one. */
int posterior_same_name(const struct posterior *p, const struct candidate *a, const struct candidate *b)
{
    int place = a->cause->place;
    return posterior_same_cause(a, b) &&
           (place < 0 || fabs(a->effect.value[place] - b->effect.value[place]) < POSTERIOR_NEAR * p->length);
}

int posterior_has(const struct posterior *p, const struct explanation *e, const struct candidate *c)
{
    for (int m = 0; m < e->nmember; m++)
        if (posterior_same_name(p, &e->member[m], c))
            return 1;
    return 0;
}

int posterior_same_set(const struct explanation *a, const struct explanation *b)
{
    int same = a->nmember == b->nmember && a->something_else == b->something_else;
    for (int m = 0; m < a->nmember && same; m++) {
        int balance = 0;
        for (int k = 0; k < a->nmember; k++)
            balance += posterior_same_model(&a->member[k], &a->member[m]) - posterior_same_model(&b->member[k], &a->member[m]);
        same = !balance;
    }
    return same;
}

struct explanation *posterior_find(const struct posterior *p, const struct explanation *e)
{
    for (int i = 0; i < p->count; i++)
        if (posterior_same_set(&p->item[i], e))
            return &p->item[i];
    return NULL;
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

/* Kinds of causes: those of the scan, and the faults of channels where there are shapes. */
static int count_kinds(const struct scan *scan, int shapes)
{
    int count = shapes ? DATA_KINDS : 0;
    for (int i = 0; i < catalogue_count(); i++) {
        int listed = 0;
        for (int j = 0; j < scan->ncandidate; j++)
            listed |= scan->candidate[j].cause == catalogue_item(i);
        count += listed;
    }
    return count;
}

/* Share of a physical cause among all of its kind. */
static double share_of_kind(const struct scan *scan, const struct cause_kind *cause, const char *target, int state)
{
    int targets = 0, alone = 0;
    for (int i = 0; i < scan->ncandidate; i++) {
        const struct scan_candidate *s = &scan->candidate[i];
        if (s->cause != cause || s->suspect)
            continue;
        targets += s->state < 0;
        alone += s->state >= 0 && !strcmp(s->target, target);
    }
    return 1.0 / (targets > 0 ? targets : 1) * (!alone ? 1 : state < 0 ? 0.5 : 0.5 / alone);
}

/* ln of the probability of a cause among all single ones. */
static double cause_prior(const struct posterior *p, const struct candidate *c)
{
    if (candidate_is_fault(c))
        return -log((double)p->nkind * faults_alike(p, c));
    int other_form = c->cause->reshape && c->effect.variant == 1 && !c->result.suspect;
    return log(share_of_kind(p->base, c->cause, c->target, c->state) / p->nkind *
               (c->result.suspect ? SUSPECTED
                : other_form      ? 0.5
                                  : 1));
}

double posterior_gain_shown(const struct scan *scan, int candidate)
{
    const struct scan_candidate *c = &scan->candidate[candidate];
    double one =
        set_prior[1] * share_of_kind(scan, c->cause, c->target, c->state) / count_kinds(scan, scan->nrow > scan->nfrequency);
    return log(VERDICT_HARMLESS / (1 - VERDICT_HARMLESS) * set_prior[0] / one * fmax(c->count, 1));
}

double posterior_log_prior(int nmember, int something_else)
{
    double sum = log(set_prior[nmember]) + (something_else ? log(ELSE_PRIOR) : log1p(-ELSE_PRIOR));
    for (int m = 1; m < nmember; m++) /* a set has no order */
        sum += log(m + 1);
    return sum;
}

double posterior_prior_of(const struct posterior *p, const struct explanation *e)
{
    double sum = posterior_log_prior(e->nmember, e->something_else);
    for (int m = 0; m < e->nmember; m++)
        sum += cause_prior(p, &e->member[m]);
    return sum;
}

/* ---- the list */

struct explanation *posterior_append(struct posterior *p, const struct explanation *e)
{
    if (p->count == p->room)
        return NULL;
    p->item[p->count] = *e;
    return &p->item[p->count++];
}

int posterior_room(struct pool *pool, int nown, struct evidence *evidence)
{
    evidence->mean = POOL_ARRAY(pool, double, nown + 1);
    evidence->std = POOL_ARRAY(pool, double, nown + 1);
    return evidence->mean && evidence->std ? ROTID_OK : ROTID_ERROR_MEMORY;
}

const struct rotid_fit_result *explanation_fit(const struct engine *engine, const struct explanation *e)
{
    return e->refit ? e->refit->fit : engine->fit;
}

const struct states *explanation_states(const struct engine *engine, const struct explanation *e)
{
    return e->refit ? &e->refit->states : &engine->states;
}

/* column [2 * MOST_MEMBERS]: those of the faults of a set, *nfault */
int explanation_faults(const struct engine *engine, const struct explanation *e, struct fault_column *column, int *nfault)
{
    int status = ROTID_OK;
    *nfault = 0;
    for (int m = 0; m < e->nmember && !status; m++)
        if (candidate_is_fault(&e->member[m]))
            status = fault_columns(engine->pool, explanation_states(engine, e), engine->number, engine->holdout,
                                   explanation_fit(engine, e), e->data, &e->member[m], column, nfault);
    return status;
}

int posterior_score(struct engine *engine, struct posterior *p, const struct scan *else_scan, struct explanation *e)
{
    struct fault_column column[2 * MOST_MEMBERS];
    const struct states *states = explanation_states(engine, e);
    int nfault = 0, status = e->evidence.mean ? ROTID_OK : posterior_room(engine->pool, engine->nown, &e->evidence);
    if (!status)
        status = explanation_faults(engine, e, column, &nfault);
    if (!status)
        status = evidence_of_fit(e->data, states, engine->nown, explanation_fit(engine, e), e->nmember, e->member, nfault, column,
                                 else_scan, &e->evidence);
    e->evidence.log_z += e->outside;
    e->evidence.log_stated += e->outside;
    e->evidence.log_exact += e->outside;
    e->evidence.log_else += e->outside;
    if (status == ROTID_ERROR_ARGUMENT) { /* a solid whose data are others */
        e->evidence.log_z = e->evidence.log_stated = e->evidence.log_exact = e->evidence.log_else = -INFINITY;
        status = ROTID_OK;
    }
    e->log_prior = posterior_prior_of(p, e);
    e->log_posterior = e->evidence.log_z + e->log_prior;
    return status;
}

/* 1 where noise reaches chi2 of the frequencies and the whole chi2 of the fit, each (BLOCK_LEVEL). What the scan still would find
 * does not count. data: of the fit, from which faults may have taken rows of the scan. */
static int fit_explains(const struct scan *scan, const struct evidence_data *data, const rotid_fit_result *fit)
{
    int dof = scan->dof - (fit->n - scan->nfree) - (scan->nrow - fit->nresidual);
    double lines = 0;
    for (int i = 0; i < data->nrow && data->nrow == fit->nresidual; i++)
        lines += data->kind[i] == EVIDENCE_FREQUENCY ? fit->r[i] * fit->r[i] : 0;
    return dof > 0 && chi_square_tail(lines, data->nline) > BLOCK_LEVEL && chi_square_tail(fit->chi2, dof) > BLOCK_LEVEL;
}

int explanation_explains(const struct engine *engine, const struct posterior *p, const struct explanation *e)
{
    return fit_explains(p->base, e->data, explanation_fit(engine, e));
}

/* ---- what follows of the list */

ORDER_BY(by_probability, struct marginal, -it->probability, 0)

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
                known |= posterior_same_name(p, &e->member[m], &e->member[k]);
            for (int j = 0; j < p->nmarginal && !known; j++)
                if (posterior_same_name(p, &p->marginal[j].cause, &e->member[m])) {
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
        sum += posterior_same_cause(&p->marginal[i].cause, c) ? p->marginal[i].probability : 0;
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

ORDER_BY(by_posterior, struct explanation, -it->log_posterior, 0)

void posterior_sort(struct posterior *p)
{
    qsort(p->item, (size_t)p->count, sizeof *p->item, by_posterior);
}

/* Probabilities of the list, and what follows. */
static int weigh(struct engine *engine, struct posterior *p)
{
    double sum = -INFINITY;
    posterior_sort(p);
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
        if (e->log_posterior < p->item[0].log_posterior - SEARCH_WITHIN)
            break;
        status = engine_stage(engine, "measured critical speeds of explanation", asked + 1);
        if (!status)
            status = posterior_room(engine->pool, p->nown, &own);
        if (status)
            return status;
        memcpy(own.mean, e->evidence.mean, (size_t)p->nown * sizeof *own.mean);
        memcpy(own.std, e->evidence.std, (size_t)p->nown * sizeof *own.std);
        e->evidence = own;
        pool_open(&scratch, engine->pool->allocator);
        status = runup_learn(&scratch, deck, explanation_states(engine, e), explanation_fit(engine, e), p->nown, e->evidence.mean,
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
    *p = (struct posterior){.room = ROOM,
                            .base = &result->scan,
                            .item = POOL_ARRAY(engine->pool, struct explanation, ROOM),
                            .states = &engine->states,
                            .nown = engine->nown,
                            .length = rotor_length(&engine->job->rotor),
                            .nothing_prior = set_prior[0] * (1 - ELSE_PRIOR)};
    if (!p->item)
        return ROTID_ERROR_MEMORY;
    int shapes = 0;
    for (int s = 0; s < engine->states.nstate; s++)
        shapes |= job_fits_shapes(&engine->states.state[s].job);
    p->nkind = count_kinds(&result->scan, shapes);
    int status = evidence_open(engine->pool, &engine->states, engine->number, engine->holdout, &p->data);
    if (!status)
        status = search_run(engine, result, p);
    if (!status)
        status = weigh(engine, p);
    return status ? status : learn_of_runup(engine, p);
}
