#include "diagnose/diagnose.h"
#include "fit/fit.h"

#define PROMISES   10.0 /* drop of chi2 from which the mesh of a solid is worth another fit */
#define STARTS     3    /* places a candidate is fitted from */
#define APART      0.06 /* of the rotor's length: nearer ones lead to the same minimum */
#define SAME_PLACE 0.03 /* of the rotor's length */
#define OFF        0.02 /* of the distance between the bounds: the bijection is flat at them */

static const struct refit no_refit = {.chi2 = INFINITY};

static double inside(const rotid_parameter *bounds, double value)
{
    double margin = OFF * (bounds->upper - bounds->lower);
    return fmin(fmax(value, bounds->lower + margin), bounds->upper - margin);
}

/* The start of a size: where the bijection moves it by a share of itself. Bounds of springs and factors span decades, and 2 % of
 * the distance between them would be a hundred times a small one. */
static double start_of_size(const rotid_parameter *bounds, double value)
{
    int open = fmin(value - bounds->lower, bounds->upper - value) > OFF * fabs(value);
    return open ? value : inside(bounds, value);
}

static void set_start(rotid_parameter *bounds, double value)
{
    int open = value > bounds->lower && value < bounds->upper && !bounds_pressed(bounds, value);
    bounds->start = open ? value : inside(bounds, value);
    if (bounds->start == 0) /* its size is the scale of the parameter */
        bounds->start = 1e-3 * (bounds->upper > 0 ? bounds->upper : bounds->lower);
}

int job_started_at(struct pool *pool, const struct job *job, const double *x, struct job *to)
{
    rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, job->unknowns.nparameter);
    if (!bounds)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        bounds[p] = job->unknowns.bounds[p];
        set_start(&bounds[p], x[p]);
    }
    *to = *job;
    to->unknowns.bounds = bounds;
    return ROTID_OK;
}

int job_with_effect(struct pool *pool, const struct job *from, const double *x, const struct effect *effect,
                    const struct cause_kind *cause, const int *fixed, struct job *to)
{
    const struct job copy = *from, *job = &copy; /* `to` may be the same */
    const struct rotor *rotor = &job->rotor;
    int nown = job->unknowns.nparameter, nnew = effect_parameters(effect), index = rotor->neffect;
    if (cause->solid) {
        int status = job_as_solid(pool, job, to);
        return status || !x ? status : job_started_at(pool, to, x, to);
    }
    *to = *job;
    to->rotor.effect = POOL_COPY(pool, rotor->effect, index, 1);
    to->unknowns.parameter = POOL_COPY(pool, job->unknowns.parameter, nown, nnew);
    to->unknowns.bounds = POOL_COPY(pool, job->unknowns.bounds, nown, nnew);
    if (!to->rotor.effect || !to->unknowns.parameter || !to->unknowns.bounds)
        return ROTID_ERROR_MEMORY;
    to->rotor.effect[to->rotor.neffect++] = *effect;
    for (int p = 0; p < nown && x; p++)
        set_start(&to->unknowns.bounds[p], x[p]);
    for (int p = 0; p < nnew; p++) {
        if (fixed && fixed[p])
            continue;
        rotid_parameter *bounds = &to->unknowns.bounds[to->unknowns.nparameter];
        *bounds = (rotid_parameter){.unit = effect->kind->parameter[p].unit};
        bounds->name = pool_format(pool, "%s.%s", effect->name, effect->kind->parameter[p].name);
        if (!bounds->name)
            return ROTID_ERROR_MEMORY;
        cause_bounds(cause, rotor, effect, p, &bounds->lower, &bounds->upper);
        bounds->start = start_of_size(bounds, effect->value[p]);
        if (bounds->start == 0) /* its size is the scale of the parameter */
            bounds->start = 1e-3 * (bounds->upper > 0 ? bounds->upper : bounds->lower);
        to->unknowns.parameter[to->unknowns.nparameter++] =
            (struct parameter){.kind = PARAMETER_EFFECT, .index = index, .component = p};
    }
    return ROTID_OK;
}

/* The unknowns of all are those of the one state there is. */
static int take_bounds(struct states *to)
{
    to->nparameter = to->state->job.unknowns.nparameter;
    to->bounds = to->state->job.unknowns.bounds;
    return ROTID_OK;
}

int states_started_at(struct pool *pool, const struct states *states, const double *x, struct states *to)
{
    const struct states from = *states; /* `to` may be the same */
    int status = states_copy(pool, &from, to);
    for (int s = 0; s < from.nstate && !status; s++) {
        double *own = state_values(pool, &from.state[s], x);
        status = own ? job_started_at(pool, &from.state[s].job, own, &to->state[s].job) : ROTID_ERROR_MEMORY;
    }
    if (status || from.nstate == 1)
        return status ? status : take_bounds(to);
    to->bounds = POOL_ARRAY(pool, rotid_parameter, from.nparameter);
    if (!to->bounds)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < from.nparameter; p++) {
        to->bounds[p] = from.bounds[p];
        set_start(&to->bounds[p], x[p]);
    }
    return ROTID_OK;
}

/* The last `added` unknowns of a state are the last ones of all. */
static int map_unknowns(struct pool *pool, int added, int nparameter, struct state *state)
{
    int n = state->job.unknowns.nparameter, *unknown = POOL_ARRAY(pool, int, n);
    if (!unknown)
        return ROTID_ERROR_MEMORY;
    for (int q = 0; q < n; q++)
        unknown[q] = q < n - added ? state_unknown(state, q) : nparameter + q - (n - added);
    state->unknown = unknown;
    return ROTID_OK;
}

/* The bounds and the start of unknown p of all for the states that have it. */
static void states_share_bounds(struct states *states, int p)
{
    for (int s = 0; s < states->nstate; s++)
        for (int q = 0; q < states->state[s].job.unknowns.nparameter; q++)
            if (state_unknown(&states->state[s], q) == p) {
                rotid_parameter *own = &states->state[s].job.unknowns.bounds[q];
                own->lower = states->bounds[p].lower;
                own->upper = states->bounds[p].upper;
                own->start = states->bounds[p].start;
            }
}

/* The bounds of the last `added` unknowns, those of one effect: what is possible in every state in which it acts, which may be of
 * different lengths. */
static int add_bounds(struct pool *pool, const struct states *from, const struct state *const *acts, int nacts, int added,
                      struct states *to)
{
    int n = from->nparameter;
    rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, n + added);
    if (!bounds)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < n; p++)
        bounds[p] = to->bounds[p];
    to->nparameter = n + added;
    to->bounds = bounds;
    for (int p = n; p < n + added; p++) {
        for (int s = 0; s < nacts; s++) {
            const rotid_parameter *own = &acts[s]->job.unknowns.bounds[acts[s]->job.unknowns.nparameter - added + p - n];
            if (!s)
                bounds[p] = *own;
            double lower = fmax(bounds[p].lower, own->lower), upper = fmin(bounds[p].upper, own->upper);
            if (lower < upper) {
                bounds[p].lower = lower;
                bounds[p].upper = upper;
            }
        }
        set_start(&bounds[p], inside(&bounds[p], bounds[p].start));
        states_share_bounds(to, p);
    }
    return ROTID_OK;
}

int states_with_effect(struct pool *pool, const struct states *from, const double *x, const struct effect *effect,
                       const struct cause_kind *cause, const int *fixed, const int *in, struct states *to)
{
    const struct states states = *from; /* `to` may be the same */
    const struct state **acts = POOL_ARRAY(pool, const struct state *, from->nstate);
    int added = 0, nacts = 0, status = x ? states_started_at(pool, &states, x, to) : states_copy(pool, &states, to);
    if (!acts)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < states.nstate && !status; s++) {
        struct job *job = &to->state[s].job;
        int before = job->unknowns.nparameter;
        if (in && !in[s] && !cause->solid)
            continue;
        status = job_with_effect(pool, job, NULL, effect, cause, fixed, job);
        added = job->unknowns.nparameter - before;
        acts[nacts++] = &to->state[s];
        if (!status && (states.nstate > 1 || to->state[s].unknown))
            status = map_unknowns(pool, added, states.nparameter, &to->state[s]);
    }
    if (status || states.nstate == 1)
        return status ? status : take_bounds(to);
    return add_bounds(pool, &states, acts, nacts, added, to);
}

void effect_at(const struct state *state, int effect, const double *x, struct effect *out)
{
    const struct job *job = &state->job;
    *out = job->rotor.effect[effect];
    for (int p = 0; p < job->unknowns.nparameter; p++)
        if (job->unknowns.parameter[p].kind == PARAMETER_EFFECT && job->unknowns.parameter[p].index == effect)
            out->value[job->unknowns.parameter[p].component] = x[state_unknown(state, p)];
}

int effect_named(const struct state *state, const char *name)
{
    const struct rotor *rotor = &state->job.rotor;
    int e = name ? rotor->neffect - 1 : -1;
    while (e >= 0 && (!rotor->effect[e].name || strcmp(rotor->effect[e].name, name) != 0))
        e--;
    return e;
}

int effect_unknown(const struct state *state, int effect, int component)
{
    const struct job_unknowns *u = &state->job.unknowns;
    for (int q = 0; q < u->nparameter; q++)
        if (u->parameter[q].kind == PARAMETER_EFFECT && u->parameter[q].index == effect && u->parameter[q].component == component)
            return state_unknown(state, q);
    return -1;
}

int states_at(struct pool *pool, const struct states *states, const double *x, struct states *to)
{
    int status = states_copy(pool, states, to);
    for (int s = 0; s < to->nstate && !status; s++) {
        struct rotor *rotor = &to->state[s].job.rotor; /* whose effects others have too */
        struct effect *own = POOL_ARRAY(pool, struct effect, rotor->neffect);
        status = own || !rotor->neffect ? ROTID_OK : ROTID_ERROR_MEMORY;
        for (int e = 0; e < rotor->neffect && !status; e++)
            effect_at(&to->state[s], e, x, &own[e]);
        rotor->effect = own;
    }
    return status;
}

int states_hold(struct pool *pool, const struct states *states, const double *x, int p, double value, struct states *to)
{
    int n = states->nparameter;
    double *at = POOL_COPY(pool, x, n, 1);
    if (!at)
        return ROTID_ERROR_MEMORY;
    at[p] = value;
    int status = states_at(pool, states, at, to);
    if (!status)
        status = states_started_at(pool, to, at, to);
    for (int s = 0; s < to->nstate && !status; s++) {
        struct job_unknowns *u = &to->state[s].job.unknowns;
        struct parameter *parameter = POOL_ARRAY(pool, struct parameter, u->nparameter);
        int kept = 0, *unknown = POOL_ARRAY(pool, int, u->nparameter);
        if (!parameter || !unknown)
            return ROTID_ERROR_MEMORY;
        for (int q = 0; q < u->nparameter; q++) {
            int one = state_unknown(&to->state[s], q);
            if (one == p)
                continue;
            parameter[kept] = u->parameter[q];
            u->bounds[kept] = u->bounds[q];
            unknown[kept++] = one - (one > p);
        }
        u->parameter = parameter;
        u->nparameter = kept;
        to->state[s].unknown = unknown;
    }
    if (status || to->nstate == 1)
        return status ? status : take_bounds(to);
    for (int q = p; q + 1 < n; q++)
        to->bounds[q] = to->bounds[q + 1];
    to->nparameter = n - 1;
    return ROTID_OK;
}

int refit_until(struct pool *pool, const struct states *states, const int *number, const int *holdout, double objective,
                const rotid_environment *environment, rotid_fit_result **fit)
{
    rotid_fit_options options = states->state->job.options.fit;
    options.max_iterations = 40;
    options.gradient_tolerance = REFIT_GRADIENT;
    options.step_tolerance = REFIT_STEP;
    options.decrease_tolerance = REFIT_DECREASE;
    options.decrease_least = objective > 0 ? REFIT_LEAST : 0;
    options.objective_tolerance = objective;
    return identify_fit_states(pool, states, number, holdout, &options, environment, fit);
}

int refit_states(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                 const rotid_environment *environment, rotid_fit_result **fit)
{
    return refit_until(pool, states, number, holdout, REFIT_OBJECTIVE, environment, fit);
}

int refit_job(struct pool *pool, const struct job *job, const int *number, const int *holdout,
              const rotid_environment *environment, rotid_fit_result **fit)
{
    struct state state;
    const struct states states = states_of(job, &state);
    return refit_states(pool, &states, number, holdout, environment, fit);
}

/* The items to start from: best first, each a distance away from those before. */
static int choose_starts(const struct scan *scan, const struct scan_candidate *c, double length, int *start)
{
    int count = 0, place = c->cause->place;
    while (count < STARTS) {
        int best = -1;
        for (int i = c->first; i < c->first + c->count; i++) {
            const struct scan_item *item = &scan->item[i];
            int near = 0;
            for (int s = 0; s < count && place >= 0; s++)
                near |= fabs(scan->item[start[s]].effect.value[place] - item->effect.value[place]) < APART * length;
            if (item->usable && !near && (!count || place >= 0) && (best < 0 || item->drop > scan->item[best].drop))
                best = i;
        }
        if (best < 0 || (count && scan->item[best].drop < 0.3 * scan->item[start[0]].drop))
            break;
        start[count++] = best;
    }
    return count;
}

/* The effects to start from; a solid has but one. */
static int starting_effects(const struct scan *scan, const struct scan_candidate *c, double length, struct effect *effect)
{
    int item[STARTS], count = choose_starts(scan, c, length, item);
    for (int s = 0; s < count; s++)
        effect[s] = scan_effect(scan, item[s], scan->item[item[s]].amplitude);
    if (c->cause->solid)
        effect[count++] = c->effect;
    if (c->far)
        effect[count++] = *c->far;
    return count;
}

/* Whether a fit ended at quite another place than that of the refit. */
static int is_elsewhere(const struct states *extended, const struct scan_candidate *c, const rotid_fit_result *fit,
                        const struct refit *refit)
{
    struct effect here;
    const struct state *home = &extended->state[c->home];
    int last = home->job.rotor.neffect - 1, place = c->cause->place, width = c->cause->width;
    if (place < 0 || !refit->fit)
        return 0;
    effect_at(home, last, fit->x, &here);
    double near = fmax(SAME_PLACE * rotor_length(&home->job.rotor), width < 0 ? 0 : here.value[width]);
    return fabs(here.value[place] - refit->states.state[c->home].job.rotor.effect[last].value[place]) > near;
}

/* Takes the fit over: the best one first, behind it the best one at another place. */
static int keep_best(struct pool *pool, const struct states *extended, const struct scan_candidate *c, rotid_fit_result *fit,
                     struct refit refit[2])
{
    int elsewhere = is_elsewhere(extended, c, fit, refit);
    if (elsewhere && fit->chi2 < refit->chi2) { /* the one before becomes the other one */
        rotid_fit_free(refit[1].fit);
        refit[1] = refit[0];
        refit[0] = no_refit;
        elsewhere = 0;
    }
    if (fit->chi2 < refit[elsewhere].chi2)
        return refit_keep(pool, extended, fit, &refit[elsewhere]);
    rotid_fit_free(fit);
    return ROTID_OK;
}

int refit_keep(struct pool *pool, const struct states *states, rotid_fit_result *fit, struct refit *refit)
{
    struct states started;
    int status = states_started_at(pool, states, fit->x, &started);
    if (!status)
        status = states_at(pool, &started, fit->x, &started);
    if (status) {
        rotid_fit_free(fit);
        return status;
    }
    rotid_fit_free(refit->fit);
    refit->states = started;
    refit->fit = fit;
    refit->chi2 = fit->chi2;
    return ROTID_OK;
}

/* Whether the meshes of a solid may be apart by another share with a cause than without it: a joint or a zone acts on a stretch
 * as short as their elements, beside a corner at most. Of nine joints at a step whose fits held the mesh of the model without
 * them one was named alone, and all are at their own mesh. */
static int moves_mesh(const struct job *job, const struct cause_kind *cause)
{
    return cause->solid || (job->options.solid && (cause->width >= 0 || (cause->effect && cause->effect->joint)));
}

/* Fits from the scan's places with the own parameters at x; the best two are kept. Statuses of memory and cancellation only. */
static int fit_from(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
                    const struct scan *scan, const struct scan_candidate *c, const rotid_environment *environment,
                    struct refit refit[2])
{
    struct effect start[STARTS + 1];
    int count = starting_effects(scan, c, rotor_length(&states->state[c->home].job.rotor), start);
    for (int s = 0; s < count; s++) {
        struct states extended;
        rotid_fit_result *fit = NULL;
        int status = states_with_effect(pool, states, x, &start[s], c->cause, c->fixed, c->in, &extended);
        if (!status)
            status = refit_states(pool, &extended, number, holdout, environment, &fit);
        if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED)
            return status;
        if (status)
            continue;
        double before = refit->chi2;
        status = keep_best(pool, &extended, c, fit, refit);
        if (!status && moves_mesh(&states->state[c->home].job, c->cause) && refit->chi2 < fmin(before, scan->chi2 - PROMISES))
            status = refit_held(pool, number, holdout, environment, refit);
        if (status)
            return status;
    }
    return ROTID_OK;
}

int refit_cause(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
                const double *deck, const struct scan *scan, int candidate, const rotid_environment *environment,
                struct refit refit[2])
{
    const struct scan_candidate *c = &scan->candidate[candidate];
    /* without its cause it is the model that the scan looked at, unless a user has fixed the size, or there is none */
    int nested = cause_has_free_size(c->cause, c->fixed);
    refit[0] = refit[1] = no_refit;
    int status = fit_from(pool, states, number, holdout, x, scan, c, environment, refit);
    if (!status && (!refit->fit || (nested && refit->chi2 > scan->chi2 + REFIT_WORSE)))
        status = fit_from(pool, states, number, holdout, deck, scan, c, environment, refit);
    for (int i = 0; i < 2 && nested && !status; i++)
        if (refit[i].fit && refit[i].chi2 > scan->chi2 + REFIT_WORSE) {
            rotid_fit_free(refit[i].fit);
            refit[i] = no_refit;
        }
    return status;
}
