/* What a person sees: the tables of every command, judged by what they must say and by numbers that stand in two places. */
#include <ctype.h>
#include <unistd.h>

#include "report/report.h"
#include "support.h"

#define INPUT ROTID_SOURCE_DIR "/input/"

static char text[1 << 16];

/* Runs the program and keeps its standard output; returns its exit code. */
static int run(const char *arguments)
{
    char command[2048];
    (void)snprintf(command, sizeof command, "%s %s 2> /dev/null", ROTID_PROGRAM, arguments);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    size_t length = fread(text, 1, sizeof text - 1, pipe);
    text[length] = 0;
    int status = pclose(pipe);
    return status < 0 ? -1 : status / 256;
}

static const char *line_with(const char *part)
{
    const char *found = strstr(text, part);
    if (!found)
        print_error("'%s' is not in:\n%s\n", part, text);
    assert_non_null(found);
    while (found > text && found[-1] != '\n')
        found--;
    return found;
}

/* Number `column`, from 0, of the table row of mode 1 to 9. */
static double cell(int mode, int column)
{
    char begin[8];
    (void)snprintf(begin, sizeof begin, "\n%4d ", mode);
    const char *row = strstr(text, begin);
    if (!row) {
        (void)snprintf(begin, sizeof begin, "\n%3d ", mode);
        row = strstr(text, begin);
    }
    assert_non_null(row);
    char *end = (char *)row + strlen(begin);
    double value = 0;
    for (int i = 0; i <= column; i++) {
        while (*end == ' ')
            end++;
        if (*end == '-' && end[1] == ' ')
            end++;
        else
            value = strtod(end, &end);
    }
    return value;
}

UNIT_TEST(identify_shows_measured_predicted_error_and_the_papers_own)
{
    static const double paper_hz[] = {418.86, 796.78, 1188.6, 1781.8, 2335.5, 2889.1},
                        paper[] = {-3.83, 8.38, 2.52, -1.12, -3.72, -1.00};
    assert_int_equal(run("identify " INPUT "paper_rotor.inp"), 0);
    (void)line_with("fit of 6 modes, functional HYBRID, reduction GUYAN");
    (void)line_with("The fit converged in ten iterations");
    (void)line_with("core.E     GPa   115.7");
    (void)line_with("The 95 % intervals: core.E = 120 +- 60 GPa, core.G = 32 +- 23 GPa.");
    (void)line_with(WITH_NLOPT ? "NLopt (LN_BOBYQA, LN_SBPLX, LD_SLSQP) finds the same minimum.\n"
                               : "no check by NLopt: this rotid is built without it");
    (void)line_with("The hybrid quotient equals the frequency of the condensed model");
    for (int k = 1; k <= 6; k++) {
        assert_close(cell(k, 2), 100 * (cell(k, 1) / cell(k, 0) - 1), 0, 0.006); /* the error is that of the two beside it */
        assert_close(cell(k, 3), paper_hz[k - 1], 0, 0);
        assert_close(cell(k, 4), paper[k - 1], 0, 0);
    }
    assert_null(strstr(text, "iteration  "));
    assert_int_equal(run("identify " INPUT "paper_rotor.inp --verbose --no-baseline"), 0);
    (void)line_with("iteration  ");
    assert_null(strstr(text, "NLopt"));
    assert_int_equal(run("identify " INPUT "paper_rotor.inp --verbose"), 0);
    (void)line_with(WITH_NLOPT ? "NLopt LN_BOBYQA        0.02305" : "no minimiser beside it");
}

/* One rotor, stated in metres and hertz and in millimetres and kilohertz: the same numbers but for their units, and one result.
 */
UNIT_TEST(lengths_and_frequencies_are_shown_in_the_units_of_the_deck)
{
    static const char *const deck[2] = {
        "*UNITS, LENGTH=M\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=steel\n"
        "1.2, 0.05, 0, 60\n*MODES\n1, 158.2\n2, 433.1\n3, 841.9\n*NOISE, FREQUENCY=0.001\n*IDENTIFY\nbar.E, 1e10, 4e11, 2e11\n",
        "*UNITS, LENGTH=MM, FREQUENCY=KHZ\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, "
        "MATERIAL=steel\n1200, 50, 0, 60\n*MODES\n1, 0.1582\n2, 0.4331\n3, 0.8419\n*NOISE, FREQUENCY=0.001\n*IDENTIFY\nbar.E, "
        "1e10, 4e11, 2e11\n"};
    static const char *const said[2][3] = {{"length              1.200000 m\n", "measured [Hz]", "  158.200"},
                                           {"length              1200.000 mm\n", "measured [kHz]", "  0.158200"}};
    static char csv[2][4096], json[2][1 << 16];
    for (int i = 0; i < 2; i++) {
        char path[] = "/tmp/rotid_units_XXXXXX", arguments[512], name[128];
        FILE *file = fdopen(mkstemp(path), "w");
        assert_non_null(file);
        (void)fputs(deck[i], file);
        assert_int_equal(fclose(file), 0);
        (void)snprintf(arguments, sizeof arguments, "check %s", path);
        assert_int_equal(run(arguments), 0);
        (void)line_with(said[i][0]);
        (void)snprintf(arguments, sizeof arguments, "identify %s --csv %s.t --json %s.json", path, path, path);
        assert_true(run(arguments) <= 1);
        (void)line_with(said[i][1]);
        (void)line_with(said[i][2]);
        (void)snprintf(name, sizeof name, "%s.t.modes.csv", path);
        FILE *table = fopen(name, "r");
        assert_non_null(table);
        csv[i][fread(csv[i], 1, sizeof csv[i] - 1, table)] = 0;
        (void)fclose(table);
        (void)remove(name);
        (void)snprintf(name, sizeof name, "%s.json", path);
        assert_non_null(table = fopen(name, "r"));
        json[i][fread(json[i], 1, sizeof json[i] - 1, table)] = 0;
        (void)fclose(table);
        (void)snprintf(arguments, sizeof arguments, "report %s.json -o %s.html", path, path);
        assert_int_equal(run(arguments), 0);
        (void)snprintf(name, sizeof name, "%s.html", path);
        assert_non_null(table = fopen(name, "r"));
        int shown = 0;
        while (fgets(text, sizeof text, table))
            shown |= strstr(text, i ? "0.1582 to 0.8419\xc2\xa0kHz" : "158.2 to 841.9\xc2\xa0Hz") != NULL;
        (void)fclose(table);
        assert_true(shown);
        (void)remove(name);
        (void)snprintf(name, sizeof name, "%s.json", path);
        (void)remove(name);
        (void)snprintf(name, sizeof name, "%s.t.parameters.csv", path);
        (void)remove(name);
        (void)remove(path);
    }
    assert_non_null(strstr(csv[1], "measured [Hz]"));
    const char *one = strchr(csv[0], '\n'), *two = strchr(csv[1], '\n');
    for (int i = 0; i < 21; i++) { /* three modes, seven numbers each */
        one += strcspn(one, "0123456789-");
        two += strcspn(two, "0123456789-");
        char *end[2];
        assert_close(strtod(two, &end[1]), strtod(one, &end[0]), 1e-6, 1e-8); /* 1200 * 0.001 is not 1.2 to the last bit */
        one = end[0];
        two = end[1];
    }
    assert_null(strstr(json[0], "length_unit"));
    assert_non_null(strstr(json[1], "\"length_unit\":\t\"mm\""));
    assert_non_null(strstr(json[1], "\"frequency_unit\":\t\"kHz\""));
    assert_non_null(strstr(json[1], "\"length_m\":\t1.2"));
}

UNIT_TEST(held_out_modes_and_widened_intervals_are_said)
{
    assert_int_equal(run("identify " INPUT "brake_reuss_beam.inp --no-baseline"), 0);
    assert_non_null(strstr(line_with("1526.76"), "held out"));
    (void)line_with("an error of 12 % rms in the frequencies that were fitted, and of +18.22 % in\n");
    (void)line_with("The prediction error on held-out modes is 14 % rms.\n");
    assert_int_equal(run("identify " INPUT "solid_rotor.inp --no-baseline"), 1);
    (void)line_with("They are widened by 3.44");
    (void)line_with(INPUT "solid_rotor.inp looks for the cause");
    (void)line_with("3.4 times what the stated noise explains (chi2 = 4795 with 406 degrees of freedom)");
}

UNIT_TEST(what_is_not_determined_or_at_a_bound_is_said)
{
    char deck[] = "/tmp/rotid_tables_XXXXXX", arguments[128];
    FILE *file = fdopen(mkstemp(deck), "w");
    assert_non_null(file);
    (void)fputs("*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, MATERIAL=steel\n2, 0.02, 0, 30\n"
                "*MODES\n1, 22.96\n2, 63.26\n3, 123.9\n*NOISE, FREQUENCY=0.001\n*IDENTIFY\nbar.E, 1e10, 4e11, 2e11\nbar.G, 1e9, "
                "9e12, 8e10\n",
                file);
    assert_int_equal(fclose(file), 0);
    (void)snprintf(arguments, sizeof arguments, "identify %s --no-baseline", deck);
    assert_int_equal(run(arguments), 1); /* a bar this slender says nothing about shear */
    assert_non_null(strstr(line_with("bar.G  "), "not determined\n"));
    assert_null(strstr(line_with("bar.E  "), "  200  not"));
    (void)snprintf(arguments, sizeof arguments, "sensitivity %s --quiet", deck);
    assert_int_equal(run(arguments), 0);
    assert_string_equal(text, "");
    (void)remove(deck);
}

UNIT_TEST(modes_stand_beside_the_measured_ones_with_reduction_and_mesh_error)
{
    assert_int_equal(run("modes " INPUT "solid_steel.inp"), 0);
    for (int k = 1; k <= 6; k++) {
        assert_close(cell(k, 2), 100 * (cell(k, 1) / cell(k, 0) - 1), 0, 6e-4);
        assert_close(cell(k, 5), 100 * (cell(k, 0) / cell(k, 4) - 1), 0, 6e-3);
        assert_true(cell(k, 5) > 3 && cell(k, 5) < 7.5 && cell(k, 6) > 0.98);
    }
    assert_null(strstr(text, "z [m]"));
    assert_int_equal(run("modes " INPUT "solid_steel.inp --verbose"), 0);
    (void)line_with("sensor  position [m]    mode 1  ");
    (void)line_with("  2.03000 ");
}

UNIT_TEST(sensitivity_shows_table_1_beside_the_paper)
{
    assert_int_equal(run("sensitivity " INPUT "paper_rotor.inp --at core.E=8e10,core.G=3e10,core.nu=0.3333333333 --points 3"), 0);
    assert_non_null(strstr(line_with("373.1534"), "0.6690")); /* the paper's first entry beside ours */
    (void)line_with("core.nu = 0.3333, reduction GUYAN.");
    (void)line_with("\n0.500 ");
    assert_int_equal(run("sensitivity " INPUT "paper_rotor.inp"), 0);
    (void)line_with("At core.E = 60 GPa");
    static const char *const wrong[] = {"--at nothing.E=1", "--at core.E=x", "--at core.E=0", "--at core.nu=0.7",
                                        "--at ,",           "--step 0",      "--range 2",     "--points 0"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char arguments[256];
        (void)snprintf(arguments, sizeof arguments, "sensitivity " INPUT "paper_rotor.inp %s", wrong[i]);
        assert_int_equal(run(arguments), 2);
        assert_string_equal(text, "");
    }
    assert_int_equal(run("sensitivity " INPUT "solid_steel.inp"), 2); /* nothing to identify, nothing named */
    assert_int_equal(run("sensitivity " INPUT "solid_steel.inp --at core.G --points 1"), 0);
}

UNIT_TEST(check_shows_mass_mesh_and_groups)
{
    assert_int_equal(run("check " INPUT "paper_rotor.inp"), 0);
    assert_non_null(strstr(line_with("mass  "), "998.2755 kg"));
    assert_non_null(strstr(line_with("centre of mass"), "1.059125 m"));
    assert_non_null(strstr(line_with("mesh"), "176 nodes, 175 elements"));
    assert_non_null(strstr(line_with("rigid-body modes"), "2 (modes on the supports at"));
    assert_non_null(strstr(line_with("core  "), "115.70"));
    assert_int_equal(run("check " INPUT "foam_bar.inp"), 0);
    assert_non_null(strstr(line_with("rigid-body modes"), "2 (the rotor is free)"));
    assert_int_equal(run("modes " INPUT "foam_bar.inp"), 0);
    assert_non_null(strstr(line_with("rigid-body modes"), "2 (the rotor is free)"));
    assert_null(strstr(text, "rotor on its supports"));
    assert_int_equal(run("modes " INPUT "paper_rotor.inp"), 0);
    assert_non_null(strstr(line_with("rotor on its supports"), "0.546 Hz, 14.39 Hz"));
}

/* ---- numbers that are none */

#define SHAFT   "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, %d\n"
#define SENSORS "*SENSORS\n1, 0\n2, 0.2\n3, 0.4\n4, 0.6\n5, 0.8\n6, 1\n"

/* Runs a command on the deck; standard error stands behind the tables. */
static void run_deck(const char *command, const char *options, const char *deck)
{
    char path[] = "/tmp/test_tables_XXXXXX", arguments[256];
    int descriptor = mkstemp(path);
    FILE *stream = descriptor < 0 ? NULL : fdopen(descriptor, "wb");
    assert_non_null(stream);
    assert_true(fputs(deck, stream) >= 0 && fclose(stream) == 0);
    (void)snprintf(arguments, sizeof arguments, "%s %s %s 2>&1", command, path, options);
    (void)run(arguments);
    (void)unlink(path);
}

static void assert_no_such_word(void)
{
    static const char *const words[] = {"nan", "inf", NULL};
    for (int w = 0; words[w]; w++)
        for (const char *at = text; (at = strstr(at, words[w])); at++)
            if ((at == text || !isalpha((unsigned char)at[-1])) && !isalpha((unsigned char)at[3]))
                fail_msg("%s in:\n%s", words[w], text);
}

/* A free-free beam of constant section (Bishop and Johnson): mode number n from 1, z from 0 to 1. */
static double free_shape(int n, double z)
{
    static const double roots[] = {4.730040744862704, 7.853204624095838, 10.995607838001671};
    double b = roots[n - 1], s = (cosh(b) - cos(b)) / (sinh(b) - sin(b));
    return cosh(b * z) + cos(b * z) - s * (sinh(b * z) + sin(b * z));
}

UNIT_TEST(what_is_no_number_is_a_dash)
{
    enum { MANY = 1020 }; /* more masters than a condensation is made for: no NCO */
    static char deck[1 << 17];
    char first[512];
    (void)snprintf(first, sizeof first, SHAFT SENSORS, 20);
    /* one frequency for two parameters: no condition number; the first iteration has no gain */
    (void)snprintf(deck, sizeof deck, "%s*MODES\n1, 448\n*IDENTIFY\ncore.E, 1e11, 4e11, 2e11\ncore.G, 1e10, 4e11, 8e10\n", first);
    run_deck("identify", "--verbose", deck);
    assert_no_such_word();
    assert_non_null(strstr(text, "condition number -\n"));
    run_deck("diagnose", "", deck);
    assert_no_such_word();
    /* as far from the model as the smallest noise makes it: every number keeps its column */
    (void)snprintf(deck, sizeof deck,
                   "%s*MODES\n1, 500\n2, 1300\n3, 2400\n*NOISE, FREQUENCY=1e-30\n*IDENTIFY\ncore.E, 1e11, 4e11, 2e11\n", first);
    run_deck("diagnose", "--verbose", deck);
    assert_no_such_word();
    const char *head = strstr(text, "res./sigma"), *row = strstr(text, "\n   1        500.000 ");
    assert_true(head && row);
    assert_int_equal(strcspn(row + 1, "|"), strcspn(strstr(row + 1, "\n") + 1, "|"));
    assert_non_null(strstr(row, "e2"));
    /* modes by their shapes, without an NCO */
    int length = snprintf(deck, sizeof deck, SHAFT "*SENSORS\n", MANY);
    for (int i = 0; i <= MANY; i++)
        length += snprintf(deck + length, sizeof deck - (size_t)length, "%d, %.9f\n", i + 1, (double)i / MANY);
    length += snprintf(deck + length, sizeof deck - (size_t)length, "*FIT, REDUCTION=NONE\n*MODES\n1, 1184\n2, 2199\n");
    for (int n = 2; n <= 3; n++) {
        length += snprintf(deck + length, sizeof deck - (size_t)length, "*SHAPE, MODE=%d\n", n - 1);
        for (int i = 0; i <= MANY; i++)
            length += snprintf(deck + length, sizeof deck - (size_t)length, "%d, %.5f\n", i + 1, free_shape(n, (double)i / MANY));
    }
    assert_true(length < (int)sizeof deck - 1);
    run_deck("modes", "", deck);
    assert_no_such_word();
    assert_non_null(strstr(text, "measured mode 1 at 1184 Hz is mode 2 of the model by its shape\n"));
}

/* Whatever the number, a column is as wide as its widest cell, and a huge one gets a power of ten. */
UNIT_TEST(columns_are_as_wide_as_their_cells)
{
    static const double values[] = {NAN, INFINITY, -INFINITY, 0, 1, -1, 1e20, -1e20, 1e300, -1e300, 1e-300, 1234.567, -0.001};
    char *made = NULL;
    size_t length, width = 0;
    FILE *stream = open_memstream(&made, &length);
    struct table *table = table_open(&test_pool, "");
    assert_non_null(stream);
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        number_column(table, "fixed", NULL, SHOW_FIXED(2), values[i]);
        number_column(table, "signed", NULL, SHOW_SIGNED(2), values[i]);
        number_column(table, "digits", NULL, SHOW_DIGITS(4), values[i]);
    }
    table_write_text(stream, table, 100);
    assert_int_equal(fclose(stream), 0);
    for (const char *line = made; *line; line += strcspn(line, "\n") + 1) {
        width = width ? width : strcspn(line, "\n");
        assert_int_equal(strcspn(line, "\n"), width);
    }
    assert_non_null(strstr(made, "\n  1.0e20   +1.0e20    1.000e20\n"));
    assert_non_null(strstr(made, "\n 1234.57  +1234.57        1235\n"));
    assert_non_null(strstr(made, "\n    0.00      0.00   -0.001000\n")); /* no negative zero */
    assert_null(strstr(made, "nan"));
    assert_null(strstr(made, "inf"));
    free(made);
}

TEST_GROUP(open_test_pool, close_test_pool);
