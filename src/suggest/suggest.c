#include "suggest/suggest.h"
#include "fit/fit.h"

/* Where sensors could stand, and what they would say there: columns of parameters and of the causes of the catalogue. */

#define MOST_PLACES  100
#define APART        0.02 /* of the length: nearer sensors share their noise, and seldom fit beside each other */
#define CAUSE_PLACES 9    /* where a cause that has a place is looked for */

static const struct effect_kind plan_design_nothing = {.id = "none"};

/* The nodes of the axis of the job's model, at most about a hundred, and its sensors. Statuses of model_open. */
static int places_find(struct pool *pool, const struct job *job, struct places *places)
{
    const struct rotor *rotor = &job->rotor;
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    int failed, status = model ? model_open(pool, job->models, rotor, 0, NULL, 1, model, &failed) : ROTID_ERROR_MEMORY;
    if (status)
        return status;
    int stride = (model->naxis + MOST_PLACES - 1) / MOST_PLACES, *sensor = POOL_ARRAY(pool, int, model->naxis);
    *places = (struct places){.z = POOL_ARRAY(pool, double, model->naxis),
                              .deck = POOL_ARRAY(pool, int, model->naxis),
                              .apart = APART * rotor_length(rotor)};
    if (!places->z || !places->deck || !sensor)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < rotor->nsensor; s++) { /* a sensor near a node is read there: no other one has room */
        int node = 0;
        for (int i = 1; i < model->naxis; i++)
            if (fabs(model->z[i] - rotor->sensor[s].position) < fabs(model->z[node] - rotor->sensor[s].position))
                node = i;
        sensor[node] = s + 1;
    }
    for (int i = 0; i < model->naxis; i++) {
        if (!sensor[i] && i % stride)
            continue;
        places->deck[places->n] = sensor[i] > 0;
        places->z[places->n++] = sensor[i] ? rotor->sensor[sensor[i] - 1].position : model->z[i];
    }
    return ROTID_OK;
}

/* Effects at neutral whose sizes are the targets, with the size worth looking for. */
struct targets {
    int n;
    struct effect *effect;
    int *size;
    double *typical;
};

static int list_targets(struct pool *pool, const struct job *job, struct targets *t)
{
    struct scan scan;
    struct state state;
    const struct states states = states_of(job, &state);
    int status = scan_list(pool, &states, &scan);
    double length = rotor_length(&job->rotor);
    if (status)
        return status;
    size_t room = (size_t)scan.ncandidate * CAUSE_PLACES;
    *t = (struct targets){0, POOL_ARRAY(pool, struct effect, room), POOL_ARRAY(pool, int, room), POOL_ARRAY(pool, double, room)};
    if (!t->effect || !t->size || !t->typical)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < scan.ncandidate; i++) {
        const struct scan_candidate *c = &scan.candidate[i];
        const struct cause_kind *cause = c->cause;
        double typical = cause->parameter[cause->size].typical - cause->parameter[cause->size].neutral, lower, upper;
        if (c->suspect || cause->solid || cause->secant || !cause->effect->nparameter || cause->target == TARGET_SENSOR ||
            typical == 0)
            continue;
        int places = cause->place >= 0 ? CAUSE_PLACES : 1;
        for (int j = 0; j < places; j++) {
            struct effect effect = c->effect;
            if (cause->place >= 0)
                effect.value[cause->place] = length * (j + 0.5) / CAUSE_PLACES;
            if (cause->width >= 0) {
                cause_range(cause, &job->rotor, &effect, cause->width, &lower, &upper);
                effect.value[cause->width] = sqrt(lower * upper);
            }
            t->effect[t->n] = effect;
            t->size[t->n] = cause->size;
            t->typical[t->n++] = typical;
        }
    }
    return ROTID_OK;
}

static double scale_of(const struct job *job, int p, double x)
{
    const rotid_parameter *b = &job->unknowns.bounds[p];
    return x != 0 ? fabs(x) : fmax(fabs(b->lower), fabs(b->upper));
}

static int fill(struct columns *c, const struct job *job, const double *x, const struct targets *t, struct design *d)
{
    int status = ROTID_OK, rows = c->nrow;
    for (int p = 0; p < d->nparam && !status; p++) {
        double *column = d->column + (ptrdiff_t)p * rows;
        status = columns_parameter(c, p, column);
        for (int i = 0; i < rows; i++)
            column[i] *= scale_of(job, p, x[p]);
        d->prior[p + (ptrdiff_t)p * d->nparam] = 1;
    }
    for (int i = 0; i < t->n && !status; i++) {
        double *column = d->column + (ptrdiff_t)(d->nparam + i) * rows;
        status = columns_probe(c, &t->effect[i]);
        if (!status)
            status = columns_parameter(c, d->nparam + t->size[i], column);
        for (int r = 0; r < rows; r++)
            column[r] *= t->typical[i];
    }
    design_take_shapes(c, d);
    return status;
}

/* The columns of the job's parameters at x [nparameter], relative ones with a prior of 100 %, and as targets those of every cause
 * of the catalogue that has a derivative, times the size worth looking for; causes with a place at several. Statuses of
 * columns_open and planned_test. */
static int plan_design(struct pool *pool, const struct job *job, const double *x, const struct places *places,
                       const struct planned *plan, struct design *design)
{
    struct effect none = {.kind = &plan_design_nothing};
    struct columns *c = POOL_NEW(pool, struct columns);
    struct targets targets;
    struct job at;
    int status = c ? planned_test(pool, job, x, places->n, places->z, plan, &at) : ROTID_ERROR_MEMORY;
    if (!status)
        status = list_targets(pool, &at, &targets);
    if (!status)
        status = columns_open(pool, &at, at.measurement.number, at.measurement.holdout, &none, x, c);
    if (!status)
        status = columns_prepare(c, NULL);
    if (!status)
        status = design_new(pool, plan->modes, places->n, c->functional.nwhole, job->unknowns.nparameter, targets.n, design);
    return status ? status : fill(c, &at, x, &targets, design);
}

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

static int count_of(int n, const int *taken)
{
    int count = 0;
    for (int i = 0; i < n; i++)
        count += taken[i];
    return count;
}

static int add_plan(struct planning *p, const char *method, int *taken)
{
    const struct places *places = p->places;
    rotid_sensor_plan *plan = &p->out->plans[p->out->nplans++];
    int count = count_of(places->n, taken), i = 0;
    double whole, value;
    *plan = (rotid_sensor_plan){.method = method};
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
static int list_detectable(struct planning *p, const struct job *job, const double *x, const rotid_suggest_options *o,
                           const int *first)
{
    struct pool *pool = p->pool;
    struct diagnosis *found = POOL_NEW(pool, struct diagnosis);
    struct scan scan = {0};
    struct job test;
    struct state state;
    double *z = POOL_ARRAY(pool, double, p->places->n);
    int n = 0;
    if (!found || !z)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < p->places->n; i++)
        if (first[i])
            z[n++] = p->places->z[i];
    const struct planned plan = {p->modes, NULL, o->frequency_noise, o->shape_noise, 0};
    int status = planned_test(pool, job, x, n, z, &plan, &test);
    struct states states = states_of(&test, &state);
    if (!status)
        status = scan_run(pool, &states, test.measurement.number, test.measurement.holdout, x, SCAN_ALL, &scan);
    if (status || scan.dof < 1)
        return status;
    struct engine engine = {.pool = pool, .out = found};
    status = engine_take_states(&engine, &states);
    if (!status)
        amplitudes_shown(&states, &scan);
    if (!status)
        status = detectable_sizes(&engine, &scan);
    p->out->ndetectable = found->result.ndetectable;
    p->out->detectable = found->result.detectable;
    return status;
}

/* ------------------------------------------------------------------------------------------------ all of it */

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

/* The places that effective independence begins with keep the same distance: else neighbours that say the same count twice. */
static void start_apart(const struct places *places, double apart, int *taken)
{
    double last = -INFINITY;
    for (int i = 0; i < places->n; i++) {
        taken[i] = places->z[i] - last >= apart * (1 - 1e-9);
        last = taken[i] ? places->z[i] : last;
    }
}

/* Fills of *out what concerns plans: modes and what is needed; detect: detection limits as well, by the first plan. Statuses of
 * plan_design, ROTID_STOP_CANCELLED. */
static int plan_run(struct pool *pool, const struct job *job, const double *x, const struct places *places,
                    const rotid_suggest_options *o, int detect, rotid_suggestion *out)
{
    struct design *design = POOL_NEW(pool, struct design);
    struct planned plan = {o->modes > MOST_MODES ? o->modes : MOST_MODES, NULL, o->frequency_noise, o->shape_noise, 0};
    int status = ROTID_ERROR_ARGUMENT, deck = 0, *first = POOL_ARRAY(pool, int, places->n),
        *optimal = POOL_ARRAY(pool, int, places->n), *classic = POOL_ARRAY(pool, int, places->n);
    double apart = fmin(places->apart, SPREAD / o->sensors * rotor_length(&job->rotor));
    if (!design || !first || !optimal || !classic || !POOL_LIST(pool, out->plans, 3))
        return ROTID_ERROR_MEMORY;
    for (; status == ROTID_ERROR_ARGUMENT && plan.modes >= LEAST_MODES; plan.modes--) /* a coarse model has fewer */
        status = plan_design(pool, job, x, places, &plan, design);
    if (status)
        return status;
    struct planning p = {.pool = pool, .design = design, .places = places, .out = out};
    p.modes = out->plan_modes = o->modes < design->nmode ? o->modes : design->nmode;
    out->modes_needed = out->sensors_needed = ROTID_NONE;
    status = design_value(pool, 1, design, p.modes, NULL, &p.nothing);
    for (int i = 0; i < places->n; i++)
        deck += first[i] = places->deck[i];
    if (!status && deck)
        status = add_plan(&p, "deck", first);
    start_apart(places, apart, classic);
    if (!status)
        status = effective_independence(pool, places->n, p.modes, design->scale, o->sensors, classic);
    if (!status)
        status = take_optimal(&p, o->sensors, apart, classic, optimal);
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
    return status || !detect ? status : list_detectable(&p, job, x, o, first);
}

#define LIKELY 0.5 /* chance of a name from which on a test is recommended without more ado */

static const char *needed(struct pool *pool, const rotid_suggestion *r)
{
    if (!r->nparameters)
        return "no interval can be planned: the deck has no *IDENTIFY";
    if (r->modes_needed != ROTID_NONE)
        return pool_text(pool, "the frequencies of modes 1 to %d determine all parameters to %g %%", r->modes_needed,
                         r->wanted_percent);
    if (r->sensors_needed != ROTID_NONE)
        return pool_text(pool, "%d modes with shapes at the %d best points determine all parameters to %g %%", r->plan_modes,
                         r->sensors_needed, r->wanted_percent);
    return pool_text(pool, "no number of modes and sensors that was tried determines all parameters to %g %%: reduce the noise",
                     r->wanted_percent);
}

static const char *plan(struct pool *pool, const rotid_suggestion *r)
{
    const rotid_sensor_plan *best = NULL;
    for (int i = 0; i < r->nplans; i++)
        if (!best || r->plans[i].gain_percent > best->gain_percent)
            best = &r->plans[i];
    const char *where = best ? pool_text(pool, " The plan \"%s\" is best for moduli and causes: shapes at its %d points.",
                                         best->method, best->nz_m)
                             : "";
    return pool_text(pool, "With this noise %s.%s", needed(pool, r), where);
}

static const char *tests(struct pool *pool, const struct suggestion *s)
{
    const rotid_suggestion *r = &s->result;
    const rotid_suggested_test *best = &r->tests[0];
    int causes = r->nrivals - 1, again = 0; /* number of the same test; the best one's where there is none or it is the best */
    for (int i = 0; i < r->ntests; i++)
        if (s->test[i].kind == TEST_AGAIN)
            again = i;
    const rotid_fit_result *fit = s->rivals.rival[0].fit;
    int doubtful = s->rivals.left_out || (fit->dof > 0 && chi_square_tail(fit->chi2, fit->dof) < JUDGED);
    const char *unless = doubtful ? "If one of these rivals is the true one: " : "Next: ";
    const char *who = causes > 1 ? pool_text(pool, "the true one of the %d rivals", causes) : "the one cause that is left";
    const char *instead = again ? pool_text(pool, "; the same test again: %.2f", r->tests[again].chance) : "";
    if (best->chance < LIKELY)
        return pool_text(
            pool,
            "%sno single test that was tried is likely to name %s; the best is %s, with a chance of %.2f at a cost of "
            "%.3g points%s.",
            unless, who, best->text, best->chance, best->cost, instead);
    return pool_text(pool, "%smeasure %s: %s is then named with a chance of %.2f, at a cost of %.3g points%s.", unless,
                     best->text, who, best->chance, best->cost, instead);
}

static const char *advice_sentence(struct pool *pool, const struct suggestion *s)
{
    const rotid_suggestion *r = &s->result;
    if (!s->found.base.fit)
        return plan(pool, r);
    if (r->ntests)
        return tests(pool, s);
    const char *open = s->rivals.left_out ? "No test of this kind distinguishes the explanations that are left"
                       : s->found.result.verdict.kind == ROTID_UNEXPLAINED
                           ? "No cause of the catalogue explains the data: there are no causes to distinguish by a test"
                           : "The diagnosis is settled: no cause is left to distinguish";
    return pool_text(pool, "%s. %s", open, plan(pool, r));
}

#define WANTED_PERCENT  2.0
#define FREQUENCY_NOISE 0.003 /* as a diagnosis assumes it */
#define SHAPE_NOISE     0.02  /* of a hammer test with care */
#define SET_UP_COST     20.0  /* points: an hour beside some minutes each */
#define SENSORS         8
#define MODES           5

/* Median of those that are finite; 0 without any. */
static double median(struct pool *pool, ptrdiff_t n, const double *value)
{
    double *known = POOL_ARRAY(pool, double, n);
    size_t count = 0;
    for (ptrdiff_t i = 0; known && i < n; i++)
        if (isfinite(value[i]))
            known[count++] = value[i];
    return count ? median_of(count, known) : 0;
}

/* What the deck and the user leave open. */
static void settle(struct pool *pool, const struct job *job, rotid_suggest_options *o, rotid_noise *noise)
{
    const struct job_measurement *m = &job->measurement;
    int fitted = job_fitted(job, m->holdout);
    if (!(o->frequency_noise > 0))
        o->frequency_noise = m->nmode ? median(pool, m->nmode, m->frequency_std) : m->stated_frequency_noise;
    if (!(o->shape_noise > 0))
        o->shape_noise = m->shape && m->shape_std ? median(pool, (ptrdiff_t)m->nmode * job->rotor.nsensor, m->shape_std)
                                                  : m->stated_shape_noise;
    *noise = (rotid_noise){.frequency_assumed = !(o->frequency_noise > 0), .shape_assumed = !(o->shape_noise > 0)};
    o->frequency_noise = noise->frequency = o->frequency_noise > 0 ? o->frequency_noise : FREQUENCY_NOISE;
    o->shape_noise = noise->shape = o->shape_noise > 0 ? o->shape_noise : SHAPE_NOISE;
    o->wanted_percent = o->wanted_percent > 0 ? o->wanted_percent : WANTED_PERCENT;
    o->set_up_cost = o->set_up_cost > 0 ? o->set_up_cost : SET_UP_COST;
    o->sensors = o->sensors > 0 ? o->sensors : job->rotor.nsensor ? job->rotor.nsensor : SENSORS;
    o->modes = o->modes > 0 ? o->modes : fitted > 1 ? fitted : MODES;
    o->threads = o->threads > 0 ? o->threads : 1;
    o->seed = o->seed > 0 ? o->seed : 1;
}

static int list_parameters(struct pool *pool, struct suggestion *out)
{
    rotid_suggestion *r = &out->result;
    const rotid_fit_result *fit = out->found.extended.fit ? out->found.extended.fit : out->found.base.fit;
    int n = POOL_LIST(pool, r->parameters, out->job.unknowns.nparameter);
    for (int q = 0; q < n; q++) {
        const rotid_parameter *b = &out->job.unknowns.bounds[q];
        int p = state_unknown(&out->home, q);
        rotid_fitted_parameter *to = &r->parameters[r->nparameters++];
        *to = (rotid_fitted_parameter){.name = b->name,
                                       .unit = b->unit,
                                       .value = out->x[q],
                                       .start = b->start,
                                       .lower = b->lower,
                                       .upper = b->upper,
                                       .std = fit ? fit->std[p] : (double)NAN,
                                       .ci95 = {fit ? fit->ci_lower[p] : (double)NAN, fit ? fit->ci_upper[p] : (double)NAN},
                                       .at_bound = fit ? fit->at_bound[p] : 0,
                                       .identifiable = fit ? fit->identifiable[p] : 1};
    }
    return n == out->job.unknowns.nparameter ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int take_home(struct pool *pool, const struct states *states, int home, const double *x, struct suggestion *out)
{
    out->home = states->state[home];
    out->job = out->home.job;
    out->x = state_values(pool, &out->home, x);
    return out->x ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Without measurements: the model as the deck states it, its unknowns at their starts. */
static int take_starts(struct pool *pool, const struct states *states, struct suggestion *out)
{
    const double *x = parameter_starts(pool, states->nparameter, states->bounds);
    return x ? take_home(pool, states, rivals_home(states), x, out) : ROTID_ERROR_MEMORY;
}

static int take_diagnosis(struct pool *pool, const struct states *states, const rotid_suggest_options *o,
                          const rotid_environment *environment, struct message_list *notes, struct suggestion *out)
{
    const struct diagnose_options options = {.threads = o->threads};
    int status = diagnose_states(pool, states, &options, environment, notes, &out->found);
    if (!status && out->found.result.interrupted)
        return ROTID_STOP_CANCELLED;
    if (status)
        return status;
    const struct diagnosis *d = &out->found;
    const struct states *judged = d->extended.fit ? &d->extended_states : &d->judged;
    int home = rivals_home(judged);
    status = take_home(pool, judged, home, (d->extended.fit ? d->extended : d->base).fit->x, out);
    out->job.models = states->state[home].job.models;
    out->result.verdict = d->result.verdict.sentence;
    out->result.ndetectable = d->result.ndetectable;
    out->result.detectable = d->result.detectable;
    if (!status)
        status = rivals_find(pool, d, &out->rivals);
    for (int i = 0; i < out->rivals.n; i++) {
        struct rival *rival = &out->rivals.rival[i];
        for (int s = 0; s < states->nstate; s++)
            rival->states.state[s].job.models = states->state[s].job.models;
        rival->job.models = out->job.models;
    }
    return status;
}

/* What the chances rest on, and do not hold without. */
static void note_rivals(struct message_list *notes, const struct rivals *rivals)
{
    const rotid_fit_result *best = rivals->n ? rivals->rival[0].fit : NULL;
    if (rivals->left_out)
        message_warn(notes,
                     "%d of the alternatives of the diagnosis %s left out: not among the first %d, no model of this kind, or not "
                     "fitted again; the chances of the tests hold among the others",
                     rivals->left_out, rivals->left_out == 1 ? "is" : "are", MOST_RIVALS);
    if (best && best->dof > 0 && chi_square_tail(best->chi2, best->dof) < JUDGED)
        message_warn(
            notes,
            "the best of the rivals leaves chi2 %.3g for %d degrees of freedom: perhaps none of them is the true one, and "
            "the chances hold only if one is",
            best->chi2, best->dof);
}

static int list_rivals(struct pool *pool, struct suggestion *out)
{
    rotid_suggestion *r = &out->result;
    int n = POOL_LIST(pool, r->rivals, out->rivals.n);
    r->among = n ? out->rivals.among : (double)NAN;
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += exp(-out->rivals.rival[i].score / 2);
    r->entropy = n ? 0 : (double)NAN;
    for (int i = 0; i < n; i++) {
        const struct rival *rival = &out->rivals.rival[i];
        double share = exp(-rival->score / 2) / sum;
        r->entropy -= share > 0 ? share * log(share) : 0;
        r->rivals[r->nrivals++] =
            (rotid_rival){.label = rival->label, .chi2 = rival->fit->chi2, .score = rival->score, .share = rival->share};
    }
    return n == out->rivals.n ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int run(struct pool *pool, const struct states *states, rotid_suggest_options *o, const rotid_environment *environment,
               struct message_list *notes, struct suggestion *out)
{
    rotid_suggestion *r = &out->result;
    struct places places;
    int measured = states_modes(states, states->nstate) > 0,
        status = measured ? take_diagnosis(pool, states, o, environment, notes, out) : take_starts(pool, states, out);
    r->state = out->home.name;
    if (!status)
        settle(pool, &out->job, o, &r->noise);
    r->wanted_percent = o->wanted_percent;
    r->set_up_cost = o->set_up_cost;
    if (!status)
        status = list_parameters(pool, out);
    if (!status)
        status = spectrum_compute_parts(pool, out->job.models, &out->job.rotor, out->job.unknowns.nparameter,
                                        out->job.unknowns.parameter, out->x, ROTID_REDUCTION_NONE, 1, 0, &out->spectrum);
    if (!status)
        status = places_find(pool, &out->job, &places);
    if (status)
        return status;
    status = plan_run(pool, &out->job, out->x, &places, o, !measured, r);
    if (!status)
        status = list_rivals(pool, out);
    if (!status)
        note_rivals(notes, &out->rivals);
    if (!status && out->rivals.n)
        status = candidates_judge(pool, &places, o, environment, out);
    if (status)
        return status;
    r->sentence = advice_sentence(pool, out);
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

int suggest_states(struct pool *pool, const struct states *states, const rotid_suggest_options *options,
                   const rotid_environment *environment, struct message_list *notes, struct suggestion *out)
{
    rotid_suggest_options o = *options;
    struct states mine;
    int begun = 0, status = states_copy(pool, states, &mine);
    *out = (struct suggestion){.result = {.noise = {.frequency = NAN, .shape = NAN}}};
    if (!status && !states->nparameter && !states_modes(states, states->nstate))
        return message_refuse(notes, ROTID_ERROR_ARGUMENT, states->state->job.deck, 1, 1,
                              "the deck has no *IDENTIFY, expected the parameters that a test is to determine");
    for (; begun < states->nstate && !status; begun++) {
        struct job *job = &mine.state[begun].job;
        job->models = models_for_run(pool, job->models);
        status = job->models ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    if (!status)
        status = run(pool, &mine, &o, environment, notes, out);
    for (int s = 0; s < begun; s++)
        if (mine.state[s].job.models)
            models_end_run(pool, mine.state[s].job.models, states->state[s].job.models);
    return status;
}

void suggest_free(struct suggestion *out)
{
    diagnose_free(&out->found);
}
