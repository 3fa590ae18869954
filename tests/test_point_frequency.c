/* Frequencies that each measured mode has at single sensors: the regression behind their mean, the card, the sets of a universal
 * file, and the deck that is written again. */
#include <unistd.h>

#include "deck/deck.h"
#include "folder.h"
#include "reading.h"
#include "run/run.h"
#include "support.h"

#define POINTS 21

/* Mean over all sensors of f (1 - b s^2) of a free beam's first shape, near enough. */
static void shape_of_beam(double *shape)
{
    for (int j = 0; j < POINTS; j++) {
        double xi = j / (POINTS - 1.0);
        shape[j] = 1 - 6.4 * xi * (1 - xi); /* two nodes near 0.22 and 0.78 */
    }
}

static double loaded(double hz, double b, double shape)
{
    return hz * (1 - b * shape * shape);
}

/* ------------------------------------------------------------------------------------------------ numbers */

POOL_TEST(the_mean_is_over_all_sensors_and_not_over_those_that_read)
{
    double shape[POINTS], hz[POINTS], std[POINTS], expected = 0;
    struct point_mean mean;
    shape_of_beam(shape);
    for (int j = 0; j < POINTS; j++) {
        hz[j] = loaded(100, 0.01, shape[j]);
        std[j] = 0.01;
        expected += hz[j] / POINTS;
    }
    assert_status(point_mean(&test_pool, POINTS, hz, std, shape, &mean), ROTID_OK);
    assert_true(mean.regressed && !mean.dropped && mean.readings == POINTS);
    assert_close(mean.hz, expected, 1e-14, 0);
    assert_close(mean.std, 0.01 / sqrt(POINTS), 1e-12, 0);
    for (int j = 0; j < POINTS; j++) /* points near a node of the mode have none */
        if (fabs(shape[j]) < 0.3)
            hz[j] = std[j] = NAN;
    assert_status(point_mean(&test_pool, POINTS, hz, std, shape, &mean), ROTID_OK);
    assert_true(mean.regressed && mean.readings < POINTS - 4);
    assert_close(mean.hz, expected, 1e-12, 0);
    double plain = 0;
    for (int j = 0; j < POINTS; j++)
        plain += isfinite(hz[j]) ? hz[j] / mean.readings : 0;
    assert_true(expected - plain > 5 * mean.std); /* what the points without one would have cost */
    hz[3] = NAN;
    shape[3] = NAN; /* no component: the sensor is not one of those that the mean is over, and no reading of it counts */
    assert_status(point_mean(&test_pool, POINTS, hz, std, shape, &mean), ROTID_OK);
    assert_true(isfinite(mean.hz) && mean.regressed);
}

POOL_TEST(two_columns_that_resemble_each_other_are_told_apart)
{
    double y[2 * POINTS], std[2 * POINTS], a[2 * POINTS], b[2 * POINTS], mean[8];
    char use[2 * POINTS];
    for (int i = 0; i < 2 * POINTS; i++) {
        double x = i % POINTS / (POINTS - 1.0);
        a[i] = x;
        b[i] = x * x; /* of a correlation of 0.97 with the other */
        y[i] = (i < POINTS ? 3 : 7) + 2 * a[i] - 1.5 * b[i];
        std[i] = 0.01 * (1 + i % 3);
        use[i] = 1;
    }
    const struct point_readings readings = {
        .nmode = 2, .npoint = POINTS, .ncolumn = 2, .y = y, .std = std, .column = {a, b}, .use = use, .mean = mean};
    struct point_fit fit;
    assert_int_equal(point_fit(&readings, &fit), 0);
    assert_close(fit.slope[0], 2, 1e-10, 0);
    assert_close(fit.slope[1], -1.5, 1e-10, 0);
    assert_true(fit.cross < 0 && fit.cross * fit.cross < fit.variance[0] * fit.variance[1]);
    assert_int_equal(fit.dof, 2 * POINTS - 4);
}

POOL_TEST(few_points_give_their_plain_mean)
{
    double shape[POINTS], hz[POINTS], std[POINTS];
    struct point_mean mean;
    shape_of_beam(shape);
    for (int j = 0; j < POINTS; j++)
        hz[j] = std[j] = NAN;
    assert_status(point_mean(&test_pool, POINTS, hz, std, shape, &mean), ROTID_ERROR_ARGUMENT);
    hz[0] = 100;
    assert_status(point_mean(&test_pool, POINTS, hz, std, shape, &mean), ROTID_OK);
    assert_true(mean.hz == 100 && !mean.regressed && isnan(mean.std)); /* one reading without a deviation says nothing of it */
    hz[5] = 101;
    std[0] = 0.1;
    assert_status(point_mean(&test_pool, POINTS, hz, std, shape, &mean), ROTID_OK); /* the other one counts with the same 0.1 */
    assert_close(mean.hz, 100.5, 1e-14, 0);
    assert_close(mean.std, 0.1 / sqrt(2) * sqrt(50), 1e-12, 0); /* 1 Hz apart: chi2 is 50 for one degree of freedom */
    assert_close(mean.std_of_others, 0.1, 1e-14, 0);
    for (int j = 0; j < POINTS; j++) {
        hz[j] = loaded(100, 0.01, shape[j]);
        std[j] = 0.01;
        shape[j] = j % 2 ? 1 : -1;
    }
    assert_status(point_mean(&test_pool, POINTS, hz, std, shape, &mean), ROTID_OK); /* nothing to regress on */
    assert_true(!mean.regressed && mean.hz > 99 && mean.hz < 100);
    assert_status(point_mean(&test_pool, POINTS, hz, std, NULL, &mean), ROTID_OK);
    assert_true(!mean.regressed);
}

/* Deviations of the mean against what happens over many tests: with stated noise, with noise stated a third of what it is, and
 * with none stated. */
POOL_TEST(the_deviation_of_the_mean_is_what_it_scatters_by)
{
    static const double stated[] = {0.01, 0.0033, NAN};
    struct random_stream stream = {17};
    double shape[POINTS], hz[POINTS], std[POINTS];
    shape_of_beam(shape);
    for (int variant = 0; variant < 3; variant++) {
        double square = 0, dropped = 0, expected = 0;
        for (int run = 0; run < 2000; run++) {
            struct point_mean mean;
            expected = 0;
            for (int j = 0; j < POINTS; j++) {
                hz[j] = loaded(100, 0.01, shape[j]) + 0.01 * random_normal(&stream);
                std[j] = stated[variant];
                expected += loaded(100, 0.01, shape[j]) / POINTS;
            }
            hz[10] = std[10] = hz[11] = std[11] = NAN;
            assert_status(point_mean(&test_pool, POINTS, hz, std, shape, &mean), ROTID_OK);
            double z = (mean.hz - expected) / mean.std;
            square += z * z / 2000;
            dropped += mean.dropped;
        }
        print_message("noise %s: rms of (mean - truth)/std %.3f, readings dropped in %.2f %% of the tests\n",
                      variant == 0   ? "stated"
                      : variant == 1 ? "understated"
                                     : "not stated",
                      sqrt(square), dropped / 20);
        assert_true(sqrt(square) > 0.9 && sqrt(square) < 1.12);
        assert_true(dropped < 0.03 * 2000); /* 1 % nominal */
    }
}

POOL_TEST(one_wrong_reading_does_not_move_the_mean)
{
    struct random_stream stream = {19};
    double shape[POINTS], hz[POINTS], std[POINTS], clean[POINTS];
    shape_of_beam(shape);
    for (int j = 0; j < POINTS; j++) {
        clean[j] = hz[j] = loaded(100, 0.01, shape[j]) + 0.01 * random_normal(&stream);
        std[j] = 0.01;
    }
    hz[4] -= 1;
    struct point_mean with, without;
    assert_status(point_mean(&test_pool, POINTS, hz, std, shape, &with), ROTID_OK);
    clean[4] = NAN;
    assert_status(point_mean(&test_pool, POINTS, clean, std, shape, &without), ROTID_OK);
    assert_int_equal(with.dropped, 1);
    assert_close(with.hz, without.hz, 1e-14, 0);
    assert_close(with.std, without.std, 1e-12, 0);
}

/* Readings a step above and below their mean by turns: the median of the sizes is a step, the noise that normal readings of this
 * median have is 1.4826 steps. Of 21 readings, one beyond 4.2 such noises is wrong: 8 steps are 3.7 of them and 10 are 4.4, by
 * the equations of drop_from_line with the mean of all. */
POOL_TEST(a_median_of_sizes_stands_for_one_and_a_half_of_the_noise)
{
    for (int steps = 8; steps <= 10; steps += 2) {
        double hz[POINTS], std[POINTS];
        struct point_mean mean;
        for (int j = 0; j < POINTS; j++) {
            hz[j] = 100 + 0.01 * (j == 4 ? steps : j % 2 ? 1 : -1);
            std[j] = 0.001; /* stated far too small: the scatter alone tells the noise */
        }
        assert_status(point_mean(&test_pool, POINTS, hz, std, NULL, &mean), ROTID_OK);
        assert_int_equal(mean.dropped, steps == 10);
    }
}

#define MODEL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, 20\n"
#define DATA                                                                                                                     \
    "*SENSORS\n1, 0\n2, 0.2\n3, 0.4\n4, 0.6\n5, 0.8\n6, 1\n*MODES\n1, 450\n2, 1230, , 0.7\n*SHAPE, MODE=1\n1, 1\n2, 0.1\n3, "    \
    "-0.55\n4, -0.55\n5, 0.1\n6, 1\n*SHAPE, MODE=2\n1, 1\n2, -0.4\n3, -0.5\n4, 0.5\n5, 0.4\n6, -1\n"
#define POINTS_1 "*FREQUENCIES, MODE=1\n1, 447, 0.2\n2, 450, 0.2\n3, 449, 0.3\n4, 449\n6, 447.1, 0.2\n"
#define POINTS_2 "*FREQUENCIES, MODE=2\n1, 1228\n"
#define END      "*IDENTIFY\ncore.E, 1e10, 4e11, 2e11\n"

static int has_note(const struct reading *r, const char *text)
{
    for (size_t i = 0; i < r->messages.count; i++)
        if (strstr(r->messages.item[i].text, text))
            return 1;
    return 0;
}

POOL_TEST(a_deck_without_them_has_none)
{
    struct reading r;
    read_job(MODEL DATA END, &r.messages, &r.job);
    assert_true(!r.job.measurement.point_frequency_hz && !r.job.measurement.point_frequency_std &&
                r.job.measurement.frequency_hz[0] == 450);
}

POOL_TEST(the_card_sets_the_frequency_of_its_mode)
{
    struct reading r;
    struct point_mean mean;
    read_job(MODEL DATA POINTS_1 POINTS_2 "*NOISE, FREQUENCY=0.001\n" END, &r.messages, &r.job);
    const double *hz = r.job.measurement.point_frequency_hz, *std = r.job.measurement.point_frequency_std;
    assert_non_null(hz);
    assert_true(hz[0] == 447 && hz[3] == 449 && isnan(hz[4]) && hz[6] == 1228 && isnan(hz[7]));
    assert_close(std[2], 0.3, 1e-15, 0);
    assert_close(std[3], 0.449, 1e-15, 0); /* NOISE counts for the reading that has no deviation of its own */
    assert_status(point_mean(&test_pool, 6, hz, std, r.job.measurement.shape, &mean), ROTID_OK);
    assert_true(mean.regressed && mean.hz != 450);
    assert_close(r.job.measurement.frequency_hz[0], mean.hz, 1e-15, 0);
    assert_close(r.job.measurement.frequency_std[0], mean.std / mean.hz, 1e-15, 0);
    assert_true(r.job.measurement.frequency_hz[1] == 1228 && has_note(&r, "mode 2 has 1 frequencies at single sensors"));
    assert_close(r.job.measurement.frequency_std[1], 0.001, 1e-15, 0);
    read_job(MODEL DATA "*FREQUENCIES, MODE=2, MEAN=NO\n1, 1228\n" END, &r.messages, &r.job);
    assert_true(r.job.measurement.frequency_hz[1] == 1230 && r.job.measurement.point_frequency_hz[6] == 1228);
    assert_close(r.job.measurement.frequency_std[1], 0.7 / 1230, 1e-14, 0);
}

POOL_TEST(floors_are_added_to_what_the_data_state_and_to_nothing_else)
{
    struct reading r;
    read_job(MODEL DATA "*NOISE, FREQUENCY=0.001, FLOOR_FREQUENCY=0.002, SHAPE=0.02, FLOOR_SHAPE=0.01\n" END, &r.messages,
             &r.job);
    assert_close(r.job.measurement.frequency_std[0], 0.001, 1e-15, 0);
    assert_close(r.job.measurement.frequency_std[1], hypot(0.7 / 1230, 0.002), 1e-14, 0);
    assert_close(r.job.measurement.shape_std[0], 0.02, 1e-15, 0);
}

static void assert_same(ptrdiff_t count, const double *a, const double *b)
{
    for (ptrdiff_t i = 0; i < count; i++)
        assert_true((isnan(a[i]) && isnan(b[i])) || a[i] == b[i]);
}

/* Mean and deviations are settled once: the deck that is written gives the numbers back, whatever the noise came from, and with
 * faults of the data taken out behind it. */
POOL_TEST(the_deck_comes_back)
{
    static const char *const text[] = {
        MODEL DATA POINTS_1 POINTS_2 "*NOISE, FREQUENCY=0.001, FLOOR_FREQUENCY=0.0005, SHAPE=0.02\n" END,
        MODEL DATA "*FREQUENCIES, MODE=1\n1, 447\n2, 450\n3, 449\n4, 449.2\n5, 450.2\n6, 447.1\n" END,
        MODEL DATA POINTS_1 "*NOISE, SHAPE=0.02\n*CAUSE, NAME=a, TYPE=sensor_position, SENSOR=2\nshift, 0.3\n"
                            "*CAUSE, NAME=b, TYPE=noise_level, AT=SHAPE\nfactor, 1.5\n" END};
    for (int i = 0; i < 3; i++) {
        struct reading r, back;
        char *written;
        double damping[] = {0.01, 0.02};
        read_job(text[i], &r.messages, &r.job);
        struct state only, other;
        const struct states given = states_of(&r.job, &only), meant = states_of(&r.job, &other);
        other.job.measurement.damping = damping; /* so that the data are written anew */
        assert_status(deck_write(&test_pool, &given, &meant, NULL, &r.messages, &written), ROTID_OK);
        assert_non_null(strstr(written, "MEAN=NO"));
        read_job(written, &back.messages, &back.job);
        assert_same(12, r.job.measurement.point_frequency_hz, back.job.measurement.point_frequency_hz);
        assert_same(12, r.job.measurement.point_frequency_std, back.job.measurement.point_frequency_std);
        assert_close(back.job.measurement.frequency_hz[0], r.job.measurement.frequency_hz[0], 1e-15, 0);
        assert_close(back.job.measurement.frequency_std[0], r.job.measurement.frequency_std[0], 1e-14, 0);
    }
}

POOL_TEST(frequencies_follow_their_sensor)
{
    struct reading r;
    read_job(MODEL DATA POINTS_1 "*CAUSE, NAME=a, TYPE=sensor_position, SENSOR=2\nshift, 0.3\n"
                                 "*CAUSE, NAME=b, TYPE=sensor_swap, SENSOR=1,6\n" END,
             &r.messages, &r.job);
    assert_int_equal(r.job.rotor.sensor[2].id, 2); /* now behind sensor 3 */
    assert_true(r.job.measurement.point_frequency_hz[2] == 450 && r.job.measurement.point_frequency_hz[1] == 449);
    assert_true(r.job.measurement.point_frequency_hz[0] == 447.1 && r.job.measurement.point_frequency_hz[5] == 447);
}

/* ------------------------------------------------------------------------------------------------ universal files */

static int node[6] = {1, 2, 3, 4, 5, 6};
static double values[6];

static struct uff_shape extra_set(const char *first, const char *second, const double *value)
{
    struct uff_shape set = {.line = 40, .component_count = 1, .node_count = 6, .node = node};
    (void)snprintf(set.id[0], sizeof set.id[0], "%s", first);
    (void)snprintf(set.id[1], sizeof set.id[1], "%s", second);
    for (int i = 0; i < 6; i++)
        values[i] = value[i];
    set.real = values;
    return set;
}

/* One such set behind modes 3 and 7 of a file that are the two of the deck; returns the first error, or "". */
static const char *read_set(struct reading *r, struct uff_shape *set, int count)
{
    static const struct uff_shape first = {.number = 3}, second = {.number = 7};
    const struct uff_shape *const chosen[] = {&first, &second};
    struct uff_file data = {.extra_count = count, .extra = set};
    struct deck_reader reader = {.pool = &test_pool, .messages = &r->messages, .job = &r->job};
    read_job(MODEL DATA END, &r->messages, &r->job);
    deck_uff_std(&reader, "test.uff", &data, 2, chosen, 0);
    for (size_t i = 0; i < r->messages.count; i++)
        if (r->messages.item[i].severity == SEVERITY_ERROR) {
            assert_string_equal(r->messages.item[i].file, "test.uff");
            assert_true(r->messages.item[i].line == 42 || r->messages.item[i].line == 43);
            assert_non_null(strstr(r->messages.item[i].text, "expected"));
            return r->messages.item[i].text;
        }
    return "";
}

static const char *read_one(struct reading *r, const char *first, const char *second, const double *value)
{
    struct uff_shape set = extra_set(first, second, value);
    return read_set(r, &set, 1);
}

POOL_TEST(sets_of_deviations_become_those_of_the_job)
{
    struct reading r;
    const double std[6] = {0.01, 0, 0.02, 0.03, 0.01, 0.01}, hz[6] = {1200, 0, 1228, 1230, 1229, 1201},
                 of[6] = {1, 0, 2, 3, 4, 5};
    assert_string_equal(read_one(&r, "ROTID STANDARD DEVIATION OF MODE 7", "FREQUENCY_HZ 0.615 DAMPING 1e-4", std), "");
    assert_close(r.job.measurement.frequency_std[1], 0.615 / 1230, 1e-14, 0);
    assert_true(isnan(r.job.measurement.frequency_std[0]) && isnan(r.job.measurement.shape_std[0]) &&
                isnan(r.job.measurement.shape_std[7]));
    assert_close(r.job.measurement.shape_std[8], 0.02, 1e-15, 0); /* the largest component is 1 */
    assert_string_equal(read_one(&r, "ROTID FREQUENCY AT POINT OF MODE 7", "", hz), "");
    assert_true(r.job.measurement.point_frequency_hz[6] == 1200 && isnan(r.job.measurement.point_frequency_hz[7]) &&
                isnan(r.job.measurement.point_frequency_hz[0]));
    assert_string_equal(read_one(&r, "ROTID STANDARD DEVIATION OF FREQUENCY AT POINT OF MODE 3", "", of), "");
    assert_true(r.job.measurement.point_frequency_std[0] == 1 && isnan(r.job.measurement.point_frequency_std[1]) &&
                isnan(r.job.measurement.point_frequency_hz[0]));
    assert_string_equal(read_one(&r, "SOMEBODY ELSE'S SET OF MODE 99", "", of), "");
}

POOL_TEST(malformed_sets_are_refused)
{
    struct reading r;
    const double good[6] = {0.01, 0.01, 0.02, 0.03, 0.01, 0.01}, negative[6] = {0.01, -0.01, 0, 0, 0, 0},
                 far[6] = {450, 440, 480};
    const char *name = "ROTID STANDARD DEVIATION OF MODE 3", *both = "FREQUENCY_HZ 0.1 DAMPING 0";
    assert_non_null(strstr(read_one(&r, "ROTID STANDARD DEVIATION OF MODE 4", both, good), "a mode that is not there"));
    assert_non_null(strstr(read_one(&r, "ROTID STANDARD DEVIATION OF MODE three", both, good), "names no mode"));
    assert_non_null(strstr(read_one(&r, name, "", good), "expected FREQUENCY_HZ value DAMPING value"));
    assert_non_null(strstr(read_one(&r, name, "FREQUENCY_HZ -1 DAMPING 0", good), "expected FREQUENCY_HZ value"));
    assert_non_null(strstr(read_one(&r, name, "FREQUENCY_HZ 1 DAMPING nan", good), "expected FREQUENCY_HZ value"));
    assert_non_null(strstr(read_one(&r, name, "FREQUENCY_HZ 1 DAMPING 0 HZ", good), "expected FREQUENCY_HZ value"));
    assert_non_null(strstr(read_one(&r, name, both, negative), "-0.01 at node 2"));
    assert_non_null(strstr(read_one(&r, "ROTID FREQUENCY AT POINT OF MODE 3", "", far), "480 at node 3"));
    node[5] = 9;
    assert_non_null(strstr(read_one(&r, name, both, good), "node 9"));
    node[5] = 6;
    struct uff_shape set[2] = {extra_set(name, both, good), extra_set(name, both, good)};
    assert_non_null(strstr(read_set(&r, set, 2), "given twice"));
    set[0].imag = values;
    assert_non_null(strstr(read_set(&r, set, 1), "complex"));
}

TEST_GROUP(folder_make, folder_remove);
