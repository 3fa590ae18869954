/* Universal files: every trap of the format as a small file of our own, and files that pyuff wrote. */
#define _POSIX_C_SOURCE 200809L /* mkstemp */
#include <unistd.h>

#include "support.h"
#include "uff/uff.h"

#ifndef ROTID_SOURCE_DIR
#define ROTID_SOURCE_DIR "."
#endif

/* ------------------------------------------------------------------------------------------------ reading a text */

struct reading {
    struct pool pool;
    struct message_list messages;
    struct uff_file file;
    int status;
    char path[512];
};

static void read_path(struct reading *r, const char *path, const rotid_allocator *allocator)
{
    pool_open(&r->pool, allocator);
    message_open(&r->messages, &r->pool);
    memset(&r->file, 0x5a, sizeof r->file); /* it must be set in any case */
    r->status = uff_read(&r->pool, path, &r->messages, &r->file);
}

static void write_bytes(char path[512], const char *bytes, size_t length)
{
    const char *directory = getenv("TMPDIR");
    (void)snprintf(path, 512, "%s/test_uff_XXXXXX", directory ? directory : "/tmp");
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    FILE *stream = fdopen(descriptor, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, length, stream), length);
    assert_int_equal(fclose(stream), 0);
}

static void read_bytes(struct reading *r, const char *bytes, size_t length)
{
    write_bytes(r->path, bytes, length);
    read_path(r, r->path, NULL);
    (void)unlink(r->path);
}

static void read_text(struct reading *r, const char *text)
{
    read_bytes(r, text, strlen(text));
}

static void print_messages(const struct reading *r)
{
    for (size_t i = 0; i < r->messages.count; ++i)
        print_message("%s:%d:%d: %s\n", r->messages.item[i].file, r->messages.item[i].line, r->messages.item[i].column,
                      r->messages.item[i].text);
}

static void check_ok(const struct reading *r)
{
    if (r->status != ROTID_OK || r->messages.errors)
        print_messages(r);
    assert_int_equal(r->status, ROTID_OK);
    assert_int_equal(r->messages.errors, 0);
}

static int has_message(const struct reading *r, int severity, int line, const char *part)
{
    for (size_t i = 0; i < r->messages.count; ++i)
        if (r->messages.item[i].severity == severity && r->messages.item[i].line == line &&
            strstr(r->messages.item[i].text, part))
            return 1;
    print_message("no message of severity %d in line %d with: %s\n", severity, line, part);
    print_messages(r);
    return 0;
}

/* The text is refused with this error in this line, and nothing is handed out. */
static void check_refused(const char *text, int line, const char *part)
{
    struct reading r;
    read_text(&r, text);
    if (r.status != ROTID_ERROR_SYNTAX)
        print_message("status %s for:\n%s\n", rotid_status_name(r.status), text);
    assert_int_equal(r.status, ROTID_ERROR_SYNTAX);
    assert_int_equal(r.messages.errors, 1);
    assert_true(has_message(&r, SEVERITY_ERROR, line, part));
    assert_int_equal(r.file.node_count, 0);
    assert_int_equal(r.file.shape_count, 0);
    pool_close(&r.pool);
}

static void check_close(double found, double expected, double tolerance)
{
    if (!(fabs(found - expected) <= tolerance * fabs(expected)))
        fail_msg("found %.17g, expected %.17g", found, expected);
}

static void check_equal(double found, double expected)
{
    check_close(found, expected, 0);
}

static void check_node(const struct uff_node *node, int id, double x, double y, double z)
{
    assert_int_equal(node->id, id);
    check_equal(node->x[0], x);
    check_equal(node->x[1], y);
    check_equal(node->x[2], z);
}

#define NODE_SET      "    -1\n    15\n"
#define TEXTS         "one\ntwo\nthree\nfour\nfive\n"
#define SHAPE_SET     "    -1\n    55\n" TEXTS
#define KIND_NORMAL_1 "         1         2         1         8         2         1\n"
#define KIND_NORMAL_3 "         1         2         2         8         2         3\n"
#define KIND_FIRST_1  "         1         3         1         8         5         1\n"
#define MODE_4        "         2         4         1         4\n"
#define RECORD_8      "  1.25000E+01  1.00000E+00  2.00000E-02  0.00000E+00\n"
#define END           "    -1\n"

/* ------------------------------------------------------------------------------------------------ sound files */

UNIT_TEST(real_shape_and_nodes)
{
    struct reading r;
    read_text(&r, NODE_SET "         7         0         0         8  1.00000E+00 -2.00000E+00  3.00000E+00\n"
                           "         2         0         0         8  0.00000E+00  2.50000E-01 -1.00000E-03\n" END SHAPE_SET
                               KIND_NORMAL_3 MODE_4 RECORD_8 "         7\n  1.00000E+00 -5.00000E-01  2.50000E-01\n"
                           "         2\n -1.00000E+00  0.00000E+00  1.25000E-01\n" END);
    check_ok(&r);
    assert_int_equal(r.messages.count, 0);
    assert_int_equal(r.file.node_count, 2);
    check_node(&r.file.node[0], 7, 1, -2, 3);
    check_node(&r.file.node[1], 2, 0, 0.25, -1e-3);
    assert_int_equal(r.file.shape_count, 1);
    const struct uff_shape *shape = r.file.shape;
    assert_int_equal(shape->line, 6);
    assert_int_equal(shape->analysis_type, 2);
    assert_int_equal(shape->number, 4);
    check_equal(shape->frequency_hz, 12.5);
    check_equal(shape->damping, 0.02);
    assert_int_equal(shape->is_complex, 0);
    assert_null(shape->imag);
    assert_int_equal(shape->component_count, 3);
    assert_int_equal(shape->node_count, 2);
    assert_int_equal(shape->node[0], 7);
    assert_int_equal(shape->node[1], 2);
    static const double expected[] = {1, -0.5, 0.25, -1, 0, 0.125};
    for (int i = 0; i < 6; ++i)
        check_equal(shape->real[i], expected[i]);
    pool_close(&r.pool);
}

/* Every number of values per node, real and complex, in columns, and separated by blanks on one line. */
UNIT_TEST(values_per_node)
{
    for (int components = 1; components <= 6; ++components)
        for (int variant = 0; variant < 4; ++variant) {
            int is_complex = variant & 1, free_format = variant >> 1;
            int values = components * (is_complex ? 2 : 1);
            char text[4096];
            int n = snprintf(
                text, sizeof text, "%s%10d%10d%10d%10d%10d%10d\n%s%s", SHAPE_SET, 1, is_complex ? 3 : 2, 3, 12,
                is_complex ? 5 : 2, components,
                is_complex ? "         2         6         1         9\n" : "         2         4         1         9\n",
                is_complex ? " -3.00000E+00  4.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00\n" : RECORD_8);
            for (int node = 1; node <= 3; ++node) {
                n += snprintf(text + n, sizeof text - (size_t)n, free_format ? "%d\n" : "%10d\n", 11 * node);
                for (int i = 0; i < values; ++i)
                    n += snprintf(text + n, sizeof text - (size_t)n, free_format ? "%.3g%s" : "%13.5E%s", 100. * node - i,
                                  i + 1 == values || (!free_format && i % 6 == 5) ? "\n"
                                  : free_format                                   ? " "
                                                                                  : "");
            }
            (void)snprintf(text + n, sizeof text - (size_t)n, END);

            struct reading r;
            read_text(&r, text);
            check_ok(&r);
            const struct uff_shape *shape = r.file.shape;
            assert_int_equal(r.file.shape_count, 1);
            assert_int_equal(shape->component_count, components);
            assert_int_equal(shape->is_complex, is_complex);
            assert_int_equal(shape->node_count, 3);
            for (int node = 1; node <= 3; ++node) {
                assert_int_equal(shape->node[node - 1], 11 * node);
                for (int c = 0; c < components; ++c) {
                    int at = components * (node - 1) + c;
                    check_equal(shape->real[at], 100. * node - (is_complex ? 2 * c : c));
                    if (is_complex)
                        check_equal(shape->imag[at], 100. * node - 2 * c - 1);
                }
            }
            pool_close(&r.pool);
        }
}

UNIT_TEST(complex_eigenvalues)
{
    static const int analysis[] = {3, 7};
    for (int i = 0; i < 2; ++i) {
        char text[2048];
        (void)snprintf(text, sizeof text, SHAPE_SET "         1%10d         1         8         5         1\n%s", analysis[i],
                       "         2         6         1         2\n"
                       " -3.00000E+00  4.00000E+00  1.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00\n"
                       "         1\n  1.00000E+00 -1.00000E+00\n" END);
        struct reading r;
        read_text(&r, text);
        check_ok(&r);
        assert_int_equal(r.file.shape[0].analysis_type, analysis[i]);
        assert_int_equal(r.file.shape[0].number, 2);
        check_close(r.file.shape[0].frequency_hz, 5 / (2 * 3.141592653589793), 1e-15);
        check_close(r.file.shape[0].damping, 0.6, 1e-15);
        check_equal(r.file.shape[0].real[0], 1);
        check_equal(r.file.shape[0].imag[0], -1);
        pool_close(&r.pool);
    }
}

UNIT_TEST(frequency_response)
{
    struct reading r;
    read_text(&r,
              SHAPE_SET "         1         5         1         8         5         1\n"
                        "         2         1         1        17\n  5.00000E+01\n         1\n  1.00000E+00  2.00000E+00\n" END);
    check_ok(&r);
    assert_int_equal(r.file.shape[0].analysis_type, 5);
    assert_int_equal(r.file.shape[0].number, 17);
    check_equal(r.file.shape[0].frequency_hz, 50);
    check_equal(r.file.shape[0].damping, 0);
    pool_close(&r.pool);
}

/* Lines of 80 columns that end as on Windows; a double precision exponent; no line end at the end of the file. */
UNIT_TEST(windows_and_trailing_blanks)
{
    struct reading r;
    read_text(&r, "    -1                                                                          \r\n"
                  "  2411                                                                          \r\n"
                  "         1         0         0         8                                        \r\n"
                  "   1.2500000000000000D+00  -2.5000000000000000d-01   0.0000000000000000D+00\t \r\n"
                  "    -1                                                                          \r\n\r\n"
                  "    -1\r\n   781\r\n"
                  "         2         0         0         8\r\n"
                  "  -1.0000000000000000D+00  -1.0000000000000000D+00  -1.0000000000000000D-100\r\n"
                  "    -1\r\n\r\n  \r\n"
                  "    -1\r\n    55\r\n\r\n\r\n\r\n\r\n\r\n"
                  "         1         2         1         8         2         1   \r\n"
                  "         2         4         1         4   \r\n"
                  "  1.25000D+01  1.00000D+00  2.00000D-02  0.00000D+00   \r\n"
                  "         1   \r\n  1.50000D+00   \r\n    -1");
    check_ok(&r);
    assert_int_equal(r.file.node_count, 2);
    check_node(&r.file.node[0], 1, 1.25, -0.25, 0);
    check_node(&r.file.node[1], 2, -1, -1, -1e-100);
    check_equal(r.file.shape[0].frequency_hz, 12.5);
    check_equal(r.file.shape[0].damping, 0.02);
    check_equal(r.file.shape[0].real[0], 1.5);
    pool_close(&r.pool);
}

UNIT_TEST(touching_fields)
{
    struct reading r;
    read_text(&r, NODE_SET "1000000001         0         0         8 -1.00000E+00-2.000000E-03  3.00000E+00\n"
                           "1000000002000000000300000000040000000005-1.000000E+00-2.000000E-03-3.000000E+00\n"
                           "         3         0         0        -8-1.000000E+001.0000000E+00-1.000000-100\n"
                           "         4         0         0         8-1.00000e+00-2.00000e+00-3.00000e+00\n"
                           "         5         0         0         8            0           -1        1.5+2\n"
                           "         6         0         0         8    1.0Q+0001      -.5e+00         +3.\n" END SHAPE_SET
                               KIND_NORMAL_3 MODE_4 RECORD_8 "         1\n-1.00000e+00-2.00000e+00-3.00000e+00\n"
                           "         2\n-1.000000E+00-1.000000-100-1.000000E+00\n" END);
    check_ok(&r);
    assert_int_equal(r.file.node_count, 6);
    check_node(&r.file.node[0], 1000000001, -1, -2e-3, 3);
    check_node(&r.file.node[1], 1000000002, -1, -2e-3, -3);
    check_node(&r.file.node[2], 3, -1, 1, -1e-100);
    check_node(&r.file.node[3], 4, -1, -2, -3);
    check_node(&r.file.node[4], 5, 0, -1, 150);
    check_node(&r.file.node[5], 6, 10, -0.5, 3);
    static const double expected[] = {-1, -2, -3, -1, -1e-100, -1};
    for (int i = 0; i < 6; ++i)
        check_equal(r.file.shape[0].real[i], expected[i]);
    pool_close(&r.pool);
}

UNIT_TEST(free_format)
{
    struct reading r;
    read_text(&r, "-1\n15\n1 0 0 8 1.0 -2.0 3\n\t2\t0\t0\t8\t-1 -1 -1\n -1\n"
                  "-1\n2411\n3 0 0 8\n1.5 2.5 3.5\n  -1\n"
                  "-1\n55 \n" TEXTS "1 2 2 8 2 3\n2 4 1 4\n12.5 1.0 0.02 0\n1\n1 2 3\n2\n-1 -1 -1\n-1\n");
    check_ok(&r);
    assert_int_equal(r.file.node_count, 3);
    check_node(&r.file.node[1], 2, -1, -1, -1);
    check_node(&r.file.node[2], 3, 1.5, 2.5, 3.5);
    check_equal(r.file.shape[0].frequency_hz, 12.5);
    assert_int_equal(r.file.shape[0].node_count, 2);
    check_equal(r.file.shape[0].real[5], -1);
    pool_close(&r.pool);
}

/* -1 where a text, a node or a value is due does not end the set. */
UNIT_TEST(minus_one_as_data)
{
    struct reading r;
    read_text(&r, NODE_SET "    -1         0         0         8 -1.00000E+00 -1.00000E+00 -1.00000E+00\n"
                           "-1 -1 -1 -1 -1 -1 -2\n" END);
    assert_int_equal(r.status, ROTID_ERROR_SYNTAX); /* not because the set had ended, but because the node is there twice */
    assert_true(has_message(&r, SEVERITY_ERROR, 4, "node -1 occurs twice"));
    pool_close(&r.pool);

    read_text(&r, "    -1\n  2411\n        -1        -1        -1        -1\n -1 -1 -1\n" END
                  "    -1\n    55\n    -1\n-1\n    -1\n-1\n    -1\n" KIND_NORMAL_1 MODE_4 RECORD_8 "         1\n    -1\n"
                  "         2\n           -1\n         3\n-1\n" END "    -1\n    55\n" TEXTS
                  "1 5 1 8 2 1\n2 1 -1 -1\n 1.0\n1\n1.0\n" END);
    check_ok(&r);
    assert_int_equal(r.file.node_count, 1);
    check_node(&r.file.node[0], -1, -1, -1, -1);
    assert_int_equal(r.file.shape_count, 2);
    assert_int_equal(r.file.shape[0].node_count, 3);
    for (int i = 0; i < 3; ++i)
        check_equal(r.file.shape[0].real[i], -1);
    assert_int_equal(r.file.shape[1].number, -1);
    pool_close(&r.pool);
}

UNIT_TEST(records_7_and_8_spill)
{
    struct reading r;
    read_text(&r, SHAPE_SET KIND_NORMAL_1 "        10        12         1         5         0         0         0         0\n"
                                          "         0         0         0         0\n"
                                          "  2.00000E+00  1.00000E+00  3.00000E-02  0.00000E+00  0.00000E+00  0.00000E+00\n"
                                          "  2.00000E+00  1.00000E+00  3.00000E-02  0.00000E+00  0.00000E+00  0.00000E+00\n"
                                          "         1\n  1.00000E+00\n" END SHAPE_SET KIND_NORMAL_1
                                          "10 7 1 6 0 0 0 0 0 0 0 0\n3 1 .04 0 0 0 0\n1\n1\n" END SHAPE_SET KIND_NORMAL_1
                                          "         2         1         1         7\n  4.00000E+00\n" END);
    check_ok(&r);
    assert_int_equal(r.file.shape_count, 3);
    for (int i = 0; i < 3; ++i) {
        assert_int_equal(r.file.shape[i].number, 5 + i);
        check_equal(r.file.shape[i].frequency_hz, 2 + i);
    }
    check_equal(r.file.shape[0].damping, 0.03);
    check_equal(r.file.shape[1].damping, 0.04);
    check_equal(r.file.shape[2].damping, 0);
    assert_int_equal(r.file.shape[2].node_count, 0); /* all values zero: the format allows it */
    assert_true(has_message(&r, SEVERITY_WARNING, 39, "no nodes"));
    pool_close(&r.pool);
}

/* ------------------------------------------------------------------------------------------------ sets that are skipped */

UNIT_TEST(skipped_sets)
{
    char text[8192], wide[5001];
    memset(wide, 'x', sizeof wide - 1);
    wide[sizeof wide - 1] = '\0';
    (void)snprintf(text, sizeof text,
                   "    -1\n   151\nmodel\n-1\n     -1\n        -1\n%s\n" END "    -1\n  2414\nNaN\n" END
                   "    -1\n   151\n" END SHAPE_SET
                   "         1         1         2         8         2         3\nanything\n-1\n" END SHAPE_SET
                   "         1         0         2         8         2         3\n" END SHAPE_SET
                   "         1         1         2         8         2         3\n" END SHAPE_SET
                   "         1         2         4         2         2         6\n" END SHAPE_SET
                   "         1         2         2         3         2         3\n" END,
                   wide);
    struct reading r;
    read_text(&r, text);
    check_ok(&r);
    assert_int_equal(r.file.shape_count, 0);
    assert_int_equal(r.messages.count, 6);
    assert_true(has_message(&r, SEVERITY_NOTE, 1, "set 151 skipped, 2 times from here on"));
    assert_true(has_message(&r, SEVERITY_NOTE, 9, "set 2414 skipped"));
    assert_true(has_message(&r, SEVERITY_NOTE, 16, "set 55 of analysis type 1 (static) skipped, 2 times"));
    assert_true(has_message(&r, SEVERITY_NOTE, 27, "set 55 of analysis type 0 (unknown) skipped"));
    assert_true(has_message(&r, SEVERITY_NOTE, 45, "data characteristic 4"));
    assert_true(has_message(&r, SEVERITY_NOTE, 54, "specific data type 3"));
    pool_close(&r.pool);
}

UNIT_TEST(many_types_of_sets)
{
    char text[8192];
    int n = 0;
    for (int i = 0; i < 100; ++i)
        n += snprintf(text + n, sizeof text - (size_t)n, "    -1\n%6d\n    -1\n", 1000 + i);
    struct reading r;
    read_text(&r, text);
    check_ok(&r);
    assert_int_equal(r.messages.count, 33);
    assert_true(has_message(&r, SEVERITY_NOTE, 1, "68 sets of further types"));
    pool_close(&r.pool);
}

static const char binary_payload[] = "\n    -1\n    -1\n    55\n\0\xff\n    -1\n";

static size_t binary_set(char *bytes, size_t room, const char *header, const char *before_end)
{
    size_t payload = sizeof binary_payload - 1;
    size_t n = (size_t)snprintf(bytes, room, "    -1\n%s\n1\n2\n    -1\n4\n5\n6\n7\n8\n9\n10\n11\n", header);
    memcpy(bytes + n, binary_payload, payload);
    n += payload;
    return n +
           (size_t)snprintf(bytes + n, room - n, "%s    -1\n" SHAPE_SET KIND_NORMAL_1 MODE_4 RECORD_8 "1\n1\n" END, before_end);
}

UNIT_TEST(binary_sets)
{
    static const char *const good[] = {"    58b     1     2          11          32     0     0           0           0",
                                       "    58B     1     2          11          32", "58b 1 2 11 32 0 0 0 0"};
    static const char *const before_end[] = {"", "\n", "\r\n", "\r\n\r\n"};
    char bytes[2048];
    assert_int_equal(sizeof binary_payload - 1, 32);
    for (size_t i = 0; i < 12; ++i) {
        struct reading r;
        read_bytes(&r, bytes, binary_set(bytes, sizeof bytes, good[i % 3], before_end[i / 3]));
        check_ok(&r);
        assert_true(has_message(&r, SEVERITY_NOTE, 1, "set 58b skipped"));
        assert_int_equal(r.file.shape_count, 1);
        /* what can be skipped is not looked at, so the six line ends in it do not count */
        assert_int_equal(r.file.shape[0].line, 15 + (int)(i < 3 ? 0 : i < 9 ? 1 : 2));
        pool_close(&r.pool);
    }

    static const char *const bad[] = {
        "    58b     1     2          11          30", "    58b     1     2          11  999999999999",
        "    58b     1     2999999999999          32", "    58b     1     2          11         -32",
        "    58b     1     2          -1          32", "    58b     1     2",
        "    58b     1     2          11           x", "    58b     1     2999999999999999999999999"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        struct reading r;
        read_bytes(&r, bytes, binary_set(bytes, sizeof bytes, bad[i], ""));
        if (r.status != ROTID_ERROR_SYNTAX)
            print_message("not refused: %s\n", bad[i]);
        assert_int_equal(r.status, ROTID_ERROR_SYNTAX);
        assert_true(strstr(r.messages.item[0].text, "set 58: ") != NULL);
        pool_close(&r.pool);
    }
}

/* ------------------------------------------------------------------------------------------------ malformed files */

UNIT_TEST(no_universal_file)
{
    check_refused("", 0, "no universal file: expected a line '    -1'");
    check_refused("\n\r\n  \n", 3, "no universal file");
    check_refused("[case]\n    -1\n", 1, "no universal file");
    check_refused("    -1x\n", 1, "no universal file");
    check_refused("    -10\n", 1, "no universal file");
    check_refused("-1 -1\n", 1, "no universal file");
    struct reading r;
    read_bytes(&r,
               "\x7f"
               "ELF\0\0\0\1",
               8);
    assert_int_equal(r.status, ROTID_ERROR_SYNTAX);
    assert_true(has_message(&r, SEVERITY_ERROR, 1, "no universal file"));
    pool_close(&r.pool);

    read_path(&r, "/does/not/exist.uff", NULL);
    assert_int_equal(r.status, ROTID_ERROR_IO);
    assert_true(has_message(&r, SEVERITY_ERROR, 1, "cannot be opened"));
    assert_int_equal(r.file.shape_count, 0);
    pool_close(&r.pool);
    read_path(&r, "/", NULL);
    assert_int_equal(r.status, ROTID_ERROR_IO);
    assert_int_equal(r.messages.errors, 1);
    pool_close(&r.pool);
}

UNIT_TEST(between_sets)
{
    check_refused("    -1\n", 1, "expected the number of a set");
    check_refused("    -1\n    -1\n", 2, "expected the number of a set");
    check_refused("    -1\nfifteen\n", 2, "found 'fifteen'");
    check_refused("    -1\n15x\n", 2, "found '15x'");
    check_refused("    -1\n99999999999999999999\n", 2, "expected the number of a set");
    check_refused("    -1\n    15\n    -1\nrubbish\x01\n", 4, "expected a line '    -1' that opens a set, found 'rubbish?'");
}

UNIT_TEST(cut_off)
{
    check_refused("    -1\n   151\nmodel\n", 3, "set 151: the file ends after this line; expected the '-1'");
    check_refused(NODE_SET, 2, "set 15: the file ends after this line; expected a node or '-1'");
    check_refused("    -1\n  2411\n1 0 0 8\n", 3, "set 2411: the file ends after this line; expected coordinates");
    check_refused("    -1\n  2411\n1 0 0 8\n    -1\n", 4, "set 2411: coordinates, record 2 of a node: expected 3 reals");
    check_refused(SHAPE_SET, 7, "set 55: the file ends after this line; expected record 6");
    check_refused("    -1\n    55\none\n", 3, "five lines of text");
    check_refused(SHAPE_SET KIND_NORMAL_1, 8, "expected record 7");
    check_refused(SHAPE_SET KIND_NORMAL_1 MODE_4, 9, "expected record 8");
    check_refused(SHAPE_SET KIND_NORMAL_1 MODE_4 RECORD_8, 10, "expected a node number or '-1'");
    check_refused(SHAPE_SET KIND_NORMAL_1 MODE_4 RECORD_8 "1\n", 11, "expected values of a node");
    /* the '-1' is taken for the value that is missing, which the line behind it gives away */
    check_refused(SHAPE_SET KIND_NORMAL_1 MODE_4 RECORD_8 "1\n" END, 12, "expected a node number or '-1'");
    check_refused(SHAPE_SET KIND_NORMAL_1 MODE_4 RECORD_8 "1\n" END SHAPE_SET, 14, "expected a line '    -1'");
    check_refused(SHAPE_SET KIND_NORMAL_3 MODE_4 RECORD_8 "1\n" END, 12, "expected 3 reals, found 1 field");
}

UNIT_TEST(wrong_numbers)
{
    static const struct {
        const char *line, *part;
    } node[] = {
        {"1 0 0 8 1.0 2.0", "expected 4 integers and 3 reals, found 6 fields"},
        {"1 0 0 8 1.0 2.0 3.0 4.0", "found at least 8 fields"},
        {"1 0 0 8 1.0 2,0 3.0", "'2,0' is not a real"},
        {"1 0 0 8 1.0 2.0.0 3.0", "'2.0.0' is not a real"},
        {"1 0 0 8 1.0 1e 3.0", "'1e' is not a real"},
        {"1 0 0 8 1.0 e5 3.0", "'e5' is not a real"},
        {"1 0 0 8 1.0 . 3.0", "'.' is not a real"},
        {"1 0 0 8 1.0 0x10 3.0", "'0x10' is not a real"},
        {"1 0 0 8 1.0 **** 3.0", "'****' is not a real"},
        {"1 0 0 8 1.0 NaN 3.0", "NaN is not a finite number"},
        {"1 0 0 8 1.0 -inf 3.0", "-inf is not a finite number"},
        {"1 0 0 8 1.0 Infinity 3.0", "Infinity is not a finite number"},
        {"1 0 0 8 1.0 1.#QNAN 3.0", "1.#QNAN is not a finite number"},
        {"1 0 0 8 1.0 1e999 3.0", "1e999 is not a finite number"},
        {"         1         0         0         8-1.000000E+00-1.00000E+999 3.00000E+00",
         "-1.00000E+999 is not a finite number"},
        {"1 0 0 8 1.0 "
         "0."
         "00000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000"
         "000000000000000000000000 3.0",
         "is not a real"},
        {"1.5 0 0 8 1.0 2.0 3.0", "'1.5' is not an integer"},
        {"- 0 0 8 1.0 2.0 3.0", "'-' is not an integer"},
        {"2147483648 0 0 8 1.0 2.0 3.0", "2147483648 is too large"},
        {"-2147483649 0 0 8 1.0 2.0 3.0", "-2147483649 is too large"},
        {"99999999999999999999999999 0 0 8 1.0 2.0 3.0", "is too large"},
        {"         1         0         0         8  1.00000E+00               3.00000E+00", "found 6 fields"},
        {"         1         0         0         81234567890123456789012345678901234567890", "found 4 fields"},
        {"         1         0         0         8.12345678901234567890123456789012345678", "'3456789012345' is not a real"},
    };
    for (size_t i = 0; i < sizeof node / sizeof *node; ++i) {
        char text[512];
        (void)snprintf(text, sizeof text, NODE_SET "         9         0         0         8  1.0  1.0  1.0\n%s\n" END,
                       node[i].line);
        check_refused(text, 4, node[i].part);
    }
}

UNIT_TEST(wrong_records)
{
    check_refused(SHAPE_SET "1 2 2 8 3 3\n", 8, "data type 3; expected 2 (real) or 5 (complex)");
    check_refused(SHAPE_SET "1 2 2 8 2 0\n", 8, "0 values per node; expected 1 to 6");
    check_refused(SHAPE_SET "1 2 2 8 2 7\n", 8, "7 values per node; expected 1 to 6");
    check_refused(SHAPE_SET "1 2 2 8 2 2147483647\n", 8, "values per node; expected 1 to 6");
    check_refused(SHAPE_SET "1 2 2 8 2\n", 8, "expected 6 integers, found 5 fields");
    check_refused(SHAPE_SET KIND_NORMAL_1 "\n", 9, "numbers of integers and reals");
    check_refused(SHAPE_SET KIND_NORMAL_1 "2147483647 4 1 1\n", 9, "2147483647 integers announced");
    check_refused(SHAPE_SET KIND_NORMAL_1 "1 4 1\n", 9, "1 integers announced");
    check_refused(SHAPE_SET KIND_NORMAL_1 "2 2147483647 1 1\n", 9, "2147483647 reals announced");
    check_refused(SHAPE_SET KIND_NORMAL_1 "2 99999999999999999999 1 1\n", 9, "numbers of integers and reals");
    check_refused(SHAPE_SET KIND_NORMAL_1 "2 -1 1 1\n", 9, "-1 reals announced");
    check_refused(SHAPE_SET KIND_NORMAL_1 "2 0 1 1\n", 9, "0 reals announced; expected at least 1");
    check_refused(SHAPE_SET KIND_FIRST_1 "2 1 1 1\n1.0\n", 9, "1 reals announced; expected at least 2");
    check_refused(SHAPE_SET KIND_NORMAL_1 MODE_4 " -1.00000E+00  1.0  0.0  0.0\n", 10, "the frequency is negative");
    check_refused(SHAPE_SET KIND_NORMAL_1 MODE_4 "          NaN  1.0  0.0  0.0\n", 10, "NaN is not a finite number");
    check_refused(SHAPE_SET KIND_FIRST_1 "2 2 1 1\n1.5e308 1.5e308\n", 10, "the frequency is");
    check_refused(SHAPE_SET KIND_NORMAL_3 MODE_4 RECORD_8 "1\n1.0 2.0\n", 12, "expected 3 reals, found 2 fields");
    check_refused(SHAPE_SET KIND_NORMAL_3 MODE_4 RECORD_8 "1\n1.0 inf 2.0\n", 12, "inf is not a finite number");
    check_refused(SHAPE_SET KIND_NORMAL_3 MODE_4 RECORD_8 "1.0 2.0 3.0\n", 11,
                  "a node number: expected 1 integer, found at least 2 fields");
}

UNIT_TEST(repeated_nodes)
{
    check_refused(SHAPE_SET KIND_NORMAL_1 MODE_4 RECORD_8 "5\n1.0\n3\n1.0\n5\n2.0\n" END, 15,
                  "set 55: node 5 occurs twice in the set, first in line 11");
    check_refused(NODE_SET "4 0 0 8 1. 2. 3.\n7 0 0 8 1. 2. 3.\n4 0 0 8 1. 2. 3.\n" END, 5,
                  "node 4 occurs twice in the set, line 3");
    check_refused(NODE_SET "4 0 0 8 1. 2. 3.\n" END "    -1\n  2411\n4 0 0 8\n1. 2. 3.1\n" END, 7,
                  "set 2411: node 4 was elsewhere in an earlier set, line 3");
    struct reading r;
    read_text(&r, NODE_SET "4 0 0 8 1.11111 2. 0.\n6 0 0 8 1. 2. 3.\n" END
                           "    -1\n  2411\n6 0 0 8\n1. 2. 3.\n2 0 0 8\n5. 5. 5.\n4 0 0 8\n1.111112345 2. 0.\n" END);
    check_ok(&r); /* the same nodes in both precisions */
    assert_int_equal(r.file.node_count, 3);
    check_node(&r.file.node[0], 4, 1.11111, 2, 0);
    check_node(&r.file.node[1], 6, 1, 2, 3);
    check_node(&r.file.node[2], 2, 5, 5, 5);
    pool_close(&r.pool);
}

UNIT_TEST(other_coordinate_system)
{
    struct reading r;
    read_text(&r, NODE_SET "4 0 0 8 1. 2. 3.\n5 2 0 8 1. 2. 3.\n6 2 0 8 1. 2. 3.\n" END);
    check_ok(&r);
    assert_int_equal(r.messages.count, 1);
    assert_true(has_message(&r, SEVERITY_WARNING, 4, "node 5 is given in coordinate system 2"));
    pool_close(&r.pool);
}

UNIT_TEST(overlong_lines)
{
    char text[8192], wide[4098];
    memset(wide, ' ', sizeof wide);
    wide[0] = 'x';
    wide[sizeof wide - 1] = '\0';
    (void)snprintf(text, sizeof text, "    -1\n    55\none\n%s\nthree\n", wide);
    check_refused(text, 4, "longer than 4096 bytes; expected five lines of text");
    (void)snprintf(text, sizeof text, "    -1\n    55\n%.4096s\ntwo\n", wide);
    check_refused(text, 4, "the file ends after this line");
    struct reading r;
    read_bytes(&r, NODE_SET "1 0 0 8 1. 2. 3\0\n" END, sizeof(NODE_SET "1 0 0 8 1. 2. 3\0\n" END) - 1);
    assert_int_equal(r.status, ROTID_ERROR_SYNTAX);
    assert_true(has_message(&r, SEVERITY_ERROR, 3, "'3?' is not a real"));
    pool_close(&r.pool);
}

/* ------------------------------------------------------------------------------------------------ damage */

static const char specimen[] =
    "    -1\r\n   151\r\nmodel\r\n    -1\r\n" NODE_SET
    "         1         0         0         8  1.00000E+00 -2.00000E+00  3.00000E+00\n" END
    "    -1\n  2411\n         2         0         0         8\n"
    "   1.0000000000000000D+00  -2.0000000000000000D+00   3.0000000000000000D+00\n" END SHAPE_SET KIND_NORMAL_1 MODE_4 RECORD_8
    "         1\n -1.00000E+00\n         2\n -1.00000E+00\n" END SHAPE_SET
    "         1         3         2         8         5         3\n         2         6         1         1\n"
    " -3.00000E+00  4.00000E+00  1.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00\n"
    "         1\n  1.00000E+00 -1.00000E+00  1.00000E+00 -1.00000E+00  1.00000E+00 -1.00000E+00\n" END;

/* Cut off anywhere but behind a set, the file is refused. */
UNIT_TEST(truncated_at_every_byte)
{
    size_t length = sizeof specimen - 1;
    int accepted = 0;
    for (size_t cut = 0; cut <= length; ++cut) {
        struct reading r;
        read_bytes(&r, specimen, cut);
        if (r.status == ROTID_OK) {
            ++accepted;
            size_t end = cut; /* the blanks of the next '-1' alone are a blank line */
            while (end && strchr("\r\n ", specimen[end - 1]))
                --end;
            if (end < 6 || strncmp(specimen + end - 6, "    -1", 6) != 0)
                fail_msg("accepted when cut at byte %zu", cut);
        } else {
            assert_int_equal(r.status, ROTID_ERROR_SYNTAX);
            assert_int_equal(r.messages.errors, 1);
        }
        pool_close(&r.pool);
    }
    assert_int_equal(accepted, 1 + 5 * 2 + 4 * 4); /* without and with line end, one of two bytes; the blanks before 4 sets */
}

/* Whatever stands in one byte: a status, and errors exactly when it is not ROTID_OK. The sanitizers watch. */
UNIT_TEST(every_byte_replaced)
{
    static const char other[] = {'\0', '\n', ' ', '-', '9', '.', 'e', 'b', '\xff'};
    size_t length = sizeof specimen - 1;
    char *bytes = malloc(length);
    assert_non_null(bytes);
    for (size_t i = 0; i < length; ++i)
        for (size_t k = 0; k < sizeof other; ++k) {
            memcpy(bytes, specimen, length);
            bytes[i] = other[k];
            struct reading r;
            read_bytes(&r, bytes, length);
            assert_true(r.status == ROTID_OK || r.status == ROTID_ERROR_SYNTAX);
            assert_int_equal(r.messages.errors, r.status != ROTID_OK);
            for (int s = 0; s < r.file.shape_count; ++s)
                assert_true(isfinite(r.file.shape[s].frequency_hz) && r.file.shape[s].frequency_hz >= 0);
            pool_close(&r.pool);
        }
    free(bytes);
}

struct limited {
    int left, blocks;
};

static void *limited_allocate(void *context, size_t bytes)
{
    struct limited *limited = context;
    if (!limited->left--) {
        limited->left = 0;
        return NULL;
    }
    ++limited->blocks;
    return malloc(bytes);
}

static void limited_release(void *context, void *block)
{
    --((struct limited *)context)->blocks;
    free(block);
}

UNIT_TEST(memory_runs_out)
{
    char path[512];
    write_bytes(path, specimen, sizeof specimen - 1);
    int failures = 0;
    for (int status = ROTID_ERROR_MEMORY; status != ROTID_OK; ++failures) {
        struct limited limited = {.left = failures};
        rotid_allocator allocator = {limited_allocate, limited_release, &limited};
        struct reading r;
        read_path(&r, path, &allocator);
        status = r.status;
        assert_true(status == ROTID_OK || status == ROTID_ERROR_MEMORY);
        if (status != ROTID_OK) {
            assert_int_equal(r.file.node_count, 0);
            assert_int_equal(r.file.shape_count, 0);
        }
        pool_close(&r.pool);
        assert_int_equal(limited.blocks, 0);
        assert_true(failures < 1000);
    }
    assert_true(failures > 10);
    (void)unlink(path);
}

/* ------------------------------------------------------------------------------------------------ files of pyuff */

static const int pyuff_nodes[] = {1, 2, 3, 5, 8, 13}; /* see tests/data/uff/generate.py */

static double pyuff_value(int mode, int node, int component)
{
    return (node % 2 ? -1 : 1) * (mode * 1000 + node * 10 + component) / 1000.;
}

UNIT_TEST(pyuff_real_modes)
{
    struct reading r;
    read_path(&r, ROTID_SOURCE_DIR "/tests/data/uff/real_modes.uff", NULL);
    check_ok(&r);
    assert_int_equal(r.messages.count, 1);
    assert_true(has_message(&r, SEVERITY_NOTE, 1, "set 151 skipped"));
    assert_int_equal(r.file.node_count, 6);
    for (int k = 0; k < 6; ++k)
        check_node(&r.file.node[k], pyuff_nodes[k], -1. - k, 0.5 * k, -k / 1000.);
    assert_int_equal(r.file.shape_count, 3);
    for (int s = 0; s < 3; ++s) {
        const struct uff_shape *shape = &r.file.shape[s];
        int components = s == 2 ? 6 : 3;
        assert_int_equal(shape->analysis_type, 2);
        assert_int_equal(shape->number, s + 1);
        check_equal(shape->frequency_hz, 100.25 * (s + 1));
        check_close(shape->damping, 0.01 * (s + 1), 1e-15);
        assert_int_equal(shape->is_complex, 0);
        assert_null(shape->imag);
        assert_int_equal(shape->component_count, components);
        assert_int_equal(shape->node_count, 6);
        for (int k = 0; k < 6; ++k) {
            assert_int_equal(shape->node[k], pyuff_nodes[k]);
            for (int c = 0; c < components; ++c)
                check_equal(shape->real[components * k + c], pyuff_value(s + 1, pyuff_nodes[k], c));
        }
    }
    pool_close(&r.pool);
}

UNIT_TEST(pyuff_complex_modes)
{
    struct reading r;
    read_path(&r, ROTID_SOURCE_DIR "/tests/data/uff/complex_modes.uff", NULL);
    check_ok(&r);
    assert_int_equal(r.messages.count, 0);
    assert_int_equal(r.file.node_count, 0);
    assert_int_equal(r.file.shape_count, 2);
    for (int s = 0; s < 2; ++s) {
        const struct uff_shape *shape = &r.file.shape[s];
        double modulus = hypot(3, 400); /* eigenvalue mode (-3 + 400 i) */
        assert_int_equal(shape->analysis_type, s ? 7 : 3);
        assert_int_equal(shape->number, s + 1);
        check_close(shape->frequency_hz, (s + 1) * modulus / (2 * 3.141592653589793), 1e-15);
        check_close(shape->damping, 3 / modulus, 1e-15);
        assert_int_equal(shape->is_complex, 1);
        assert_int_equal(shape->component_count, 3);
        assert_int_equal(shape->node_count, 6);
        for (int k = 0; k < 6; ++k)
            for (int c = 0; c < 3; ++c) { /* v (1 - 2 i) */
                double value = pyuff_value(s + 1, pyuff_nodes[k], c);
                check_equal(shape->real[3 * k + c], value);
                check_close(shape->imag[3 * k + c], -2 * value, 1e-15);
            }
    }
    pool_close(&r.pool);
}

UNIT_TEST(pyuff_nodes_2411)
{
    struct reading r;
    read_path(&r, ROTID_SOURCE_DIR "/tests/data/uff/nodes_2411.uff", NULL);
    check_ok(&r);
    assert_int_equal(r.file.shape_count, 0);
    assert_int_equal(r.file.node_count, 6);
    for (int k = 0; k < 6; ++k) /* all digits of a double */
        check_node(&r.file.node[k], pyuff_nodes[k], -1, k / 3., -3.141592653589793 * k);
    pool_close(&r.pool);
}
