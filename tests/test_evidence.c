/* The evidence of explanations (src/diagnose/laplace.c) beside integrals over a grid of the same likelihood and priors, which
 * share nothing with it but the residual: each within 0.3 in ln Z. The bar on foam, real data. */
#include "deck/deck.h"
#include "diagnose/diagnose.h"
#include "one_state.h"
#include "support.h"

#define CLOSE  0.3
#define STATED 0.15 /* deviation of ln of a noise that is stated, */
#define WRONG  0.7  /* and of one of the shapes that is stated wrongly, one in ten */

static struct job job;
static int number[16], holdout[16];

static void open_deck(const char *path, int count, const struct override *list)
{
    struct message_list messages;
    message_open(&messages, &test_pool);
    if (deck_read(&test_pool, path, count, list, &messages, &job))
        fail_msg("%s", messages.count ? messages.item[0].text : "deck");
    job.options.fit.functional = ROTID_LIKELIHOOD;
    job.options.fit.reduction = ROTID_REDUCTION_NONE;
    job.options.fit.derivative = ROTID_NELSON;
    memcpy(number, job.measurement.number, (size_t)job.measurement.nmode * sizeof *number);
    memset(holdout, 0, sizeof holdout);
}

static void open_bar(double noise_factor)
{
    char value[2][32];
    snprintf(value[0], sizeof value[0], "%g", 0.003 * noise_factor);
    snprintf(value[1], sizeof value[1], "%g", 0.03 * noise_factor);
    const struct override list[2] = {{"NOISE", "FREQUENCY", value[0], "", NULL}, {"NOISE", "SHAPE", value[1], "", NULL}};
    open_deck("input/foam_bar.inp", 2, list);
}

/* The job with a cause at its best values. */
static void fit_with_fixed(const char *id, const double *value, const int *fixed, struct states *states, struct state *state,
                           rotid_fit_result **fit)
{
    struct job with = job;
    if (id) {
        const struct cause_kind *cause = catalogue_find(id);
        struct effect effect = {.kind = cause->effect, .target = cause->target == TARGET_GROUP ? 0 : -1, .name = "cause"};
        memcpy(effect.value, value, sizeof effect.value);
        assert_status(job_with_effect(&test_pool, &job, NULL, &effect, cause, fixed, &with), ROTID_OK);
    }
    struct job *kept = POOL_NEW(&test_pool, struct job);
    *kept = with;
    *states = states_of(kept, state);
    assert_status(refit_until(&test_pool, states, number, holdout, 0, NULL, fit), ROTID_OK);
    assert_status(states_at(&test_pool, states, (*fit)->x, states), ROTID_OK);
}

static void fit_with(const char *id, const double *value, struct states *states, struct state *state, rotid_fit_result **fit)
{
    fit_with_fixed(id, value, NULL, states, state, fit);
}

static double evidence_fixed(const char *id, const double *value, const int *fixed, double *log_else, double *x)
{
    struct states states;
    struct state state;
    rotid_fit_result *fit;
    struct evidence_data *data;
    double mean[16], std[16];
    struct evidence e = {.mean = mean, .std = std};
    fit_with_fixed(id, value, fixed, &states, &state, &fit);
    assert_status(evidence_open(&test_pool, &states, number, holdout, &data), ROTID_OK);
    assert_status(
        evidence_of_fit(data, &states, job.unknowns.nparameter, fit, 0, NULL, 0, NULL, log_else ? &(struct scan){0} : NULL, &e),
        ROTID_OK);
    if (log_else)
        *log_else = e.log_else;
    memcpy(x, fit->x, (size_t)fit->n * sizeof *x);
    rotid_fit_free(fit);
    return e.log_z;
}

static double evidence(const char *id, const double *value, double *log_else, double *x)
{
    return evidence_fixed(id, value, NULL, log_else, x);
}

/* ---- the same by a grid */

struct likelihood {
    struct columns columns;
    double *r, *x;
    int nline, nshape, end; /* rows less the scales; behind those of the modes */
};

static void open_likelihood(const struct job *at, struct likelihood *l)
{
    assert_status(columns_open(&test_pool, at, number, holdout, NULL, NULL, &l->columns), ROTID_OK);
    l->r = POOL_ARRAY(&test_pool, double, l->columns.nrow);
    l->nline = l->columns.nmode;
    l->end = l->columns.nrow - l->columns.functional.nwhole;
    l->nshape = l->end - l->nline;
    for (int m = 0; m < l->columns.nmode; m++)
        l->nshape -= l->columns.mode[m].sensors > 0;
}

static double sum_logs(double a, double b)
{
    return a > b ? a + log1p(exp(b - a)) : b + log1p(exp(a - b));
}

static double normal(double x, double deviation)
{
    return -x * x / (2 * deviation * deviation) - log(deviation) - log(2 * acos(-1)) / 2;
}

/* ln of the integral over a factor of the noise, by points 0.02 deviations apart; of the shapes it may be stated wrongly. */
static double over_factor(double square, int count, int of_shapes)
{
    double sum = -INFINITY, step = 0.02 * STATED;
    for (int i = -1000; i <= 1000; i++) {
        double a = i * step, prior = normal(a, STATED);
        if (of_shapes)
            prior = sum_logs(log(0.9) + prior, log(0.1) + normal(a, WRONG));
        sum = sum_logs(sum, -square * exp(-2 * a) / 2 - count * a + prior + log(step));
    }
    return sum;
}

/* Of `count` states, whose noise is off by the same factors. */
static double log_likelihood_of(int count, struct likelihood *l, const double *x)
{
    double lines = 0, shapes = 0, whole = 0; /* whose noise is what is stated */
    int nline = 0, nshape = 0;
    for (int s = 0; s < count; s++) {
        if (columns_residual(&l[s].columns, x, l[s].r))
            return -INFINITY;
        for (int i = 0; i < l[s].columns.nrow; i++)
            *(i < l[s].nline ? &lines : i < l[s].end ? &shapes : &whole) += l[s].r[i] * l[s].r[i];
        nline += l[s].nline;
        nshape += l[s].nshape;
    }
    return over_factor(lines, nline, 0) + over_factor(shapes, nshape, nshape > 0) - whole / 2;
}

struct axis { /* of a grid: x between two values, in ln where `log`; ln of the prior's density over that */
    int points, log;
    double from, to, (*density)(double x);
};

static double on_axis(const struct axis *axis, int i)
{
    double share = (i + 0.5) / axis->points;
    return axis->log ? axis->from * pow(axis->to / axis->from, share) : axis->from + share * (axis->to - axis->from);
}

/* The modulus multiplies all frequencies alike, by its root, and leaves the shapes alone: one model for all its values. */
static double over_modulus(struct likelihood *l, double *x, const struct axis *modulus)
{
    double shapes = 0, whole = 0, sum = -INFINITY, step = log(modulus->to / modulus->from) / modulus->points;
    x[0] = modulus->from;
    if (columns_residual(&l->columns, x, l->r))
        return -INFINITY;
    for (int i = l->nline; i < l->columns.nrow; i++)
        *(i < l->end ? &shapes : &whole) += l->r[i] * l->r[i];
    for (int j = 0; j < modulus->points; j++) {
        double lines = 0, factor = exp((j + 0.5) * step / 2);
        for (int i = 0; i < l->nline; i++) {
            double std = job.measurement.frequency_std[l->columns.mode[i].k], r = ((1 + l->r[i] * std) * factor - 1) / std;
            lines += r * r;
        }
        sum = sum_logs(sum, over_factor(lines, l->nline, 0) + modulus->density(0) + log(step));
    }
    return sum + over_factor(shapes, l->nshape, l->nshape > 0) - whole / 2;
}

/* Over all axes, the first of which is the modulus. */
static double over_grid(struct likelihood *l, int n, const struct axis *axis)
{
    double x[8], sum = -INFINITY;
    int total = 1;
    for (int p = 1; p < n; p++)
        total *= axis[p].points;
    for (int i = 0; i < total; i++) {
        double weight = 0;
        for (int p = 1, rest = i; p < n; rest /= axis[p].points, p++) {
            x[p] = on_axis(&axis[p], rest % axis[p].points);
            weight += log((axis[p].log ? log(axis[p].to / axis[p].from) : axis[p].to - axis[p].from) / axis[p].points) +
                      axis[p].density(x[p]);
        }
        sum = sum_logs(sum, weight + over_modulus(l, x, &axis[0]));
    }
    return sum;
}

static double e_lower, e_upper;
static double of_modulus(double x)
{
    (void)x;
    return -log(log(e_upper / e_lower));
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

POOL_TEST(nothing_but_a_modulus)
{
    double x[8];
    struct likelihood l;
    for (int noise = 0; noise < 3; noise++) {
        open_bar(noise == 0 ? 1 : noise == 1 ? 1.5 : 0.7);
        double z = evidence(NULL, NULL, NULL, x);
        const struct axis axis[1] = {modulus_axis(x[0], 0.03, 200)};
        open_likelihood(&job, &l);
        double grid = over_grid(&l, 1, axis);
        check("a modulus", z, grid);
        assert_close(z, grid, 0, 0.02); /* nothing is approximated but the normal about the fit */
    }
}

POOL_TEST(a_size_with_a_sign)
{
    const double start[EFFECT_MOST_PARAMETERS] = {0.02};
    double x[8];
    struct likelihood l;
    struct states states;
    struct state one;
    rotid_fit_result *fit;
    open_bar(1);
    double z = evidence("stiffness_gradient", start, NULL, x);
    fit_with("stiffness_gradient", start, &states, &one, &fit);
    const struct axis axis[2] = {modulus_axis(x[0], 0.03, 60), {90, 0, -0.4, 0.4, of_gradient}};
    open_likelihood(&states.state->job, &l);
    check("a gradient", z, over_grid(&l, 2, axis));
    rotid_fit_free(fit);
}

static double of_profile(double x)
{
    return normal(x, 0.2) - log((erf(0.9 / 0.2 / sqrt(2)) + erf(1.2 / 0.2 / sqrt(2))) / 2);
}

/* Two causes at once, which share what the modes say. */
POOL_TEST(a_pair)
{
    static const char *const id[2] = {"stiffness_gradient", "stiffness_profile"};
    double mean[16], std[16];
    struct evidence e = {.mean = mean, .std = std};
    struct evidence_data *data;
    struct likelihood l;
    struct state one;
    rotid_fit_result *fit;
    open_bar(1);
    struct job with[3] = {job};
    for (int i = 0; i < 2; i++) {
        const struct cause_kind *cause = catalogue_find(id[i]);
        struct effect effect = {.kind = cause->effect, .target = 0, .name = id[i], .value = {0.02}};
        assert_status(job_with_effect(&test_pool, &with[i], NULL, &effect, cause, NULL, &with[i + 1]), ROTID_OK);
    }
    struct states states = states_of(&with[2], &one);
    assert_status(refit_until(&test_pool, &states, number, holdout, 0, NULL, &fit), ROTID_OK);
    assert_status(states_at(&test_pool, &states, fit->x, &states), ROTID_OK);
    assert_status(evidence_open(&test_pool, &states, number, holdout, &data), ROTID_OK);
    assert_status(evidence_of_fit(data, &states, job.unknowns.nparameter, fit, 0, NULL, 0, NULL, NULL, &e), ROTID_OK);
    const struct axis axis[3] = {
        modulus_axis(fit->x[0], 0.02, 16), {30, 0, -0.3, 0.3, of_gradient}, {30, 0, -0.3, 0.3, of_profile}};
    open_likelihood(&states.state->job, &l);
    check("a gradient and a profile", e.log_z, over_grid(&l, 3, axis));
    rotid_fit_free(fit);
}

/* A fit that ended two deviations off its minimum without having converged: its line promises the way back, which is no evidence.
 */
POOL_TEST(what_no_step_brought_is_no_evidence)
{
    double mean[2][16], std[16], ends[2];
    struct evidence_data *data;
    struct states states;
    struct state one;
    rotid_fit_result *fit;
    open_bar(1);
    fit_with(NULL, NULL, &states, &one, &fit);
    assert_status(evidence_open(&test_pool, &states, number, holdout, &data), ROTID_OK);
    double norm = 0, along = 0;
    for (int i = 0; i < fit->nresidual; i++)
        norm += fit->jacobian[i] * fit->jacobian[i];
    for (int i = 0; i < fit->nresidual; i++) {
        fit->r[i] += 2 * fit->jacobian[i] / sqrt(norm);
        along += fit->r[i] * fit->jacobian[i] / sqrt(norm);
    }
    for (int converged = 0; converged < 2; converged++) {
        struct evidence e = {.mean = mean[converged], .std = std};
        fit->converged = converged;
        assert_status(evidence_of_fit(data, &states, job.unknowns.nparameter, fit, 0, NULL, 0, NULL, NULL, &e), ROTID_OK);
        ends[converged] = e.log_stated;
    }
    assert_close(ends[1] - ends[0], along * along / 2, 1e-4, 0);
    assert_close(mean[0][0], fit->x[0], 1e-6, 0);
    assert_close(mean[1][0], fit->x[0] - along / sqrt(norm), 1e-4, 0);
    rotid_fit_free(fit);
}

/* The bar hung twice, with a noise of its own each: both say what its modulus is. */
POOL_TEST(two_states)
{
    double mean[16], std[16], sum = -INFINITY;
    struct evidence e = {.mean = mean, .std = std};
    struct evidence_data *data;
    struct likelihood l[2];
    struct state hung[2];
    rotid_fit_result *fit;
    int numbers[32], out[32] = {0};
    for (int s = 0; s < 2; s++) {
        open_bar(s ? 1.3 : 0.8);
        hung[s] = (struct state){.job = job, .name = s ? "again" : "once"};
        open_likelihood(&hung[s].job, &l[s]);
        memcpy(numbers + s * job.measurement.nmode, number, (size_t)job.measurement.nmode * sizeof *number);
    }
    struct states states = {.nstate = 2, .state = hung, .nparameter = job.unknowns.nparameter, .bounds = job.unknowns.bounds};
    assert_status(refit_until(&test_pool, &states, numbers, out, 0, NULL, &fit), ROTID_OK);
    assert_status(states_at(&test_pool, &states, fit->x, &states), ROTID_OK);
    assert_status(evidence_open(&test_pool, &states, numbers, out, &data), ROTID_OK);
    assert_status(evidence_of_fit(data, &states, job.unknowns.nparameter, fit, 0, NULL, 0, NULL, NULL, &e), ROTID_OK);
    const struct axis axis = modulus_axis(fit->x[0], 0.02, 200);
    for (int i = 0; i < axis.points; i++) {
        double x = axis.from * pow(axis.to / axis.from, (i + 0.5) / axis.points);
        sum = sum_logs(sum, log_likelihood_of(2, l, &x) + of_modulus(x) + log(log(axis.to / axis.from) / axis.points));
    }
    check("a modulus by two states", e.log_z, sum);
    rotid_fit_free(fit);
}

/* States at one point keep their values when they are asked for at another. */
POOL_TEST(states_at_two_points_are_apart)
{
    const double start[EFFECT_MOST_PARAMETERS] = {0.02}, at[2][2] = {{1e9, 0.1}, {1e9, -0.3}};
    struct states states, point[2];
    struct state one;
    rotid_fit_result *fit;
    open_bar(1);
    fit_with("stiffness_gradient", start, &states, &one, &fit);
    for (int i = 0; i < 2; i++)
        assert_status(states_at(&test_pool, &states, at[i], &point[i]), ROTID_OK);
    for (int i = 0; i < 2; i++)
        assert_close(point[i].state->job.rotor.effect[0].value[0], at[i][1], 0, 0);
    rotid_fit_free(fit);
}

/* ln Z of a cause over all its places, by the columns of the scan. */
static double by_columns(const char *id, double *x)
{
    double nothing = evidence(NULL, NULL, NULL, x), sum = -INFINITY;
    struct state alone;
    const struct states base = states_of(&job, &alone);
    struct scan scan;
    assert_status(scan_run(&test_pool, &base, number, holdout, x, SCAN_ALL, &scan), ROTID_OK);
    for (int i = 0; i < scan.ncandidate; i++) {
        const struct scan_candidate *c = &scan.candidate[i];
        for (int k = c->first; k < c->first + c->count && !strcmp(c->cause->id, id); k++)
            sum = sum_logs(sum, evidence_of_item(&scan, &job.rotor, k) - log(c->count));
    }
    return nothing + sum;
}

/* A mass that the data hardly want, anywhere. */
POOL_TEST(a_size_at_its_bound)
{
    const double start[EFFECT_MOST_PARAMETERS] = {0.001, 0.3};
    double x[8];
    struct likelihood l;
    struct states states;
    struct state one;
    rotid_fit_result *fit;
    open_bar(1);
    double columns = by_columns("added_mass", x);
    fit_with("added_mass", start, &states, &one, &fit);
    heaviest = states.bounds[1].upper;
    bar_length = states.bounds[2].upper;
    const struct axis axis[3] = {
        modulus_axis(x[0], 0.015, 12), {30, 0, 0, 0.02 * heaviest, of_mass}, {48, 0, 0, bar_length, of_place}};
    open_likelihood(&states.state->job, &l);
    check("a mass, by its columns", columns, over_grid(&l, 3, axis));
    rotid_fit_free(fit);
}

/* Uniform in ln over three decades, and below in the stiffness itself. */
static double stiffest;
static double of_stiffness(double k)
{
    return -log(1 + 3 * log(10)) - log(fmax(k, 1e-3 * stiffest));
}

static double of_ln_stiffness(double k)
{
    return of_stiffness(k) + log(k);
}

/* A spring to the ground at a known place, a third as stiff as the decades of its prior begin, in frequencies of a tenth of the
 * noise: it is determined to a quarter, so below them is all that counts. */
POOL_TEST(a_size_below_its_decades)
{
    const int fixed[EFFECT_MOST_PARAMETERS] = {0, 1};
    const double start[EFFECT_MOST_PARAMETERS] = {300, 0};
    double x[8];
    struct likelihood l;
    struct states states;
    struct state one;
    struct spectrum spectrum;
    rotid_fit_result *fit;
    open_bar(1);
    fit_with_fixed("support_extra", start, fixed, &states, &one, &fit);
    stiffest = states.bounds[1].upper;
    rotid_fit_free(fit);
    x[0] = job.unknowns.bounds[0].start;
    x[1] = stiffest / 3000;
    assert_status(spectrum_compute(&test_pool, NULL, &states.state->job.rotor, 2, states.state->job.unknowns.parameter, x,
                                   ROTID_GUYAN, number[job.measurement.nmode - 1], &spectrum),
                  ROTID_OK);
    for (int k = 0; k < job.measurement.nmode; k++) {
        job.measurement.frequency_hz[k] = spectrum.full_hz[number[k] - 1];
        job.measurement.frequency_std[k] /= 20;
    }
    double z = evidence_fixed("support_extra", start, fixed, NULL, x);
    fit_with_fixed("support_extra", start, fixed, &states, &one, &fit);
    print_message("k %g +- %g, decades from %g\n", fit->x[1], fit->std[1], stiffest / 1000);
    const struct axis modulus = modulus_axis(x[0], 0.002, 60);
    const struct axis soft[2] = {modulus, {80, 0, 0, 1e-3 * stiffest, of_stiffness}},
                      stiff[2] = {modulus, {40, 1, 1e-3 * stiffest, 0.1 * stiffest, of_ln_stiffness}};
    open_likelihood(&states.state->job, &l);
    check("a soft support", z, sum_logs(over_grid(&l, 2, soft), over_grid(&l, 2, stiff)));
    rotid_fit_free(fit);
}

/* A residual along a column with the drop that is said gains so much by it. */
POOL_TEST(a_gain_has_its_drop)
{
    double x[8];
    struct states base;
    struct state alone;
    struct scan scan;
    int seen = 0;
    open_bar(1);
    (void)evidence(NULL, NULL, NULL, x);
    base = states_of(&job, &alone);
    assert_status(scan_run(&test_pool, &base, number, holdout, x, SCAN_ALL, &scan), ROTID_OK);
    for (int i = 0; i < scan.nitem; i++)
        for (int k = 0; k < 3 && scan.item[i].usable; k++) {
            const struct scan_item *item = &scan.item[i];
            double gain = 2 * pow(3, k), drop = evidence_drop_for(&scan, &job.rotor, i, gain);
            if (!(sqrt(drop) < item->norm * fmax(item->upper, -item->lower)))
                continue;
            assert_true(drop > gain);
            seen++;
            for (int row = 0; row < scan.nrow; row++)
                scan.r[row] = -scan_side(item) * sqrt(drop) * scan.column[row + (ptrdiff_t)i * scan.nrow];
            assert_close(evidence_of_item(&scan, &job.rotor, i), gain, 0, 2e-3);
        }
    assert_true(seen > 100);
}

/* Something else needs the columns of its fields alone, one width of a zone at each place: the same as among all. */
POOL_TEST(fields_have_the_columns_of_a_whole_scan)
{
    double x[8];
    struct states base;
    struct state alone;
    struct scan whole, fields;
    int compared = 0;
    open_bar(1);
    (void)evidence(NULL, NULL, NULL, x);
    base = states_of(&job, &alone);
    assert_status(scan_run(&test_pool, &base, number, holdout, x, SCAN_ALL, &whole), ROTID_OK);
    assert_status(scan_run(&test_pool, &base, number, holdout, x, SCAN_FIELDS, &fields), ROTID_OK);
    assert_int_equal(fields.ncandidate, 2);
    for (int i = 0; i < fields.nitem; i++)
        for (int k = 0; k < whole.nitem; k++) {
            const struct scan_item *one = &fields.item[i], *other = &whole.item[k];
            if (fields.candidate[one->candidate].cause != whole.candidate[other->candidate].cause ||
                memcmp(&one->effect.value, &other->effect.value, sizeof one->effect.value) != 0)
                continue;
            for (int j = 0; j < whole.nrow; j++)
                assert_close(fields.column[j + (ptrdiff_t)i * whole.nrow], whole.column[j + (ptrdiff_t)k * whole.nrow], 1e-12,
                             1e-12);
            compared++;
        }
    assert_int_equal(compared, fields.nitem);
    assert_true(2 * fields.nitem < whole.nitem);
}

/* ---- faults of channels: put right by faults.c, beside integrals over data that are put right here */

/* The fault of an id at a sensor as it is proposed beside the base, its fit, and its evidence. */
static double fault_evidence(const char *id, int sensor, int other, struct candidate *fault)
{
    struct state one;
    struct states states = states_of(&job, &one);
    struct evidence_data *data;
    struct scan scan;
    struct refit refit;
    struct fault_proposal *list = POOL_ARRAY(&test_pool, struct fault_proposal, 200);
    struct fault_column column[2];
    double mean[16], std[16];
    struct evidence e = {.mean = mean, .std = std};
    rotid_fit_result *fit;
    int found = 0, at = 0, count = 0;
    assert_status(refit_until(&test_pool, &states, number, holdout, 0, NULL, &fit), ROTID_OK);
    assert_status(evidence_open(&test_pool, &states, number, holdout, &data), ROTID_OK);
    assert_status(scan_run(&test_pool, &states, number, holdout, fit->x, SCAN_ALL, &scan), ROTID_OK);
    assert_status(faults_propose(&test_pool, &states, number, holdout, fit, data, &scan, 200, list, &found), ROTID_OK);
    while (at < found &&
           (strcmp(list[at].fault.cause->id, id) != 0 || list[at].fault.sensor[0] != sensor || list[at].fault.sensor[1] != other))
        at++;
    assert_true(at < found);
    *fault = list[at].fault;
    assert_status(fault_refit(&test_pool, &states, job.unknowns.nparameter, number, holdout, fit, NULL, fault, &refit, &data),
                  ROTID_OK);
    assert_non_null(refit.fit);
    assert_status(fault_columns(&test_pool, &refit.states, number, holdout, refit.fit, data, fault, column, &count), ROTID_OK);
    assert_status(evidence_of_fit(data, &refit.states, job.unknowns.nparameter, refit.fit, 0, NULL, count, column, NULL, &e),
                  ROTID_OK);
    rotid_fit_free(refit.fit);
    rotid_fit_free(fit);
    return e.log_z + list[at].outside;
}

/* ln Z of the base beside shapes of its own, [nsensor * nmode] and their noise relative to the largest one. */
static double grid_of_shapes(double *shape, double *std, double from, double to)
{
    struct job with = job;
    struct likelihood l;
    with.measurement.shape = shape;
    with.measurement.shape_std = std;
    open_likelihood(&with, &l);
    e_lower = job.unknowns.bounds[0].lower;
    e_upper = job.unknowns.bounds[0].upper;
    const struct axis axis[1] = {{120, 1, from, to, of_modulus}};
    return over_grid(&l, 1, axis);
}

static double *copy_of(const double *values)
{
    size_t count = (size_t)job.rotor.nsensor * (size_t)job.measurement.nmode;
    double *copy = POOL_ARRAY(&test_pool, double, count);
    memcpy(copy, values, count * sizeof *copy);
    return copy;
}

static double largest_of(const double *shape, int k)
{
    double most = 0;
    for (int s = 0; s < job.rotor.nsensor; s++)
        most = fmax(most, isfinite(shape[s + k * job.rotor.nsensor]) ? fabs(shape[s + k * job.rotor.nsensor]) : 0);
    return most;
}

/* What sensor s reads times a factor, with its noise; the noise of all others stays what it is in absolute terms. */
static void multiply(double *shape, double *std, int s, double factor)
{
    for (int k = 0; k < job.measurement.nmode; k++) {
        int n = job.rotor.nsensor;
        double before = largest_of(shape, k);
        shape[s + k * n] *= factor;
        double after = largest_of(shape, k);
        for (int i = 0; i < n; i++)
            std[i + k * n] *= before / after;
        if (isfinite(factor))
            std[s + k * n] *= fabs(factor);
    }
}

#define SENSOR 2

static double modulus_of_base(void)
{
    double x[8];
    (void)evidence(NULL, NULL, NULL, x);
    return x[0];
}

POOL_TEST(a_wrong_sign)
{
    struct candidate fault;
    open_bar(1);
    multiply(job.measurement.shape, job.measurement.shape_std, SENSOR, -1);
    double *shape = copy_of(job.measurement.shape), *std = copy_of(job.measurement.shape_std), x = modulus_of_base();
    multiply(shape, std, SENSOR, -1);
    check("a sign", fault_evidence("sensor_sign", job.rotor.sensor[SENSOR].id, 0, &fault),
          grid_of_shapes(shape, std, x * 0.9, x * 1.1));
}

POOL_TEST(a_gain)
{
    struct candidate fault;
    double sum = -INFINITY;
    const int points = 80;
    open_bar(1);
    double x = modulus_of_base();
    multiply(job.measurement.shape, job.measurement.shape_std, SENSOR, 1.3);
    double z = fault_evidence("sensor_gain", job.rotor.sensor[SENSOR].id, 0, &fault);
    for (int i = 0; i < points; i++) { /* normal of deviation 0.5 in ln of the gain */
        double width = 0.24 / points, t = log(1.3) - 0.12 + (i + 0.5) * width, *shape = copy_of(job.measurement.shape),
               *std = copy_of(job.measurement.shape_std);
        multiply(shape, std, SENSOR, exp(-t));
        sum = sum_logs(sum, grid_of_shapes(shape, std, x * 0.97, x * 1.03) + normal(t, 0.5) + log(width));
    }
    assert_close(fault.effect.value[0], 1.3, 0.03, 0);
    check("a gain", z, sum);
}

/* y of the sensor is normal about `of` (NULL: about 0), with a deviation that is log-uniform between two multiples of its noise.
 */
static double scatter(const double *of, double least, double most)
{
    double sum = -INFINITY, square = 0;
    const int points = 4000;
    for (int k = 0; k < job.measurement.nmode; k++) {
        int at = SENSOR + k * job.rotor.nsensor;
        double off = (job.measurement.shape[at] - (of ? of[at] : 0)) /
                     (largest_of(job.measurement.shape, k) * job.measurement.shape_std[at]);
        square += off * off;
    }
    for (int i = 0; i < points; i++) {
        double t = least * pow(most / least, (i + 0.5) / points);
        sum = sum_logs(sum, -square / (2 * t * t) - job.measurement.nmode * log(t) - log(points));
    }
    return sum;
}

POOL_TEST(a_dead_channel_and_a_copy)
{
    for (int copy = 0; copy < 2; copy++) {
        struct candidate fault;
        open_bar(1);
        double x = modulus_of_base(), most = 2;
        int n = job.rotor.nsensor, other = copy ? SENSOR + 1 : -1;
        double *source = copy_of(job.measurement.shape);
        for (int k = 0; k < job.measurement.nmode; k++) {
            int at = SENSOR + k * n;
            source[at] = copy ? source[at + 1] : 0;
            job.measurement.shape[at] = copy ? source[at + 1] * (1 + 1e-6 * (k % 3 - 1)) : 0.01 * sin(1 + 3 * k);
        }
        for (int k = 0; k < job.measurement.nmode && !copy; k++)
            for (int s = 0; s < n; s++)
                most = fmax(most, fabs(job.measurement.shape[s + k * n]) /
                                      (largest_of(job.measurement.shape, k) * job.measurement.shape_std[s + k * n]));
        double *shape = copy_of(job.measurement.shape), *std = copy_of(job.measurement.shape_std);
        multiply(shape, std, SENSOR, NAN);
        double grid = grid_of_shapes(shape, std, x * 0.97, x * 1.03) + (copy ? scatter(source, 1e-6, 1) : scatter(NULL, 1, most));
        check(copy ? "a copy" : "a dead channel",
              fault_evidence("duplicate_channel", job.rotor.sensor[SENSOR].id, copy ? job.rotor.sensor[other].id : 0, &fault),
              grid);
    }
}

/* ---- something else: covariance 1 + A^2 C in every shape and 1 + B^2 on every frequency, by a dense factor of it at each
 * modulus */

static double log_normal_rows(int n, double *covariance, const double *r, const double *u)
{
    /* ln of the integral over the scale of u, known to 1/|u| and better, by the covariance of r with it in: its part of ln det is
     * that of the base, which has none */
    double determinant, *inverse = covariance, square = 0, ru = 0, uu = 0, length = 0;
    assert_int_equal(positive_invert(n, inverse, &determinant), 0);
    for (int i = 0; i < n; i++) {
        length += u[i] * u[i];
        for (int j = 0; j < n; j++) {
            double a = inverse[i + j * n];
            square += r[i] * a * r[j];
            ru += r[i] * a * u[j];
            uu += u[i] * a * u[j];
        }
    }
    return -(square - ru * ru / uu) / 2 - determinant / 2 - log(uu / length) / 2;
}

static double else_at(struct likelihood *l, const double *x, double shapes, double lines)
{
    double sum = 0;
    if (columns_residual(&l->columns, x, l->r))
        return -INFINITY;
    for (int i = 0; i < l->nline; i++)
        sum -= (l->r[i] * l->r[i] / (1 + lines * lines) + log(1 + lines * lines)) / 2;
    for (int m = 0, row = l->nline; m < l->columns.nmode; m++) {
        int n = l->columns.mode[m].sensors;
        double *c = POOL_ARRAY(&test_pool, double, (size_t)n *(size_t)n), *u = POOL_ARRAY(&test_pool, double, n);
        double length = 0.3 * rotor_length(&job.rotor) / (number[l->columns.mode[m].k] + 1);
        for (int i = 0; i < n; i++) {
            int s = l->columns.mode[m].sensor[i];
            u[i] = l->r[row + i] + job.measurement.shape[s + l->columns.mode[m].k * job.rotor.nsensor] /
                                       (largest_of(job.measurement.shape, l->columns.mode[m].k) *
                                        job.measurement.shape_std[s + l->columns.mode[m].k * job.rotor.nsensor]);
            for (int j = 0; j < n; j++) {
                double apart = (job.rotor.sensor[s].position - job.rotor.sensor[l->columns.mode[m].sensor[j]].position) / length;
                c[i + j * n] = (i == j) + shapes * shapes * exp(-apart * apart / 2);
            }
        }
        sum += log_normal_rows(n, c, l->r + row, u);
        row += n;
    }
    return sum;
}

POOL_TEST(something_else)
{
    double log_else, x[8], sum = -INFINITY;
    struct likelihood l;
    const int points = 24;
    open_bar(0.3); /* the noise stated too small: there is something else to find */
    (void)evidence(NULL, NULL, &log_else, x);
    open_likelihood(&job, &l);
    for (int a = 0; a < points; a++)
        for (int b = 0; b < points; b++)
            for (int i = 0; i < 30; i++) {
                const double shapes = 2 * pow(500, (a + 0.5) / points), lines = 2 * pow(500, (b + 0.5) / points), half = 0.1,
                             at = x[0] * exp(half * (2 * (i + 0.5) / 30 - 1));
                e_lower = job.unknowns.bounds[0].lower;
                e_upper = job.unknowns.bounds[0].upper;
                sum = sum_logs(sum, else_at(&l, &at, shapes, lines) + of_modulus(at) + log(2 * half / 30) - 2 * log(points));
            }
    check("something else", log_else, sum);
}

/* What a cause that is an approximation leaves is noise behind it, in arrays of its own. */
POOL_TEST(what_an_approximation_leaves_is_noise)
{
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

/* The modulus of the bar, whose frequencies are a hundred times as far off as is stated: by an approximation that may leave as
 * much, and with noise of that size. */
POOL_TEST(what_an_approximation_leaves_is_in_the_deviation)
{
    const struct candidate cone = {.cause = catalogue_find("step_stiffness")};
    double mean[2], std[2];
    open_bar(1);
    const struct job_measurement *m = &job.measurement;
    for (int with = 0; with < 2; with++) {
        struct states states;
        struct state one;
        struct evidence_data *data;
        struct evidence e = {.mean = &mean[with], .std = &std[with]};
        rotid_fit_result *fit;
        for (int k = 0; k < m->nmode; k++)
            m->frequency_std[k] = with ? hypot(3e-5, cone.cause->discrepancy_frequency) : 3e-5;
        for (int i = 0; i < m->nmode * job.rotor.nsensor && with; i++)
            m->shape_std[i] = hypot(m->shape_std[i], cone.cause->discrepancy_shape);
        fit_with(NULL, NULL, &states, &one, &fit);
        assert_status(evidence_open(&test_pool, &states, number, holdout, &data), ROTID_OK);
        assert_status(evidence_of_fit(data, &states, 1, fit, !with, &cone, 0, NULL, NULL, &e), ROTID_OK);
        rotid_fit_free(fit);
    }
    print_message("E %.5g +- %.2g %%, with such noise %.5g +- %.2g %%\n", mean[0], 100 * std[0] / mean[0], mean[1],
                  100 * std[1] / mean[1]);
    assert_close(mean[0], mean[1], 1e-3, 0);
    assert_close(std[0], std[1], 0.1, 0);
    assert_true(std[0] / mean[0] > 20 * 3e-5);
}

/* ---- two places and a free width: effects that are hidden in data of the model itself, with noise of its size */

/* The job's data are those of the bar with an effect, its frequencies alone or its shapes as well. */
static void hide(const char *id, const double *value, int shapes)
{
    const struct cause_kind *cause = catalogue_find(id);
    struct effect effect = {.kind = cause->effect, .target = -1, .name = "hidden"};
    struct job with;
    struct columns columns;
    int n = job.rotor.nsensor, nmode = job.measurement.nmode;
    memcpy(effect.value, value, sizeof effect.value);
    assert_status(job_with_effect(&test_pool, &job, NULL, &effect, cause, NULL, &with), ROTID_OK);
    double x[8] = {job.unknowns.bounds[0].start};
    memcpy(x + 1, value, 3 * sizeof *x);
    assert_status(columns_open(&test_pool, &with, number, holdout, NULL, x, &columns), ROTID_OK);
    const struct prediction *p = &columns.functional.prediction;
    double *hz = POOL_ARRAY(&test_pool, double, nmode), *shape = POOL_ARRAY(&test_pool, double, (size_t)n *(size_t)nmode);
    for (int k = 0; k < nmode; k++) {
        hz[k] = prediction_hz(p, columns.mode[k].pair) * (1 + job.measurement.frequency_std[k] * sin(2 + 5 * k));
        for (int s = 0; s < n; s++)
            shape[s + k * n] = prediction_at_sensor(p, columns.mode[k].pair, s);
        double most = 0;
        for (int s = 0; s < n; s++)
            most = fmax(most, fabs(shape[s + k * n]));
        for (int s = 0; s < n; s++)
            shape[s + k * n] = shape[s + k * n] / most + job.measurement.shape_std[s + k * n] * sin(1 + 3 * s + 7 * k);
    }
    job.measurement.frequency_hz = hz;
    job.measurement.shape = shapes ? shape : NULL;
}

/* The cause of an id as it is fitted beside the base, its evidence over both places that it may have, and the fits. */
static double hidden_evidence(const char *id, struct refit refit[2])
{
    struct state one;
    struct states states = states_of(&job, &one);
    struct evidence_data *data;
    struct scan scan;
    double mean[16], std[16], valley[2];
    struct evidence e = {.mean = mean, .std = std};
    rotid_fit_result *fit;
    int at = 0;
    assert_status(refit_until(&test_pool, &states, number, holdout, 0, NULL, &fit), ROTID_OK);
    assert_status(evidence_open(&test_pool, &states, number, holdout, &data), ROTID_OK);
    assert_status(scan_run(&test_pool, &states, number, holdout, fit->x, SCAN_ALL, &scan), ROTID_OK);
    while (at < scan.ncandidate && (strcmp(scan.candidate[at].cause->id, id) != 0 || scan.candidate[at].effect.variant))
        at++;
    assert_true(at < scan.ncandidate);
    assert_status(refit_cause(&test_pool, &states, number, holdout, fit->x, fit->x, &scan, at, NULL, refit), ROTID_OK);
    assert_non_null(refit->fit);
    rotid_fit_free(fit);
    double sum = -INFINITY;
    for (int i = 0; i < 2 && refit[i].fit; i++) {
        const struct refit *r = &refit[i];
        const struct profile_case c = {.data = data,
                                       .states = &r->states,
                                       .fit = r->fit,
                                       .number = number,
                                       .holdout = holdout,
                                       .nown = job.unknowns.nparameter};
        assert_status(evidence_of_fit(data, &r->states, job.unknowns.nparameter, r->fit, 0, NULL, 0, NULL, NULL, &e), ROTID_OK);
        int width = r->fit->n > 3; /* in place of the place */
        assert_status(profile_unknown(&test_pool, &c, 2 + width, width, &e, valley), ROTID_OK);
        sum = log_sum(sum, e.log_z);
    }
    return sum;
}

/* ln Z of a mass of up to 0.04 kg at any of so many places. */
static double mass_on_grid(const struct refit *refit, int places)
{
    struct likelihood l;
    heaviest = refit->states.bounds[1].upper;
    bar_length = refit->states.bounds[2].upper;
    const struct axis axis[3] = {
        modulus_axis(refit->fit->x[0], 0.02, 10), {20, 0, 0, 0.04, of_mass}, {places, 0, 0, bar_length, of_place}};
    open_likelihood(&refit->states.state->job, &l);
    return over_grid(&l, 3, axis);
}

/* By its frequencies a bar without supports does not know its left end from its right one, though it was weighed; shapes of eight
 * times the noise hardly tell them apart. */
POOL_TEST(two_places)
{
    const double value[EFFECT_MOST_PARAMETERS] = {0.012, 0.15};
    struct random_stream stream = {1};
    for (int i = 0; i < 3; i++) {
        struct refit refit[2];
        open_bar(1);
        hide("added_mass", value, i == 1);
        if (i == 2)
            job.measurement.weighed = (struct weighed){.mass = rotor_mass(&job.rotor) + 0.0125, .mass_std = 0.001};
        for (int at = 0; at < job.rotor.nsensor * job.measurement.nmode; at++) { /* noise as stated: its level is a part of Z */
            job.measurement.shape_std[at] *= 8;
            if (i == 1)
                job.measurement.shape[at] += job.measurement.shape_std[at] * random_normal(&stream);
        }
        double z = hidden_evidence("added_mass", refit);
        check("a mass at one of two places", z, mass_on_grid(refit, 80));
        assert_true(refit[1].fit && refit[1].chi2 < refit->chi2 + 4);
        rotid_fit_free(refit[0].fit);
        rotid_fit_free(refit[1].fit);
    }
}

/* In the middle of the bar the first derivative by the place vanishes, but for noise: the normal about the fit is 0.8 off. */
POOL_TEST(a_place_of_symmetry)
{
    const double value[EFFECT_MOST_PARAMETERS] = {0.012, 0.305};
    struct refit refit[2];
    open_bar(1);
    hide("added_mass", value, 0);
    double z = hidden_evidence("added_mass", refit);
    check("a mass in the middle", z, mass_on_grid(refit, 120));
    rotid_fit_free(refit[0].fit);
    rotid_fit_free(refit[1].fit);
}

static double of_decades(double x)
{
    (void)x;
    return -log(1 + catalogue_find("support_rotation")->parameter[0].scale * log(10));
}

/* Left of a step of the section the place hardly matters, right of it much: the normal about the fit is 2.4 off. */
POOL_TEST(a_place_at_a_step)
{
    enum { N = 4 };
    static const int points[N] = {5, 5, 6, 24};
    const double value[EFFECT_MOST_PARAMETERS] = {1.24e6, 0.25};
    struct states states;
    struct state one;
    struct evidence_data *data;
    struct likelihood l;
    double mean[2], std[2], from[N], to[N], x[N], valley[2], sum = -INFINITY;
    struct evidence e = {.mean = mean, .std = std};
    rotid_fit_result *fit;
    open_deck("tests/data/search/place_at_a_step.inp", 0, NULL);
    fit_with("support_rotation", value, &states, &one, &fit);
    assert_status(evidence_open(&test_pool, &states, number, holdout, &data), ROTID_OK);
    const struct profile_case c = {.data = data, .states = &states, .fit = fit, .number = number, .holdout = holdout, .nown = 2};
    assert_status(evidence_of_fit(data, &states, 2, fit, 0, NULL, 0, NULL, NULL, &e), ROTID_OK);
    double normal_fit = e.log_z, prior = of_decades(0);
    assert_status(profile_unknown(&test_pool, &c, 3, 0, &e, valley), ROTID_OK);
    for (int p = 0; p < N; p++) { /* three deviations to each side; left of 0.15 m and right of 0.45 m is nothing */
        const rotid_parameter *bounds = &states.bounds[p];
        from[p] = p < 3 ? fit->x[p] * exp(-3 * fit->std[p] / fit->x[p]) : 0.15;
        to[p] = p < 3 ? fit->x[p] * exp(3 * fit->std[p] / fit->x[p]) : 0.45;
        prior += p < 3 ? log(log(to[p] / from[p]) / points[p]) : log((to[p] - from[p]) / points[p]);
        prior -= p < 2 ? log(log(bounds->upper / bounds->lower)) : p == 3 ? log(bounds->upper - bounds->lower) : 0;
    }
    open_likelihood(&states.state->job, &l);
    for (int i = 0; i < points[0] * points[1] * points[2] * points[3]; i++) {
        for (int p = 0, rest = i; p < N; rest /= points[p], p++) {
            double share = (rest % points[p] + 0.5) / points[p];
            x[p] = p < 3 ? from[p] * pow(to[p] / from[p], share) : from[p] + share * (to[p] - from[p]);
        }
        sum = sum_logs(sum, log_likelihood_of(1, &l, x) + prior);
    }
    check("a place at a step", e.log_z, sum);
    assert_true(fabs(normal_fit - sum) > 2); /* the test tests something */
    rotid_fit_free(fit);
}

static double of_depth(double x)
{
    return normal(x, 0.5) + log(2) - log(erf(0.95 / 0.5 / sqrt(2)));
}

static double of_log_width(double x)
{
    (void)x;
    return -log(log(200.0 / 14));
}

/* A narrow deep zone may as well be a wider shallow one: its width is hardly known, its depth is near the most there is. */
POOL_TEST(a_free_width)
{
    static const struct {
        double depth, width, noise, from, to; /* of the depth: next to nothing lies beyond */
    } zone[] = {{0.8, 0.008, 1, 0.55, 0.95}, {0.3, 0.025, 0.5, 0.22, 0.42}};
    for (int i = 0; i < 2; i++) {
        const double value[EFFECT_MOST_PARAMETERS] = {zone[i].depth, 0.2, zone[i].width}, reach = 0.008;
        struct refit refit[2];
        struct likelihood l;
        open_bar(zone[i].noise);
        hide("stiffness_local", value, 1);
        double z = hidden_evidence("stiffness_local", refit), at = refit->fit->x[2];
        bar_length = refit->states.bounds[2].upper;
        const struct axis axis[4] = {modulus_axis(refit->fit->x[0], 0.02, 10),
                                     {32, 0, zone[i].from, zone[i].to, of_depth},
                                     {8, 0, at - reach, at + reach, of_place},
                                     {12, 1, bar_length / 200, bar_length / 14, of_log_width}};
        open_likelihood(&refit->states.state->job, &l);
        check("a zone of any width", z, over_grid(&l, 4, axis));
        rotid_fit_free(refit[0].fit);
        rotid_fit_free(refit[1].fit);
    }
}
