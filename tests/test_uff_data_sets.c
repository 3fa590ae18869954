/* Set 55: data at nodes. */
#include "support.h"
#include "uff/uff.h"
#include "uff_fixture.h"

#define SET(number) UFF_EDGE #number "\n"
#define TEXTS       "one\ntwo\nthree\nfour\nNONE\n"

#define SHAPE(text, analysis, numbers)                                                                                           \
    SET(55) text "\ntwo\nthree\nfour\nfive\n" analysis "\n" numbers "         1\n  1.00000E+00\n" UFF_EDGE

UNIT_TEST(shapes)
{
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
