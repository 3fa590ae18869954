/* Modes of several tests as one, the scatter between them, and the floors that a deck takes from what its file states. */
#include "deck/deck.h"
#include "ema/ema.h"
#include "folder.h"
#include "import/import.h"
#include "one_state.h"
#include "support.h"

#define TESTS  40
#define MODES  3
#define POINTS 12

/* sin(wave pi z) with noise as the shape of mode k. */
static void put_shape(struct ema *test, int k, int wave, double factor, double noise, struct random_stream *stream)
{
    struct ema_mode *mode = &test->mode[k];
    for (int p = 0; p < POINTS; p++) {
        double exact = sin(wave * 3.141592653589793 * (test->point_node[p] - 10 + 0.5) / POINTS);
        mode->complex_shape[p] = mode->shape[p] = factor * (exact + noise * random_normal(stream));
    }
}

/* Tests of known scatter: modes sin(k pi z) with signs and an order of the points of their own; mode 2 of the last one has
 * another shape where `foreign`. */
static void make_tests(int count, double frequency, double shape, int foreign, struct ema test[])
{
    struct random_stream stream = {7};
    for (int t = 0; t < count; t++) {
        test[t] = (struct ema){.npoint = POINTS, .nmode = MODES, .impacts = 4, .std_from_impacts = 1};
        test[t].point_node = POOL_ARRAY(&test_pool, int, POINTS);
        test[t].point_direction = POOL_ARRAY(&test_pool, int, POINTS);
        test[t].mode = POOL_ARRAY(&test_pool, struct ema_mode, MODES);
        for (int k = 0; k < MODES; k++) {
            struct ema_mode *mode = &test[t].mode[k];
            mode->shape = POOL_ARRAY(&test_pool, double, POINTS);
            mode->shape_std = POOL_ARRAY(&test_pool, double, POINTS);
            mode->complex_shape = POOL_ARRAY(&test_pool, double complex, POINTS);
            mode->frequency_hz = 100 * (k + 1) * (k + 1) * (1 + frequency * random_normal(&stream));
            mode->frequency_std = 1e-6;
            mode->damping = 0.01;
            mode->modal_mass = 5;
            for (int p = 0; p < POINTS; p++) {
                test[t].point_node[p] = 10 + (p + 5 * t) % POINTS;
                test[t].point_direction[p] = 1;
                mode->shape_std[p] = 1e-6;
            }
            put_shape(&test[t], k, foreign && t == count - 1 && k == 1 ? 5 : k + 1, t % 2 ? -1 : 1, shape, &stream);
        }
    }
}

POOL_TEST(means_and_scatter_are_those_of_the_draws)
{
    static struct ema test[TESTS];
    struct ema mean;
    struct ema_scatter scatter;
    make_tests(TESTS, 3e-4, 5e-3, 0, test);
    assert_status(ema_average(&test_pool, TESTS, test, &mean, &scatter), ROTID_OK);
    assert_int_equal(mean.nmode, MODES);
    assert_int_equal(mean.tests, TESTS);
    assert_int_equal(scatter.missing, 0);
    assert_close(scatter.frequency, 3e-4, 0.2, 0); /* 117 degrees of freedom: 6.5 % */
    assert_close(scatter.shape, 5e-3, 0.06, 0);    /* 1287 of them: 2 % */
    for (int k = 0; k < MODES; k++) {
        double hz = 0, largest = 0, sign = mean.mode[k].shape[0] > 0 ? 1 : -1;
        for (int p = 0; p < POINTS; p++)
            largest = fmax(largest, fabs(sin((k + 1) * 3.141592653589793 * (p + 0.5) / POINTS)));
        for (int t = 0; t < TESTS; t++)
            hz += test[t].mode[k].frequency_hz / TESTS;
        assert_close(mean.mode[k].frequency_hz, hz, 1e-13, 0);
        assert_close(mean.mode[k].frequency_std, scatter.frequency * hz / sqrt(TESTS), 1e-12, 0);
        for (int p = 0; p < POINTS; p++) {
            assert_close(sign * mean.mode[k].shape[p], sin((k + 1) * 3.141592653589793 * (p + 0.5) / POINTS) / largest, 0,
                         12 * 5e-3 / sqrt(TESTS));
            assert_close(mean.mode[k].shape_std[p], scatter.shape / sqrt(TESTS), 1e-12, 0);
        }
    }
}

POOL_TEST(a_mode_counts_where_every_test_has_it)
{
    static struct ema test[3];
    struct ema mean;
    struct ema_scatter scatter;
    make_tests(3, 1e-4, 1e-3, 1, test);
    assert_status(ema_average(&test_pool, 3, test, &mean, &scatter), ROTID_OK);
    assert_int_equal(mean.nmode, MODES - 1);
    assert_int_equal(scatter.missing, 1);
    assert_int_equal(scatter.lacking, 0);
    assert_close(mean.mode[1].frequency_hz, 900, 1e-3, 0);
}

/* The second test has a point along another axis, the third one lacks another. */
POOL_TEST(a_point_counts_where_every_test_has_it)
{
    static struct ema test[3];
    struct ema mean;
    struct ema_scatter scatter;
    make_tests(3, 1e-4, 1e-3, 0, test);
    test[1].point_direction[3] = 2;
    test[2].npoint--;
    assert_status(ema_average(&test_pool, 3, test, &mean, &scatter), ROTID_OK);
    assert_int_equal(mean.npoint, POINTS - 2);
    assert_int_equal(scatter.lacking, 3); /* the first along both axes */
}

ORDER_BY(rising, double, *it, 0)

/* Modes 1 and 2 as of two planes along one axis, 0.4 % apart, of tests that shift both by more than that: each partner once. The
 * first two tests are too far apart for each other. */
POOL_TEST(alike_shapes_keep_the_order_of_their_frequencies)
{
    struct ema test[3], mean;
    struct ema_scatter scatter;
    struct random_stream stream = {3};
    static const double shift[3] = {0.03, -0.03, 0};
    for (int round = 0; round < 20; round++) {
        make_tests(3, 0, 0, 0, test);
        for (int t = 0; t < 3; t++)
            for (int k = 0; k < 2; k++) {
                test[t].mode[k].frequency_hz = (k ? 100.4 : 100) * (1 + shift[t]);
                put_shape(&test[t], k, 1, k ? 0.8 : 1, 0.01, &stream);
            }
        assert_status(ema_average(&test_pool, 3, test, &mean, &scatter), ROTID_OK);
        assert_int_equal(mean.nmode, MODES);
        assert_close(mean.mode[0].frequency_hz, 100, 1e-12, 0);
        assert_close(mean.mode[1].frequency_hz, 100.4, 1e-12, 0);
        assert_close(scatter.std_hz[0], 3, 1e-12, 0);
    }
}

/* Modes 1 and 2, of a MAC of 0.86, change places in the last test. */
POOL_TEST(shapes_that_differ_tell_modes_that_cross)
{
    struct ema test[3], mean;
    struct ema_scatter scatter;
    struct random_stream stream = {3};
    make_tests(3, 0, 1e-2, 0, test);
    for (int t = 0; t < 3; t++)
        for (int k = 0; k < 2; k++) {
            test[t].mode[k].frequency_hz = k ? 100.5 : 100;
            put_shape(&test[t], k, 1, 1, 0.01, &stream);
            for (int p = 0; p < POINTS && (t == 2) != k; p++)
                test[t].mode[k].shape[p] += 0.4 * sin(2 * 3.141592653589793 * (test[t].point_node[p] - 10 + 0.5) / POINTS);
        }
    assert_status(ema_average(&test_pool, 3, test, &mean, &scatter), ROTID_OK);
    assert_int_equal(mean.nmode, MODES);
    assert_close(mean.mode[0].frequency_hz, (100 + 100 + 100.5) / 3, 1e-12, 0);
    assert_close(mean.mode[1].frequency_hz, (100.5 + 100.5 + 100) / 3, 1e-12, 0);
}

/* Modes of one shape whose frequencies are drawn: of all pairings that of one order has the least sum of squares. */
POOL_TEST(modes_of_one_shape_are_paired_in_order)
{
    struct ema test[2], mean;
    struct ema_scatter scatter;
    struct random_stream stream = {3};
    make_tests(2, 0, 0, 0, test);
    for (int round = 0; round < 100; round++) {
        double hz[2][MODES], sum[MODES];
        for (int t = 0; t < 2; t++)
            for (int k = 0; k < MODES; k++) {
                put_shape(&test[t], k, 1, 1, 0, &stream);
                hz[t][k] = test[t].mode[k].frequency_hz = 100 + random_uniform(&stream);
            }
        assert_status(ema_average(&test_pool, 2, test, &mean, &scatter), ROTID_OK);
        assert_int_equal(mean.nmode, MODES);
        for (int k = 0; k < MODES; k++)
            sum[k] = 2 * mean.mode[k].frequency_hz;
        qsort(hz[0], MODES, sizeof **hz, rising);
        qsort(hz[1], MODES, sizeof **hz, rising);
        qsort(sum, MODES, sizeof *sum, rising);
        for (int k = 0; k < MODES; k++)
            assert_close(sum[k], hz[0][k] + hz[1][k], 1e-13, 0);
    }
}

/* A mode that only the first test has, next to those of all, takes no partner of theirs. */
POOL_TEST(a_mode_of_one_test_takes_no_partner_of_another)
{
    struct ema test[3], mean;
    struct ema_scatter scatter;
    struct random_stream stream = {3};
    make_tests(3, 0, 1e-2, 0, test);
    test[0].mode[1].frequency_hz = 101;
    put_shape(&test[0], 1, 1, 1, 0, &stream);
    assert_status(ema_average(&test_pool, 3, test, &mean, &scatter), ROTID_OK);
    assert_int_equal(mean.nmode, MODES - 1);
    assert_int_equal(scatter.missing, 1);
    assert_close(mean.mode[0].frequency_hz, 100, 1e-12, 0);
    assert_close(mean.mode[1].frequency_hz, 900, 1e-12, 0);
}

/* A scale is fitted to each test: of p points p - 1 scatter. */
POOL_TEST(a_fitted_scale_is_no_scatter)
{
    static struct ema test[TESTS];
    struct ema mean;
    struct ema_scatter scatter;
    for (int points = 2; points <= 3; points++) {
        make_tests(TESTS, 1e-4, 5e-3, 0, test);
        for (int t = 1; t < TESTS; t++)
            for (int p = 0; p < POINTS; p++)
                test[t].point_direction[p] = test[t].point_node[p] < 10 + points ? 1 : 2;
        for (int t = 0; t < TESTS; t++)
            for (int k = 0; k < MODES; k++) /* the largest component is that of the first mode at the edge */
                for (int p = 0; p < POINTS; p++)
                    test[t].mode[k].shape[p] += (t % 2 ? -1.0 : 1.0) * (test[t].point_node[p] == 10 ? 1 : 0);
        assert_status(ema_average(&test_pool, TESTS, test, &mean, &scatter), ROTID_OK);
        assert_int_equal(mean.npoint, points);
        double expected = 0;
        for (int k = 0; k < MODES; k++) /* of the component that is 1 then */
            expected += pow(5e-3 / (1 + sin((k + 1) * 3.141592653589793 * 0.5 / POINTS)), 2) / MODES;
        assert_close(scatter.shape, sqrt(expected), 0.2, 0); /* 117 degrees of freedom at least: 6.5 % */
    }
}

/* MAC is 1 whatever the shapes are, and nothing of them scatters: frequencies alone. */
POOL_TEST(one_point_has_no_scatter_of_shapes)
{
    struct ema test[3], mean;
    struct ema_scatter scatter;
    make_tests(3, 1e-4, 1e-2, 0, test);
    for (int t = 0; t < 2; t++)
        for (int p = 0; p < POINTS; p++)
            test[t].point_direction[p] = test[t].point_node[p] == 10 ? 1 : 2 + t;
    assert_status(ema_average(&test_pool, 3, test, &mean, &scatter), ROTID_OK);
    assert_int_equal(mean.nmode, MODES);
    assert_int_equal(mean.npoint, 1);
    assert_close(scatter.frequency, 1e-4, 0.8, 0);
    assert_true(isnan(scatter.shape) && isnan(mean.mode[0].shape_std[0]));
    assert_close(mean.mode[0].shape[0], 1, 0, 0);
}

/* Three tests of own damping, mass, scale of the shape, phase and doubts, in closed form whatever comes first. */
POOL_TEST(nothing_depends_on_the_order_of_the_tests)
{
    static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    static const double damping[3] = {0.006, 0.01, 0.02}, scale[3] = {1, -2, 0.5}, mass[3] = {3, 4 * 4, 5 * 0.25};
    struct ema test[3], mean, before = {0};
    struct ema_scatter scatter, first = {0};
    for (int o = 0; o < 6; o++) {
        struct ema some[3];
        struct random_stream stream = {11};
        make_tests(3, 1e-4, 0, 0, test);
        for (int t = 0; t < 3; t++)
            for (int k = 0; k < MODES; k++) {
                struct ema_mode *mode = &test[t].mode[k];
                put_shape(&test[t], k, k + 1, scale[t], 1e-3, &stream);
                mode->damping = (k + 1) * damping[t];
                mode->modal_mass = t == 1 && k == 1 ? (double)NAN : mass[t];
                for (int p = 0; p < POINTS; p++)
                    mode->complex_shape[p] *= CMPLX(1, 0.1 * t * (p % 2 ? 1 : -1));
                mode->quality_flags = t == 2 && k == 0 ? EMA_CLOSE : 0;
            }
        test[1].mode[2].modal_mass = -1;
        test[2].npoint--; /* node 10 + 9 of it */
        for (int t = 0; t < 3; t++)
            some[t] = test[order[o][t]];
        assert_status(ema_average(&test_pool, 3, some, &mean, &scatter), ROTID_OK);
        assert_int_equal(mean.nmode, MODES);
        assert_int_equal(mean.npoint, POINTS - 1);
        double relative = sqrt(3 * (pow(0.006 - 0.012, 2) + pow(0.01 - 0.012, 2) + pow(0.02 - 0.012, 2)) / 2 /
                               (0.006 * 0.006 + 0.01 * 0.01 + 0.02 * 0.02));
        assert_close(scatter.damping, relative, 1e-12, 0);
        for (int k = 0; k < MODES; k++) {
            const struct ema_mode *mode = &mean.mode[k];
            assert_close(mode->damping, (k + 1) * 0.012, 1e-12, 0);
            assert_close(scatter.std_damping[k], (k + 1) * sqrt((36 + 4 + 64) * 1e-6 / 2), 1e-12, 0);
            assert_close(mode->damping_std, scatter.std_damping[k] / sqrt(3), 1e-12, 0);
            assert_true(k == 2 ? isnan(mode->modal_mass) : mode->modal_mass > 0);
            assert_int_equal(mode->quality_flags, k ? 0 : EMA_CLOSE);
            for (int p = 0; p < mean.npoint && o; p++)
                for (int q = 0; q < mean.npoint; q++)
                    if (before.point_node[q] == mean.point_node[p])
                        assert_close(mode->shape[p], before.mode[k].shape[q], 0, 1e-13);
            if (!o)
                continue;
            assert_close(mode->frequency_hz, before.mode[k].frequency_hz, 1e-13, 0);
            assert_close(mode->frequency_std, before.mode[k].frequency_std, 1e-9, 0);
            assert_close(mode->shape_std[0], before.mode[k].shape_std[0], 1e-9, 0);
            assert_close(mode->mpc, before.mode[k].mpc, 1e-9, 0);
            assert_close(mode->mpd, before.mode[k].mpd, 1e-9, 0);
            assert_true(mode->mpc < 1 - 1e-4);
        }
        assert_close(mean.mode[0].modal_mass, 4 / pow(sin(5.5 / 12 * 3.141592653589793), 2), 0.01, 0);
        assert_close(mean.mode[1].modal_mass, 4 / pow(sin(5.0 / 12 * 3.141592653589793), 2), 0.01, 0);
        if (!o) {
            before = mean;
            first = scatter;
        }
        assert_close(scatter.shape, first.shape, 1e-9, 0);
    }
}

/* The file of `impacts` impacts (below 0: of so many tests) in a deck without *NOISE: the standard deviation of its mode 1, and
 * what is said. */
static double read_back(int impacts, int tests, double frequency_std, double shape_std, const char **said)
{
    struct ema test[1];
    struct measurement measurement = {0};
    struct message_list messages;
    struct job job;
    make_tests(1, 0, 0, 0, test);
    test->impacts = impacts;
    test->tests = tests;
    measurement.node_count = POINTS;
    measurement.node = POOL_ARRAY(&test_pool, struct uff_node, POINTS);
    for (int p = 0; p < POINTS; p++)
        measurement.node[p] = (struct uff_node){.id = 10 + p, .x = {0, 0, (p + 0.5) / POINTS}};
    for (int k = 0; k < MODES; k++) {
        test->mode[k].frequency_std = frequency_std * test->mode[k].frequency_hz;
        for (int p = 0; p < POINTS; p++)
            test->mode[k].shape_std[p] = shape_std;
    }
    FILE *file = fopen(folder_path("modes.unv"), "w");
    assert_non_null(file);
    assert_status(modes_write(file, "rec.unv", "test", &measurement, test), ROTID_OK);
    assert_int_equal(fclose(file), 0);
    (void)folder_write("deck.inp", "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, "
                                   "MATERIAL=steel\n1, 0.05, 0, 20\n*MEASURED, FILE=modes.unv\n");
    message_open(&messages, &test_pool);
    assert_status(deck_read(&test_pool, folder_path("deck.inp"), 0, NULL, &messages, &job), ROTID_OK);
    *said = "";
    for (size_t i = 0; i < messages.count; i++)
        if (strstr(messages.item[i].text, "scatter"))
            *said = messages.item[i].text;
    return job.measurement.frequency_std[0];
}

POOL_TEST(floors_are_the_scatter_of_single_impacts_and_no_less_than_stated)
{
    const char *said;
    assert_close(read_back(4, 0, 1e-5, 1e-4, &said), hypot(1e-5, 2e-4), 1e-6, 0);
    assert_non_null(strstr(said, "0.02 % of frequencies (the least that is taken)"));
    assert_close(read_back(4, 0, 3e-4, 1e-4, &said), hypot(3e-4, 2 * 3e-4), 1e-6, 0); /* std * sqrt(4) */
    assert_non_null(
        strstr(said, "0.06 % of frequencies (scatter of single impacts) and 0.2 % of shapes (the least that is taken)"));
    assert_close(read_back(0, 0, 3e-4, 1e-4, &said), hypot(3e-4, 2e-4), 1e-6, 0); /* how many impacts is not known */
    assert_close(read_back(4, 3, 3e-4, 4e-3, &said), 3e-4, 1e-6, 0);              /* three tests: their scatter, nothing else */
    assert_string_equal(said, "");
    assert_close(read_back(4, 3, 1e-6, 4e-3, &said), hypot(1e-6, 2e-4), 1e-6, 0);
    assert_non_null(strstr(said, "the scatter between 3 tests; 0.02 % of frequencies (the least that is taken) and 0 %"));
}

TEST_GROUP(folder_make, folder_remove);
