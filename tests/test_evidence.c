/* The evidence of explanations (src/diagnose/laplace.c) beside integrals over a grid of the same likelihood and priors, which
 * share nothing with it but the residual: each within 0.3 in ln Z. The bar on foam, real data. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deck/deck.h"
#include "diagnose/diagnose.h"
#include "support.h"

#define CLOSE  0.3
#define STATED 0.15 /* deviation of ln of a noise that is stated */

static struct job job;
static int number[16], holdout[16];

static void open_bar(double noise_factor)
{
    struct message_list messages;
    char value[2][32];
    snprintf(value[0], sizeof value[0], "%g", 0.003 * noise_factor);
    snprintf(value[1], sizeof value[1], "%g", 0.03 * noise_factor);
    const struct override list[2] = {{"NOISE", "FREQUENCY", value[0], "", NULL}, {"NOISE", "SHAPE", value[1], "", NULL}};
    message_open(&messages, &test_pool);
    if (deck_read(&test_pool, "input/foam_bar.inp", 2, list, &messages, &job))
        fail_msg("%s", messages.count ? messages.item[0].text : "deck");
    job.options.fit.functional = ROTID_LIKELIHOOD;
    job.options.fit.reduction = ROTID_REDUCTION_NONE;
    job.options.fit.derivative = ROTID_NELSON;
    for (int k = 0; k < job.measurement.nmode; k++)
        number[k] = job.measurement.number[k];
    memset(holdout, 0, sizeof holdout);
}

/* The job with a cause at its best values. */
static void fit_with(const char *id, const double *value, struct states *states, struct state *state, rotid_fit_result **fit)
{
    struct job with = job;
    if (id) {
        const struct cause_kind *cause = catalogue_find(id);
        struct effect effect = {.kind = cause->effect, .target = cause->target == TARGET_GROUP ? 0 : -1, .name = "cause"};
        memcpy(effect.value, value, sizeof effect.value);
        assert_status(job_with_effect(&test_pool, &job, NULL, &effect, cause, NULL, &with), ROTID_OK);
    }
    struct job *kept = POOL_NEW(&test_pool, struct job);
    *kept = with;
    *states = states_of(kept, state);
    assert_status(refit_until(&test_pool, states, number, holdout, 0, NULL, fit), ROTID_OK);
    assert_status(states_at(&test_pool, states, (*fit)->x, states), ROTID_OK);
}

static double evidence(const char *id, const double *value, double *log_else, double *x)
{
    struct states states;
    struct state state;
    rotid_fit_result *fit;
    struct evidence_data *data;
    double mean[16], std[16];
    struct evidence e = {.mean = mean, .std = std};
    fit_with(id, value, &states, &state, &fit);
    assert_status(evidence_open(&test_pool, &states, number, holdout, &data), ROTID_OK);
    assert_status(evidence_of_fit(data, &states, job.unknowns.nparameter, fit, 0, NULL, log_else ? &(struct scan){0} : NULL, &e),
                  ROTID_OK);
    if (log_else)
        *log_else = e.log_else;
    memcpy(x, fit->x, (size_t)fit->n * sizeof *x);
    rotid_fit_free(fit);
    return e.log_z;
}

/* ---- the same by a grid */

struct likelihood {
    struct columns columns;
    double *r, *x;
    int nline, nshape; /* rows less the scales */
};

static void open_likelihood(const struct job *at, struct likelihood *l)
{
    assert_status(columns_open(&test_pool, at, number, holdout, NULL, NULL, &l->columns), ROTID_OK);
    l->r = POOL_ARRAY(&test_pool, double, l->columns.nrow);
    l->nline = l->columns.nmode;
    l->nshape = l->columns.nrow - l->nline;
    for (int m = 0; m < l->columns.nmode; m++)
        l->nshape -= l->columns.mode[m].sensors > 0;
}

static double sum_logs(double a, double b)
{
    return a > b ? a + log1p(exp(b - a)) : b + log1p(exp(a - b));
}

/* ln of the integral over both factors of the noise, by points 0.02 deviations apart. */
static double over_noise(double lines, int nline, double shapes, int nshape)
{
    double sum[2] = {-INFINITY, -INFINITY}, step = 0.02 * STATED;
    const double square[2] = {lines, shapes};
    const int count[2] = {nline, nshape};
    for (int part = 0; part < 2; part++)
        for (int i = -400; i <= 400; i++) {
            double a = i * step;
            sum[part] = sum_logs(sum[part], -square[part] * exp(-2 * a) / 2 - count[part] * a - a * a / (2 * STATED * STATED) +
                                                log(step / STATED) - log(2 * acos(-1)) / 2);
        }
    return sum[0] + sum[1];
}

static double log_likelihood(struct likelihood *l, const double *x)
{
    double lines = 0, shapes = 0;
    if (columns_residual(&l->columns, x, l->r))
        return -INFINITY;
    for (int i = 0; i < l->columns.nrow; i++)
        *(i < l->nline ? &lines : &shapes) += l->r[i] * l->r[i];
    return over_noise(lines, l->nline, shapes, l->nshape);
}

struct axis { /* of a grid: x between two values, in ln where `log`; ln of the prior's density over that */
    int points, log;
    double from, to, (*density)(double x);
};

static double over_grid(struct likelihood *l, int n, const struct axis *axis)
{
    double x[8], sum = -INFINITY;
    int total = 1;
    for (int p = 0; p < n; p++)
        total *= axis[p].points;
    for (int i = 0; i < total; i++) {
        double weight = 0;
        for (int p = 0, rest = i; p < n; rest /= axis[p].points, p++) {
            double share = (rest % axis[p].points + 0.5) / axis[p].points, a = axis[p].log ? log(axis[p].from) : axis[p].from,
                   b = axis[p].log ? log(axis[p].to) : axis[p].to, t = a + share * (b - a);
            x[p] = axis[p].log ? exp(t) : t;
            weight += log((b - a) / axis[p].points) + axis[p].density(x[p]);
        }
        sum = sum_logs(sum, weight + log_likelihood(l, x));
    }
    return sum;
}

static double e_lower, e_upper;
static double of_modulus(double x)
{
    (void)x;
    return -log(log(e_upper / e_lower));
}

static double normal(double x, double deviation)
{
    return -x * x / (2 * deviation * deviation) - log(deviation) - log(2 * acos(-1)) / 2;
}

static double of_gradient(double x)
{
    return normal(x, 0.2) - log(erf(0.9 / 0.2 / sqrt(2)));
}

static double heaviest, bar_length;
static double of_mass(double x)
{
    return normal(x, 0.125 * heaviest) + log(2) - log(erf(8 / sqrt(2)));
}

static double of_place(double x)
{
    (void)x;
    return -log(bar_length);
}

static struct axis modulus_axis(double x, double half, int points)
{
    e_lower = job.unknowns.bounds[0].lower;
    e_upper = job.unknowns.bounds[0].upper;
    return (struct axis){points, 1, x * exp(-half), x * exp(half), of_modulus};
}

static void check(const char *what, double laplace, double grid)
{
    print_message("%s: ln Z %.3f, by a grid %.3f\n", what, laplace, grid);
    if (!(fabs(laplace - grid) < CLOSE))
        fail_msg("%s: ln Z %.4f, by a grid %.4f", what, laplace, grid);
}

static void nothing_but_a_modulus(void **state)
{
    double x[8];
    struct likelihood l;
    (void)state;
    for (int noise = 0; noise < 3; noise++) {
        open_bar(noise == 0 ? 1 : noise == 1 ? 1.5 : 0.7);
        double z = evidence(NULL, NULL, NULL, x);
        const struct axis axis[1] = {modulus_axis(x[0], 0.03, 200)};
        open_likelihood(&job, &l);
        check("a modulus", z, over_grid(&l, 1, axis));
    }
}

static void a_size_with_a_sign(void **state)
{
    const double start[EFFECT_MOST_PARAMETERS] = {0.02};
    double x[8];
    struct likelihood l;
    struct states states;
    struct state one;
    rotid_fit_result *fit;
    (void)state;
    open_bar(1);
    double z = evidence("stiffness_gradient", start, NULL, x);
    fit_with("stiffness_gradient", start, &states, &one, &fit);
    const struct axis axis[2] = {modulus_axis(x[0], 0.03, 60), {90, 0, -0.4, 0.4, of_gradient}};
    open_likelihood(&states.state->job, &l);
    check("a gradient", z, over_grid(&l, 2, axis));
    rotid_fit_free(fit);
}

/* A mass that the data hardly want, anywhere: the columns of the scan, over all places. */
static void a_size_at_its_bound(void **state)
{
    const double start[EFFECT_MOST_PARAMETERS] = {0.001, 0.3};
    double x[8], sum = -INFINITY;
    struct likelihood l;
    struct states states, base;
    struct state one, alone;
    struct scan scan;
    rotid_fit_result *fit;
    (void)state;
    open_bar(1);
    double nothing = evidence(NULL, NULL, NULL, x);
    base = states_of(&job, &alone);
    assert_status(scan_run(&test_pool, &base, number, holdout, x, &scan), ROTID_OK);
    for (int i = 0; i < scan.ncandidate; i++) {
        const struct scan_candidate *c = &scan.candidate[i];
        for (int k = c->first; k < c->first + c->count && !strcmp(c->cause->id, "added_mass"); k++)
            sum = sum_logs(sum, evidence_of_item(&scan, &job.rotor, k) - log(c->count));
    }
    fit_with("added_mass", start, &states, &one, &fit);
    heaviest = states.bounds[1].upper;
    bar_length = states.bounds[2].upper;
    const struct axis axis[3] = {
        modulus_axis(x[0], 0.015, 12), {30, 0, 0, 0.02 * heaviest, of_mass}, {48, 0, 0, bar_length, of_place}};
    open_likelihood(&states.state->job, &l);
    check("a mass, by its columns", nothing + sum, over_grid(&l, 3, axis));
    rotid_fit_free(fit);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_test_pool, close_test_pool)

/* What a cause that is an approximation leaves is noise behind it, in arrays of its own. */
static void what_an_approximation_leaves_is_noise(void **state)
{
    (void)state;
    static const int in_all[] = {1};
    double frequency[] = {1e-4, NAN}, shape[] = {0.01, NAN, 0.02, 0.03}, any[4] = {0};
    const struct candidate cone = {.cause = catalogue_find("step_stiffness"), .in = in_all},
                           exact = {.cause = catalogue_find("density"), .in = in_all};
    struct state one = {
        .job = {.rotor.nsensor = 2, .measurement = {.nmode = 2, .frequency_std = frequency, .shape_std = shape, .shape = any}}};
    struct states with = {.nstate = 1, .state = &one};
    const struct job_measurement *m = &one.job.measurement;
    assert_status(discrepancy_add(&test_pool, &exact, &with), ROTID_OK);
    assert_ptr_equal(m->frequency_std, frequency);
    assert_status(discrepancy_add(&test_pool, &cone, &with), ROTID_OK);
    assert_close(m->frequency_std[0], hypot(1e-4, cone.cause->discrepancy_frequency), 1e-14, 0);
    assert_close(m->shape_std[3], hypot(0.03, cone.cause->discrepancy_shape), 1e-14, 0);
    assert_true(isnan(m->frequency_std[1]) && isnan(m->shape_std[1])); /* what is not measured stays so */
    assert_close(frequency[0], 1e-4, 0, 0);                            /* others may have the same arrays */
}

int main(void)
{
    const struct CMUnitTest tests[] = {TEST(nothing_but_a_modulus), TEST(a_size_with_a_sign), TEST(a_size_at_its_bound),
                                       TEST(what_an_approximation_leaves_is_noise)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
