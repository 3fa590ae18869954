/* The numbers a function is summed up in, and a listing under failing memory and cancellation. */
#include <unistd.h>

#include "import/import.h"
#include "support.h"
#include "uff/uff.h"

static char path[] = "/tmp/test_listing_XXXXXX";

static struct values values_of(int count, const double *real, const double *imag)
{
    struct values values;
    values_open(&values);
    for (int i = 0; i < count; i++) { /* in pieces of one */
        double x = 2.0 * i;
        values_add(&values, 1, &x, real + i, imag ? imag + i : NULL, imag != NULL);
    }
    values_close(&values);
    return values;
}

UNIT_TEST(statistics_follow_their_definitions)
{
    const double real[] = {3, -3, 0, 6}, imag[] = {4, 4, -1, 8};
    struct values values = values_of(4, real, imag);
    assert_int_equal(values.count, 4);
    assert_close(values.min, 1, 0, 0);
    assert_close(values.max, 10, 0, 0);
    assert_close(values.rms, sqrt((25 + 25 + 1 + 100) / 4.0), 1e-15, 0);
    assert_close(values.sum[0], 6, 0, 0);
    assert_close(values.sum[1], 15, 0, 0);
    assert_close(values.first[1], 4, 0, 0);
    assert_close(values.last[0], 6, 0, 0);
    assert_close(values.x_last, 6, 0, 0);
    assert_close(values.x_least_step, 2, 0, 0);
    values = values_of(4, real, NULL);
    assert_close(values.min, -3, 0, 0);
    assert_close(values.max, 6, 0, 0);
    const double large[] = {3e300, 4e300}, small[] = {3e-300, 4e-300}; /* of which the squares are no numbers */
    assert_close(values_of(2, large, NULL).rms, 5e300 / sqrt(2), 1e-15, 0);
    assert_close(values_of(2, small, NULL).rms, 5e-300 / sqrt(2), 1e-15, 0);
    assert_close(values_of(0, NULL, NULL).rms, 0, 0, 0);
}

UNIT_TEST(a_clipped_record_is_told_from_a_crest)
{
    static double wave[400], clipped[400], coarse[400], window[400];
    for (int i = 0; i < 400; i++) {
        wave[i] = sin(0.1 * i);
        clipped[i] = fmax(-0.8, wave[i]);
        coarse[i] = round(200 * wave[i]) / 200; /* nine bits */
        window[i] = i >= 100 && i < 120 ? 5 * sin(0.157 * (i - 100)) : 0;
    }
    struct values values = values_of(400, wave, NULL);
    assert_false(values_are_clipped(&values));
    values = values_of(400, clipped, NULL);
    assert_true(values_are_clipped(&values));
    values = values_of(400, coarse, NULL);
    assert_false(values_are_clipped(&values));
    values = values_of(400, window, NULL);
    assert_false(values_are_clipped(&values));
    struct values same = values_of(400, window, NULL);
    assert_true(values_are_same(&same, &values));
    window[399] = 1e-300;
    same = values_of(400, window, NULL);
    assert_false(values_are_same(&same, &values));
    const double constant[] = {2, 2, 2}, nearly[] = {2, 2, 2.5};
    assert_true(values_of(3, constant, NULL).is_constant);
    assert_false(values_of(3, nearly, NULL).is_constant);
    assert_false(values_of(1, constant, NULL).is_constant); /* one value says nothing */
}

/* Nodes, functions and shapes enough that every array has to grow. */
static int make_file(void **state)
{
    (void)state;
    int descriptor = mkstemp(path);
    FILE *stream = descriptor < 0 ? NULL : fdopen(descriptor, "wb");
    if (!stream)
        return 1;
    const struct uff_units units = {.code = 5, .length = 1000, .force = 1000, .temperature = 1};
    int status = uff_write_units(stream, &units);
    for (int i = 1; i <= 20 && !status; i++) {
        const struct uff_node node = {.id = i, .x = {100.0 * i, 0, 0}};
        const struct uff_function f = {.type = UFF_TRANSFER,
                                       .response_node = i % 10 ? i : 99,
                                       .response_direction = 3,
                                       .reference_node = 1,
                                       .ordinate = UFF_REAL_DOUBLE,
                                       .count = 2,
                                       .is_even = 1,
                                       .step = 1,
                                       .abscissa = {.specific_type = 18},
                                       .numerator = {.specific_type = 12, .unit = "mm/s2"},
                                       .denominator = {.specific_type = 13}};
        const double value[] = {i, -i};
        int label = i;
        double real = 1;
        const struct uff_shape shape = {
            .analysis_type = 2, .frequency_hz = 10.0 * i, .component_count = 1, .node_count = 1, .node = &label, .real = &real};
        struct uff_function_writer writer;
        status = uff_write_nodes(stream, 15, 1, &node) || uff_write_function(stream, &f, &writer) ||
                 uff_write_values(&writer, 2, NULL, value, NULL) || uff_end_function(&writer) || uff_write_shape(stream, &shape);
    }
    return fclose(stream) != 0 || status;
}

static int remove_file(void **state)
{
    (void)state;
    return unlink(path);
}

static int list(struct pool *pool, const struct listing_options *options, struct listing *listing, int *count, const char ***what)
{
    struct message_list messages;
    message_open(&messages, pool);
    int status = listing_read(pool, path, options, &messages, listing);
    return status ? status : listing_summarise(pool, listing, count, what);
}

POOL_TEST(a_listing_counts_what_is_there)
{
    const struct listing_options options = {.keep_shapes = 1};
    struct listing listing;
    const char **what;
    int count;
    assert_status(list(&test_pool, &options, &listing, &count, &what), ROTID_OK);
    assert_int_equal(listing.set_count, 61);
    assert_int_equal(listing.function_count, 20);
    assert_int_equal(listing.node_count, 20);
    assert_int_equal(listing.shape_count, 20);
    assert_int_equal(listing.group_count, 1);
    assert_int_equal(listing.finding_count, 2);               /* node 99 twice */
    assert_close(listing.function[0].si_factor, 1, 1e-15, 0); /* mm/s2 over mN */
    assert_close(listing.shape[7].shape.real[0], 1, 0, 0);
    assert_int_equal(count, 3);
    assert_string_equal(what[0], "20 transfer functions, 2 lines each, 0 to 1 Hz, responses 1 to 9, 11 to 19, 99, reference 1");
    assert_string_equal(what[1], "20 shapes, real, 10 to 200 Hz, 1 point");
    assert_string_equal(what[2], "20 nodes, x 0.1 to 2, y 0 to 0, z 0 to 0 m");
}

UNIT_TEST(every_failing_allocation_is_told)
{
    const struct listing_options options = {.keep_shapes = 1};
    for (long n = 1;; n++) {
        struct failing_allocator failing;
        struct pool pool;
        struct listing listing;
        const char **what;
        int count;
        failing_allocator_open(&failing, n);
        pool_open(&pool, &failing.allocator);
        int status = list(&pool, &options, &listing, &count, &what);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
        if (status == ROTID_OK) {
            assert_true(n > 50);
            return;
        }
        assert_status(status, ROTID_ERROR_MEMORY);
    }
}

static int cancel_later(void *context)
{
    int *left = context;
    return --*left < 0;
}

POOL_TEST(a_listing_can_be_cancelled)
{
    for (int after = 0; after < 5; after++) {
        int left = after, count;
        const struct listing_options options = {.cancelled = cancel_later, .context = &left};
        struct listing listing;
        const char **what;
        assert_status(list(&test_pool, &options, &listing, &count, &what), ROTID_STOP_CANCELLED);
    }
}

TEST_GROUP(make_file, remove_file);
