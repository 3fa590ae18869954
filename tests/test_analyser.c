/* Tables of an analyser: the transfer functions of a formula, written in every way they come, and the mistakes in them. */
#include "folder.h"
#include "import/import.h"
#include "support.h"

#define LINES 50

/* Acceleration over force of a mass on a spring, of point p. */
static double complex exact(int p, double hz)
{
    double w = 2 * 3.141592653589793 * hz;
    return -w * w * (0.5 + p) / (1e6 - w * w + 0.04 * I * w * 1e3);
}

static int read_table(const char *text, const struct measurement_options *options, struct measurement *out, const char **said)
{
    static const struct measurement_options none;
    struct message_list messages;
    message_open(&messages, &test_pool);
    int status = analyser_read(&test_pool, folder_write("table.csv", text), options ? options : &none, &messages, out);
    *said = messages.count ? pool_format(&test_pool, "%d:%d: %s", messages.item[messages.count - 1].line,
                                         messages.item[messages.count - 1].column, messages.item[messages.count - 1].text)
                           : "";
    return status;
}

/* Written with two columns a function; polar: magnitude and phase. comma: the decimal sign. */
static const char *table_of(const char *head, char separator, char comma, int polar, double in_hz, double in_si, double degrees)
{
    const char *text = pool_format(&test_pool, "%s\r\n", head);
    for (int i = 0; i < LINES; i++) {
        double hz = 100 + 2.0 * i, cell[5] = {hz / in_hz};
        for (int p = 0; p < 2; p++) {
            double complex h = exact(p, hz) / in_si;
            cell[1 + 2 * p] = polar ? cabs(h) : creal(h);
            cell[2 + 2 * p] = polar ? carg(h) * degrees : cimag(h);
        }
        for (int c = 0; c < 5; c++) {
            char *number = pool_format(&test_pool, "%.12g", cell[c]);
            for (char *dot = number; comma != '.' && (dot = strchr(dot, '.')) != NULL;)
                *dot = comma;
            text = pool_format(&test_pool, "%s%s%c", text, number, c < 4 ? separator : '\n');
        }
    }
    return text;
}

POOL_TEST(every_form_gives_the_same_functions)
{
    const struct {
        const char *head;
        char separator, comma;
        int polar;
        double in_hz, in_si, degrees;
    } forms[] = {
        {"Frequency [Hz],12/1 real [m/s2/N],12/1 imag [m/s2/N],13/1 real [m/s2/N],13/1 imag [m/s2/N]", ',', '.', 0, 1, 1, 1},
        {"\xef\xbb\xbf\"f [kHz]\";\"H12,1 Magnitude [g/N]\";\"H12,1 Phase [deg]\";\"H13,1 Magnitude [g/N]\";\"H13,1 Phase "
         "[deg]\"",
         ';', ',', 1, 1e3, 9.80665, 57.29577951308232},
        {"freq\t12:1 mag [mm/s2/N]\t12:1 phase [rad]\t13:1 mag [mm/s2/N]\t13:1 phase [rad]", '\t', '.', 1, 1, 1e-3, 1},
        {"sep=|\r\nf|12/1 re [1/kg]|12/1 im [1/kg]|13/1 re [1/kg]|13/1 im [1/kg]", '|', ',', 0, 1, 1, 1},
    };
    for (size_t f = 0; f < 2 * sizeof forms / sizeof *forms; f++) {
        struct measurement m = {0};
        const char *said;
        size_t k = f / 2;
        char *text = pool_format(&test_pool, "%s",
                                 table_of(forms[k].head, forms[k].separator, forms[k].comma, forms[k].polar, forms[k].in_hz,
                                          forms[k].in_si, forms[k].degrees));
        for (char *feed = text; f % 2 && (feed = strchr(feed, '\n')) != NULL;)
            *feed = '\r';
        assert_status(read_table(text, NULL, &m, &said), ROTID_OK);
        assert_string_equal(said, "");
        assert_int_equal(m.set.nfrf, 2);
        assert_int_equal(m.set.nline, LINES);
        assert_int_equal(m.set.quantity, FRF_ACCELERATION);
        for (int p = 0; p < 2; p++) {
            assert_int_equal(m.set.frf[p].response_node, 12 + p);
            assert_int_equal(m.set.frf[p].reference_node, 1);
            for (int i = 0; i < LINES; i++) {
                assert_close(m.set.frequency_hz[i], 100 + 2.0 * i, 1e-10, 0);
                assert_true(cabs(m.set.frf[p].h[i] - exact(p, 100 + 2.0 * i)) < 1e-9 * cabs(exact(p, 100 + 2.0 * i)));
            }
        }
    }
}

POOL_TEST(a_band_and_a_reference_are_those_of_the_options)
{
    const struct measurement_options options = {.low_hz = 110, .high_hz = 130, .reference = 7};
    struct measurement m = {0};
    const char *said;
    assert_status(read_table(table_of("Frequency,P12 re,P12 im,P13 re,P13 im", ',', '.', 0, 1, 1, 1), &options, &m, &said),
                  ROTID_OK);
    assert_non_null(strstr(said, "accelerances in (m/s2)/N are assumed"));
    assert_int_equal(m.set.nline, 11);
    assert_close(m.set.frequency_hz[0], 110, 1e-12, 0);
    assert_int_equal(m.set.frf[1].reference_node, 7);
}

POOL_TEST(of_two_references_that_of_the_options_is_taken)
{
    const struct measurement_options options = {.reference = 2}, other = {.reference = 3};
    struct measurement m = {0}, none = {0};
    const char *said, *text = table_of("Frequency,12/1 re,12/1 im,13/2 re,13/2 im", ',', '.', 0, 1, 1, 1);
    assert_status(read_table(text, &options, &m, &said), ROTID_OK);
    assert_int_equal(m.set.nfrf, 1);
    assert_int_equal(m.set.frf[0].response_node, 13);
    assert_true(cabs(m.set.frf[0].h[3] - exact(1, 106)) < 1e-9 * cabs(exact(1, 106)));
    assert_status(read_table(text, &other, &none, &said), ROTID_ERROR_ARGUMENT);
    assert_string_equal(said, "1:1: no function has the reference asked for, expected one");
}

POOL_TEST(mistakes_have_their_place)
{
    static const char *const cases[][2] = {
        {"", "1:1: the first row is ''"},
        {"time,1/1 re,1/1 im\n1,2,3\n", "1:1: the first column is 'time', expected frequency [Hz]"},
        {"freq,1/1 re,1/1 what\n", "1:3: '1/1 what' does not say what it holds"},
        {"freq,H re,H im\n", "1:2: 'H re' does not name response and reference"},
        {"freq,3 re,3 im\n", "one and --reference N"},
        {"freq,1/1 re,1/2 im\n", "1:1: 1/1 has not two columns"},
        {"freq,1/1 re,1/1 phase\n", "1:1: 1/1 has not two columns"},
        {"freq,1/1 re [dB],1/1 im\n", "1:2: the unit of '1/1 re [dB]' is not known"},
        {"freq,1/1 re [m/N],1/1 im [g/N]\n", "1:3: '1/1 im [g/N]' is another quantity"},
        {"freq,1/1 re,1/1 im\n1,2,3\n1,2,3\n", "3:1: the frequency 1 does not rise"},
        {"freq,1/1 re,1/1 im\n1,2,x\n", "2:3: the cell is 'x', expected a number"},
        {"freq,1/1 re,1/1 im\n1,2\n", "2:1: the row has another number of cells"},
        {"freq,1/1 re,1/1 im\n1,2,3,4\n", "2:1: the row has another number of cells"},
        {"freq,1/1 re,1/1 im\n1,2,3\n", "1:1: fewer than two lines"},
        {"frequency (kHz),1/1 re,1/1 im\n", "1:1: the unit of the first column 'frequency (kHz)' does not stand in brackets"},
        {"freq rad/s,1/1 re,1/1 im\n", "1:1: the unit of the first column"},
        {"freq,1/1 re (g/N),1/1 im (g/N)\n", "1:2: the unit of '1/1 re (g/N)' does not stand in brackets"},
        {"freq,1/1 mag,1/1 phase (rad)\n", "1:3: the unit of '1/1 phase (rad)' does not stand in brackets"},
        {"freq,1/1 re [g/N],1/1 im\n", "1:3: '1/1 im' and the columns before do not all have a unit"},
        {"freq,1/1 re,1/1 im [g/N]\n", "1:3: '1/1 im [g/N]' and the columns before do not all have a unit"},
        {"freq,1/1 mag dB,1/1 phase\n", "1:2: '1/1 mag dB' holds levels"},
        {"freq,run 3 12/1 re,run 3 12/1 im\n", "1:2: 'run 3 12/1 re' does not name response and reference"},
        {"freq,12.5/1 re,12.5/1 im\n", "1:2: '12.5/1 re' does not name response and reference"},
        {"freq,4294967297/1 re,4294967297/1 im\n", "does not name response and reference"},
        {"freq;1/1 re;1/1 im\n1,000;2.5;3\n", "2:1: numbers have decimal commas and decimal points"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct measurement m = {0};
        const char *said;
        assert_status(read_table(cases[i][0], NULL, &m, &said), ROTID_ERROR_ARGUMENT);
        if (!strstr(said, cases[i][1]))
            fail_msg("%s: '%s', expected '%s'", cases[i][0], said, cases[i][1]);
    }
}

TEST_GROUP(folder_make, folder_remove);
