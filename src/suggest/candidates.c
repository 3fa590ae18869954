#include "suggest/suggest.h"

#define OWN_RANGE 1e3 /* bounds of what has a value of its own in a state, from its start */

int joint_measurement(struct pool *pool, const struct rival *a, const double *x, const struct test *test, int coarse,
                      struct job_measurement *measured)
{
    int n = a->job.unknowns.nparameter;
    const struct planned plan = {test->modes, test->number, test->frequency_std, test->nsensor ? test->shape_std : 0, coarse};
    double *x_test = POOL_ARRAY(pool, double, n);
    int *own = POOL_ARRAY(pool, int, n);
    struct job job;
    int status = x_test && own ? test_apply(pool, test, &a->job, x, &job, x_test, own) : ROTID_ERROR_MEMORY;
    if (!status)
        status = planned_measure(pool, &job, x_test, &plan, &job);
    if (!status)
        *measured = job.measurement;
    return status;
}

/* The state of the test behind those of the rival, its unknowns those of the rival's home but for the ones of its own, which
 * follow in states->bounds. */
static int open_state(struct pool *pool, const struct rival *b, const struct test *test, const struct job_measurement *measured,
                      struct states *states)
{
    const struct state *home = &b->states.state[b->home];
    struct state *state = &states->state[states->nstate - 1];
    int n = b->job.unknowns.nparameter, *own = POOL_ARRAY(pool, int, n);
    double *x = POOL_ARRAY(pool, double, n);
    *state = (struct state){.name = "test", .ncommon = n, .unknown = POOL_ARRAY(pool, int, n)};
    int status = own && x && state->unknown ? test_apply(pool, test, &b->job, b->x, &state->job, x, own) : ROTID_ERROR_MEMORY;
    rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, n);
    if (status || !bounds)
        return status ? status : ROTID_ERROR_MEMORY;
    state->job.measurement = *measured;
    for (int p = 0; p < n; p++) {
        bounds[p] = b->job.unknowns.bounds[p];
        state->unknown[p] = state_unknown(home, p);
        if (!own[p])
            continue;
        bounds[p] = (rotid_parameter){.name = pool_format(pool, "test:%s", bounds[p].name),
                                      .unit = bounds[p].unit,
                                      .lower = x[p] / OWN_RANGE,
                                      .upper = x[p] * OWN_RANGE,
                                      .start = x[p]};
        if (!bounds[p].name)
            return ROTID_ERROR_MEMORY;
        state->unknown[p] = states->nparameter;
        states->bounds[states->nparameter++] = bounds[p];
    }
    state->job.unknowns.bounds = bounds;
    return ROTID_OK;
}

int joint_chi2(struct pool *pool, const struct rival *b, const struct test *test, const struct job_measurement *measured,
               const rotid_environment *environment, double *chi2)
{
    int n = b->states.nparameter, count = b->states.nstate + 1;
    struct states states = {.nstate = count,
                            .state = POOL_ARRAY(pool, struct state, count),
                            .nparameter = n,
                            .bounds = POOL_ARRAY(pool, rotid_parameter, 2 * n)};
    struct identification *out = POOL_ARRAY(pool, struct identification, count);
    rotid_fit_result *fit = NULL;
    struct message_list quiet;
    message_open(&quiet, pool);
    if (!states.state || !states.bounds || !out)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s + 1 < count; s++) {
        states.state[s] = b->states.state[s];
        states.state[s].name = states.state[s].name ? states.state[s].name : "measured";
    }
    for (int p = 0; p < n; p++)
        states.bounds[p] = b->states.bounds[p];
    int status = open_state(pool, b, test, measured, &states);
    if (!status)
        status = identify_states(pool, &states, 0, environment, &quiet, out, &fit);
    if (status)
        return status;
    if (fit->status == ROTID_STOP_CANCELLED)
        status = ROTID_STOP_CANCELLED;
    *chi2 = fit->chi2;
    rotid_fit_free(fit);
    return status;
}

#define MOST_OF_SET 3 /* rivals, of which all pairs are taken */

static int one_pair(struct pool *pool, struct pool *scratch, const struct rivals *rivals, const struct rival *a,
                    const struct rival *b, const struct places *places, double frequency_std, double shape_std, struct design *d)
{
    struct columns *c = POOL_NEW(scratch, struct columns);
    const struct planned plan = {rivals->nmode, rivals->number, frequency_std, shape_std, 1};
    struct job source, job;
    int n = b->fit->n, used = 0, q = 0;
    for (int p = 0; p < n; p++)
        used += rival_uses(b, p);
    int status = c ? planned_sensors(scratch, &a->job, places->n, places->z, &source) : ROTID_ERROR_MEMORY;
    if (!status)
        status = planned_measure(scratch, &source, a->x, &plan, &source);
    if (!status)
        status = planned_sensors(scratch, &b->job, places->n, places->z, &job);
    if (status)
        return status;
    job.measurement = source.measurement;
    status = planned_on_coarse(scratch, &job);
    if (!status)
        status = columns_open(scratch, &job, job.measurement.number, job.measurement.holdout, NULL, b->x, c);
    if (!status)
        status = columns_prepare(c, NULL);
    if (!status)
        status = design_new(pool, rivals->nmode, places->n, 0, used, 1, d);
    if (status)
        return status;
    d->targets_alone = 1;
    rival_gram(b, NULL, used, d->prior);
    for (int p = 0; p < n && !status; p++) {
        double *column = d->column + (ptrdiff_t)q * c->nrow;
        if (!rival_uses(b, p))
            continue;
        int own = rival_own(b, p);
        if (own >= 0)
            status = columns_parameter(c, own, column);
        for (int i = 0; i < c->nrow && own >= 0; i++)
            column[i] *= b->x[own];
        double *own_prior = &d->prior[q + (ptrdiff_t)q * used];
        *own_prior = *own_prior > 0 ? *own_prior * (1 + 1e-9) : 1; /* a direction that the data leave open; a parameter, 100 % */
        q++;
    }
    memcpy(d->column + (ptrdiff_t)used * c->nrow, c->r, (size_t)c->nrow * sizeof *c->r);
    design_take_shapes(c, d);
    return status;
}

/* design [ndesign]: the target is what rival b lacks where a is true, in the same test again at all the places, the parameters
 * are those of b with what is measured as prior; for the pairs of the best of the set, both ways, beside the model as it is where
 * there is one alone. None where the modes of such a pair have no partner. Statuses of memory and cancellation only. */
static int pair_designs(struct pool *pool, const struct rivals *rivals, const struct places *places, double frequency_std,
                        double shape_std, int *ndesign, struct design **design)
{
    int set = rivals->n - 1, most = set > MOST_OF_SET ? MOST_OF_SET : set;
    *ndesign = 0;
    *design = POOL_ARRAY(pool, struct design, (size_t)(most + 1) * (size_t)(most + 1));
    if (!*design)
        return ROTID_ERROR_MEMORY;
    for (int a = 0; a < most; a++)
        for (int b = 0; b < (set > 1 ? most : 2); b++) {
            if (a == b)
                continue;
            struct pool scratch; /* the models of a pair go before those of the next one come */
            pool_open(&scratch, pool->allocator);
            int status = one_pair(pool, &scratch, rivals, &rivals->rival[a], &rivals->rival[b], places, frequency_std, shape_std,
                                  *design + *ndesign);
            pool_close(&scratch);
            if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED)
                return status;
            *ndesign += !status;
        }
    return ROTID_OK;
}

#define MOST_TESTS    16
#define MASS_PLACES   9
#define MORE_MODES    2
#define LEAST_MORE    4 /* sensors that are added, and most */
#define MOST_MORE     12
#define AVERAGES      4    /* measurements of a point that halve its noise */
#define MOVED         0.1  /* of the length */
#define SAME_ENTROPY  0.05 /* that is worth no cost */
#define MOST_REFITTED 3    /* tests */
#define MOST_BESIDE   2    /* rivals of the best one */

static const double mass_share[] = {0.05, 0.15}; /* of the rotor */

struct judging {
    struct pool *pool;
    const struct places *places;
    const rotid_suggest_options *options;
    const rotid_environment *environment;
    struct suggestion *out;
    int ndesign;
    struct design *design; /* of pairs of rivals, at the places */
};

static int stage(const struct judging *j, const char *what, int step)
{
    environment_progress(j->environment, what, step);
    return environment_cancelled(j->environment) ? ROTID_STOP_CANCELLED : ROTID_OK;
}

/* What is measured so far, once more. */
static int test_again(struct judging *j, enum test_kind kind, struct test *t)
{
    const struct rivals *rivals = &j->out->rivals;
    const struct job *job = &rivals->rival[rivals->n - 1].job;
    int shapes = job_fits_shapes(job);
    double *z = POOL_ARRAY(j->pool, double, job->rotor.nsensor);
    *t = (struct test){.kind = kind,
                       .modes = rivals->nmode,
                       .number = POOL_ARRAY(j->pool, int, rivals->nmode + MORE_MODES),
                       .sensor = z,
                       .nsensor = shapes ? job->rotor.nsensor : 0,
                       .frequency_std = j->options->frequency_noise,
                       .shape_std = j->options->shape_noise,
                       .z = NAN,
                       .mass = NAN,
                       .setups = 1,
                       .averages = 1};
    if (!t->number || !z)
        return ROTID_ERROR_MEMORY;
    memcpy(t->number, rivals->number, (size_t)rivals->nmode * sizeof *t->number);
    for (int s = 0; s < job->rotor.nsensor; s++)
        z[s] = job->rotor.sensor[s].position;
    return ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------ one test */

static int compare_tests(const void *left, const void *right)
{
    const rotid_suggested_test *a = *(const rotid_suggested_test *const *)left, *b = *(const rotid_suggested_test *const *)right;
    double x = floor(a->entropy / SAME_ENTROPY + 0.5), y = floor(b->entropy / SAME_ENTROPY + 0.5);
    if (x != y)
        return (x > y) - (x < y);
    if (a->cost != b->cost)
        return (a->cost > b->cost) - (a->cost < b->cost);
    return (a->entropy > b->entropy) - (a->entropy < b->entropy);
}

/* The frequencies that the best rival expects, for the comments of the deck. */
static int expect_hz(struct pool *pool, const struct rival *best, struct test *t)
{
    struct job_measurement measured;
    int status = joint_measurement(pool, best, best->x, t, 0, &measured);
    t->hz = status ? NULL : measured.frequency_hz;
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
}

static int add_test(struct judging *j, struct test *t)
{
    rotid_suggestion *out = &j->out->result;
    rotid_suggested_test *made = &out->tests[out->ntests];
    int feasible, status = out->ntests < MOST_TESTS ? stage(j, "test", out->ntests + 1) : ROTID_ERROR_ARGUMENT;
    *made = (rotid_suggested_test){.id = test_id(t->kind),
                                   .text = test_text(j->pool, &j->out->rivals.rival[0].job, t),
                                   .setups = t->setups,
                                   .points = (t->nsensor ? t->nsensor : 1) * t->averages,
                                   .modes = t->modes,
                                   .mass_kg = t->mass,
                                   .z_m = t->z};
    made->cost = t->setups * j->options->set_up_cost + made->points;
    made->nsensors_m = POOL_LIST(j->pool, made->sensors_m, t->nsensor);
    if (status || !made->text || !made->sensors_m)
        return status ? status : ROTID_ERROR_MEMORY;
    for (int s = 0; s < t->nsensor; s++)
        made->sensors_m[s] = t->sensor[s];
    status = margin_judge(j->pool, &j->out->rivals, t, (unsigned long)j->options->seed, made, &feasible);
    if (status || !feasible)
        return status;
    j->out->test[out->ntests++] = *t;
    return ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------ kinds */

static int add_modes(struct judging *j)
{
    int status = ROTID_OK;
    for (int more = 1; more <= MORE_MODES && !status; more++) {
        struct test t;
        status = test_again(j, TEST_MODES, &t);
        int highest = 0;
        for (int k = 0; k < t.modes && !status; k++)
            highest = t.number[k] > highest ? t.number[k] : highest;
        for (int i = 1; i <= more && !status; i++)
            t.number[t.modes++] = highest + i;
        if (!status)
            status = add_test(j, &t);
    }
    return status;
}

/* Points that tell the rivals apart, beside those that were measured or instead of none. */
static int add_sensors(struct judging *j)
{
    const struct places *places = j->places;
    struct test t;
    int status = test_again(j, TEST_SENSORS, &t), *taken = POOL_ARRAY(j->pool, int, places->n), n = 0;
    double *z = POOL_ARRAY(j->pool, double, places->n);
    if (status || !taken || !z)
        return status ? status : ROTID_ERROR_MEMORY;
    int more = t.nsensor < LEAST_MORE ? LEAST_MORE : t.nsensor > MOST_MORE ? MOST_MORE : t.nsensor;
    for (int i = 0; i < places->n && t.nsensor; i++)
        taken[i] = places->deck[i];
    t.kind = t.nsensor ? TEST_SENSORS : TEST_SHAPES;
    n = t.nsensor ? t.nsensor + more : j->options->sensors;
    status = design_choose(j->pool, j->ndesign, j->design, j->design[0].nmode, places->z, places->apart, n, NULL, NULL, taken);
    for (int i = n = 0; i < places->n; i++)
        if (taken[i])
            z[n++] = places->z[i];
    t.nsensor = n;
    t.sensor = z;
    return status || !j->ndesign ? status : add_test(j, &t);
}

static int add_noise(struct judging *j)
{
    struct test t;
    int status = test_again(j, TEST_NOISE, &t);
    t.averages = AVERAGES;
    t.shape_std /= 2;
    return status || !t.nsensor ? status : add_test(j, &t);
}

/* How well a mass there tells the rivals apart: the least ln(1 + distance), over the truths by their shares. */
static int mass_worth(struct judging *j, const struct test *t, double *worth)
{
    const struct rivals *rivals = &j->out->rivals;
    int n = rivals->n, feasible = 1;
    struct pool scratch;
    pool_open(&scratch, j->pool->allocator);
    double *distance = POOL_ARRAY(&scratch, double, (size_t)n *(size_t)n);
    int status = distance ? margin_distances(&scratch, rivals, t, distance, &feasible) : ROTID_ERROR_MEMORY;
    status = scratch.out_of_memory ? ROTID_ERROR_MEMORY : status;
    *worth = 0;
    for (int a = 0; a + 1 < n && !status && feasible; a++) {
        double least = INFINITY;
        for (int b = 0; b < n; b++)
            least = b == a || (b == n - 1 && b > 1) ? least : fmin(least, distance[b + (ptrdiff_t)a * n]);
        *worth += rivals->rival[a].share * log1p(least);
    }
    pool_close(&scratch);
    return status;
}

static int add_masses(struct judging *j)
{
    const struct rivals *rivals = &j->out->rivals;
    const struct rotor *rotor = &rivals->rival[rivals->n - 1].job.rotor;
    double length = rotor_length(rotor), weight = rotor_mass(rotor), best = 0, z = length / 2;
    struct test t;
    int status = test_again(j, TEST_MASS, &t);
    t.setups = 2;
    for (int i = 0; i < MASS_PLACES && !status; i++) {
        double worth;
        t.mass = mass_share[0] * weight;
        t.z = length * (i + 0.5) / MASS_PLACES;
        status = mass_worth(j, &t, &worth);
        if (worth > best) {
            best = worth;
            z = t.z;
        }
    }
    for (size_t m = 0; m < sizeof mass_share / sizeof *mass_share && !status; m++) {
        t.mass = mass_share[m] * weight;
        t.z = z;
        status = add_test(j, &t);
    }
    return status;
}

static int add_supports(struct judging *j)
{
    const struct rivals *rivals = &j->out->rivals;
    const struct rotor *rotor = &rivals->rival[rivals->n - 1].job.rotor;
    static const enum test_kind kinds[] = {TEST_STIFF, TEST_FREE, TEST_MOVED};
    double length = rotor_length(rotor);
    int stiffest = 0, status = ROTID_OK;
    for (int s = 0; s < rotor->nspring; s++)
        stiffest = rotor->spring[s].lateral > rotor->spring[stiffest].lateral ? s : stiffest;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds && rotor->nspring && !status; i++) {
        struct test t;
        status = test_again(j, kinds[i], &t);
        t.setups = kinds[i] == TEST_FREE ? 2 : 3;
        t.spring = stiffest;
        if (kinds[i] == TEST_MOVED) {
            double at = rotor->spring[stiffest].position;
            t.z = at + (at < length / 2 ? MOVED : -MOVED) * length;
        }
        if (!status)
            status = add_test(j, &t);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------ all of them */

/* What one more sensor raises the distance of the rivals by, in the same test again. */
static int list_margins(struct judging *j)
{
    rotid_suggestion *out = &j->out->result;
    int n = j->places->n, *taken = POOL_ARRAY(j->pool, int, n), status = taken ? ROTID_OK : ROTID_ERROR_MEMORY;
    double whole, value;
    for (int i = 0; i < n && !status; i++)
        taken[i] = j->places->deck[i];
    if (!status && j->ndesign)
        status = design_value(j->pool, j->ndesign, j->design, j->design[0].nmode, taken, &whole);
    for (int i = 0; i < n && i < out->nplaces && !status && j->ndesign; i++) {
        if (taken[i])
            continue;
        taken[i] = 1;
        status = design_value(j->pool, j->ndesign, j->design, j->design[0].nmode, taken, &value);
        taken[i] = 0;
        out->places[i].margin_percent = 100 * expm1(value - whole);
    }
    return status;
}

static int rank(struct judging *j)
{
    rotid_suggestion *out = &j->out->result;
    int n = out->ntests, status = ROTID_OK;
    const rotid_suggested_test **order = POOL_ARRAY(j->pool, const rotid_suggested_test *, n);
    rotid_suggested_test *sorted = POOL_ARRAY(j->pool, rotid_suggested_test, n);
    struct test *test = POOL_ARRAY(j->pool, struct test, n);
    if (!order || !sorted || !test)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < n; i++)
        order[i] = &out->tests[i];
    qsort((void *)order, (size_t)n, sizeof *order, compare_tests);
    for (int i = 0; i < n && !status; i++) {
        sorted[i] = *order[i];
        test[i] = j->out->test[order[i] - out->tests];
        status = expect_hz(j->pool, &j->out->rivals.rival[0], &test[i]);
    }
    out->tests = sorted;
    j->out->test = test;
    return status;
}

/* The linear margins of the best rival in the first tests beside those of nonlinear fits; of a solid these would take too long.
 */
static int refit_first(struct judging *j)
{
    const struct rivals *rivals = &j->out->rivals;
    rotid_suggestion *out = &j->out->result;
    int status = ROTID_OK, solid = rivals->rival[0].job.options.solid;
    for (int i = 0; i < out->ntests && i < MOST_REFITTED && !solid && !status; i++)
        for (int k = 0; k < out->tests[i].nmargins && !status; k++) {
            rotid_expected_margin *m = &out->tests[i].margins[k];
            const struct rival *b = &rivals->rival[m->rival];
            struct job_measurement measured;
            struct pool scratch;
            double chi2;
            if (m->truth || m->rival > MOST_BESIDE)
                continue;
            pool_open(&scratch, j->pool->allocator);
            status = joint_measurement(&scratch, &rivals->rival[0], rivals->rival[0].x, &j->out->test[i], 0, &measured);
            if (!status)
                status = joint_chi2(&scratch, b, &j->out->test[i], &measured, j->environment, &chi2);
            status = scratch.out_of_memory ? ROTID_ERROR_MEMORY : status;
            pool_close(&scratch);
            if (!status)
                m->refitted = m->before + chi2 - b->fit->chi2;
            status = status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
        }
    return status;
}

int candidates_judge(struct pool *pool, const struct places *places, const rotid_suggest_options *options,
                     const rotid_environment *environment, struct suggestion *out)
{
    struct judging j = {pool, places, options, environment, out, 0, NULL};
    struct test again;
    if (!POOL_LIST(pool, out->result.tests, MOST_TESTS))
        return ROTID_ERROR_MEMORY;
    out->test = POOL_ARRAY(pool, struct test, MOST_TESTS);
    int status = out->test ? test_again(&j, TEST_AGAIN, &again) : ROTID_ERROR_MEMORY;
    if (!status)
        status = add_test(&j, &again);
    if (!status)
        status = stage(&j, "places of sensors", 1);
    if (!status)
        status = pair_designs(pool, &out->rivals, places, options->frequency_noise, options->shape_noise, &j.ndesign, &j.design);
    if (!status && j.ndesign)
        status = list_margins(&j);
    if (!status && j.ndesign)
        status = add_sensors(&j);
    if (!status)
        status = add_modes(&j);
    if (!status)
        status = add_noise(&j);
    if (!status)
        status = add_masses(&j);
    if (!status)
        status = add_supports(&j);
    if (!status)
        status = rank(&j);
    return status ? status : refit_first(&j);
}
