/* What is expected of tests that nobody has made, beside what comes out when they are made: intervals beside closed forms and
 * identifications, detection limits beside diagnoses, places of sensors beside all choices there are, margins beside fits to
 * second states, simulated here and by tools/hide (exact dynamic stiffness, no code of the library). */
#include <sys/stat.h>
#include <unistd.h>

#include "deck/deck.h"
#include "diagnose/diagnose.h"
#include "folder.h"
#include "hide/hide.h"
#include "linalg/linalg.h"
#include "reading.h"
#include "suggest/suggest.h"
#include "support.h"

static const char shaft[] = "*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n2.1e11, 8e10, 0.30\n*DENSITY\n7850\n"
                            "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.05, 0, 10\n"
                            "*SHAFT, NAME=core, MATERIAL=steel\n0.5, 0.08, 0, 20\n"
                            "*SHAFT, NAME=right, MATERIAL=steel\n0.3, 0.05, 0, 10\n"
                            "*IDENTIFY\ncore.E, 1e10, 6e11, 2.1e11\ncore.G, 1e9, 3e11, 8e10\n";

static rotid_suggestion *suggest_text(const char *text, const rotid_suggest_options *options)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *deck = read_handle(text, 0, NULL);
    rotid_suggestion *s;
    if (rotid_suggest(deck, options, NULL, failure, &s))
        fail_msg("%s", failure);
    rotid_deck_free(deck);
    return s;
}

/* A solid by its coarse mesh: columns of the model that was planned with leave nothing there, those of the finer mesh do. */
POOL_TEST(a_test_of_a_solid_is_planned_on_one_mesh)
{
    const double place[] = {0, 0.2, 0.45, 0.7, 0.9, 1.1};
    const int number[] = {1, 2, 3};
    const struct planned plan = {3, number, 1e-3, 1e-2, 1};
    struct message_list messages;
    struct job job, to;
    message_open(&messages, &test_pool);
    const char *path = folder_write("solid.inp", pool_format(&test_pool, "%s*FIT, MODEL=SOLID\n", shaft));
    assert_status(deck_read(&test_pool, path, 0, NULL, &messages, &job), ROTID_OK);
    assert_status(planned_sensors(&test_pool, &job, 6, place, &job), ROTID_OK);
    double *x = parameter_starts(&test_pool, job.unknowns.nparameter, job.unknowns.bounds);
    assert_status(planned_measure(&test_pool, &job, x, &plan, &job), ROTID_OK);
    to = job;
    for (int coarse = 0; coarse < 2; coarse++) {
        struct columns columns;
        double most = 0;
        if (coarse)
            assert_status(planned_on_coarse(&test_pool, &to), ROTID_OK);
        assert_status(columns_open(&test_pool, &to, number, to.measurement.holdout, NULL, x, &columns), ROTID_OK);
        for (int i = 0; i < columns.nrow; i++)
            most = fmax(most, fabs(columns.r[i]));
        assert_true(coarse ? most < 1e-3 : most > 0.1);
    }
}

/* ---- before a test */

/* Where E alone is free and G follows, every frequency goes with the root of E: 196 2 s / sqrt(m) percent. */
POOL_TEST(an_interval_of_e_alone_has_a_closed_form)
{
    static const char text[] = "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.30\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=steel\n"
                               "0.8, 0.03, 0, 30\n*NOISE, FREQUENCY=0.004\n*IDENTIFY\nbar.E, 1e10, 6e11, 2.1e11\n*FIT, TIE=E:G\n";
    const rotid_suggest_options options = {.size = sizeof options, .wanted_percent = 0.8};
    rotid_suggestion *s = suggest_text(text, &options);
    assert_int_equal(s->noise.frequency_assumed, 0);
    assert_int_equal(s->noise.shape_assumed, 1);
    for (int i = 0; i < s->nmodes; i++)
        assert_close(s->modes[i].frequencies_percent[0], 196 * 2 * 0.004 / sqrt(s->modes[i].modes), 1e-6, 0);
    assert_int_equal(s->modes_needed, 4); /* 196 2 0.004 / 0.8 squared is 3.84 */
    rotid_suggestion_free(s);
}

/* The density of a bar by its frequencies and by scales that read its mass to 0.4 %. */
POOL_TEST(a_rotor_that_will_be_weighed_is_counted_so)
{
    static const char text[] =
        "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.30\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=steel\n"
        "0.8, 0.03, 0, 30\n*NOISE, FREQUENCY=0.004\n*IDENTIFY\nbar.rho, 1e3, 2e4, 7850\n*WEIGHT\n4, 0.018\n";
    const double weight = 196 * 0.018 / (0.8 * 0.03 * 0.03 * 7850 * 3.14159265358979323846 / 4);
    const rotid_suggest_options options = {.size = sizeof options};
    rotid_suggestion *s = suggest_text(text, &options);
    for (int i = 0; i < s->nmodes; i++) {
        double alone = 196 * 2 * 0.004 / sqrt(s->modes[i].modes);
        assert_close(s->modes[i].frequencies_percent[0], alone * weight / hypot(alone, weight), 1e-6, 0);
    }
    rotid_suggestion_free(s);
}

static char *measured_deck(const rotid_deck *deck, int modes, const char *cards)
{
    char failure[ROTID_FAILURE_LENGTH], *text = pool_format(&test_pool, "%s%s*MODES\n", shaft, cards);
    rotid_spectrum *s;
    if (rotid_spectrum_compute(deck, NULL, modes, NULL, failure, &s))
        fail_msg("%s", failure);
    for (int k = 0; k < modes; k++)
        text = pool_format(&test_pool, "%s%d, %.17g\n", text, k + 1, s->modes[k].full_hz);
    for (int k = 0; k < modes; k++) {
        text = pool_format(&test_pool, "%s*SHAPE, MODE=%d\n", text, k + 1);
        for (int i = 0; i < s->nsensor_z_m; i++)
            text = pool_format(&test_pool, "%s%d, %.17g\n", text, i + 1, s->modes[k].shape[i]);
    }
    rotid_spectrum_free(s);
    return text;
}

static const char seven[] = "*SENSORS\n1, 0.05\n2, 0.2\n3, 0.35\n4, 0.5\n5, 0.7\n6, 0.9\n7, 1.05\n*NOISE, FREQUENCY=0.001, "
                            "SHAPE=0.005\n";

/* The data that were expected, measured without error: identification states the intervals, diagnosis the limits. */
static void compare_with_the_test(const char *cards)
{
    const rotid_suggest_options options = {.size = sizeof options, .modes = 5};
    char failure[ROTID_FAILURE_LENGTH], *before = pool_format(&test_pool, "%s%s", shaft, cards);
    rotid_suggestion *s = suggest_text(before, &options);
    rotid_deck *bare = read_handle(before, 0, NULL), *deck = read_handle(measured_deck(bare, 5, cards), 0, NULL);
    rotid_identification *fit;
    rotid_diagnosis *d;
    if (rotid_identify(deck, 0, NULL, failure, &fit) || rotid_diagnose(deck, NULL, NULL, failure, &d))
        fail_msg("%s", failure);
    assert_string_equal(s->plans[0].method, "deck");
    for (int p = 0; p < 2; p++)
        assert_close(s->plans[0].half_width_percent[p], 196 * fit->parameters[p].std / fit->parameters[p].value, 2e-3, 0);
    int compared = 0;
    for (int i = 0; i < s->ndetectable; i++)
        for (int k = 0; k < d->ndetectable; k++)
            if (!strcmp(s->detectable[i].id, d->detectable[k].id) && !strcmp(s->detectable[i].target, d->detectable[k].target) &&
                !d->detectable[k].beyond) {
                assert_close(s->detectable[i].smallest, d->detectable[k].smallest, 0.05, 0);
                compared++;
            }
    assert_true(compared >= 10);
    rotid_diagnosis_free(d);
    rotid_identification_free(fit);
    rotid_suggestion_free(s);
    rotid_deck_free(deck);
    rotid_deck_free(bare);
}

POOL_TEST(intervals_and_limits_are_those_of_the_test_that_is_made)
{
    double mass = 7850 * 3.14159265358979323846 / 4 * (2 * 0.3 * 0.05 * 0.05 + 0.5 * 0.08 * 0.08);
    compare_with_the_test(seven);
    compare_with_the_test(pool_format(&test_pool, "%s*WEIGHT\n%.17g, 0.01\n*CENTRE\n0.55, 1e-4\n", seven, mass));
}

/* ---- places of sensors */

#define PLACES 9
#define MODES  3

static struct design random_design(int nparam, int ntarget)
{
    struct random_stream stream = {7};
    struct design d;
    assert_int_equal(design_new(&test_pool, MODES, PLACES, 0, nparam, ntarget, &d), 0);
    for (int i = 0; i < MODES * (1 + PLACES) * (nparam + ntarget); i++)
        d.column[i] = random_normal(&stream);
    for (int i = 0; i < MODES * PLACES; i++) {
        d.scale[i] = random_normal(&stream);
        d.largest[i] = 1;
    }
    for (int p = 0; p < nparam; p++)
        d.prior[p + p * nparam] = 1;
    return d;
}

/* Columns with the scales projected out one place after the other, as vectors: c - u (u'c)/(u'u). */
static double product(const struct design *d, const int *taken, int i, int j)
{
    int rows = MODES * (1 + PLACES);
    double sum = 0;
    for (int k = 0; k < MODES; k++) {
        const double *a = d->column + i * rows, *b = d->column + j * rows, *u = d->scale + k * PLACES;
        double uu = 0, ua = 0;
        sum += a[k] * b[k];
        for (int s = 0; s < PLACES; s++)
            if (taken[s]) {
                uu += u[s] * u[s];
                ua += u[s] * a[MODES + k * PLACES + s];
            }
        for (int s = 0; s < PLACES; s++)
            if (taken[s])
                sum += (a[MODES + k * PLACES + s] - u[s] * ua / uu) * b[MODES + k * PLACES + s];
    }
    return sum;
}

/* With one parameter and one target determinants are written out. */
POOL_TEST(the_value_of_places_is_that_of_their_projected_columns)
{
    const struct design d = random_design(1, 1);
    const int taken[PLACES] = {1, 0, 1, 1, 0, 0, 1, 0, 0};
    struct information found = {0};
    double g = product(&d, taken, 0, 0), q;
    q = product(&d, taken, 1, 1) - product(&d, taken, 0, 1) * product(&d, taken, 0, 1) / (1 + g);
    assert_int_equal(design_information(&test_pool, &d, MODES, taken, 0, &found), 0);
    assert_close(found.target, log1p(q), 1e-12, 0);
    assert_close(found.value, log1p(g) + log1p(q), 1e-12, 0);
}

/* One sensor says nothing of shapes, whose scale is free, so that the first of a list is as good anywhere: what rounding made of
 * this stood near nodes of the modes, where the noise of the largest component is small, and promised less of more sensors. */
POOL_TEST(sensors_that_are_equal_are_not_chosen_by_rounding)
{
    rotid_suggestion *s = suggest_text(
        pool_format(&test_pool, "*IDENTIFY\nleft.E, 1e10, 6e11, 2.1e11\n%s*NOISE, FREQUENCY=0.001, SHAPE=0.01\n", shaft), NULL);
    assert_true(s->ncounts > 5);
    for (int i = 1; i < s->ncounts; i++)
        assert_true(s->counts[i].half_width_percent <= 1.005 * s->counts[i - 1].half_width_percent);
    rotid_suggestion_free(s);
}

/* All 84 choices of three places beside the one that is made. */
POOL_TEST(no_choice_of_three_places_is_much_better)
{
    const struct design d = random_design(2, 3);
    static const double z[PLACES] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    double best = -INFINITY, found;
    int taken[PLACES] = {0};
    for (int a = 0; a < PLACES; a++)
        for (int b = a + 1; b < PLACES; b++)
            for (int c = b + 1; c < PLACES; c++) {
                int set[PLACES] = {0};
                double value;
                set[a] = set[b] = set[c] = 1;
                assert_int_equal(design_value(&test_pool, 1, &d, MODES, set, &value), 0);
                best = fmax(best, value);
            }
    assert_int_equal(design_choose(&test_pool, 1, &d, MODES, z, 0.5, 3, NULL, NULL, taken), 0);
    assert_int_equal(design_value(&test_pool, 1, &d, MODES, taken, &found), 0);
    assert_close(found, best, 0.02, 0);
    int apart[PLACES] = {0};
    assert_int_equal(design_choose(&test_pool, 1, &d, MODES, z, 2.5, 3, NULL, NULL, apart), 0);
    for (int i = 0, last = -9; i < PLACES; i++)
        if (apart[i]) {
            assert_true(i - last >= 3);
            last = i;
        }
}

static double determinant(int n, double a[3][3])
{
    return n == 2 ? a[0][0] * a[1][1] - a[0][1] * a[1][0]
                  : a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
                        a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

/* To lose the place of the least leverage is to lose the least of det(Phi'Phi): det(F - f f') = det F (1 - f'F^-1 f). */
POOL_TEST(effective_independence_keeps_the_determinant)
{
    struct random_stream stream = {3};
    double shape[PLACES * MODES], best = -1;
    int taken[PLACES], lost = -1, left = 0;
    for (int i = 0; i < PLACES * MODES; i++)
        shape[i] = random_normal(&stream);
    for (int out = 0; out < PLACES; out++) {
        double fisher[3][3] = {{0}};
        for (int i = 0; i < PLACES; i++)
            for (int a = 0; a < MODES && i != out; a++)
                for (int b = 0; b < MODES; b++)
                    fisher[a][b] += shape[i + a * PLACES] * shape[i + b * PLACES];
        if (determinant(3, fisher) > best) {
            best = determinant(3, fisher);
            lost = out;
        }
    }
    for (int i = 0; i < PLACES; i++)
        taken[i] = 1;
    assert_int_equal(effective_independence(&test_pool, PLACES, MODES, shape, PLACES - 1, taken), 0);
    assert_int_equal(taken[lost], 0);
    assert_int_equal(effective_independence(&test_pool, PLACES, MODES, shape, MODES, taken), 0);
    for (int i = 0; i < PLACES; i++)
        left += taken[i];
    assert_int_equal(left, MODES);
}

/* ---- after an ambiguous diagnosis */

/* A job of data that tools/hide makes of a deck. */
static void make_job(const char *deck, const char *effect, double frequency_noise, unsigned seed, struct job *job)
{
    static const char *const truth[] = {"core.E=2.2e11", "core.G=8.2e10"};
    struct hide_request request = hide_request_default();
    struct message_list messages;
    char message[300] = "", *text, *json, *path = pool_copy_text(&test_pool, folder_path("case.inp"));
    request.deck = deck;
    request.name = "case";
    request.seed = seed;
    request.modes = 5;
    request.sensors = 12;
    request.frequency_noise = frequency_noise;
    request.truths = 2;
    request.truth = truth;
    request.effects = 1;
    request.effect = &effect;
    if (hide_case(&request, &text, &json, message, sizeof message))
        fail_msg("%s", message);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    message_open(&messages, &test_pool);
    if (deck_read(&test_pool, path, 0, NULL, &messages, job))
        fail_msg("%s", messages.count ? messages.item[0].text : "no deck");
    free(text);
    free(json);
}

static double penalty(const struct rival *r)
{
    return r->score - r->fit->chi2;
}

/* The lead of rival a over b by a test with these measurements. */
static double lead(const struct rival *a, const struct rival *b, const struct test *test, const struct job_measurement *measured)
{
    double of_a, of_b;
    assert_int_equal(joint_chi2(&test_pool, a, test, measured, NULL, &of_a), 0);
    assert_int_equal(joint_chi2(&test_pool, b, test, measured, NULL, &of_b), 0);
    return of_b + penalty(b) - of_a - penalty(a);
}

/* Noise on what is measured, as the test states it. */
static void add_noise(struct random_stream *stream, struct job_measurement *m, int nsensor)
{
    for (int k = 0; k < m->nmode; k++)
        m->frequency_hz[k] *= 1 + m->frequency_std[k] * random_normal(stream);
    for (int i = 0; i < nsensor * m->nmode && m->shape; i++)
        m->shape[i] += m->shape_std[i] * random_normal(stream);
}

/* x := a truth as likely as any other by what is measured. */
static void draw_truth(struct random_stream *stream, const struct rival *a, double *x)
{
    int n = 0;
    double gram[64] = {0}, move[8];
    for (int p = 0; p < a->fit->n; p++)
        n += rival_uses(a, p);
    assert_true(n <= 8);
    rival_gram(a, NULL, n, gram);
    for (int p = 0; p < n; p++) {
        gram[p + p * n] += 1;
        move[p] = random_normal(stream);
    }
    assert_int_equal(cholesky_factor(n, gram), 0);
    cholesky_backward_leading(n, n, gram, move);
    for (int p = 0, q = 0; p < a->fit->n; p++)
        x[p] = a->fit->x[p] * (rival_uses(a, p) ? 1 + move[q++] : 1);
}

static const struct {
    const char *effect;
    double noise;
    unsigned seed;
    double nonlinear; /* of the distance: beside a zone whose place and width are open, columns at its best place are no more */
    int draws;
} ambiguous[] = {{"density:group=left,factor=1.04", 0.001, 1, 0.02, 6}, {"stiffness:group=right,factor=0.93", 0.002, 5, 0.45, 4}};
#define CASES ((int)(sizeof ambiguous / sizeof *ambiguous))
#define DRAWS 6 /* at most */

/* Twice the size of d decides: the lead is nearly normal about what is expected, with deviation 2 |d| and what the truth leaves
 * open. */
static double normal_chance(const struct rivals *rivals, const rotid_expected_margin *m)
{
    double needed = m->rival == rivals->n - 1 ? rivals->margin : rivals->margin;
    return 0.5 * erfc((needed - m->expected) / (2 * sqrt(m->distance) * sqrt(2)));
}

static void numbers_agree(const struct suggestion *s)
{
    const struct rival *rival = s->rivals.rival;
    double last = 0;
    for (int r = 0; r + 1 < s->rivals.n; r++)
        assert_close(rival[r].share / rival[0].share, exp(-(rival[r].score - rival[0].score) / 2), 1e-9, 0);
    for (int t = 0; t < s->result.ntests; t++) {
        const rotid_suggested_test *test = &s->result.tests[t];
        double least = 1;
        assert_close(test->cost, 20 * test->setups + test->points, 1e-12, 0);
        assert_true(test->entropy >= last - 0.05); /* ranked, in steps of that */
        last = test->entropy;
        assert_true(test->entropy <= s->result.entropy + 0.1); /* no test takes knowledge away on the average */
        assert_int_equal(test->nexpected_percent, s->result.nparameters);
        for (int p = 0; p < test->nexpected_percent; p++)
            assert_true(test->expected_percent[p] > 0);
        for (int i = 0; i < test->nmargins; i++) {
            const rotid_expected_margin *m = &test->margins[i];
            if (m->truth == 0) {
                least = fmin(least, m->chance);
                assert_close(m->chance, normal_chance(&s->rivals, m), 0, 0.15);
            }
        }
        assert_true(test->chance <= least * rival[0].share + (1 - rival[0].share) + 1e-12);
    }
}

static const rotid_expected_margin *first_margin(const rotid_suggested_test *t)
{
    for (int i = 0; i < t->nmargins; i++)
        if (t->margins[i].truth == 0 && t->margins[i].rival == 1)
            return &t->margins[i];
    fail();
    return NULL;
}

static double mean_of(int n, const double *value, double *error)
{
    double mean = 0, square = 0;
    for (int i = 0; i < n; i++)
        mean += value[i] / n;
    for (int i = 0; i < n; i++)
        square += (value[i] - mean) * (value[i] - mean) / (n - 1);
    *error = sqrt(square / n);
    return mean;
}

/* The same with data of the true structure by the oracle: the same test again, and one with a known mass, which the deck of the
 * oracle has as a disk. What is expected holds over all that the truth may be, the oracle has one truth: its leads scatter about
 * their mean, which lies within two deviations of what is expected. */
static void the_oracle_keeps_the_promise(const struct suggestion *s)
{
    int compared = 0;
    double heavy = 0;
    for (int t = 0; t < s->result.ntests; t++) {
        const struct test *test = &s->test[t];
        const rotid_expected_margin *m = first_margin(&s->result.tests[t]);
        double value[DRAWS], error;
        const char *deck = shaft;
        if (test->kind != TEST_AGAIN && (test->kind != TEST_MASS || !(m->distance > heavy)))
            continue;
        heavy = test->kind == TEST_MASS ? INFINITY : heavy; /* one of them is enough */
        if (test->kind == TEST_MASS)
            deck = pool_format(&test_pool, "%s*DISK\n%.17g, %.17g\n", shaft, test->z, test->mass);
        for (int i = 0; i < DRAWS; i++) {
            struct job second;
            make_job(deck, ambiguous[0].effect, ambiguous[0].noise, 100 + (unsigned)i, &second);
            value[i] = lead(&s->rivals.rival[0], &s->rivals.rival[1], test, &second.measurement);
        }
        double mean = mean_of(DRAWS, value, &error), deviation = 2 * sqrt(m->distance) + 3;
        if (fabs(mean - m->expected) > 2 * deviation)
            fail_msg("%s: expected %g +- %g, found %g +- %g", s->result.tests[t].text, m->expected, deviation, mean, error);
        compared++;
    }
    assert_int_equal(compared, 2);
}

/* The promise: leads that are expected by linear columns, beside those of nonlinear fits to both states over draws. */
POOL_TEST(a_lead_that_is_promised_is_found)
{
    for (int c = 0; c < CASES; c++) {
        const rotid_suggest_options options = {.size = sizeof options};
        struct suggestion s;
        struct message_list notes;
        struct random_stream stream = {17};
        struct job job;
        make_job(shaft, ambiguous[c].effect, ambiguous[c].noise, ambiguous[c].seed, &job);
        message_open(&notes, &test_pool);
        assert_int_equal(suggest_run(&test_pool, &job, &options, NULL, &notes, &s), 0);
        assert_true(s.rivals.n >= 3);
        assert_true(s.result.ntests >= 5);
        numbers_agree(&s);
        double shares = 0;
        for (int r = 0; r + 1 < s.rivals.n; r++)
            shares += s.rivals.rival[r].share;
        assert_close(shares, 1, 1e-12, 0);
        for (int t = 0; t < 3; t++) { /* those that are refitted */
            const rotid_expected_margin *m = first_margin(&s.result.tests[t]);
            const struct rival *a = &s.rivals.rival[0], *b = &s.rivals.rival[1];
            double value[DRAWS], x[8], error;
            assert_close(m->distance, m->refitted - m->before, ambiguous[c].nonlinear, 0.1);
            if (t == 1 || !ambiguous[c].draws)
                continue;
            for (int i = 0; i < ambiguous[c].draws; i++) {
                struct job_measurement measured;
                draw_truth(&stream, a, x);
                assert_int_equal(joint_measurement(&test_pool, a, x, &s.test[t], 0, &measured), 0);
                add_noise(&stream, &measured, s.test[t].nsensor);
                value[i] = lead(a, b, &s.test[t], &measured);
            }
            double mean = mean_of(ambiguous[c].draws, value, &error);
            if (fabs(mean - m->expected) > 3.5 * error + ambiguous[c].nonlinear * m->distance)
                fail_msg("case %d, %s: expected %g, found %g +- %g", c, s.result.tests[t].text, m->expected, mean, error);
        }
        if (c == 0)
            the_oracle_keeps_the_promise(&s);
        suggest_free(&s);
    }
}

/* Rivals that leave no more than noise hold the truth but for what was not taken as a rival; where even the best leaves far more,
 * no test can be promised a name. */
POOL_TEST(a_chance_allows_for_a_truth_that_is_no_rival)
{
    const rotid_suggest_options options = {.size = sizeof options};
    struct suggestion sound, spoilt;
    struct message_list notes;
    struct job job;
    make_job(shaft, ambiguous[0].effect, ambiguous[0].noise, ambiguous[0].seed, &job);
    message_open(&notes, &test_pool);
    assert_int_equal(suggest_run(&test_pool, &job, &options, NULL, &notes, &sound), 0);
    for (int k = 0; k < job.measurement.nmode; k++)
        job.measurement.frequency_std[k] /= 5;
    assert_int_equal(suggest_run(&test_pool, &job, &options, NULL, &notes, &spoilt), 0);
    print_message("%.3f, %.3g\n", sound.result.among, spoilt.result.among);
    assert_true(sound.result.among > 0.5 && sound.result.among < 1);
    for (int t = 0; t < sound.result.ntests; t++)
        assert_true(sound.result.tests[t].chance <= sound.result.among + 1e-12);
    for (int t = 0; t < spoilt.result.ntests; t++)
        assert_true(spoilt.result.tests[t].chance <= spoilt.result.among + 1e-12);
    assert_true(spoilt.result.ntests > 0);
    suggest_free(&sound);
    suggest_free(&spoilt);
}

/* The modes of a job shared out to two states of the same structure. */
static struct states shared_out(const struct job *job)
{
    struct states states = {.nstate = 2, .state = POOL_ARRAY(&test_pool, struct state, 2), .bounds = job->unknowns.bounds};
    states.nparameter = job->unknowns.nparameter;
    for (int s = 0; s < 2; s++) {
        struct state *state = &states.state[s];
        *state = (struct state){.name = s ? "upper" : "lower", .job = *job, .ncommon = states.nparameter};
        state->unknown = POOL_ARRAY(&test_pool, int, states.nparameter);
        for (int p = 0; p < states.nparameter; p++)
            state->unknown[p] = p;
        assert_int_equal(data_copy(&test_pool, &state->job), 0);
        for (int k = job->measurement.nmode - 1; k >= 0; k--)
            if ((k >= 3) != s)
                data_remove_mode(&state->job, k);
    }
    return states;
}

static int rival_called(const struct rivals *rivals, const char *label)
{
    for (int r = 0; r < rivals->n; r++)
        if (!strcmp(rivals->rival[r].label, label))
            return r;
    return -1;
}

/* Two states of one structure that share out its modes say what one state with all of them says: of causes that act in both the
 * same chi2, and for the same test the same distances between them. */
POOL_TEST(states_that_share_out_the_modes_say_the_same)
{
    const rotid_suggest_options options = {.size = sizeof options};
    struct suggestion one, two;
    struct message_list notes;
    struct job job;
    int compared = 0, feasible;
    make_job(shaft, ambiguous[0].effect, ambiguous[0].noise, ambiguous[0].seed, &job);
    for (int s = 0; s < job.rotor.nsegment; s++)
        job.rotor.segment[s].elements *= 4; /* one state has its mesh refined, several have not */
    struct states states = shared_out(&job);
    message_open(&notes, &test_pool);
    assert_int_equal(suggest_run(&test_pool, &job, &options, NULL, &notes, &one), 0);
    assert_int_equal(suggest_states(&test_pool, &states, &options, NULL, &notes, &two), 0);
    assert_null(one.result.state);
    assert_string_equal(two.result.state, "lower"); /* it has three of the five modes */
    assert_true(two.result.ntests >= 5);
    static double of_one[(MOST_RIVALS + 1) * (MOST_RIVALS + 1)], of_two[(MOST_RIVALS + 1) * (MOST_RIVALS + 1)];
    assert_int_equal(margin_distances(&test_pool, &one.rivals, &one.test[0], of_one, &feasible), 0);
    assert_true(feasible);
    assert_int_equal(margin_distances(&test_pool, &two.rivals, &one.test[0], of_two, &feasible), 0);
    assert_true(feasible);
    for (int a = 0; a + 1 < one.rivals.n; a++) {
        int same = rival_called(&two.rivals, one.rivals.rival[a].label);
        if (same < 0 || same + 1 == two.rivals.n)
            continue;
        const double *first = of_one + (ptrdiff_t)a * one.rivals.n, *second = of_two + (ptrdiff_t)same * two.rivals.n;
        assert_close(two.rivals.rival[same].fit->chi2, one.rivals.rival[a].fit->chi2, 1e-3, 1e-3);
        for (int b = 0; b < one.rivals.n; b++) {
            int other = rival_called(&two.rivals, one.rivals.rival[b].label);
            const struct rival *rival = &one.rivals.rival[b];
            if (other < 0 || b == a || (rival->ncause && rival->cause->cause->place >= 0)) /* in a flat valley of places */
                continue;
            /* in deviations; fits end where a step gains less than REFIT_OBJECTIVE */
            assert_close(sqrt(second[other]), sqrt(first[b]), 0.04, 0.02);
            compared++;
        }
    }
    assert_true(compared >= 2);
    suggest_free(&one);
    suggest_free(&two);
}

/* ---- the deck of a test */

/* A test like a state takes what that state has, and measures anew. */
POOL_TEST(the_deck_of_a_test_like_a_state_has_its_cards)
{
    static const char old[] = "*SHAFT, NAME=bar\n1, 0.1, 0, 4\n*STATE, NAME=bare\n*MODES\n1, 90\n*STATE, NAME=Disc\n*DISK, "
                              "NAME=d\n** heavy\n0.5, 3\n*SENSORS\n1, 0.2\n*SET\nbar.length, 0.9\n*MODES\n1, 70\n",
                      cards[] = "** proposed\n*STATE, NAME=again\n*NOISE, FREQUENCY=0.001\n";
    char *text;
    const struct deck_file file = {"old", old};
    const struct deck_origin origin = {.path = "old", .memory = 1, .nfile = 1, .file = &file};
    assert_int_equal(deck_add_state(&test_pool, &origin, "disc", cards, &text), 0);
    assert_int_equal(strncmp(text, old, sizeof old - 1), 0);
    assert_string_equal(text + sizeof old - 1, "** proposed\n*STATE, NAME=again\n*DISK, NAME=d\n0.5, 3\n*SET\nbar.length, "
                                               "0.9\n*NOISE, FREQUENCY=0.001\n");
    assert_int_equal(deck_add_state(&test_pool, &origin, "bare", cards, &text), 0);
    assert_string_equal(text + sizeof old - 1, cards);
    /* the machine in operation stays behind all states */
    const char *machine = "*RUNNING\n** bearings\n*BEARING\n0, 1e8\n";
    const struct deck_file whole = {"old", pool_format(&test_pool, "%s%s", old, machine)};
    const struct deck_origin running = {.path = "old", .memory = 1, .nfile = 1, .file = &whole};
    assert_int_equal(deck_add_state(&test_pool, &running, "bare", cards, &text), 0);
    assert_string_equal(text, pool_format(&test_pool, "%s%s%s", old, cards, machine));
}

POOL_TEST(the_deck_of_a_test_is_the_deck_and_a_state)
{
    static const char old[] = "** my shaft\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, "
                              "MATERIAL=steel\n0.8, 0.03, 0, 10\n*MODES\n1, 200\n2, 550\n** soft\n*SPRING, NAME=foam\n0.1, 500\n"
                              "*IDENTIFY\nbar.E, 1e10, 6e11, 2.1e11\nfoam.k, 10, 1e5, 500\n";
    static const enum test_kind kinds[] = {TEST_MASS, TEST_STIFF, TEST_FREE, TEST_MOVED};
    int number[] = {1, 2};
    double z[] = {0.1, 0.4, 0.7};
    rotid_deck *deck = read_handle(old, 0, NULL);
    struct job job;
    struct message_list messages;
    const struct deck_memory memory = {.name = "old", .text = old, .length = sizeof old - 1};
    struct states states;
    message_open(&messages, &test_pool);
    assert_int_equal(deck_read_states(&test_pool, memory.name, &memory, 0, NULL, &messages, &states), 0);
    job = states.state[0].job;
    rotid_deck_free(deck);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const struct test test = {.kind = kinds[i],
                                  .modes = 2,
                                  .number = number,
                                  .nsensor = 3,
                                  .sensor = z,
                                  .frequency_std = 0.001,
                                  .shape_std = 0.01,
                                  .mass = 0.5,
                                  .z = 0.25,
                                  .averages = 1};
        char *cards, *text, failure[ROTID_FAILURE_LENGTH];
        assert_int_equal(deck_write_test(&test_pool, &job, &test, &cards), 0);
        assert_int_equal(deck_add_state(&test_pool, job.origin, NULL, cards, &text), 0);
        assert_int_equal(strncmp(text, "** my shaft\n", 12), 0);
        assert_non_null(strstr(text, "*STATE, NAME=measured\n*MODES\n1, 200\n"));
        /* with its measurements in it, it is fitted; a support that was changed has a stiffness of its own */
        text = pool_format(&test_pool, "%s*MODES\n1, 199\n2, 548\n", text);
        deck = read_handle(text, 0, NULL);
        assert_int_equal(deck->nstate, 2);
        assert_int_equal(deck->state[0]->nmode, 2);
        assert_int_equal(deck->state[1]->nsensor, 3);
        assert_close(deck->state[1]->mass - deck->state[0]->mass, kinds[i] == TEST_MASS ? 0.5 : 0, 1e-9, 1e-12);
        rotid_identification *fit;
        if (rotid_identify(deck, 0, NULL, failure, &fit))
            fail_msg("%s", failure);
        assert_int_equal(fit->nparameters, kinds[i] == TEST_MASS ? 2 : 3);
        rotid_identification_free(fit);
        rotid_deck_free(deck);
    }
}

#define STEEL_BAR                                                                                                                \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=steel\n0.8, 0.03, 0, 80\n"

/* The deck of a file with a test in it: statuses of deck_propose, after which `notes` are its own. */
static int propose(const char *from, const char *to, const char *home, enum test_kind kind, const char *cards,
                   struct message_list *notes, char **text)
{
    static int number[] = {1, 2};
    static double z[] = {0.1, 0.4, 0.7}, hz[] = {199, 548};
    struct states states;
    char *own;
    const struct test test = {.kind = kind,
                              .modes = 2,
                              .number = number,
                              .nsensor = 3,
                              .sensor = z,
                              .frequency_std = 0.001,
                              .shape_std = 0.01,
                              .mass = 0.5,
                              .z = 0.25,
                              .averages = 1,
                              .hz = hz};
    int moves = kind == TEST_MASS || kind == TEST_MOVED;
    rotid_suggested_test suggested = {.id = test_id(kind),
                                      .nsensors_m = 3,
                                      .sensors_m = z,
                                      .mass_kg = kind == TEST_MASS ? 0.5 : (double)NAN,
                                      .z_m = moves ? 0.25 : (double)NAN};
    states = read_states_at(from, NULL);
    assert_int_equal(deck_write_test(&test_pool, &states.state[states.nstate - 1].job, &test, &own), 0);
    suggested.cards = cards ? cards : own;
    message_open(notes, &test_pool);
    int status = deck_propose(&test_pool, &states, home, &suggested, notes, text);
    return status ? status : deck_place(&test_pool, from, *text, to, notes, text);
}

/* What is proposed for a deck stands in its units, finds its files from the other folder, gets a name of its own and goes with
 * the files that the deck includes. Each of these was once written as something else. */
POOL_TEST(what_is_proposed_reads_as_it_is_meant)
{
    static const char *const shaft_mm = "*UNITS, LENGTH=MM, MASS=G, STIFFNESS=N/MM, FREQUENCY=KHZ\n*MATERIAL, NAME=steel\n"
                                        "*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=steel\n"
                                        "800, 30, 0, 80\n*SPRING, NAME=foam\n100, 0.5\n*SPRING, NAME=felt\n700, 0.4\n"
                                        "*IDENTIFY\nbar.E, 1e10, 6e11, 2.1e11\nfoam.k, 0.01, 100, 0.5\n",
                             *modes = "*MODES\n1, 0.2\n2, 0.55\n";
    static const enum test_kind kinds[] = {TEST_MASS, TEST_STIFF, TEST_FREE, TEST_MOVED};
    const char *path[] = {"units.inp", "table.inp", "named.inp", "included.inp", "chosen.inp"};
    const char *to = pool_copy_text(&test_pool, folder_path("next/next.inp"));
    struct message_list notes;
    char *text;
    assert_int_equal(mkdir(folder_path("next"), 0700), 0);
    (void)folder_write("units.inp", pool_format(&test_pool, "%s%s", shaft_mm, modes));
    (void)folder_write("modes.csv", "mode,frequency [kHz]\n1,0.2\n2,0.55\n");
    (void)folder_write("table.inp", pool_format(&test_pool, "%s*MODES,\n File = modes.csv ** of today\n", shaft_mm));
    (void)folder_write("named.inp", pool_format(&test_pool, "%s*STATE, NAME=Mass\n%s*STATE, NAME=heavy\n*DISK\n500, 90\n%s",
                                                shaft_mm, modes, modes));
    (void)folder_write("shaft.inc", shaft_mm);
    (void)folder_write("modes.inc", "** measured with care\n*DISK\n500, 90\n*MODES, FILE=modes.csv\n");
    (void)folder_write("included.inp", "*INCLUDE, FILE=shaft.inc\n** the hammer\n*INCLUDE, FILE=modes.inc\n");
    (void)folder_write("chosen.inp", pool_format(&test_pool, "%s*FIT, STATE=one\n*STATE, NAME=one\n%s*STATE, NAME=two\n%s",
                                                 shaft_mm, modes, modes));
    for (int i = 0; i < 4; i++)
        for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
            struct states states;
            const char *home = i == 2 ? "heavy" : NULL;
            if (propose(folder_path(path[i]), to, home, kinds[k], NULL, &notes, &text))
                fail_msg("%s %s: %s", path[i], test_id(kinds[k]), notes.count ? notes.item[0].text : "no message");
            (void)folder_write("next/next.inp", pool_format(&test_pool, "%s*MODES\n1, 0.199\n2, 0.548\n", text));
            states = read_states_at(to, NULL);
            assert_int_equal(states.nstate, i == 2 ? 3 : 2);
            const struct rotor *was = &states.state[states.nstate - 2].job.rotor,
                               *rotor = &states.state[states.nstate - 1].job.rotor;
            assert_close(states.state[0].job.measurement.frequency_hz[0], 200, 1e-12, 0);
            assert_int_equal(rotor->ndisk, was->ndisk + (kinds[k] == TEST_MASS));
            if (kinds[k] == TEST_MASS) {
                assert_close(rotor->disk[rotor->ndisk - 1].position, 0.25, 1e-12, 0);
                assert_close(rotor->disk[rotor->ndisk - 1].mass, 0.5, 1e-12, 0);
                assert_non_null(strstr(text, "\n250, 500\n"));
            }
            if (kinds[k] == TEST_STIFF)
                assert_close(rotor->spring[1].lateral, 4000, 1e-12, 0);
            if (kinds[k] == TEST_MOVED)
                assert_close(rotor->spring[2].position, 0.25, 1e-12, 0);
            assert_close(rotor->sensor[1].position, 0.4, 1e-12, 0);
            assert_non_null(strstr(text, "** 2, 0.548\n"));
            assert_int_equal(!!strstr(text, "*STATE, NAME=mass_2\n"), i == 2 && kinds[k] == TEST_MASS);
            if (i == 3) {
                assert_non_null(strstr(text, "/shaft.inc\n"));
                assert_non_null(strstr(text, "** measured with care\n"));
            }
        }
    /* in the same folder paths stay */
    assert_int_equal(propose(folder_path("table.inp"), folder_path("next.inp"), NULL, TEST_MASS, NULL, &notes, &text), 0);
    assert_non_null(strstr(text, "*MODES,\n File = modes.csv ** of today\n"));
    /* cards of something else are not handed out: SI in millimetres, and a state that is not read */
    assert_int_equal(
        propose(folder_path("units.inp"), to, NULL, TEST_MASS,
                "** proposed\n*STATE, NAME=mass\n*DISK, NAME=known_mass\n0.25, 0.5\n*SENSORS\n1, 100\n2, 400\n3, 700\n"
                "** *MODES\n** 1, 0.2\n",
                &notes, &text),
        ROTID_ERROR_ARGUMENT);
    assert_null(text);
    assert_non_null(strstr(notes.item[0].text, "the cards of the test mass would be read as another one"));
    assert_int_equal(propose(folder_path("chosen.inp"), to, NULL, TEST_MASS, NULL, &notes, &text), ROTID_ERROR_ARGUMENT);
    assert_null(text);
    assert_int_equal(propose(folder_path("units.inp"), folder_path("nowhere/x.inp"), NULL, TEST_MASS, NULL, &notes, &text),
                     ROTID_ERROR_IO);
}

/* Modes that *FIT holds out are of the test that was made: the next one may not measure them. This once gave no deck. */
POOL_TEST(modes_that_are_held_out_stay_with_their_state)
{
    static const char *const model = STEEL_BAR "*SPRING, NAME=foam\n0.1, 500\n*IDENTIFY\nbar.E, 1e10, 6e11, 2.1e11\n";
    struct message_list notes;
    struct states states;
    char *text;
    (void)folder_write(
        "held.inp", pool_format(&test_pool, "%s*MODES\n1, 200\n2, 550\n3, 1080\n4, 1780\n*FIT, MODES=1-3, HOLDOUT=3\n", model));
    assert_int_equal(propose(folder_path("held.inp"), folder_path("next.inp"), NULL, TEST_MASS, NULL, &notes, &text), 0);
    assert_non_null(strstr(text, "*STATE, NAME=measured, MODES=1-3, HOLDOUT=3\n"));
    (void)folder_write("held.inp", pool_format(&test_pool, "%s*MODES\n1, 199\n2, 548\n", text));
    states = read_states_at(folder_path("held.inp"), NULL);
    static const int held[] = {0, 0, 1, 1};
    assert_memory_equal(states.state[0].job.measurement.holdout, held, sizeof held);
    assert_memory_equal(states.state[1].job.measurement.holdout, held, 2 * sizeof *held);
}

/* *IDENTIFY may have a stiffness that the card of the support lacks: it starts from there and the card says none. Refused once.
 */
POOL_TEST(a_stiffness_that_identify_alone_states_is_left_to_it)
{
    static const enum test_kind kinds[] = {TEST_STIFF, TEST_FREE, TEST_MOVED};
    struct message_list notes;
    char *text;
    (void)folder_write("turning.inp", STEEL_BAR "*SPRING, NAME=foam\n0.1, 500\n*MODES\n1, 200\n2, 550\n"
                                                "*IDENTIFY\nbar.E, 1e10, 6e11, 2.1e11\nfoam.k_rot, 0.1, 10, 1\n");
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (propose(folder_path("turning.inp"), folder_path("next.inp"), NULL, kinds[k], NULL, &notes, &text))
            fail_msg("%s: %s", test_id(kinds[k]), notes.count ? notes.item[0].text : "no message");
}

/* A rival with a parameter that no datum feels, of a lap whose bending and shear are sought apart: it has a prior of 100 %. */
POOL_TEST(a_parameter_that_nothing_feels_ends_no_suggestion)
{
    rotid_deck *deck;
    rotid_suggestion *suggestion;
    char failure[ROTID_FAILURE_LENGTH];
    assert_status(rotid_deck_read(ROTID_SOURCE_DIR "/input/brake_reuss_lap.inp", 0, NULL, NULL, failure, &deck), ROTID_OK);
    rotid_suggest_options options = {.size = sizeof options, .threads = 1};
    assert_status(rotid_suggest(deck, &options, NULL, failure, &suggestion), ROTID_OK);
    assert_true(suggestion->nplans > 0 && suggestion->sentence);
    rotid_suggestion_free(suggestion);
    rotid_deck_free(deck);
}

TEST_GROUP(folder_make, folder_remove);
