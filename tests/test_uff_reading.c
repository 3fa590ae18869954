/* The reader of universal files over a whole file: the order of sets, what is wrong and where to go on, memory, pipes. */
#include <unistd.h>

#include "support.h"
#include "uff/uff.h"
#include "uff_fixture.h"

#define SET(number) UFF_EDGE #number "\n"
#define TEXTS       "one\ntwo\nthree\nfour\nNONE\n"

/* After each error the next set is found, and a set that was returned is found again. */
UNIT_TEST(goes_on_behind_errors)
{
    static const char good[] = SET(15) "         1         0         0         8  1.0  2.0  3.0\n" UFF_EDGE;
    static const char *const bad[] = {
        SET(15) "         1         0         0         8  1.0  2.0\n" UFF_EDGE, /* a number missing */
        SET(55) TEXTS "         1         2         1         8         2         1\n         2         1         3         4\n  "
                      "2.5\n         1\n" UFF_EDGE,                          /* the end taken for a value */
        SET(15x) "rubbish\n" UFF_EDGE,                                       /* no number */
        SET(15) "         1         0         0         8  1.0  2.0  3.0\n", /* no end */
        "rubbish\n",                                                         /* between sets */
        "    -1\n    58b     1     2\nx\n" UFF_EDGE,                         /* no length */
        SET(2411) "         1         0         0         8\n" UFF_EDGE,
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
        char text[2048];
        struct uff_fixture fixture;
        struct uff_set set, first = {0};
        struct uff_node *node;
        struct uff_shape shape;
        int count, read = 0, status = ROTID_OK;
        (void)snprintf(text, sizeof text, "%s%s%s%s", good, bad[k], good, good);
        uff_fixture_text(&fixture, text);
        while ((status = uff_next(fixture.reader, &set)) != UFF_END) {
            if (!first.number)
                first = set;
            if (status == ROTID_OK && set.number == 55)
                status = uff_read_shape_set(fixture.reader, &fixture.pool, &shape);
            else if (status == ROTID_OK)
                status = uff_read_nodes(fixture.reader, &fixture.pool, &count, &node);
            read += status == ROTID_OK && set.number == 15;
        }
        /* without its end, a set still has its nodes, and the next '-1' ends it */
        if (read != (k == 3 ? 4 : 3) || fixture.messages.errors < 1 || fixture.messages.errors > 2)
            fail_msg("variant %zu: %d sets read, %d errors", k, read, fixture.messages.errors);
        assert_int_equal(uff_return_to(fixture.reader, &first), ROTID_OK);
        assert_int_equal(uff_read_nodes(fixture.reader, &fixture.pool, &count, &node), ROTID_OK);
        assert_int_equal(count, 1);
        assert_int_equal(uff_read_nodes(fixture.reader, &fixture.pool, &count, &node), ROTID_ERROR_ARGUMENT);
        uff_fixture_close(&fixture);
    }
}

UNIT_TEST(no_universal_file)
{
    static const struct {
        const char *text, *part;
    } item[] = {{"", "no universal file"},
                {"\x7f"
                 "ELF\1\2",
                 "no universal file"},
                {"    -1\r    15\r    -1\r", "lines end with a carriage return alone; expected line feeds"}};
    struct uff_fixture fixture;
    struct uff_set set;
    for (size_t k = 0; k < sizeof item / sizeof *item; ++k) {
        uff_fixture_text(&fixture, item[k].text);
        uff_fixture_refuses(&fixture, uff_next(fixture.reader, &set), k ? 1 : 0, 0, item[k].part);
        assert_int_equal(uff_next(fixture.reader, &set), UFF_END);
        assert_int_equal(fixture.messages.errors, 1);
        uff_fixture_close(&fixture);
    }
    static const char *const path[] = {"/", "/does/not/exist"};
    for (int k = 0; k < 2; ++k) {
        pool_open(&fixture.pool, NULL);
        message_open(&fixture.messages, &fixture.pool);
        assert_int_equal(uff_open(&fixture.pool, path[k], &fixture.messages, &fixture.reader), ROTID_ERROR_IO);
        assert_null(fixture.reader);
        assert_int_equal(fixture.messages.errors, 1);
        uff_close(fixture.reader);
        pool_close(&fixture.pool);
    }
}

static long long bytes_served;

static void *count_allocation(void *context, size_t bytes)
{
    (void)context;
    bytes_served += (long long)bytes;
    return malloc(bytes);
}

static void release(void *context, void *block)
{
    (void)context;
    free(block);
}

/* 300 MB of zeros in one 58b between two sets, without a block on the disk: listed by seeking, read in pieces. */
UNIT_TEST(little_memory)
{
    static const long long count = 37500000;
    char text[2048];
    int head = snprintf(text, sizeof text,
                        SET(15) "1 0 0 8 1. 2. 3.\n" UFF_EDGE
                                "    -1\n    58b     1     2          11%12lld     0     0           0           0\n" TEXTS
                                "    1         0    0         0 NONE               1   3 NONE               0   0\n"
                                "         4%10lld         1  0.00000E+00  1.00000E+00  0.00000E+00\n17\n12\n0\n0\n",
                        8 * count, count);
    char path[512];
    uff_write_bytes(path, text, (size_t)head);
    assert_int_equal(truncate(path, (off_t)(head + 8 * count)), 0);
    FILE *stream = fopen(path, "ab");
    assert_non_null(stream);
    assert_true(fputs(UFF_EDGE SET(15) "2 0 0 8 1. 2. 3.\n" UFF_EDGE, stream) >= 0);
    assert_int_equal(fclose(stream), 0);

    rotid_allocator allocator = {count_allocation, release, NULL};
    struct pool pool;
    struct message_list messages;
    struct uff_reader *reader;
    struct uff_set set[3], end;
    struct uff_function function;
    double value[4096];
    long long got, total = 0;
    bytes_served = 0;
    pool_open(&pool, &allocator);
    message_open(&messages, &pool);
    assert_int_equal(uff_open(&pool, path, &messages, &reader), ROTID_OK);
    for (int k = 0; k < 3; ++k) {
        assert_int_equal(uff_next(reader, &set[k]), ROTID_OK);
        assert_int_equal(set[k].number, k == 1 ? 58 : 15);
    }
    assert_int_equal(uff_next(reader, &end), UFF_END);
    assert_true(set[2].offset > 8 * count);
    assert_int_equal(uff_return_to(reader, &set[1]), ROTID_OK);
    assert_int_equal(uff_read_function(reader, &function), ROTID_OK);
    for (int k = 0; k < 100; ++k, total += got)
        assert_int_equal(uff_read_values(reader, 4096, NULL, value, NULL, &got), ROTID_OK);
    assert_int_equal(total, 100 * 4096);
    assert_int_equal(uff_next(reader, &end), ROTID_OK);
    assert_int_equal(end.offset, set[2].offset);
    assert_int_equal(messages.count, 0);
    assert_true(bytes_served < 100000);
    uff_close(reader);
    pool_close(&pool);
    (void)unlink(path);
}

/* A pipe cannot be sought in: what is read over is read. */
UNIT_TEST(from_a_pipe)
{
    static const char before[] =
        SET(15) "1 0 0 8 1. 2. 3.\n" UFF_EDGE
                "    -1\n    58b     1     2          11       40000     0     0           0           0\n" TEXTS
                "    1         0    0         0 NONE               1   3 NONE               0   0\n"
                "         4      5000         1  0.00000E+00  1.00000E+00  0.00000E+00\n17\n12\n0\n0\n";
    static const char data[40000] = "\n    -1\n    -1\n    15\n"; /* more than the reader has at once */
    static const char after[] = UFF_EDGE SET(15) "2 0 0 8 1. 2. 3.\n" UFF_EDGE;
    int end[2];
    char path[64];
    struct pool pool;
    struct message_list messages;
    struct uff_reader *reader;
    struct uff_set set[3], last;
    assert_int_equal(pipe(end), 0);
    assert_int_equal(write(end[1], before, sizeof before - 1), sizeof before - 1);
    assert_int_equal(write(end[1], data, sizeof data), sizeof data);
    assert_int_equal(write(end[1], after, sizeof after - 1), sizeof after - 1);
    (void)snprintf(path, sizeof path, "/proc/self/fd/%d", end[0]);
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    assert_int_equal(uff_open(&pool, path, &messages, &reader), ROTID_OK);
    assert_int_equal(close(end[1]), 0);
    for (int k = 0; k < 3; ++k) {
        assert_int_equal(uff_next(reader, &set[k]), ROTID_OK);
        assert_int_equal(set[k].number, k == 1 ? 58 : 15);
    }
    assert_int_equal(uff_next(reader, &last), UFF_END);
    assert_int_equal(messages.count, 0);
    assert_int_equal(uff_return_to(reader, &set[0]), ROTID_ERROR_IO);
    assert_int_equal(uff_next(reader, &last), ROTID_ERROR_IO);
    assert_int_equal(messages.errors, 1);
    uff_close(reader);
    pool_close(&pool);
    (void)close(end[0]);
}

static int sweep_once(const char *path, const rotid_allocator *allocator)
{
    struct pool pool;
    struct message_list messages;
    struct uff_reader *reader;
    struct uff_set set;
    struct uff_node *node;
    struct uff_shape shape;
    int count;
    pool_open(&pool, allocator);
    message_open(&messages, &pool);
    int status = uff_open(&pool, path, &messages, &reader);
    while (status == ROTID_OK && (status = uff_next(reader, &set)) == ROTID_OK) {
        if (set.number == 15)
            status = uff_read_nodes(reader, &pool, &count, &node);
        else if (set.number == 55)
            status = uff_read_shape_set(reader, &pool, &shape);
    }
    uff_close(reader);
    pool_close(&pool);
    return status;
}

UNIT_TEST(memory_runs_out)
{
    static const char text[] =
        SET(15) "1 0 0 8 1. 2. 3.\n" UFF_EDGE SET(18) "1 0 0 8 1\nCS\n0 0 0 1 0 0\n0 0 1\n" UFF_EDGE SET(55) TEXTS
        "1 2 1 8 2 1\n2 1 3 4\n1.25\n1\n1.0\n" UFF_EDGE;
    char path[512];
    uff_write_bytes(path, text, sizeof text - 1);
    int failures = 0;
    for (int status = ROTID_ERROR_MEMORY; status != UFF_END; ++failures) {
        struct failing_allocator failing;
        failing_allocator_open(&failing, failures + 1);
        status = sweep_once(path, &failing.allocator);
        assert_true(status == UFF_END || status == ROTID_ERROR_MEMORY);
        assert_int_equal(failing.in_use, 0);
        assert_true(failures < 1000);
    }
    print_message("%d allocations\n", failures);
    assert_true(failures > 5);
    (void)unlink(path);
}
