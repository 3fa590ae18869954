#include "suggest/plan.h"

#include <math.h>
#include <string.h>

#include "diagnose/bootstrap.h"
#include "diagnose/detectable.h"
#include "suggest/planned.h"

#define MOST_COUNTED 24  /* sensors; beyond that a plan is no longer the question */
#define SPREAD       0.5 /* of the distance of that many sensors spread evenly: where there are many they come nearer */
#define LEAST_MODES  2
#define MOST_MODES   8 /* of the list: a hammer seldom excites more */

struct planning {
    struct pool *pool;
    const struct design *design;
    const struct places *places;
    int modes;
    double nothing; /* value of the frequencies alone */
    rotid_suggestion *out;
};

/* Of standard deviations, geometric mean over moduli and a cause, for a value that is higher by `more`. */
static double factor(const struct design *d, double more)
{
    return exp(-more / (2 * (d->nparam + (d->ntarget > 0))));
}

static int half_widths(struct planning *p, int modes, const int *taken, double *half_width)
{
    int n = p->design->nparam;
    struct information information = {.gram = POOL_ARRAY(p->pool, double, (size_t)n *(size_t)n)};
    if (!information.gram)
        return ROTID_ERROR_MEMORY;
    int status = design_information(p->pool, p->design, modes, taken, 1, &information);
    return status ? status : design_half_widths(p->pool, n, information.gram, half_width);
}

static double widest(int n, const double *half_width)
{
    double most = n ? 0 : (double)NAN;
    for (int i = 0; i < n && isfinite(most); i++)
        most = isfinite(half_width[i]) ? fmax(most, half_width[i]) : (double)NAN;
    return most;
}

static int add_plan(struct planning *p, const char *method, int *taken)
{
    const struct places *places = p->places;
    rotid_sensor_plan *plan = &p->out->plans[p->out->nplans++];
    int count = 0, i = 0;
    double whole, value;
    *plan = (rotid_sensor_plan){.method = method};
    for (int k = 0; k < places->n; k++)
        count += taken[k];
    plan->nz_m = POOL_LIST(p->pool, plan->z_m, count);
    plan->nloss_percent = POOL_LIST(p->pool, plan->loss_percent, count);
    plan->nhalf_width_percent = POOL_LIST(p->pool, plan->half_width_percent, p->design->nparam);
    int status = p->pool->out_of_memory ? ROTID_ERROR_MEMORY : half_widths(p, p->modes, taken, plan->half_width_percent);
    if (!status)
        status = design_value(p->pool, 1, p->design, p->modes, taken, &whole);
    for (int k = 0; k < places->n && !status; k++) {
        if (!taken[k])
            continue;
        taken[k] = 0;
        status = design_value(p->pool, 1, p->design, p->modes, taken, &value);
        taken[k] = 1;
        plan->z_m[i] = places->z[k];
        plan->loss_percent[i++] = 100 * (1 / factor(p->design, whole - value) - 1);
    }
    if (!status)
        plan->gain_percent = 100 * (1 - factor(p->design, whole - p->nothing));
    return status;
}

static int count_one(void *context, const int *taken)
{
    struct planning *p = context;
    rotid_suggestion *out = p->out;
    double value, *half_width = POOL_ARRAY(p->pool, double, p->design->nparam);
    int status = half_width ? half_widths(p, p->modes, taken, half_width) : ROTID_ERROR_MEMORY;
    if (!status)
        status = design_value(p->pool, 1, p->design, p->modes, taken, &value);
    if (status)
        return status;
    rotid_sensor_count *count = &out->counts[out->ncounts++];
    *count = (rotid_sensor_count){out->ncounts, widest(p->design->nparam, half_width),
                                  100 * (1 - factor(p->design, value - p->nothing))};
    if (out->sensors_needed == ROTID_NONE && count->half_width_percent <= out->wanted_percent)
        out->sensors_needed = count->sensors;
    return ROTID_OK;
}

static int list_modes(struct planning *p, const int *first)
{
    rotid_suggestion *out = p->out;
    int n = p->design->nparam, most = p->design->nmode < MOST_MODES ? p->design->nmode : MOST_MODES, status = ROTID_OK;
    if (!POOL_LIST(p->pool, out->modes, MOST_MODES))
        return ROTID_ERROR_MEMORY;
    for (int m = LEAST_MODES; m <= most && !status; m++) {
        rotid_expected_modes *row = &out->modes[out->nmodes++];
        row->modes = m;
        row->nfrequencies_percent = POOL_LIST(p->pool, row->frequencies_percent, n);
        row->nshapes_percent = POOL_LIST(p->pool, row->shapes_percent, n);
        status = p->pool->out_of_memory ? ROTID_ERROR_MEMORY : half_widths(p, m, NULL, row->frequencies_percent);
        if (!status)
            status = half_widths(p, m, first, row->shapes_percent);
        if (!status && out->modes_needed == ROTID_NONE && n && widest(n, row->frequencies_percent) <= out->wanted_percent)
            out->modes_needed = m;
    }
    return status;
}

static int list_worth(struct planning *p, int *first)
{
    const struct places *places = p->places;
    rotid_suggestion *out = p->out;
    double whole, value;
    int room = POOL_LIST(p->pool, out->places, places->n), status;
    status = room ? design_value(p->pool, 1, p->design, p->modes, first, &whole) : ROTID_ERROR_MEMORY;
    for (int i = 0; i < room && !status; i++) {
        int was = first[i];
        double more = 0;
        if (!was) {
            first[i] = 1;
            status = design_value(p->pool, 1, p->design, p->modes, first, &value);
            first[i] = was;
            more = value - whole;
        }
        out->places[out->nplaces++] =
            (rotid_sensor_place){places->z[i], was ? (double)NAN : 100 * (1 - factor(p->design, more)), NAN};
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------ detection limits */

/* By the scan of a diagnosis, of data that have no noise yet. */
static int list_detectable(struct planning *p, const struct job *job, const double *x, const struct plan_request *request,
                           const int *first)
{
    struct pool *pool = p->pool;
    struct diagnosis *found = POOL_NEW(pool, struct diagnosis);
    struct round_result last = {0};
    struct job test;
    struct state state;
    double *z = POOL_ARRAY(pool, double, p->places->n);
    int *number = POOL_ARRAY(pool, int, p->modes), n = 0;
    if (!found || !z || !number)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < p->places->n; i++)
        if (first[i])
            z[n++] = p->places->z[i];
    for (int k = 0; k < p->modes; k++)
        number[k] = k + 1;
    const struct planned plan = {p->modes, number, request->frequency_std, request->shape_std};
    int status = planned_sensors(pool, job, n, z, &test);
    if (!status)
        status = planned_measure(pool, &test, x, &plan, &test);
    struct states states = states_of(&test, &state);
    if (!status)
        status = scan_run(pool, &states, test.measurement.number, test.measurement.holdout, x, &last.scan);
    if (status || last.scan.dof < 1)
        return status;
    status = bootstrap_run(pool, &last.scan, request->replicates, request->seed, request->threads, request->environment,
                           &last.bootstrap);
    struct engine engine = {.pool = pool, .out = found};
    if (!status)
        status = engine_take_states(&engine, &states);
    if (!status)
        status = detectable_sizes(&engine, &last);
    p->out->ndetectable = found->result.ndetectable;
    p->out->detectable = found->result.detectable;
    return status;
}

/* ------------------------------------------------------------------------------------------------ all of it */

static int count_of(int n, const int *taken)
{
    int count = 0;
    for (int i = 0; i < n; i++)
        count += taken[i];
    return count;
}

/* taken := other, improved, where that is better. */
static int take_better(struct planning *p, double apart, int *other, int *taken)
{
    double value, with;
    int status = design_improve(p->pool, 1, p->design, p->modes, p->places->z, apart, other);
    if (!status)
        status = design_value(p->pool, 1, p->design, p->modes, taken, &value);
    if (!status)
        status = design_value(p->pool, 1, p->design, p->modes, other, &with);
    if (!status && with > value)
        memcpy(taken, other, (size_t)p->places->n * sizeof *taken);
    return status;
}

/* One after the other from none, and by exchanges from the classic and from places spread evenly: none of them alone is always
 * the best. */
static int take_optimal(struct planning *p, int n, double apart, const int *classic, int *taken)
{
    int places = p->places->n, status, *counted = POOL_ARRAY(p->pool, int, places), *other = POOL_ARRAY(p->pool, int, places);
    if (!POOL_LIST(p->pool, p->out->counts, MOST_COUNTED + 1) || !counted || !other)
        return ROTID_ERROR_MEMORY;
    status = design_choose(p->pool, 1, p->design, p->modes, p->places->z, apart, MOST_COUNTED, count_one, p, counted);
    if (!status)
        status = design_choose(p->pool, 1, p->design, p->modes, p->places->z, apart, n, NULL, NULL, taken);
    memcpy(other, classic, (size_t)places * sizeof *other);
    if (!status && count_of(places, classic) == n) /* it has one for each mode at least */
        status = take_better(p, apart, other, taken);
    memset(other, 0, (size_t)places * sizeof *other);
    for (int i = 0; i < n; i++)
        other[(int)((i + 0.5) / n * places)] = 1;
    return status || n > places ? status : take_better(p, apart, other, taken);
}

static int shapes_of(struct planning *p, double **shape)
{
    size_t cells = (size_t)p->places->n * (size_t)p->design->nmode;
    *shape = POOL_ARRAY(p->pool, double, cells);
    for (size_t i = 0; *shape && i < cells; i++)
        (*shape)[i] = p->design->scale[i];
    return *shape ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The places that effective independence begins with keep the same distance: else neighbours that say the same count twice. */
static void start_apart(const struct places *places, double apart, int *taken)
{
    double last = -INFINITY;
    for (int i = 0; i < places->n; i++) {
        taken[i] = places->z[i] - last >= apart * (1 - 1e-9);
        last = taken[i] ? places->z[i] : last;
    }
}

int plan_run(struct pool *pool, const struct job *job, const double *x, const struct places *places,
             const struct plan_request *request, rotid_suggestion *out, int *first)
{
    struct design *design = POOL_NEW(pool, struct design);
    int most = request->modes > MOST_MODES ? request->modes : MOST_MODES, status = ROTID_ERROR_ARGUMENT, deck = 0;
    int *optimal = POOL_ARRAY(pool, int, places->n), *classic = POOL_ARRAY(pool, int, places->n);
    double *shape = NULL, apart = fmin(places->apart, SPREAD / request->sensors * rotor_length(&job->rotor));
    if (!design || !optimal || !classic || !POOL_LIST(pool, out->plans, 3))
        return ROTID_ERROR_MEMORY;
    for (; status == ROTID_ERROR_ARGUMENT && most >= LEAST_MODES; most--) /* a coarse model has fewer */
        status = plan_design(pool, job, x, places, most, request->frequency_std, request->shape_std, design);
    if (status)
        return status;
    struct planning p = {.pool = pool, .design = design, .places = places, .out = out};
    p.modes = out->plan_modes = request->modes < design->nmode ? request->modes : design->nmode;
    out->modes_needed = out->sensors_needed = ROTID_NONE;
    status = design_value(pool, 1, design, p.modes, NULL, &p.nothing);
    for (int i = 0; i < places->n; i++)
        deck += first[i] = places->deck[i];
    if (!status && deck)
        status = add_plan(&p, "deck", first);
    if (!status)
        status = shapes_of(&p, &shape);
    start_apart(places, apart, classic);
    if (!status)
        status = effective_independence(pool, places->n, p.modes, shape, request->sensors, classic);
    if (!status)
        status = take_optimal(&p, request->sensors, apart, classic, optimal);
    if (!status && !deck)
        memcpy(first, optimal, (size_t)places->n * sizeof *first);
    if (!status)
        status = add_plan(&p, "optimal", optimal);
    if (!status)
        status = add_plan(&p, "effective_independence", classic);
    if (!status)
        status = list_modes(&p, first);
    if (!status)
        status = list_worth(&p, first);
    return status || !request->detect ? status : list_detectable(&p, job, x, request, first);
}
