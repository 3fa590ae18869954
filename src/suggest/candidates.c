#include "suggest/candidates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "suggest/joint_fit.h"
#include "suggest/margin.h"
#include "suggest/pair_design.h"

#define MOST_TESTS    16
#define MASS_PLACES   9
#define MORE_MODES    2
#define LEAST_MORE    4 /* sensors that are added, and most */
#define MOST_MORE     12
#define AVERAGES      4    /* measurements of a point that halve its noise */
#define MOVED         0.1  /* of the length */
#define SAME_CHANCE   0.05 /* that is worth no cost */
#define MOST_REFITTED 3    /* tests */
#define MOST_BESIDE   2    /* rivals of the best one */
#define DRAWS         400  /* a chance to 0.025 */

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
    const rotid_environment *e = j->environment;
    if (e && e->progress)
        e->progress(e->context, what, step);
    return e && e->cancelled && e->cancelled(e->context) ? ROTID_STOP_CANCELLED : ROTID_OK;
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
    double x = floor(a->chance / SAME_CHANCE + 0.5), y = floor(b->chance / SAME_CHANCE + 0.5);
    if (x != y)
        return (x < y) - (x > y);
    if (a->cost != b->cost)
        return (a->cost > b->cost) - (a->cost < b->cost);
    return (a->chance < b->chance) - (a->chance > b->chance);
}

/* The frequencies that the best rival expects, for the comments of the deck. */
static int expect_hz(struct pool *pool, const struct rival *best, struct test *t)
{
    double *x = POOL_ARRAY(pool, double, best->job.unknowns.nparameter);
    int *own = POOL_ARRAY(pool, int, best->job.unknowns.nparameter);
    struct job job;
    const struct planned plan = {t->modes, t->number, t->frequency_std, 0};
    if (!x || !own)
        return ROTID_ERROR_MEMORY;
    int status = test_apply(pool, t, &best->job, best->x, &job, x, own);
    if (!status)
        status = planned_measure(pool, &job, x, &plan, &job);
    t->hz = status ? NULL : job.measurement.frequency_hz;
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
    status = margin_judge(j->pool, &j->out->rivals, t, DRAWS, (unsigned long)j->options->seed, made, &feasible);
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
    int status = ROTID_OK, feasible = 1;
    double *distance = POOL_ARRAY(j->pool, double, rivals->n);
    *worth = 0;
    if (!distance)
        return ROTID_ERROR_MEMORY;
    for (int a = 0; a + 1 < rivals->n && !status && feasible; a++) {
        double least = INFINITY;
        struct pool scratch;
        pool_open(&scratch, j->pool->allocator);
        status = margin_distances(&scratch, rivals, t, a, distance, &feasible);
        status = scratch.out_of_memory ? ROTID_ERROR_MEMORY : status;
        pool_close(&scratch);
        for (int b = 0; b < rivals->n && feasible; b++)
            least = b == a || (b == rivals->n - 1 && b > 1) ? least : fmin(least, distance[b]);
        *worth += feasible ? rivals->rival[a].share * log1p(least) : 0;
    }
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
            status = joint_measurement(&scratch, &rivals->rival[0], rivals->rival[0].x, &j->out->test[i], &measured);
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
