#include "running/running.h"

#define SPEEDS 25   /* at which the modes are looked at in a search */
#define BEYOND 1.1  /* times the highest measured speed: how far a search goes at least */
#define FAR    0.02 /* of a critical speed: a step that is linearised again */
#define STEPS  6

/* The machine at one point of a fit. */
struct point {
    struct pool pool;
    int is_open;
    double *x; /* [machine_unknowns] */
    struct search search;
    struct critical *critical; /* [nrunup] of each reading; speed NaN where it was not found */
};

struct runup {
    struct pool *pool;
    const struct states *states; /* without the unknowns of the machine */
    const struct machine *machine;
    const struct job *job;
    struct joint_more more;
    struct point anchor; /* the start, whose mesh the others share */
    int out_of_memory;   /* in an evaluation, which a minimiser takes for a point without a model */
    int at;              /* which of the points is the last one where every reading has a critical speed */
    struct point point[2];
    struct message_list quiet;
};

/* Which unknown of the fit of all states unknown p of the machine is. */
static int of_all(const struct runup *r, int p)
{
    int at_rest = r->job->unknowns.nparameter;
    return p < at_rest ? state_unknown(&r->states->state[0], p) : r->states->nparameter + p - at_rest;
}

/* The critical speeds of a machine up to all that were measured. */
static int search_all(struct pool *pool, struct message_list *notes, struct search *s)
{
    int most[2] = {0, 0};
    double highest = 0;
    for (int i = 0; i < s->machine->nrunup; i++) {
        const struct runup_reading *reading = &s->machine->runup[i];
        most[reading->backward] = reading->number > most[reading->backward] ? reading->number : most[reading->backward];
        highest = fmax(highest, reading->speed);
    }
    return search_until(pool, BEYOND * highest, most[0], most[1], notes, s);
}

static int search_anew(struct runup *r, struct point *p, struct message_list *notes)
{
    int lost = 0, status = search_all(&p->pool, notes, &p->search);
    for (int i = 0; i < r->machine->nrunup && !status; i++) {
        const struct critical *found = search_find(&p->search, r->machine->runup[i].number, r->machine->runup[i].backward);
        p->critical[i].speed = NAN;
        if (found)
            p->critical[i] = *found;
        lost += !found;
    }
    return status ? status : lost;
}

static int open_point(struct runup *r, const double *x, struct point *p)
{
    int n = machine_unknowns(r->machine, r->job);
    if (p->is_open)
        pool_close(&p->pool);
    pool_open(&p->pool, r->pool->allocator);
    p->is_open = 1;
    p->x = POOL_ARRAY(&p->pool, double, n);
    p->critical = POOL_ARRAY(&p->pool, struct critical, r->machine->nrunup);
    if (!p->x || !p->critical)
        return ROTID_ERROR_MEMORY;
    for (int q = 0; q < n; q++)
        p->x[q] = x[of_all(r, q)];
    p->search = (struct search){.machine = r->machine, .job = r->job, .harmonic = 1, .count = SPEEDS};
    return machine_nominal(&p->pool, r->machine, p->x, &p->search.values);
}

/* From the point before by the modes there. How many readings are left without a critical speed, or a status below 0. */
static int carry(struct runup *r, const struct point *from, struct point *to)
{
    int failed, lost = 0;
    to->search.basis = from->search.basis;
    int status = system_build(&to->pool, r->machine, r->job, &to->search.values, &r->anchor.search.system, &to->search.basis,
                              &to->search.system, &failed);
    for (int i = 0; i < r->machine->nrunup && !status; i++) {
        to->critical[i].speed = from->critical[i].speed;
        if (pair_new(&to->pool, to->search.system.size, &to->critical[i].pair))
            return ROTID_ERROR_MEMORY;
        lost += critical_carry(&from->search.system, &from->critical[i], 1, &to->search.system, &to->critical[i]) ||
                (system_at(&to->search.system, to->critical[i].speed), pair_left(&to->search.system, 0, &to->critical[i].pair));
    }
    return status ? status : lost;
}

static int residual(void *user, const double *x, double *out)
{
    struct runup *r = user;
    struct point *here = &r->point[1 - r->at];
    int status = open_point(r, x, here);
    r->out_of_memory |= status != ROTID_OK;
    if (status)
        return status;
    int lost = carry(r, &r->point[r->at], here);
    if (lost && lost != ROTID_ERROR_MEMORY) {
        message_open(&r->quiet, &here->pool);
        status = open_point(r, x, here);
        lost = status ? status : search_anew(r, here, &r->quiet);
    }
    r->out_of_memory |= lost == ROTID_ERROR_MEMORY;
    if (lost == ROTID_ERROR_MEMORY)
        return lost;
    for (int i = 0; i < r->machine->nrunup; i++) {
        const struct runup_reading *reading = &r->machine->runup[i];
        out[i] = lost < 0 ? (double)NAN : (here->critical[i].speed - reading->speed) / reading->std;
    }
    if (!lost)
        r->at = 1 - r->at;
    return ROTID_OK;
}

static int jacobian(void *user, const double *x, int rows, double *out)
{
    struct runup *r = user;
    struct pool scratch;
    int n = machine_unknowns(r->machine, r->job), nrunup = r->machine->nrunup, moved = 0, status = ROTID_OK;
    pool_open(&scratch, r->pool->allocator);
    double *gradient = POOL_ARRAY(&scratch, double, (size_t)nrunup *(size_t)n), *again = POOL_ARRAY(&scratch, double, nrunup);
    for (int q = 0; q < n; q++)
        moved |= r->point[r->at].x[q] != x[of_all(r, q)];
    if (!gradient || !again || moved)
        status = gradient && again ? residual(r, x, again) : ROTID_ERROR_MEMORY;
    struct point *p = &r->point[r->at];
    if (!status)
        status = bands_gradient(&scratch, &p->search, nrunup, p->critical, gradient, NULL);
    for (int q = 0; q < n && !status; q++)
        for (int i = 0; i < nrunup; i++)
            out[i + (ptrdiff_t)rows * of_all(r, q)] += p->critical[i].speed * gradient[q + (ptrdiff_t)n * i] /
                                                       (machine_by_logarithm(r->machine, r->job, q) ? p->x[q] : 1) /
                                                       r->machine->runup[i].std;
    pool_close(&scratch);
    r->out_of_memory |= status == ROTID_ERROR_MEMORY;
    return status;
}

static int join_bounds(struct pool *pool, const struct states *states, struct states *joined)
{
    const struct machine *machine = states->machine;
    rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, states->nparameter + machine->nunknown);
    if (!bounds)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < states->nparameter; p++)
        bounds[p] = states->bounds[p];
    for (int p = 0; p < machine->nunknown; p++)
        bounds[states->nparameter + p] = machine->unknown[p].bounds;
    joined->bounds = bounds;
    joined->nparameter = states->nparameter + machine->nunknown;
    return ROTID_OK;
}

static void refuse_reading(const struct runup *r, struct message_list *notes)
{
    const struct point *p = &r->anchor;
    const struct search *s = &p->search;
    for (int i = 0; i < r->machine->nrunup; i++) {
        const struct runup_reading *reading = &r->machine->runup[i];
        if (isfinite(p->critical[i].speed))
            continue;
        message_at(
            notes, SEVERITY_ERROR, reading->place,
            "the model has %d critical speeds with %s whirl up to %.0f rpm, expected number %d of *RUNUP to be one of them",
            search_count(s, reading->backward), reading->backward ? "backward" : "forward", s->speed[s->count - 1] / RPM,
            reading->number);
    }
}

int runup_join(struct pool *pool, const struct states *states, struct message_list *notes, struct states *joined,
               struct runup **runup)
{
    const struct machine *machine = states->machine;
    *joined = *states;
    *runup = NULL;
    if (!machine || !machine->nrunup || machine->runup_held)
        return ROTID_OK;
    struct runup *r = *runup = POOL_NEW(pool, struct runup);
    double *start = POOL_ARRAY(pool, double, states->nparameter + machine->nunknown);
    if (!r || !start || join_bounds(pool, states, joined))
        return ROTID_ERROR_MEMORY;
    *r = (struct runup){.pool = pool, .states = states, .machine = machine, .job = &states->state[0].job};
    r->more = (struct joint_more){machine->nrunup, r, residual, jacobian};
    joined->more = &r->more;
    for (int p = 0; p < joined->nparameter; p++)
        start[p] = joined->bounds[p].start;
    int status = open_point(r, start, &r->anchor);
    if (!status)
        status = search_anew(r, &r->anchor, notes);
    if (status > 0) {
        refuse_reading(r, notes);
        return ROTID_ERROR_ARGUMENT;
    }
    if (!status)
        status = open_point(r, start, &r->point[0]);
    if (!status)
        status = carry(r, &r->anchor, &r->point[0]);
    return status > 0 ? ROTID_ERROR_EIGEN : status;
}

int runup_close(struct runup *runup)
{
    struct point *const all[] = {runup ? &runup->point[0] : NULL, runup ? &runup->point[1] : NULL, runup ? &runup->anchor : NULL};
    for (int i = 0; i < 3 && runup; i++)
        if (all[i]->is_open)
            pool_close(&all[i]->pool);
    return runup && runup->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

int runup_identify(struct pool *pool, const struct states *states, const rotid_environment *environment,
                   struct message_list *notes, struct identification *out, rotid_fit_result **fit)
{
    struct states joined;
    struct runup *runup;
    int status = runup_join(pool, states, notes, &joined, &runup);
    if (!status)
        status = identify_states(pool, &joined, 0, environment, notes, out, fit);
    return runup_close(runup) ? ROTID_ERROR_MEMORY : status;
}

/* ---- beside the model */

/* The critical speeds that were measured, those of them that the machine has. */
struct reached {
    struct search search;
    int count, *reading; /* [count] which they are of */
    struct critical *critical;
    double *gradient;   /* [n * count] G', of ln W by u */
    double *spread;     /* [n * count] C G' */
    double *covariance; /* [count^2] G C G' and that by what is no unknown */
};

/* At x [machine_unknowns]; fit: of these, C in u about its own x. Statuses of search_until and bands_gradient. */
static int reach(struct pool *pool, const struct machine *machine, const struct job *job, const double *x,
                 const rotid_fit_result *fit, struct message_list *notes, struct reached *r)
{
    int n = machine_unknowns(machine, job), most = machine->nrunup;
    size_t room = (size_t)most * (size_t)n;
    *r = (struct reached){.search = {.machine = machine, .job = job, .harmonic = 1, .count = SPEEDS},
                          .reading = POOL_ARRAY(pool, int, most),
                          .critical = POOL_ARRAY(pool, struct critical, most),
                          .gradient = POOL_ARRAY(pool, double, room),
                          .spread = POOL_ARRAY(pool, double, room),
                          .covariance = POOL_ARRAY(pool, double, most *most)};
    if (!r->reading || !r->critical || !r->gradient || !r->spread || !r->covariance)
        return ROTID_ERROR_MEMORY;
    int status = machine_nominal(pool, machine, x, &r->search.values);
    if (!status)
        status = search_all(pool, notes, &r->search);
    for (int i = 0; i < most && !status; i++) {
        const struct critical *own = search_find(&r->search, machine->runup[i].number, machine->runup[i].backward);
        if (own) {
            r->critical[r->count] = *own;
            r->reading[r->count++] = i;
        }
    }
    if (!status)
        status = bands_gradient(pool, &r->search, r->count, r->critical, r->gradient, r->covariance);
    for (int p = 0; p < n && !status; p++)
        for (int q = 0; q < n; q++) {
            double c = machine_covariance(machine, job, fit, p, q);
            for (int i = 0; i < r->count && isfinite(fit->std[p]) && isfinite(fit->std[q]); i++)
                r->spread[p + (ptrdiff_t)n * i] += c * r->gradient[q + (ptrdiff_t)n * i];
        }
    for (int i = 0; i < r->count && !status; i++)
        for (int k = 0; k < r->count; k++)
            r->covariance[i + (ptrdiff_t)r->count * k] +=
                product_dot(n, r->gradient + (ptrdiff_t)n * i, r->spread + (ptrdiff_t)n * k);
    return status;
}

int runup_compare(struct pool *pool, const struct machine *machine, const struct job *job, const double *x,
                  const rotid_fit_result *fit, struct message_list *notes, int *count, rotid_runup_speed **list)
{
    struct reached r;
    *count = 0;
    if (!machine->nrunup)
        return ROTID_OK;
    int status = reach(pool, machine, job, x, fit, notes, &r);
    if (!status)
        *count = POOL_LIST(pool, *list, machine->nrunup);
    if (!status && !*count)
        return ROTID_ERROR_MEMORY;
    for (int i = 0, next = 0; i < *count; i++) {
        const struct runup_reading *reading = &machine->runup[i];
        int found = next < r.count && r.reading[next] == i;
        double predicted = found ? r.critical[next].speed : NAN,
               std = found ? predicted * sqrt(fmax(0, r.covariance[next * (r.count + (ptrdiff_t)1)])) : NAN;
        next += found;
        (*list)[i] = (rotid_runup_speed){.number = reading->number,
                                         .whirl = reading->backward ? "backward" : "forward",
                                         .measured_rpm = reading->speed / RPM,
                                         .measured_std = reading->std / RPM,
                                         .predicted_rpm = predicted / RPM,
                                         .predicted_std = std / RPM,
                                         .z = (reading->speed - predicted) /
                                              (machine->runup_held ? hypot(reading->std, std) : reading->std),
                                         .holdout = machine->runup_held};
    }
    return status;
}

/* ---- of explanations */

/* The machine of states with causes besides those of the deck, and what their fit says of its unknowns. */
static int explained(struct pool *pool, const struct states *deck, const struct states *states, const rotid_fit_result *fit,
                     struct machine *machine, rotid_fit_result *mine)
{
    struct states own = *states;
    const struct rotor *rotor = &states->state[0].job.rotor;
    int known = deck->state[0].job.rotor.neffect, *without = POOL_ARRAY(pool, int, rotor->neffect);
    *machine = *deck->machine;
    if (!without)
        return ROTID_ERROR_MEMORY;
    for (int e = 0; e < rotor->neffect; e++)
        without[e] = e < known ? machine->without_effect[e] : effect_is_of_test(&rotor->effect[e], rotor);
    machine->without_effect = without;
    own.machine = machine;
    return machine_fit(pool, &own, fit, mine);
}

int runup_explain(struct pool *pool, const struct states *deck, const struct states *states, const rotid_fit_result *fit,
                  struct message_list *notes, int *count, rotid_runup_speed **list)
{
    struct machine machine;
    rotid_fit_result mine;
    int status = explained(pool, deck, states, fit, &machine, &mine);
    machine.runup_held = 1;
    return status ? status : runup_compare(pool, &machine, &states->state[0].job, mine.x, &mine, notes, count, list);
}

/* The normal at rest: the deviations of the deck's unknowns are those of the evidence, and what the machine alone has is open. */
static void prepare(const struct machine *machine, const struct state *state, int nown, const double *std, rotid_fit_result *fit)
{
    int n = fit->n, at_rest = state->job.unknowns.nparameter;
    for (int p = 0; p < at_rest; p++) {
        int q = state_unknown(state, p);
        double wider = q < nown && fit->std[p] > 0 && std[q] > 0 ? std[q] / fit->std[p] : 1;
        if (!isfinite(wider))
            continue;
        fit->std[p] *= wider;
        for (int i = 0; i < n; i++) {
            fit->covariance[p + (ptrdiff_t)n * i] *= wider;
            fit->covariance[i + (ptrdiff_t)n * p] *= wider;
        }
    }
    for (int p = at_rest; p < n; p++) {
        const rotid_parameter *bounds = machine_bounds(machine, &state->job, p);
        double range = bounds->lower > 0 ? fit->x[p] * log(bounds->upper / bounds->lower) : bounds->upper - bounds->lower;
        for (int i = 0; i < n; i++)
            fit->covariance[p + (ptrdiff_t)n * i] = fit->covariance[i + (ptrdiff_t)n * p] = 0;
        fit->std[p] = range * exp(-LN_2PI / 2);
        fit->covariance[p * (n + (ptrdiff_t)1)] = fit->std[p] * fit->std[p];
    }
}

/* S and v at a point that was reached from `start`; S := its Cholesky factor, gain := S^-1 v. Returns 0, or 1 where S is none. */
static int innovate(const struct reached *r, int n, const double *start, const double *x, double *factor, double *v, double *gain,
                    double *log_determinant)
{
    int count = r->count;
    for (int i = 0; i < count; i++) {
        const struct runup_reading *reading = &r->search.machine->runup[r->reading[i]];
        double relative = reading->std / reading->speed;
        v[i] = log(reading->speed / r->critical[i].speed);
        for (int p = 0; p < n; p++)
            v[i] += r->gradient[p + (ptrdiff_t)n * i] *
                    (machine_by_logarithm(r->search.machine, r->search.job, p) ? log(x[p] / start[p]) : x[p] - start[p]);
        for (int k = 0; k < count; k++)
            factor[i + (ptrdiff_t)count * k] = r->covariance[i + (ptrdiff_t)count * k] + (i == k ? relative * relative : 0);
        gain[i] = v[i];
    }
    if (cholesky_factor(count, factor))
        return 1;
    cholesky_solve(count, factor, 1, gain);
    *log_determinant = 0;
    for (int i = 0; i < count; i++)
        *log_determinant += 2 * log(factor[i * (count + (ptrdiff_t)1)]);
    return 0;
}

/* u := u0 + C G' gain within the bounds. Returns the largest motion of a critical speed, relative. */
static double take_step(const struct reached *r, int n, const double *start, const double *gain, double *x, double *moved)
{
    double most = 0;
    for (int p = 0; p < n; p++) {
        const rotid_parameter *bounds = machine_bounds(r->search.machine, r->search.job, p);
        double by = 0, was = x[p];
        for (int i = 0; i < r->count; i++)
            by += r->spread[p + (ptrdiff_t)n * i] * gain[i];
        x[p] = fmin(
            fmax(machine_by_logarithm(r->search.machine, r->search.job, p) ? start[p] * exp(by) : start[p] + by, bounds->lower),
            bounds->upper);
        moved[p] = machine_by_logarithm(r->search.machine, r->search.job, p) ? log(x[p] / was) : x[p] - was;
    }
    for (int i = 0; i < r->count; i++)
        most = fmax(most, fabs(product_dot(n, r->gradient + (ptrdiff_t)n * i, moved)));
    return most;
}

int runup_learn(struct pool *pool, const struct states *deck, const struct states *states, const rotid_fit_result *fit, int nown,
                double *mean, double *std, double *log_z, double *chi2)
{
    const struct state *state = &states->state[0];
    struct machine machine;
    struct message_list quiet;
    struct reached r;
    rotid_fit_result mine = {0};
    int most = deck->machine->nrunup, status = explained(pool, deck, states, fit, &machine, &mine), n = mine.n;
    double *x = POOL_ARRAY(pool, double, 2 * n), *v = POOL_ARRAY(pool, double, 2 * most),
           *factor = POOL_ARRAY(pool, double, most *most), determinant = 0, moved;
    if (!status && (!x || !v || !factor))
        status = ROTID_ERROR_MEMORY;
    if (status)
        return status;
    prepare(&machine, state, nown, std, &mine);
    memcpy(x, mine.x, (size_t)n * sizeof *x);
    message_open(&quiet, pool);
    *log_z = -INFINITY;
    *chi2 = NAN;
    int step = 0;
    do {
        status = reach(pool, &machine, &state->job, x, &mine, &quiet, &r);
        if (status || r.count < most)
            return status;
        if (innovate(&r, n, mine.x, x, factor, v, v + most, &determinant))
            return ROTID_ERROR_FINITE;
        moved = take_step(&r, n, mine.x, v + most, x, x + n);
    } while (++step < STEPS && moved > FAR);
    *chi2 = product_dot(most, v, v + most);
    *log_z = -(*chi2 + determinant + most * LN_2PI) / 2;
    for (int p = 0; p < state->job.unknowns.nparameter; p++) {
        int q = state_unknown(state, p);
        double less = 0, scale = machine_by_logarithm(&machine, &state->job, p) ? mine.x[p] : 1;
        if (q >= nown || !(mine.std[p] > 0))
            continue;
        for (int i = 0; i < most; i++)
            v[i] = r.spread[p + (ptrdiff_t)n * i];
        cholesky_forward(most, factor, 1, v);
        less = product_dot(most, v, v) * scale * scale;
        mean[q] += x[p] - mine.x[p];
        std[q] = sqrt(fmax(0, mine.std[p] * mine.std[p] - less));
    }
    return ROTID_OK;
}
