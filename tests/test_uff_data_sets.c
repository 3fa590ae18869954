/* Sets 2414 and 55: data at nodes and on elements. */
#include <stdio.h>

#include "uff/uff.h"
#include "uff_fixture.h"

#define SET(number) UFF_EDGE #number "\n"
#define TEXTS       "one\ntwo\nthree\nfour\nNONE\n"

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
                                                                                                    "    1\n-1\n" UFF_EDGE RECORDS(
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
                                                                                                                 "      1")
                                                                                                                 UFF_EDGE RECORDS(
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
                                                                                                                         "9") "  "
                                                                                                                              "  "
                                                                                                                              "  "
                                                                                                                              "  "
                                                                                                                              " 1"
                                                                                                                              "\n"
                                                                                                                              " 1"
                                                                                                                              "."
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(analysis), cmocka_unit_test(shapes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
