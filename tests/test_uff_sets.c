/* Sets 151 and 164, 18 and 2420, 82 and 2412: what a test is about, its units, its geometry. */
#include <stdio.h>
#include <string.h>

#include "uff_fixture.h"

#define SET(number) UFF_EDGE #number "\n"

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

/* As Test.Lab ends them: the last line filled with zeros, or a line of zeros behind one that is full. */
static void traces_padded_with_zeros(void **state)
{
    (void)state;
    static const char eight[] = "         1         2         3         4         5         6         7         8\n",
                      zeros[] = "         0         0         0         0         0         0         0         0\n",
                      one[] = "         1         0         0         0         0         0         0         0\n",
                      late[] = "         0         0         0         0         0         0         0         7\n";
    const struct {
        int count, refused; /* line that is too much, 0: none */
        const char *first, *second;
    } table[] = {{8, 0, eight, ""},   {8, 0, eight, zeros}, {9, 0, eight, one},    {1, 0, one, zeros},
                 {0, 0, zeros, ""},   {0, 0, "", ""},       {16, 0, eight, eight}, {16, 0, eight, zeros},
                 {8, 6, eight, late}, {8, 6, eight, eight}, {9, 6, eight, late}};
    for (size_t i = 0; i < sizeof table / sizeof *table; ++i) {
        struct uff_fixture fixture;
        struct uff_trace trace;
        uff_fixture_text(&fixture, pool_format(&test_pool, SET(82) "         3%10d         8\nshaft\n%s%s" UFF_EDGE,
                                               table[i].count, table[i].first, table[i].second));
        (void)uff_fixture_next(&fixture, 82);
        int status = uff_read_trace(fixture.reader, &fixture.pool, &trace);
        if (table[i].refused) {
            assert_int_equal(status, ROTID_ERROR_SYNTAX);
        } else {
            assert_int_equal(status, ROTID_OK);
            assert_int_equal(trace.node_count, table[i].count);
            uff_fixture_is_quiet(&fixture);
        }
        uff_fixture_close(&fixture);
    }
}

#define TEXTS    "one\ntwo\nthree\nfour\nNONE\n"
#define LOCATION "    1         0    0         0 NONE               1   3 NONE               0   0\n"
#define FORM     "         4         3         1  0.00000E+00  1.00000E+00  0.00000E+00\n"
#define KIND     "9\nname\n3\n" TEXTS

/* Reads the set at hand, whatever it is. */
static int read_any(struct uff_fixture *fixture, int number)
{
    struct uff_units unit;
    struct uff_system *system;
    struct uff_element *element;
    struct uff_trace trace;
    struct uff_function function;
    struct uff_analysis a;
    int count;
    switch (number) {
    case 18:
    case 2420:
        return uff_read_systems(fixture->reader, &fixture->pool, &count, &system);
    case 58:
        return uff_read_function(fixture->reader, &function);
    case 82:
        return uff_read_trace(fixture->reader, &fixture->pool, &trace);
    case 164:
        return uff_read_units(fixture->reader, &unit);
    case 2412:
        return uff_read_elements(fixture->reader, &fixture->pool, &count, &element);
    default:
        return uff_read_analysis(fixture->reader, &fixture->pool, &a);
    }
}

static void wrong_records(void **state)
{
    (void)state;
    static const struct {
        int number;
        const char *text;
        int line, column;
        const char *part;
    } item[] = {
        {18, SET(18) "9999999999         0         0         8         1\n", 3, 1, "too large for 32 bits"},
        {18, SET(18) "                   0\n", 3, 1, "'' is not an integer; expected it in columns 1 to 10"},
        {58, SET(58) TEXTS "    x         0    0         0 NONE\n", 8, 5,
         "record 6 (function type, number, version, load case, response, reference): 'x' is not an integer; expected it in "
         "columns 1 to 5"},
        {58, SET(58) TEXTS "    19999999999    0         0 NONE\n", 8, 6, "9999999999 is too large for a 32-bit integer"},
        {58, SET(58) TEXTS LOCATION FORM "        17    0   1.\n", 10, 19,
         "record 8 (abscissa): '1.' is not an integer; expected it in columns 16 to 20"},
        {58,
         "    -1\n    58b     1     2          11          16\n" TEXTS LOCATION FORM "17\n12\n0\n0\n................" UFF_EDGE,
         13, 0, "16 bytes of binary data; expected 24 for 3 values"},
        {58, "    -1\n    58b     1     2          13          24\n" TEXTS LOCATION FORM "17\n12\n0\n0\nmore\n", 14, 0,
         "expected as many lines of text as announced"},
        {82, SET(82) "1 -5 0\nname\n", 3, 11, "-5 nodes; expected none or more"},
        {82, SET(82) "1 2 0\nname\n1 2\n3\n" UFF_EDGE, 6, 0, "expected the '-1' that ends the set behind 2 nodes"},
        {82, SET(82) "1 9 0\nname\n1 2 3 4 5 6 7 8 9\n" UFF_EDGE "    -1\n    82", 8, 0, "expected a trace line"},
        {164, SET(164) "1 m 2\n1 1 1\n0\n1\n" UFF_EDGE, 6, 0, "behind four factors"},
        {164, SET(164) "1 m 2\n1 1 1\n", 4, 0, "expected record 2"},
        {2412, SET(2412) "1 94 3\n", 3, 0, "expected 6 integers, found 3 fields"},
        {2414, SET(2414) KIND "1 2 2 8 2 0\n", 11, 51, "0 values; expected at least 1"},
        {2414, SET(2414) KIND "1 2 2 8 2 1\n0\n0\n0\n0\n1 7 1 1\n", 16, 0, "expected expansion code 1 or 2"},
        {2414, SET(2414) KIND "1 2 2 8 2 1\n0\n0\n0\n0\n1 1 1\n", 16, 0,
         "record 14 (label of a node or an element): expected 4 integers"},
        {2414, SET(2414) KIND "1 2 2 8 2 1\n0\n0\n0\n0\n1 1 1 1\nx\n", 17, 1, "values: 'x' is not a real; expected 1 real"},
        {2420, SET(2420) "1\npart\n         1         0         8\nname\n1 0 0\n0 1\n", 8, 0, "records 5 to 8: expected 3 reals"},
    };
    for (size_t k = 0; k < sizeof item / sizeof *item; ++k) {
        struct uff_fixture fixture;
        uff_fixture_text(&fixture, item[k].text);
        (void)uff_fixture_next(&fixture, item[k].number);
        int status = read_any(&fixture, item[k].number);
        if (status == ROTID_OK) { /* then it is the next one */
            (void)uff_fixture_next(&fixture, item[k].number);
            status = read_any(&fixture, item[k].number);
        }
        uff_fixture_refuses(&fixture, status, item[k].line, item[k].column, item[k].part);
        uff_fixture_close(&fixture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(header),
        cmocka_unit_test(units),
        cmocka_unit_test(systems),
        cmocka_unit_test(elements_and_traces),
        cmocka_unit_test_setup_teardown(traces_padded_with_zeros, open_test_pool, close_test_pool),
        cmocka_unit_test(wrong_records),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
