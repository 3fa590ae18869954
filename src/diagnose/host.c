/* The explanations of a host's model: the same priors, evidence and verdict, with causes that the host adds to its matrices.
 *
 *   model   K(x) + sum over the set of dK(x, c), M alike: the unknowns are those of the host, then the values of the causes
 *   search  nothing, every single cause, then the likeliest sets with one cause more or less (SETS of them, within WITHIN of the
 * best) result  probabilities, marginals, and the host's unknowns averaged over all explanations */
#include "diagnose/diagnose.h"
#include "fit/fit.h"

#define VALUES 4   /* of a cause */
#define SETS   8   /* that are expanded */
#define WITHIN 7.0 /* of the best, in ln P */
#define ELSE   4   /* the likeliest sets get something else beside them */

struct host {
    const rotid_model *model;
    const rotid_parameter *parameter;
    const rotid_measured *measured;
    int ncause, nkind;
    const rotid_host_cause *cause; /* [ncause] of this library's size */
    const struct evidence_data *data;
    const rotid_environment *environment;
    struct pool *pool, *keep; /* of the search; of the result */
    char *failure;
    rotid_host_options options;
    int count, room;
    struct host_set *set;
    int dof; /* of the model without a cause */
};

struct host_set {
    rotid_host_explanation is;
    int expanded;
    struct evidence evidence;
    double log_posterior;
};

/* ---- the model with a set */

struct composed {
    const struct host *host;
    const rotid_host_explanation *set;
};

static int matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    const struct composed *c = user;
    const rotid_model *model = c->host->model;
    const double *value = x + model->nparam;
    int status = model->matrices(model->user, x, k, m);
    for (int i = 0; i < c->set->ncause && !status; i++) {
        const rotid_host_cause *cause = &c->host->cause[c->set->cause[i]];
        status = cause->add(cause->user, x, value, k, m);
        value += cause->nparameter;
    }
    return status;
}

static int unknowns_of(const struct host *h, const rotid_host_explanation *set)
{
    int n = h->model->nparam;
    for (int i = 0; i < set->ncause; i++)
        n += h->cause[set->cause[i]].nparameter;
    return n;
}

/* Starts at x, but inside the bounds by a part of their distance: a fit does not begin at a bound. */
static void start_at(double x, double part, rotid_parameter *parameter)
{
    double off = part * (parameter->upper - parameter->lower);
    double inside = fmin(fmax(x, parameter->lower + off), parameter->upper - off);
    if (isfinite(x) && inside != 0)
        parameter->start = inside;
}

/* The unknowns of a set with their priors; starts are what a fit of a part of the set gave. */
static void take_unknowns(const struct host *h, const rotid_host_explanation *set, rotid_parameter *parameter,
                          struct model_prior *prior)
{
    int at = h->model->nparam;
    for (int p = 0; p < at; p++) {
        parameter[p] = h->parameter[p];
        prior[p] = (struct model_prior){parameter[p].lower, parameter[p].upper, 0, 0};
    }
    for (int i = 0; i < set->ncause; i++) {
        const rotid_host_cause *cause = &h->cause[set->cause[i]];
        for (int q = 0; q < cause->nparameter; q++, at++) {
            parameter[at] = cause->parameter[q];
            start_at(set->value[VALUES * i + q], 1e-6, &parameter[at]);
            prior[at] = (struct model_prior){parameter[at].lower, parameter[at].upper, cause->neutral ? cause->neutral[q] : 0,
                                             cause->deviation ? cause->deviation[q] : 0};
        }
    }
}

static double log_prior(const struct host *h, const rotid_host_explanation *set)
{
    double sum = posterior_log_prior(set->ncause, set->something_else);
    if (h->options.changed && !set->ncause)
        sum += posterior_log_prior(1, 0) - posterior_log_prior(0, 0) - log(h->nkind);
    for (int i = 0; i < set->ncause; i++) {
        int targets = 0;
        for (int c = 0; c < h->ncause; c++)
            targets += same_text(h->cause[c].name, h->cause[set->cause[i]].name);
        sum -= log((double)h->nkind * targets);
    }
    return sum;
}

/* Fits a set and enters it, and with something else where asked; a set without a fit is left out. */
static int enter(struct host *h, rotid_host_explanation set, const double *x, int with_else)
{
    int n = unknowns_of(h, &set), nown = h->model->nparam, status = ROTID_OK;
    struct composed composed = {h, &set};
    rotid_model model = *h->model;
    rotid_parameter *parameter = POOL_ARRAY(h->pool, rotid_parameter, n);
    struct model_prior *prior = POOL_ARRAY(h->pool, struct model_prior, n);
    struct host_set entered = {
        .evidence = {.mean = POOL_ARRAY(h->pool, double, nown + 1), .std = POOL_ARRAY(h->pool, double, nown + 1)}};
    rotid_fit_options options = {.size = sizeof options, .functional = ROTID_LIKELIHOOD};
    rotid_fit_result *fit = NULL;
    if (!parameter || !prior || !entered.evidence.mean || !entered.evidence.std)
        return ROTID_ERROR_MEMORY;
    take_unknowns(h, &set, parameter, prior);
    for (int p = 0; p < nown && x; p++)
        start_at(x[p], 0.02, &parameter[p]);
    model.nparam = n;
    if (set.ncause) {
        model.matrices = matrices;
        model.derivatives = NULL; /* both are of the host's model alone, and of its user */
        model.derivative_products = NULL;
        model.user = &composed;
    }
    status = rotid_fit(&model, parameter, h->measured, &options, h->environment, h->failure, &fit);
    if (!status || status > 0) {
        int cancelled = fit->status == ROTID_STOP_CANCELLED;
        status = cancelled ? ROTID_STOP_CANCELLED : evidence_of_model(h->data, prior, nown, fit, with_else, &entered.evidence);
    } else if (set.ncause && (status == ROTID_ERROR_CALLBACK || status == ROTID_ERROR_FINITE || status == ROTID_ERROR_ARGUMENT)) {
        return failure_say_of(h->failure, status, "with cause[%d]: ", set.cause[set.ncause - 1]);
    } else if (set.ncause && status != ROTID_ERROR_MEMORY) {
        *h->failure = 0; /* the model has no fit with this cause */
        return ROTID_OK;
    }
    if (!status) {
        int at = nown;
        for (int i = 0; i < set.ncause; i++)
            for (int q = 0; q < h->cause[set.cause[i]].nparameter; q++, at++) {
                set.value[VALUES * i + q] = fit->x[at];
                set.std[VALUES * i + q] = fit->std[at];
            }
        set.chi2 = fit->chi2;
        h->dof = set.ncause ? h->dof : fit->dof;
        set.something_else = with_else;
        entered.is = set;
        entered.expanded = with_else;
        entered.log_posterior = (with_else ? entered.evidence.log_else : entered.evidence.log_z) + log_prior(h, &set);
        if (h->count < h->room && isfinite(entered.log_posterior))
            h->set[h->count++] = entered;
    }
    rotid_fit_free(fit);
    return status;
}

/* ---- the search */

static rotid_host_explanation with_cause(const rotid_host_explanation *set, int cause)
{
    rotid_host_explanation more = *set;
    more.cause[more.ncause] = cause;
    for (int q = 0; q < VALUES; q++)
        more.value[VALUES * more.ncause + q] = more.std[VALUES * more.ncause + q] = NAN;
    more.ncause++;
    return more;
}

static rotid_host_explanation without_cause(const rotid_host_explanation *set, int k)
{
    rotid_host_explanation less = *set;
    less.ncause--;
    for (; k < less.ncause; k++) {
        less.cause[k] = set->cause[k + 1];
        memcpy(less.value + (ptrdiff_t)VALUES * k, set->value + (ptrdiff_t)VALUES * (k + 1), VALUES * sizeof *less.value);
    }
    for (int q = 0; q < VALUES; q++)
        less.value[VALUES * less.ncause + q] = less.std[VALUES * less.ncause + q] = NAN;
    return less;
}

static int is_known(const struct host *h, const rotid_host_explanation *set)
{
    for (int i = 0; i < h->count; i++) {
        int alike = h->set[i].is.ncause == set->ncause && !h->set[i].is.something_else;
        for (int k = 0; k < set->ncause && alike; k++) {
            int found = 0;
            for (int j = 0; j < set->ncause; j++)
                found |= h->set[i].is.cause[j] == set->cause[k];
            alike = found;
        }
        if (alike)
            return 1;
    }
    return 0;
}

static int has(const rotid_host_explanation *set, int cause)
{
    int found = 0;
    for (int i = 0; i < set->ncause; i++)
        found |= set->cause[i] == cause;
    return found;
}

/* The likeliest set that was not expanded yet. */
static int next_set(const struct host *h)
{
    int best = -1, lead = 0;
    for (int i = 0; i < h->count; i++) {
        lead = h->set[i].log_posterior > h->set[lead].log_posterior ? i : lead;
        if (!h->set[i].expanded && (best < 0 || h->set[i].log_posterior > h->set[best].log_posterior))
            best = i;
    }
    return best >= 0 && h->set[best].log_posterior > h->set[lead].log_posterior - WITHIN ? best : -1;
}

ORDER_BY(by_posterior, struct host_set, -it->log_posterior, 0)

static int search(struct host *h)
{
    rotid_host_explanation none = {0};
    int next = 0, status;
    for (int i = 0; i < MOST_MEMBERS; i++)
        for (int q = 0; q < VALUES; q++)
            none.value[VALUES * i + q] = none.std[VALUES * i + q] = NAN;
    status = enter(h, none, NULL, 0);
    if (!status && !h->count)
        status =
            refuse(h->failure, "the model without a cause has no finite likelihood of these data, expected modes nearer to them");
    for (int pass = 0; pass < SETS && !status && next >= 0; pass++) {
        h->set[next].expanded = 1;
        for (int c = 0; c < h->ncause && h->set[next].is.ncause < MOST_MEMBERS && !status; c++) {
            rotid_host_explanation more = with_cause(&h->set[next].is, c);
            if (environment_cancelled(h->environment))
                return ROTID_STOP_CANCELLED;
            if (!has(&h->set[next].is, c) && !is_known(h, &more))
                status = enter(h, more, h->set[next].evidence.mean, 0);
        }
        for (int k = 0; k < h->set[next].is.ncause && h->set[next].is.ncause > 1 && !status; k++) {
            rotid_host_explanation less = without_cause(&h->set[next].is, k); /* what led here may not be needed any more */
            if (!is_known(h, &less))
                status = enter(h, less, h->set[next].evidence.mean, 0);
        }
        next = next_set(h);
    }
    if (status)
        return status;
    qsort(h->set, (size_t)h->count, sizeof *h->set, by_posterior);
    for (int i = 0, count = h->count; i < ELSE && i < count && !status; i++)
        status = enter(h, h->set[i].is, h->set[i].evidence.mean, 1);
    qsort(h->set, (size_t)h->count, sizeof *h->set, by_posterior);
    return status;
}

/* ---- what is said */

static int conclude(struct host *h, rotid_host_diagnosis *d)
{
    int nown = h->model->nparam;
    struct posterior p = {.count = h->count, .item = POOL_ARRAY(h->pool, struct explanation, h->count)};
    double sum = -INFINITY, most = 0;
    d->explanation = POOL_ARRAY(h->keep, rotid_host_explanation, h->count);
    d->probability = POOL_ARRAY(h->keep, double, h->ncause);
    d->mean = POOL_ARRAY(h->keep, double, 4 * (size_t)nown + 1);
    if (!p.item || !d->explanation || !d->probability || !d->mean)
        return ROTID_ERROR_MEMORY;
    d->std = d->mean + nown;
    d->ci_lower = d->std + nown;
    d->ci_upper = d->ci_lower + nown;
    d->nexplanation = h->count;
    d->ncause = h->ncause;
    d->dof = h->dof;
    d->nparameter = nown;
    memset(d->probability, 0, (size_t)h->ncause * sizeof *d->probability);
    for (int i = 0; i < h->count; i++)
        sum = log_sum(sum, h->set[i].log_posterior);
    for (int i = 0; i < h->count; i++) {
        rotid_host_explanation *e = &d->explanation[i];
        *e = h->set[i].is;
        e->probability = exp(h->set[i].log_posterior - sum);
        p.item[i] = (struct explanation){.evidence = h->set[i].evidence, .probability = e->probability};
        d->something_else = fmin(1, d->something_else + (e->something_else ? e->probability : 0));
        d->nothing += !e->ncause && !e->something_else ? e->probability : 0;
        for (int k = 0; k < e->ncause; k++)
            d->probability[e->cause[k]] = fmin(1, d->probability[e->cause[k]] + e->probability);
        if (!e->ncause && !e->something_else)
            d->chi2 = e->chi2;
    }
    for (int c = 0; c < h->ncause; c++)
        most = fmax(most, d->probability[c]);
    for (int q = 0; q < nown; q++)
        posterior_average(&p, &h->parameter[q], q, &d->mean[q], &d->std[q], &d->ci_lower[q], &d->ci_upper[q]);
    d->verdict =
        posterior_kind(d->something_else, most >= VERDICT_NAMED, !d->explanation[0].ncause && !d->explanation[0].something_else,
                       most, d->nothing, exp(log_prior(h, &(rotid_host_explanation){0})));
    return ROTID_OK;
}

/* ---- the call */

static int take_cause(const char *given, int c, char *failure, rotid_host_cause *own)
{
    size_t size, first;
    memcpy(&first, given, sizeof first);
    given += (size_t)c * first;
    memcpy(&size, given, sizeof size);
    if (size != first)
        return refuse(failure, "cause[%d].size is %zu, expected that of the first, %zu", c, size, first);
    int status = sized_take(SIZED_CAUSE, given, failure, own);
    if (status)
        return status;
    if (!own->name || !own->parameter || !own->add)
        return refuse(failure, "cause[%d].%s is NULL, expected %s", c,
                      !own->name        ? "name"
                      : !own->parameter ? "parameter"
                                        : "add",
                      !own->name        ? "a text"
                      : !own->parameter ? "parameters"
                                        : "a function");
    if (own->nparameter < 1 || own->nparameter > VALUES)
        return refuse(failure, "cause[%d].nparameter is %d, expected 1 to %d", c, own->nparameter, VALUES);
    for (int q = 0; q < own->nparameter; q++) {
        double neutral = own->neutral ? own->neutral[q] : 0, deviation = own->deviation ? own->deviation[q] : 0;
        if (!isfinite(neutral) || !(deviation >= 0 && isfinite(deviation)))
            return refuse(failure,
                          "cause[%d]: neutral[%d] is %g and deviation[%d] %g, expected finite ones, the latter not negative", c,
                          q, neutral, q, deviation);
    }
    status = fit_check_parameters("cause->nparameter", own->nparameter, own->parameter, failure);
    return status ? failure_say_of(failure, status, "cause[%d].", c) : ROTID_OK;
}

static int check(const rotid_model *model, const rotid_measured *measured, int ncause, const rotid_host_cause *cause,
                 char *failure)
{
    if (!model || !measured || !cause)
        return refuse(failure, "%s is NULL, expected a struct", !model ? "model" : !measured ? "measured" : "cause");
    if (ncause < 1 || ncause > 1000)
        return refuse(failure, "ncause is %d, expected 1 to 1000", ncause);
    return ROTID_OK;
}

static int run(struct entry *entry, struct pool *keep, struct host *h, const rotid_host_cause *cause, rotid_host_diagnosis *made)
{
    rotid_host_cause *own = POOL_ARRAY(&entry->scratch, rotid_host_cause, h->ncause);
    struct evidence_data *data = NULL;
    int status = own ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int c = 0; c < h->ncause && !status; c++) {
        int first = 1;
        status = take_cause((const char *)cause, c, entry->failure, &own[c]);
        for (int k = 0; k < c && !status; k++)
            first &= !same_text(own[k].name, own[c].name);
        h->nkind += first;
    }
    h->cause = own;
    h->room = (h->ncause + MOST_MEMBERS) * (SETS + 1) + ELSE;
    h->set = POOL_ARRAY(&entry->scratch, struct host_set, h->room);
    h->pool = &entry->scratch;
    h->keep = keep;
    if (!status && !h->set)
        status = ROTID_ERROR_MEMORY;
    if (!status) /* all as rotid_fit judges it, before anything is made of it */
        status = fit_check_model(h->model, entry->failure);
    if (!status)
        status = fit_check_parameters("model->nparam", h->model->nparam, h->parameter, entry->failure);
    if (!status)
        status = measured_check(h->model, h->measured, ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE, entry->failure);
    if (!status)
        status =
            evidence_open_model(&entry->scratch, h->measured, h->model->nmaster, h->options.position, h->options.length, &data);
    h->data = data;
    if (!status)
        status = search(h);
    return status ? status : conclude(h, made);
}

int rotid_diagnose_model(const rotid_model *model, const rotid_parameter *parameter, const rotid_measured *measured, int ncause,
                         const rotid_host_cause *cause, const rotid_host_options *options, const rotid_environment *environment,
                         char *failure, rotid_host_diagnosis **diagnosis)
{
    struct entry entry;
    rotid_model own_model;
    rotid_measured own_measured;
    char text[ROTID_FAILURE_LENGTH] = "";
    struct pool first;
    struct host h = {.parameter = parameter, .ncause = ncause, .failure = failure ? failure : text};
    int status = entry_open(&entry, environment, failure);
    if (diagnosis)
        *diagnosis = NULL;
    else if (!status)
        status = refuse(failure, "diagnosis is NULL, expected a pointer");
    if (!status)
        status = check(model, measured, ncause, cause, failure);
    if (!status)
        status = sized_take(SIZED_MODEL, model, failure, &own_model);
    if (!status)
        status = sized_take(SIZED_MEASURED, measured, failure, &own_measured);
    if (!status && options)
        status = sized_take(SIZED_HOST_OPTIONS, options, failure, &h.options);
    if (!status && h.options.position && !(h.options.length > 0 && isfinite(h.options.length)))
        status = refuse(failure, "options->length is %g, expected the length of the structure [m]", h.options.length);
    pool_open(&first, entry.environment.allocator);
    rotid_host_diagnosis *made = POOL_NEW(&first, rotid_host_diagnosis);
    struct pool *keep = made ? POOL_NEW(&first, struct pool) : NULL;
    entry.environment.size = sizeof entry.environment;
    if (!status && !keep)
        status = ROTID_ERROR_MEMORY;
    if (!status) {
        *made = (rotid_host_diagnosis){0};
        h.model = &own_model;
        h.measured = &own_measured;
        own_model.size = sizeof own_model;
        own_measured.size = sizeof own_measured;
        h.environment = &entry.environment;
        status = run(&entry, &first, &h, cause, made);
    }
    if (status) {
        pool_close(&first);
    } else {
        *keep = first; /* the result carries the pool that it lives on */
        made->memory = keep;
        *diagnosis = made;
    }
    return entry_close(&entry, status);
}

void rotid_host_diagnosis_free(rotid_host_diagnosis *diagnosis)
{
    if (!diagnosis)
        return;
    struct pool pool = *(struct pool *)diagnosis->memory;
    pool_close(&pool);
}
