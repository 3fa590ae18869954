/* Sets 151 and 164: what a test is about, its units; records of mixed contents that are wrong. */
#include "support.h"
#include "uff_fixture.h"

#define SET(number) UFF_EDGE #number "\n"

UNIT_TEST(header)
{
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

UNIT_TEST(units)
{
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

#define TEXTS    "one\ntwo\nthree\nfour\nNONE\n"
#define LOCATION "    1         0    0         0 NONE               1   3 NONE               0   0\n"
#define FORM     "         4         3         1  0.00000E+00  1.00000E+00  0.00000E+00\n"

/* Reads the set at hand, whatever it is. */
static int read_any(struct uff_fixture *fixture, int number)
{
    struct uff_units unit;
    struct uff_function function;
    return number == 58 ? uff_read_function(fixture->reader, &function) : uff_read_units(fixture->reader, &unit);
}

UNIT_TEST(wrong_records)
{
    static const struct {
        int number;
        const char *text;
        int line, column;
        const char *part;
    } item[] = {
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
        {164, SET(164) "1 m 2\n1 1 1\n0\n1\n" UFF_EDGE, 6, 0, "behind four factors"},
        {164, SET(164) "1 m 2\n1 1 1\n", 4, 0, "expected record 2"},
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
