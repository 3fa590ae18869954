/* The values of a set 58 as text: how writers write them, and what is refused. */
#include "support.h"
#include "uff_fixture.h"

/* A function of text: its record 7 and its values as given. */
static void open_text(struct uff_fixture *fixture, const char *record_7, const char *values)
{
    char text[16384];
    (void)snprintf(text, sizeof text, "%s    58\n1\n2\n3\n4\n5\n%s\n%s\n%s%s", UFF_EDGE,
                   "    1         0    0         0 NONE               1   3 NONE               0   0", record_7,
                   "        17    0    0    0 Time                 s\n        12    0    0    0\n         0\n\n", values);
    uff_fixture_text(fixture, text);
    (void)uff_fixture_next(fixture, 58);
}

UNIT_TEST(text_as_writers_write_it)
{
    static const struct {
        const char *record_7, *values;
        int count;
        double real[8];
    } item[] = {
        /* fields without a blank between them, exponents of three digits */
        {"         2         7         1 0.00000E+000 5.00000E-005 0.00000E+000",
         "-3.09944E-004-2.74181E-004  -0.00115633-6.31809E-004-4.88758E-004 0.00000E+000\n-1.00000E-005\n" UFF_EDGE,
         7,
         {-3.09944e-4, -2.74181e-4, -0.00115633, -6.31809e-4, -4.88758e-4, 0, -1e-5}},
        {"         2         3         1  0.00000E+00  1.00000D+00  0.00000E+00",
         "-1.00000e+00-2.00000e+00-3.00000e+00\n" UFF_EDGE,
         3,
         {-1, -2, -3}},
        {"         4         4         1  0.00000E+00  1.00000E+00  0.00000E+00",
         "  1.00000000000D+00    1.0d0               1.0-100            -1.00000000000-001\n" UFF_EDGE,
         4,
         {1, 1, 1e-100, -0.1}},
        /* minus one alone in a line, not in columns 5 and 6 */
        {"         2         3         1  0.00000E+00  1.00000E+00  0.00000E+00",
         "-1\n           -1\n-1.\n" UFF_EDGE,
         3,
         {-1, -1, -1}},
        /* free format: other numbers a line, filled beyond the last value, blank lines before the end */
        {"2 8 1 0 1 0", "1 2\n3\n4 5 6 7 8\n\n" UFF_EDGE, 8, {1, 2, 3, 4, 5, 6, 7, 8}},
        {"2 8 1 0 1 0", "1 2 3 4 5 6 7 8\n" UFF_EDGE, 8, {1, 2, 3, 4, 5, 6, 7, 8}},
        {"2 4 1 0 1 0",
         "   1.000000000000E+00   2.000000000000E+00\n   3.000000000000E+00   4.000000000000E+00\n" UFF_EDGE,
         4,
         {1, 2, 3, 4}},
        {"         2         2         1                                       ",
         "  1.00000E+00  2.00000E+00  0.00000E+00\n" UFF_EDGE,
         2,
         {1, 2}},
        {"         2         0         1  0.00000E+00  1.00000E+00  0.00000E+00", UFF_EDGE, 0, {0}},
    };
    for (size_t k = 0; k < sizeof item / sizeof *item; ++k) {
        struct uff_fixture fixture;
        struct uff_function function;
        double real[9];
        long long got;
        open_text(&fixture, item[k].record_7, item[k].values);
        assert_int_equal(uff_read_function(fixture.reader, &function), ROTID_OK);
        int status = uff_read_values(fixture.reader, 9, NULL, real, NULL, &got);
        if (status != ROTID_OK)
            print_message("%s\n", fixture.messages.item[0].text);
        assert_int_equal(status, ROTID_OK);
        assert_int_equal(got, item[k].count);
        for (int i = 0; i < item[k].count; ++i)
            assert_close(real[i], item[k].real[i], 0, 0);
        assert_int_equal(uff_read_values(fixture.reader, 9, NULL, real, NULL, &got), ROTID_OK);
        assert_int_equal(got, 0);
        uff_fixture_is_quiet(&fixture);
        uff_fixture_close(&fixture);
    }
}

#define EVEN_3 "         2         3         1  0.00000E+00  1.00000E+00  0.00000E+00"

UNIT_TEST(text_that_is_wrong)
{
    static const struct {
        const char *record_7, *values;
        int line, column;
        const char *part;
    } item[] = {
        {"         3         3         1", "", 9, 10, "set 58: record 7: found '3', expected an ordinate data type 2, 4, 5 or 6"},
        {"         2        -3         1", "", 9, 19, "record 7: found '-3', expected a number of values"},
        {"         2                   1", "", 9, 0, "expected a number of values"},
        {"2 99999999999999999999 1 0 0 0", "", 9, 0, "record 7"},
        {"         2         3         2", "", 9, 30, "found '2', expected abscissa spacing 0 (uneven) or 1 (even)"},
        {"         2         3         1          x.0", "", 9, 0, "expected an abscissa minimum"},
        {EVEN_3, "  1.00000E+00  2.00000E+00\n" UFF_EDGE, 15, 0, "the set ends after 2 of 3 values"},
        {EVEN_3, "  1.00000E+00  2.00000E+00  3.00000E+00\n  4.0\n" UFF_EDGE, 15, 0,
         "expected a line '    -1' behind the last value"},
        {EVEN_3, "  1.00000E+00               3.00000E+00\n" UFF_EDGE, 14, 0, "record 12: expected 3 reals, found 2 fields"},
        {EVEN_3, "  1.00000E+00  2.0000,E+00  3.00000E+00\n" UFF_EDGE, 14, 16, "'2.0000,E+00' is not a real"},
        {EVEN_3, "  1.00000E+00          NaN  3.00000E+00\n" UFF_EDGE, 14, 24, "NaN is not a finite number"},
        {EVEN_3, "  1.00000E+00  2.00000E+00", 14, 0, "the file ends after this line; expected values"},
        {EVEN_3, "  1.00000E+00  2.00000E+00  3.00000E+00\n", 14, 0,
         "the file ends after this line; expected the '-1' that ends the set"},
        {"         2 999999999         1  0.00000E+00  1.00000E+00  0.00000E+00", "1.\n" UFF_EDGE, 9, 12,
         "record 7 announces 999999999 values, expected no more than the 97 bytes that follow"},
        {"         2        60         1  0.00000E+00  1.00000E+00  0.00000E+00", "1.\n" UFF_EDGE, 15, 0, "after 1 of 60"},
    };
    for (size_t k = 0; k < sizeof item / sizeof *item; ++k) {
        struct uff_fixture fixture;
        struct uff_function function;
        struct uff_set set;
        double real[4];
        long long got = 1;
        open_text(&fixture, item[k].record_7, item[k].values);
        int status = uff_read_function(fixture.reader, &function);
        while (status == ROTID_OK && got)
            status = uff_read_values(fixture.reader, 2, NULL, real, NULL, &got);
        uff_fixture_refuses(&fixture, status, item[k].line, item[k].column, item[k].part);
        assert_int_equal(uff_read_values(fixture.reader, 2, NULL, real, NULL, &got), ROTID_ERROR_ARGUMENT);
        assert_int_equal(uff_next(fixture.reader, &set), UFF_END);
        uff_fixture_close(&fixture);
    }
}
