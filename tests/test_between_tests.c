/* Modes of several tests as one, the scatter between them, and the floors that a deck takes from what its file states. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/base.h"
#include "deck/deck.h"
#include "ema/ema.h"
#include "folder.h"
#include "import/import.h"
#include "one_state.h"
#include "support.h"

#define TESTS  40
#define MODES  3
#define POINTS 12

/* Tests of known scatter: modes sin(k pi z) with signs, scales and an order of the points of their own; mode 2 of the last one
 * has another shape where `foreign`. */
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
            mode->frequency_hz = 100 * (k + 1) * (k + 1) * (1 + frequency * random_normal(&stream));
            mode->frequency_std = 1e-6;
            for (int p = 0; p < POINTS; p++) {
                int own = (p + 5 * t) % POINTS, wave = foreign && t == count - 1 && k == 1 ? 5 : k + 1;
                test[t].point_node[p] = 10 + own;
                test[t].point_direction[p] = 1;
                double exact = sin(wave * 3.141592653589793 * (own + 0.5) / POINTS);
                mode->shape[p] = (t % 2 ? -1.0 : 1.0) * (exact + shape * random_normal(&stream));
                mode->shape_std[p] = 1e-6;
            }
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
    assert_close(scatter.shape, 5e-3, 0.06, 0);    /* 1404 of them, less the scales: 2 % */
    for (int k = 0; k < MODES; k++) {
        double hz = 0;
        for (int t = 0; t < TESTS; t++)
            hz += test[t].mode[k].frequency_hz / TESTS;
        assert_close(mean.mode[k].frequency_hz, hz, 1e-13, 0);
        assert_close(mean.mode[k].frequency_std, scatter.frequency * hz / sqrt(TESTS), 1e-12, 0);
        for (int p = 0; p < POINTS; p++) {
            assert_close(mean.mode[k].shape[p], sin((k + 1) * 3.141592653589793 * (p + 0.5) / POINTS), 0,
                         6 * 5e-3 / sqrt(TESTS) + 3e-3);
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
    int left = 0;
    make_tests(3, 1e-4, 1e-3, 0, test);
    test[1].point_direction[3] = 2;
    test[2].npoint--;
    assert_status(ema_average(&test_pool, 3, test, &mean, &scatter), ROTID_OK);
    for (int p = 0; p < POINTS; p++)
        left += !isfinite(mean.mode[0].shape[p]);
    assert_int_equal(left, 2);
    assert_int_equal(scatter.lacking, 3); /* the first along both axes */
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
