/* Sets 18, 82, 151, 164, 2412, 2414, 2420 and 55 of other analyses; the order of sets; what is wrong and where to go on. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "uff/uff.h"
#include "uff_fixture.h"

#define SET(number) UFF_EDGE #number "\n"
#define TEXTS       "one\ntwo\nthree\nfour\nNONE\n"

static void header(void **state)
{
    (void)state;
    struct uff_fixture fixture;
    struct uff_header h;
    uff_fixture_text(&fixture,
                     SET(151) "model\nNONE\nprogram\n01-JAN-26 10:00:00          11        12         2\n02-JAN-26 11:00:00\n"
                              "writer\n03-JAN-26 12:00:00\n" UFF_EDGE
                                  /* fewer records, more of them, other things in record 4 */
                                  SET(151) "model\n-1\n" UFF_EDGE SET(
                                      151) "1\n2\n3\n     0     0     0     0     0\n5\n6\n7\n8\n9\n" UFF_EDGE);
    (void)uff_fixture_next(&fixture, 151);
    assert_int_equal(uff_read_header(fixture.reader, &h), ROTID_OK);
    assert_string_equal(h.model, "model");
    assert_string_equal(h.description, "");
    assert_string_equal(h.program, "program");
    assert_string_equal(h.created, "01-JAN-26 10:00:00");
    assert_int_equal(h.version[0], 11);
    assert_int_equal(h.version[1], 12);
    assert_int_equal(h.file_type, 2);
    assert_string_equal(h.saved, "02-JAN-26 11:00:00");
    assert_string_equal(h.written_by, "writer");
    assert_string_equal(h.written, "03-JAN-26 12:00:00");
    (void)uff_fixture_next(&fixture, 151);
    assert_int_equal(uff_read_header(fixture.reader, &h), ROTID_OK);
    assert_string_equal(h.description, "-1");
    (void)uff_fixture_next(&fixture, 151);
    assert_int_equal(uff_read_header(fixture.reader, &h), ROTID_OK);
    assert_string_equal(h.written, "7");
    uff_fixture_is_quiet(&fixture);
    uff_fixture_close(&fixture);
}

#define FACTORS(length, force) "   " length "   " force "   1.0000000000000000D+00\n   2.7314999999999998D+02\n"

static void units(void **state)
{
    (void)state;
    struct uff_fixture fixture;
    struct uff_units u;
    uff_fixture_text(
        &fixture,
        SET(164) "         5mm (newton)                  2\n" FACTORS("1.0000000000000000D+03", "1.0000000000000000D+00")
            UFF_EDGE SET(164) "         9USER_DEFINED\n  1.0 1.0 1.0 -273.15\n" UFF_EDGE SET(164) "        10\n" UFF_EDGE);
    (void)uff_fixture_next(&fixture, 164);
    assert_int_equal(uff_read_units(fixture.reader, &u), ROTID_OK);
    assert_int_equal(u.code, 5);
    assert_string_equal(u.description, "mm (newton)");
    assert_int_equal(u.temperature_mode, 2);
    assert_close(u.length, 1000, 0, 0);
    assert_close(u.temperature_offset, 273.15, 0, 0);

    struct uff_axis axis = {.specific_type = 12};
    assert_close(uff_si_factor(&u, &axis), 1e-3, 1e-15, 0); /* mm/s2 */
    assert_close(uff_si_factor(NULL, &axis), 1, 0, 0);
    strcpy(axis.unit, "g");
    assert_close(uff_si_factor(&u, &axis), 9.80665, 0, 0);
    strcpy(axis.unit, "gn");
    assert_close(uff_si_factor(NULL, &axis), 9.80665, 0, 0);
    axis.specific_type = 16; /* grams, or whatever: only an acceleration is measured in g */
    assert_close(uff_si_factor(&u, &axis), 1e3, 1e-15, 0);
    axis = (struct uff_axis){.specific_type = 15};
    assert_close(uff_si_factor(&u, &axis), 1e6, 1e-15, 0); /* N/mm2 */
    axis.specific_type = 13;
    assert_close(uff_si_factor(&u, &axis), 1, 0, 0);
    axis.specific_type = 18;
    axis.length = 7; /* counts for general data only */
    assert_close(uff_si_factor(&u, &axis), 1, 0, 0);
    axis = (struct uff_axis){.specific_type = 1, .length = 2, .force = 1};
    assert_close(uff_si_factor(&u, &axis), 1e-6, 1e-15, 0);
    const struct uff_units foot = {.length = 3.280839895013123, .force = 0.2248089430997105};
    assert_close(uff_si_factor(&foot, &axis), 0.3048 * 0.3048 * 4.4482216152605, 1e-12, 0);
    const struct uff_units none = {0};
    assert_close(uff_si_factor(&none, &axis), 1, 0, 0);

    (void)uff_fixture_next(&fixture, 164);
    assert_int_equal(uff_read_units(fixture.reader, &u), ROTID_OK);
    assert_int_equal(u.temperature_mode, 0);
    assert_close(u.temperature_offset, -273.15, 0, 0);
    uff_fixture_is_quiet(&fixture);
    (void)uff_fixture_next(&fixture, 164);
    uff_fixture_refuses(&fixture, uff_read_units(fixture.reader, &u), 14, 1, "code 10; expected 1 to 9");
    uff_fixture_close(&fixture);
}

static void systems(void **state)
{
    (void)state;
    struct uff_fixture fixture;
    struct uff_system *s;
    int count;
    uff_fixture_text(
        &fixture, SET(18) "         4         0         1         8         1\nCS4\n"
                          "  1.00000E+00  2.00000E+00  3.00000E+00  1.00000E+00  4.00000E+00  3.00000E+00\n"
                          "  1.00000E+00  3.00000E+00  2.00000E+00\n" UFF_EDGE SET(
                              2420) "         1\nPart\n         7         1         9\nNONE\n"
                                    "   0.0000000000000000D+00   1.0000000000000000D+00   0.0000000000000000D+00\n"
                                    "  -1.0000000000000000D+00   0.0000000000000000D+00   0.0000000000000000D+00\n"
                                    "   0.0000000000000000D+00   0.0000000000000000D+00   1.0000000000000000D+00\n"
                                    "   5.0000000000000000D-01  -1.0000000000000000D+00   2.0000000000000000D+00\n" UFF_EDGE SET(
                                        18) "         1         0         0         8         1\nline\n"
                                            "0 0 0 1 0 0\n2 0 0\n" UFF_EDGE SET(18) "         1         3\n" UFF_EDGE);
    (void)uff_fixture_next(&fixture, 18);
    assert_int_equal(uff_read_systems(fixture.reader, &fixture.pool, &count, &s), ROTID_OK);
    assert_int_equal(count, 1);
    assert_int_equal(s->id, 4);
    assert_int_equal(s->reference, 1);
    assert_int_equal(s->color, 8);
    assert_string_equal(s->name, "CS4");
    static const double axes[] = {0, 1, 0, -1, 0, 0, 0, 0, -1}, turned[] = {0, 1, 0, -1, 0, 0, 0, 0, 1};
    /* x points along y, z along -z; y = z x x = x of the reference */
    static const double expected_y[] = {1, 0, 0};
    for (int i = 0; i < 3; ++i) {
        assert_close(s->origin[i], i + 1, 0, 0);
        assert_close(s->matrix[i], axes[i], 0, 1e-15);
        assert_close(s->matrix[3 + i], expected_y[i], 0, 1e-15);
        assert_close(s->matrix[6 + i], axes[6 + i], 0, 1e-15);
    }
    (void)uff_fixture_next(&fixture, 2420);
    assert_int_equal(uff_read_systems(fixture.reader, &fixture.pool, &count, &s), ROTID_OK);
    assert_int_equal(count, 1);
    assert_int_equal(s->type, 1);
    assert_int_equal(s->color, 9);
    assert_string_equal(s->name, "");
    for (int i = 0; i < 9; ++i)
        assert_close(s->matrix[i], turned[i], 0, 0);
    assert_close(s->origin[1], -1, 0, 0);
    uff_fixture_is_quiet(&fixture);
    (void)uff_fixture_next(&fixture, 18);
    uff_fixture_refuses(&fixture, uff_read_systems(fixture.reader, &fixture.pool, &count, &s), 24, 0, "the points lie on a line");
    (void)uff_fixture_next(&fixture, 18);
    uff_fixture_refuses(&fixture, uff_read_systems(fixture.reader, &fixture.pool, &count, &s), 28, 11, "type 3; expected 0");
    uff_fixture_close(&fixture);
}

static void elements_and_traces(void **state)
{
    (void)state;
    struct uff_fixture fixture;
    struct uff_element *e;
    struct uff_trace trace;
    int count;
    uff_fixture_text(
        &fixture,
        SET(2412) "         5        21         2         3         7         2\n         9         1         2\n        11      "
                  "  12\n"
                  "         6       118         2         3         7        10\n"
                  "         1         2         3         4         5         6         7         8\n         9        "
                  "10\n" UFF_EDGE
                      /* the last line is filled with zeros, as Testlab writes it */
                      SET(82) "         3         9         8\nshaft\n         1         2         3         0         5         "
                              "6         7         8\n"
                              "         9         0         0         0         0         0         0         0\n" UFF_EDGE SET(
                                  82) "         3         3         8\nshaft\n         1         2         3         4\n" UFF_EDGE
                                  SET(82) "         3 999999999         8\nshaft\n         1         2         3         0       "
                                          "  5         6         7         8\n" UFF_EDGE SET(
                                              2412) "         5        94         2         3         7        -1\n" UFF_EDGE);
    (void)uff_fixture_next(&fixture, 2412);
    assert_int_equal(uff_read_elements(fixture.reader, &fixture.pool, &count, &e), ROTID_OK);
    assert_int_equal(count, 2);
    assert_int_equal(e[0].descriptor, 21);
    assert_int_equal(e[0].beam[0], 9);
    assert_int_equal(e[0].beam[2], 2);
    assert_int_equal(e[0].node_count, 2);
    assert_int_equal(e[0].node[1], 12);
    assert_int_equal(e[1].property, 2);
    assert_int_equal(e[1].material, 3);
    assert_int_equal(e[1].color, 7);
    for (int i = 0; i < 10; ++i)
        assert_int_equal(e[1].node[i], i + 1);
    (void)uff_fixture_next(&fixture, 82);
    assert_int_equal(uff_read_trace(fixture.reader, &fixture.pool, &trace), ROTID_OK);
    assert_int_equal(trace.number, 3);
    assert_int_equal(trace.color, 8);
    assert_string_equal(trace.name, "shaft");
    assert_int_equal(trace.node_count, 9);
    assert_int_equal(trace.node[3], 0);
    assert_int_equal(trace.node[8], 9);
    uff_fixture_is_quiet(&fixture);
    (void)uff_fixture_next(&fixture, 82);
    uff_fixture_refuses(&fixture, uff_read_trace(fixture.reader, &fixture.pool, &trace), 21, 40,
                        "found one more; expected 3 in this line");
    (void)uff_fixture_next(&fixture, 82);
    uff_fixture_refuses(&fixture, uff_read_trace(fixture.reader, &fixture.pool, &trace), 28, 0,
                        "the set ends after 8 of 999999999");
    (void)uff_fixture_next(&fixture, 2412);
    uff_fixture_refuses(&fixture, uff_read_elements(fixture.reader, &fixture.pool, &count, &e), 31, 51, "-1 nodes");
    uff_fixture_close(&fixture);
}

#define RECORDS(location, kind)                                                                                                  \
    SET(2414)                                                                                                                    \
    "         9\nname\n" location "\n" TEXTS kind "\n"                                                                           \
    "         1         0         1         0         1        17         0         0\n         5         6\n"                   \
    "  0.00000E+00  1.25000E+01  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00\n"                                           \
    "  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00  7.00000E+00\n"

static void analysis(void **state)
{
    (void)state;
    struct uff_fixture fixture;
    struct uff_analysis a;
    uff_fixture_text(
        &fixture,
        RECORDS(
            "         1",
            "         1         2         2         8         2         3") "        11\n "
                                                                            "-1.00000e+00-2.00000e+00-3.00000e+00\n    "
                                                                            "    12\n"
                                                                            "  4.00000E+00  5.00000E+00  "
                                                                            "6.00000E+00\n" UFF_EDGE RECORDS(
                                                                                "         "
                                                                                "1",
                                                                                "         "
                                                                                "1        "
                                                                                " 5       "
                                                                                "  2      "
                                                                                "   8     "
                                                                                "    5    "
                                                                                "     2") "        11\n  1.00000E+00  "
                                                                                          "2.00000E+00  3.00000E+00  "
                                                                                          "4.00000E+00\n" UFF_EDGE RECORDS(
                                                                                              "     "
                                                                                              "    "
                                                                                              "2",
                                                                                              "     "
                                                                                              "    "
                                                                                              "1    "
                                                                                              "  "
                                                                                              "   2 "
                                                                                              "     "
                                                                                              "   4 "
                                                                                              " "
                                                                                              "     "
                                                                                              "  2  "
                                                                                              "     "
                                                                                              " "
                                                                                              " 2   "
                                                                                              "     "
                                                                                              " 6") "         3         7\n 1 2 "
                                                                                                    "3 4 5 6\n 7\n         4     "
                                                                                                    "    1\n-1\n" UFF_EDGE
                                                                                                        RECORDS(
                                                                                                            "         3",
                                                                                                            "         1         "
                                                                                                            "2         "
                                                                                                            "1         2         "
                                                                                                            "4         "
                                                                                                            "1") "         3     "
                                                                                                                 "    1     "
                                                                                                                 "    2         "
                                                                                                                 "1\n  "
                                                                                                                 "1.00000000000E+"
                                                                                                                 "00\n  "
                                                                                                                 "2.00000000000E+"
                                                                                                                 "00\n"
                                                                                                                 "         4     "
                                                                                                                 "    2     "
                                                                                                                 "    8         "
                                                                                                                 "1\n  "
                                                                                                                 "3.00000000000E+"
                                                                                                                 "00\n" UFF_EDGE RECORDS(
                                                                                                                     "         6",
                                                                                                                     "         1 "
                                                                                                                     "        2 "
                                                                                                                     "        1  "
                                                                                                                     "       2  "
                                                                                                                     "       2   "
                                                                                                                     "      1") UFF_EDGE
                                                                                                                     RECORDS(
                                                                                                                         "       "
                                                                                                                         "  1",
                                                                                                                         "       "
                                                                                                                         "  1    "
                                                                                                                         "   "
                                                                                                                         "  2    "
                                                                                                                         "     1 "
                                                                                                                         "   "
                                                                                                                         "     2 "
                                                                                                                         "       "
                                                                                                                         " 3 "
                                                                                                                         "       "
                                                                                                                         " 1") UFF_EDGE
                                                                                                                         RECORDS(
                                                                                                                             "   "
                                                                                                                             "   "
                                                                                                                             "   "
                                                                                                                             "1",
                                                                                                                             "   "
                                                                                                                             "   "
                                                                                                                             "   "
                                                                                                                             "1  "
                                                                                                                             "   "
                                                                                                                             "   "
                                                                                                                             " 2 "
                                                                                                                             "   "
                                                                                                                             "   "
                                                                                                                             "  "
                                                                                                                             "1  "
                                                                                                                             "   "
                                                                                                                             " "
                                                                                                                             "   "
                                                                                                                             "2  "
                                                                                                                             "   "
                                                                                                                             "   "
                                                                                                                             " 2 "
                                                                                                                             "999"
                                                                                                                             "999"
                                                                                                                             "99"
                                                                                                                             "9") "    "
                                                                                                                                  "    "
                                                                                                                                  " 1\n"
                                                                                                                                  " 1."
                                                                                                                                  "\n" UFF_EDGE);
    static const struct {
        int location, items, offset[3];
        double value[8];
    } expected[] = {{1, 2, {0, 3, 6}, {-1, -2, -3, 4, 5, 6}},
                    {1, 1, {0, 4}, {1, 2, 3, 4}},
                    {2, 2, {0, 7, 8}, {1, 2, 3, 4, 5, 6, 7, -1}},
                    {3, 2, {0, 2, 3}, {1, 2, 3}}};
    for (int k = 0; k < 4; ++k) {
        (void)uff_fixture_next(&fixture, 2414);
        int status = uff_read_analysis(fixture.reader, &fixture.pool, &a);
        if (status != ROTID_OK)
            print_message("%d: %s\n", fixture.messages.item[0].line, fixture.messages.item[0].text);
        assert_int_equal(status, ROTID_OK);
        assert_int_equal(a.label, 9);
        assert_string_equal(a.name, "name");
        assert_string_equal(a.id[3], "four");
        assert_string_equal(a.id[4], "");
        assert_int_equal(a.location, expected[k].location);
        assert_int_equal(a.integer[5], 17);
        assert_int_equal(a.integer[9], 6);
        assert_close(a.real[1], 12.5, 0, 0);
        assert_close(a.real[11], 7, 0, 0);
        assert_int_equal(a.item_count, expected[k].items);
        for (int i = 0; i <= a.item_count; ++i)
            assert_int_equal(a.item_offset[i], expected[k].offset[i]);
        for (int i = 0; i < a.item_offset[a.item_count]; ++i)
            assert_close(a.value[i], expected[k].value[i], 0, 0);
    }
    uff_fixture_is_quiet(&fixture);
    static const char *const wrong[] = {"location 6; expected 1", "record 9: data type 3",
                                        "the set ends where 999999998 more values"};
    for (int k = 0; k < 3; ++k) {
        struct uff_set set = uff_fixture_next(&fixture, 2414);
        int status = uff_read_analysis(fixture.reader, &fixture.pool, &a);
        uff_fixture_refuses(&fixture, status, set.line + (int[]){14, 10, 17}[k], 0, wrong[k]);
    }
    uff_fixture_close(&fixture);
}

#define SHAPE(text, analysis, numbers)                                                                                           \
    SET(55) text "\ntwo\nthree\nfour\nfive\n" analysis "\n" numbers "         1\n  1.00000E+00\n" UFF_EDGE

static void shapes(void **state)
{
    (void)state;
    static const char text[] = SHAPE("ROTID residuals", "         1         0         1         8         2         1",
                                     "         2         1         3         4\n  2.50000E+00\n")
        SHAPE("other", "         1         0         1         8         2         1",
              "         1         1         3\n  0.00000E+00\n")
            SHAPE("static", "         1         1         1         8         2         1",
                  "         1         1         3\n  0.00000E+00\n")
                SHAPE("mode", "         1         2         1         8         2         1",
                      "         2         4         3         4\n  1.25000E+01  2.00000E+00  1.00000E-02  2.00000E-02\n") SET(55)
                    TEXTS
        "         1         3         1         8         5         1\n         2         6         3         4\n"
        " -1.00000E+00  1.00000E+02  1.00000E+00  2.00000E+00  3.00000E+00  4.00000E+00\n         1\n  1.00000E+00  "
        "2.00000E+00\n" UFF_EDGE SET(55) TEXTS "         1         1         5         2         2         9\n" UFF_EDGE;
    struct uff_fixture fixture;
    struct uff_shape s;
    uff_fixture_text(&fixture, text);
    static const int number[] = {4, 3, 0, 4, 4}, load_case[] = {3, 0, 3, 3, 3};
    for (int k = 0; k < 5; ++k) {
        (void)uff_fixture_next(&fixture, 55);
        assert_int_equal(uff_read_shape_set(fixture.reader, &fixture.pool, &s), ROTID_OK);
        assert_int_equal(s.number, number[k]);
        assert_int_equal(s.load_case, load_case[k]);
        assert_int_equal(s.node_count, 1);
        if (k == 0)
            assert_close(s.frequency_hz, 2.5, 0, 0);
        if (k == 3) {
            assert_close(s.modal_mass, 2, 0, 0);
            assert_close(s.damping, 0.01, 0, 0);
            assert_close(s.hysteretic, 0.02, 0, 0);
        }
    }
    assert_close(s.eigenvalue[0], -1, 0, 0);
    assert_close(s.eigenvalue[1], 100, 0, 0);
    assert_close(s.modal_a[1], 2, 0, 0);
    assert_close(s.modal_b[0], 3, 0, 0);
    assert_close(s.imag[0], 2, 0, 0);
    assert_int_equal(s.data_characteristic, 1);
    assert_int_equal(s.specific_type, 8);
    (void)uff_fixture_next(&fixture, 55);
    uff_fixture_refuses(&fixture, uff_read_shape_set(fixture.reader, &fixture.pool, &s), 73, 0,
                        "9 values per node; expected 1 to 6");

    /* the deck's view: what rotid has written comes through, other data of unknown kind do not */
    struct uff_file file;
    struct message_list messages;
    message_open(&messages, &fixture.pool);
    assert_int_equal(uff_read(&fixture.pool, fixture.path, &messages, &file), ROTID_OK);
    assert_int_equal(file.shape_count, 2);
    assert_int_equal(file.extra_count, 1);
    assert_string_equal(file.extra[0].id[0], "ROTID residuals");
    assert_int_equal(messages.count, 2);
    uff_fixture_close(&fixture);
}

/* After each error the next set is found, and a set that was returned is found again. */
static void goes_on_behind_errors(void **state)
{
    (void)state;
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

static void no_universal_file(void **state)
{
    (void)state;
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
static void little_memory(void **state)
{
    (void)state;
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

static int sweep_once(const char *path, const rotid_allocator *allocator)
{
    struct pool pool;
    struct message_list messages;
    struct uff_reader *reader;
    struct uff_set set;
    struct uff_system *system;
    struct uff_element *element;
    struct uff_node *node;
    struct uff_trace trace;
    struct uff_analysis a;
    struct uff_shape shape;
    int count;
    pool_open(&pool, allocator);
    message_open(&messages, &pool);
    int status = uff_open(&pool, path, &messages, &reader);
    while (status == ROTID_OK && (status = uff_next(reader, &set)) == ROTID_OK) {
        if (set.number == 15)
            status = uff_read_nodes(reader, &pool, &count, &node);
        else if (set.number == 18)
            status = uff_read_systems(reader, &pool, &count, &system);
        else if (set.number == 2412)
            status = uff_read_elements(reader, &pool, &count, &element);
        else if (set.number == 82)
            status = uff_read_trace(reader, &pool, &trace);
        else if (set.number == 2414)
            status = uff_read_analysis(reader, &pool, &a);
        else
            status = uff_read_shape_set(reader, &pool, &shape);
    }
    uff_close(reader);
    pool_close(&pool);
    return status;
}

static void memory_runs_out(void **state)
{
    (void)state;
    static const char text[] = SET(15) "1 0 0 8 1. 2. 3.\n" UFF_EDGE SET(18) "1 0 0 8 1\nCS\n0 0 0 1 0 0\n0 0 1\n" UFF_EDGE
        SET(2412) "5 94 2 3 7 2\n11 12\n" UFF_EDGE SET(82) "3 3 8\nshaft\n1 2 3\n" UFF_EDGE RECORDS(
            "         1", "         1         2         2         8         2         3") "        11\n 1. 2. 3.\n" UFF_EDGE
            SHAPE("mode", "1 2 1 8 2 1", "2 1 3 4\n1.25\n");
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
    assert_true(failures > 15);
    (void)unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(header),
        cmocka_unit_test(units),
        cmocka_unit_test(systems),
        cmocka_unit_test(elements_and_traces),
        cmocka_unit_test(analysis),
        cmocka_unit_test(shapes),
        cmocka_unit_test(goes_on_behind_errors),
        cmocka_unit_test(no_universal_file),
        cmocka_unit_test(little_memory),
        cmocka_unit_test(memory_runs_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
