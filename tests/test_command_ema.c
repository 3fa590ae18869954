/* rotid ema as its users see it: the modes of a real bar as JSON and as a file for a deck, and what is refused. */
#include <sys/wait.h>

#include "deck/deck.h"
#include "json_value.h"
#include "one_state.h"
#include "support.h"
#include "uff_program.h"

#define EXCERPT ROTID_SOURCE_DIR "/tests/data/uff/beam_excerpt.uff"
#define MODES   9
#define POINTS  3
#define DECK                                                                                                                     \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*BEAM, NAME=bar, MATERIAL=steel\n1, 0.0127, 0.0254, 40\n"

static const double hz[MODES] = {52.553, 144.632, 283.127, 468.277, 698.466, 972.977, 1292.957, 1655.35, 2064.51};
static const double zeta[MODES] = {0.001821, 0.000715, 0.000392, 0.000216, 0.000186, 0.000228, 0.000217, 0.000333, 0.000210};

/* Runs `rotid command` in the folder; its streams in uff_output. */
static int program(const char *command, const char *arguments)
{
    char line[1024];
    (void)snprintf(line, sizeof line, "cd %s && %s %s %s 2>&1", uff_folder, ROTID_PROGRAM, command, arguments);
    FILE *pipe = popen(line, "r");
    assert_non_null(pipe);
    size_t length = fread(uff_output, 1, sizeof uff_output - 1, pipe);
    uff_output[length] = '\0';
    while (fgetc(pipe) != EOF) /* what does not fit; nobody breaks the pipe */
        continue;
    int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

static void ema_says(const char *arguments, int code, const char *text)
{
    int seen = program("ema", arguments);
    if (seen != code || !strstr(uff_output, text))
        print_error("rotid ema %s: exit code %d for %d, expected \"%s\" in:\n%s\n", arguments, seen, code, text, uff_output);
    assert_true(seen == code && strstr(uff_output, text));
}

static void put_text(const char *name, const char *text)
{
    FILE *stream = create(name);
    assert_true(fputs(text, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
}

static void make_excerpt(const char *name)
{
    char buffer[4096];
    FILE *from = fopen(EXCERPT, "rb"), *to = create(name);
    assert_non_null(from);
    put_nodes(to, POINTS); /* the excerpt has none */
    for (size_t length; (length = fread(buffer, 1, sizeof buffer, from));)
        assert_int_equal(fwrite(buffer, 1, length, to), length);
    (void)fclose(from);
    assert_int_equal(fclose(to), 0);
}

static cJSON *json_of(const char *name)
{
    size_t length;
    char *text = read_file(name, &length);
    assert_non_null(text);
    cJSON *json = cJSON_ParseWithOpts(text, NULL, 1);
    free(text);
    assert_non_null(json);
    return json;
}

UNIT_TEST(nine_modes_of_a_bar_in_the_json)
{
    make_excerpt("bar.uff");
    ema_says("bar.uff --json bar.json -o modes.uff", 0, "9 modes written to modes.uff");
    assert_non_null(strstr(uff_output, "3 transfer functions (accelerance), 3 points, 1861 lines from 40 to 2106 Hz"));
    cJSON *json = json_of("bar.json");
    const cJSON *modes = get(json, "modes");
    assert_int_equal(cJSON_GetArraySize(modes), MODES);
    for (int k = 0; k < MODES; k++) {
        const cJSON *mode = cJSON_GetArrayItem(modes, k);
        assert_close(number_of(mode, "mode"), k + 1, 0, 0);
        assert_close(number_of(mode, "frequency_hz"), hz[k], 1e-3, 0);
        assert_close(number_of(mode, "damping"), zeta[k], 0.15, 0);
        assert_true(number_of(mode, "frequency_std_hz") > 0 && number_of(mode, "frequency_std_hz") < 1e-3 * hz[k]);
        assert_true(cJSON_IsNull(get(mode, "modal_mass_kg"))); /* nothing was measured at the hammer */
        assert_int_equal(cJSON_GetArraySize(get(mode, "shape")), POINTS);
        double largest = 0;
        for (int p = 0; p < POINTS; p++)
            largest = fmax(largest, fabs(number_of(cJSON_GetArrayItem(get(mode, "shape"), p), "value")));
        assert_close(largest, 1, 1e-12, 0);
    }
    assert_int_equal(cJSON_GetArraySize(get(json, "channels")), POINTS);
    assert_int_equal(cJSON_GetArraySize(get(json, "mac")), MODES);
    assert_string_equal(get(json, "output")->valuestring, "modes.uff");
    assert_string_equal(get(json, "std_from")->valuestring, "residual");
    const cJSON *source = get(json, "source");
    assert_close(number_of(source, "transfer_functions"), POINTS, 0, 0);
    assert_close(number_of(source, "lines"), 1861, 0, 0);
    cJSON_Delete(json);
}

POOL_TEST(a_deck_reads_the_modes_back)
{
    struct message_list messages;
    struct job job;
    make_excerpt("bar.uff");
    ema_says("bar.uff --quiet --json bar.json -o modes.uff", 0, "");
    put_text("bar.inp", DECK "*MEASURED, FILE=modes.uff\n");
    cJSON *json = json_of("bar.json");
    message_open(&messages, &test_pool);
    assert_status(deck_read(&test_pool, path_of("bar.inp"), 0, NULL, &messages, &job), ROTID_OK);
    assert_int_equal(job.measurement.nmode, MODES);
    assert_int_equal(job.rotor.nsensor, POINTS);
    for (int k = 0; k < MODES; k++) {
        const cJSON *mode = cJSON_GetArrayItem(get(json, "modes"), k);
        assert_close(job.measurement.frequency_hz[k], number_of(mode, "frequency_hz"), 1e-5, 0); /* six digits of a set 55 */
        assert_close(job.measurement.frequency_std[k],
                     hypot(number_of(mode, "frequency_std_hz") / number_of(mode, "frequency_hz"), 2e-4), 1e-5, 0);
        for (int p = 0; p < POINTS; p++) {
            const cJSON *point = cJSON_GetArrayItem(get(mode, "shape"), p);
            assert_int_equal(job.rotor.sensor[p].id, (int)number_of(point, "node"));
            assert_close(job.measurement.shape[p + POINTS * k], number_of(point, "value"), 1e-5, 1e-6);
            assert_close(job.measurement.shape_std[p + POINTS * k], hypot(number_of(point, "std"), 2e-3), 1e-5, 1e-6);
        }
    }
    size_t said = messages.count;
    assert_non_null(
        strstr(messages.item[said - 1].text,
               "scatter within one test; 0.02 % of frequencies (the least that is taken) and 0.2 % of shapes (the least "
               "that is taken) are added"));
    put_text("bar.inp", DECK "*MEASURED, FILE=modes.uff\n*NOISE, FLOOR_FREQUENCY=0\n"); /* as the user says */
    message_open(&messages, &test_pool);
    assert_status(deck_read(&test_pool, path_of("bar.inp"), 0, NULL, &messages, &job), ROTID_OK);
    assert_int_equal(messages.count, said - 1);
    assert_close(job.measurement.frequency_std[0],
                 number_of(cJSON_GetArrayItem(get(json, "modes"), 0), "frequency_std_hz") /
                     number_of(cJSON_GetArrayItem(get(json, "modes"), 0), "frequency_hz"),
                 1e-5, 0);
    cJSON_Delete(json);
    assert_int_equal(program("check", "bar.inp"), 0);
}

/* Each step is said as the command that does it alone, and that command does the same. */
UNIT_TEST(a_test_is_its_four_commands)
{
    static const char *const commands[] = {
        "$ rotid ema bar.uff --band 40,2000 -o p_modes.unv --json p_ema.json\n",
        "$ rotid identify bar.inp --set MEASURED.FILE=p_modes.unv --set FIT.FUNCTIONAL=LIKELIHOOD --json p_identify.json\n",
        "$ rotid diagnose bar.inp --set MEASURED.FILE=p_modes.unv --set FIT.FUNCTIONAL=LIKELIHOOD --json p_diagnose.json\n",
        "$ rotid report p_ema.json p_identify.json p_diagnose.json -o p.html\n"};
    make_excerpt("bar.uff");
    put_text("bar.inp", DECK "*IDENTIFY\nbar.E, 1e11, 3e11, 2e11\n");
    int code = program("test", "bar.uff bar.inp -o p.html --band 40,2000 --set FIT.FUNCTIONAL=LIKELIHOOD"), worst = 0;
    const char *at = uff_output;
    for (int i = 0; i < 4; i++) {
        at = strstr(at, commands[i]);
        if (!at)
            print_error("no %s in %s\n", commands[i], uff_output);
        assert_non_null(at);
    }
    cJSON *json = json_of("p_identify.json");
    const double e = number_of(cJSON_GetArrayItem(get(json, "parameters"), 0), "value");
    assert_true(e > 1e11 && e < 3e11); /* the excerpt has no places: nothing of the truth */
    cJSON_Delete(json);
    for (int i = 0; i < 4; i++) {
        char name[16], words[256];
        assert_int_equal(sscanf(commands[i], "$ rotid %15s %255[^\n]", name, words), 2);
        int own = program(name, words);
        worst = own > worst ? own : worst;
    }
    assert_int_equal(code, worst);
    json = json_of("p_identify.json");
    assert_close(number_of(cJSON_GetArrayItem(get(json, "parameters"), 0), "value"), e, 0, 0);
    cJSON_Delete(json);
    put_text("my bar's $x.inp", DECK "*IDENTIFY\nbar.E, 1e11, 3e11, 2e11\n"); /* a name that a shell would change */
    assert_int_equal(program("test", "bar.uff \"my bar's \\$x.inp\" -o p.html"), code);
    assert_non_null(strstr(uff_output, "$ rotid identify 'my bar'\\''s $x.inp' --set MEASURED.FILE=p_modes.unv"));
    assert_int_equal(program("test", "bar.uff"), 2);
    assert_non_null(strstr(uff_output, "expected two files, the records of the test and the deck of the rotor"));
    assert_int_equal(program("test", "none.uff bar.inp"), 2); /* and no step behind the one that fails */
    assert_null(strstr(uff_output, "rotid identify"));
}

UNIT_TEST(picks_and_bands_choose)
{
    make_excerpt("bar.uff");
    ema_says("bar.uff --quiet --pick 283,1293 --json pick.json", 0, "");
    cJSON *json = json_of("pick.json");
    const cJSON *modes = get(json, "modes");
    assert_int_equal(cJSON_GetArraySize(modes), 2);
    assert_close(number_of(cJSON_GetArrayItem(modes, 0), "frequency_hz"), hz[2], 1e-3, 0);
    assert_close(number_of(cJSON_GetArrayItem(modes, 1), "frequency_hz"), hz[6], 1e-3, 0);
    cJSON_Delete(json);

    ema_says("bar.uff --quiet --pick 400 --json pick.json", 1, ""); /* no mode there */
    json = json_of("pick.json");
    const cJSON *doubts = get(cJSON_GetArrayItem(get(json, "modes"), 0), "doubts");
    int unstable = 0;
    for (const cJSON *doubt = doubts->child; doubt; doubt = doubt->next)
        unstable |= !strcmp(doubt->valuestring, "no stable pole in the table");
    assert_true(unstable);
    cJSON_Delete(json);

    ema_says("bar.uff --quiet --band 100,600 --json band.json", 0, "");
    json = json_of("band.json");
    modes = get(json, "modes");
    assert_int_equal(cJSON_GetArraySize(modes), 3);
    for (int k = 0; k < 3; k++)
        assert_close(number_of(cJSON_GetArrayItem(modes, k), "frequency_hz"), hz[k + 1], 1e-3, 0);
    cJSON_Delete(json);
}

UNIT_TEST(per_point_gives_each_point_its_frequency)
{
    size_t length;
    make_excerpt("bar.uff");
    ema_says("bar.uff --quiet --per-point --json points.json -o points.uff", 0, "");
    cJSON *json = json_of("points.json");
    int known = 0;
    for (int k = 0; k < MODES; k++)
        for (int p = 0; p < POINTS; p++) {
            const cJSON *point = cJSON_GetArrayItem(get(cJSON_GetArrayItem(get(json, "modes"), k), "shape"), p);
            if (cJSON_IsNull(get(point, "frequency_hz")))
                continue;
            assert_close(number_of(point, "frequency_hz"), hz[k], 2e-3, 0);
            assert_true(number_of(point, "frequency_std_hz") > 0);
            known++;
        }
    cJSON_Delete(json);
    assert_true(known >= 2 * MODES);
    char *text = read_file("points.uff", &length);
    assert_non_null(text);
    assert_non_null(strstr(text, "ROTID FREQUENCY AT POINT OF MODE 9"));
    assert_non_null(strstr(text, "ROTID STANDARD DEVIATION OF FREQUENCY AT POINT OF MODE 9"));
    free(text);
}

UNIT_TEST(quiet_says_nothing)
{
    make_excerpt("bar.uff");
    ema_says("bar.uff --quiet", 0, "");
    assert_int_equal(strlen(uff_output), 0);
    ema_says("bar.uff --json -", 0, "");
    assert_int_equal(uff_output[0], '{'); /* nothing but JSON */
    ema_says("bar.uff --verbose", 0, "order  frequency [Hz]");
    assert_null(strstr(uff_output, "nan"));
}

UNIT_TEST(wrong_usage_is_refused)
{
    static const struct {
        const char *arguments, *text;
    } wrong[] = {
        {"bar.uff --band 200,100", "--band 200,100: expected two frequencies, the lower one first"},
        {"bar.uff --band 200", "--band 200: expected two frequencies"},
        {"bar.uff --band x,100", "--band x,100: expected frequencies"},
        {"bar.uff --band nan,100", "--band nan,100: expected frequencies"},
        {"bar.uff --band 5000,6000", "lines from 40 to 2106 Hz lie in the band asked for"},
        {"bar.uff --band 41,42.6", "at least 16 lines in the band"},
        {"bar.uff --method peaks", "--method peaks: expected lscf or quadrature"},
        {"bar.uff --estimator H4", "--estimator H4: expected H1, H2 or HV"},
        {"bar.uff --pick 100,", "--pick 100,: expected frequencies"},
        {"bar.uff --pick -3", "--pick -3: expected frequencies"},
        {"bar.uff --order 1", "--order 1: expected a whole number from 2 to 400"},
        {"bar.uff --reference 7", "no transfer function is left to use"},
        {"bar.uff -o bar.uff", "is the file that is read"},
        {"bar.uff -o ./bar.uff", "is the file that is read"},
        {"bar.uff --json bar.uff", "is the file that is read"},
        {"bar.uff -o same --json same", "is the file of --json as well"},
        {"bar.uff --extended x.inp", "--extended is no option of ema, but of diagnose suggest"},
        {"bar.uff more.uff", "more.uff:1:1: cannot be opened"},
        {"bar.uff bar.uff", "bar.uff: has the modes of a file before it to the last digit"},
        {"bar.uff bar.uff --json both.json", "--json both.json: expected one file"},
        {"", "no file given"},
        {"missing.uff", "missing.uff:1:1: cannot be opened"},
        {".", "cannot be read"},
        {"bar.inp", "bar.inp:1:1: no universal file"},
        {"nodes.uff", "nodes.uff:1:1: 0 functions, none of them a transfer function"},
        {"cut.uff", "set 58: the file ends after this line"},
    };
    size_t length;
    make_excerpt("bar.uff");
    put_text("bar.inp", DECK);
    put_text("nodes.uff", "    -1\n  2411\n    -1\n");
    char *text = read_file("bar.uff", &length);
    text[length - strlen("    -1\n")] = '\0';
    put_text("cut.uff", text);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        ema_says(wrong[i].arguments, 2, wrong[i].text);
    text[length - strlen("    -1\n")] = ' ';
    char *same = read_file("bar.uff", &length); /* what was refused left the input alone */
    assert_string_equal(same, text);
    free(same);
    free(text);
    assert_int_equal(program("uff", "bar.uff --pick 100"), 2);
    assert_non_null(strstr(uff_output, "--pick is an option of ema alone"));
    assert_int_equal(program("modes", "bar.inp --per-point"), 2);
    assert_non_null(strstr(uff_output, "--per-point is an option of ema alone"));
}

/* One mode at 100 Hz of four points, two over each of two references, in digits that leave more noise than rounding does. */
static void put_two_parts(const char *name, int tied)
{
    const double phi[] = {1, 0.5, -0.4, -0.9};
    FILE *out = create(name);
    (void)fputs("frequency [Hz];1/1 real;1/1 imaginary;2/1 real;2/1 imaginary;3/4 real;3/4 imaginary;4/4 real;4/4 imaginary",
                out);
    (void)fputs(tied ? ";2/4 real;2/4 imaginary\n" : "\n", out);
    for (int i = 0; i < 400; i++) {
        double f = 50 + 0.25 * i, re = 1 - f * f / 1e4, im = 0.02 * f / 100, square = re * re + im * im;
        const double product[] = {phi[0] * phi[0], phi[1] * phi[0], phi[2] * phi[3], phi[3] * phi[3], phi[1] * phi[3]};
        (void)fprintf(out, "%g", f);
        for (int c = 0; c < 4 + tied; c++)
            (void)fprintf(out, ";%.6g;%.6g", -f * f * product[c] * re / square, f * f * product[c] * im / square);
        (void)fputc('\n', out);
    }
    assert_int_equal(fclose(out), 0);
}

/* A table of up to four points over one reference, one line for each of two modes; files of one test differ in order and digits,
 * in which noise is that of `seed`. */
static void put_table(const char *name, int seed, int last, int digits, int points)
{
    const double phi[2][4] = {{1, 0.5, -0.4, -0.9}, {-1, 0.3, 0.8, -0.6}}, at_hz[2] = {80, 130};
    struct random_stream random = {(uint64_t)seed};
    FILE *out = create(name);
    (void)fputs("frequency [Hz]", out);
    for (int c = 0; c < points; c++)
        (void)fprintf(out, ";%d/1 real;%d/1 imaginary", (c + last) % points + 1, (c + last) % points + 1);
    (void)fputc('\n', out);
    for (int i = 0; i < 400; i++) {
        double f = 50 + 0.25 * i;
        double complex h[4] = {0};
        for (int c = 0; c < points; c++) {
            for (int k = 0; k < 2; k++)
                h[c] += phi[k][c] * phi[k][0] * f * f / (at_hz[k] * at_hz[k] - f * f + I * 0.02 * at_hz[k] * f);
            h[c] += 1e-2 * (random_normal(&random) + I * random_normal(&random));
        }
        (void)fprintf(out, "%g", f);
        for (int c = 0; c < points; c++)
            (void)fprintf(out, ";%.*g;%.*g", digits, creal(h[(c + last) % points]), digits, cimag(h[(c + last) % points]));
        (void)fputc('\n', out);
    }
    assert_int_equal(fclose(out), 0);
}

/* The same records in another order, or with other digits, have no scatter either. */
UNIT_TEST(two_files_of_one_test_are_no_two_tests)
{
    put_table("first.csv", 1, 0, 12, 4);
    put_table("again.csv", 1, 1, 6, 4);
    put_table("second.csv", 2, 0, 12, 4);
    ema_says("first.csv second.csv -o both.unv", 0, "the means of 2 tests");
    ema_says("first.csv second.csv again.csv -o all.unv", 2, "/1 is that of first.csv, expected another test");
}

/* What no file of the two alone stands for; a card that a deck takes. */
UNIT_TEST(means_are_of_no_file_alone)
{
    size_t length;
    put_table("first.csv", 1, 0, 12, 4);
    put_table("second.csv", 2, 0, 12, 3);
    ema_says("first.csv second.csv -o both.unv", 0, "1 point left out of the shapes");
    assert_non_null(strstr(uff_output, "*NOISE, FREQUENCY="));
    assert_non_null(strstr(uff_output, ", SHAPE="));
    char *text = read_file("both.unv", &length);
    assert_non_null(strstr(text, "from 2 tests"));
    assert_null(strstr(text, "first.csv"));
    assert_non_null(strstr(text, "ROTID HAMMER AT NODE 1")); /* of both */
    free(text);
}

UNIT_TEST(nodes_that_lie_elsewhere_in_another_test_are_told)
{
    for (int moved = 0; moved < 2; moved++) {
        const struct uff_node node = {.id = 2, .x = {0, 0, moved ? 0.5002 : 0.500001}}; /* for 0.5 */
        const struct uff_function f = function(UFF_TRANSFER, 2, 641);
        FILE *stream = create("elsewhere.uff");
        assert_status(uff_write_nodes(stream, 2411, 1, &node), ROTID_OK);
        put_function(stream, &f, 1, INFINITY);
        assert_int_equal(fclose(stream), 0);
        make_excerpt("bar.uff");
        (void)program("ema", "bar.uff elsewhere.uff");
        assert_int_equal(strstr(uff_output, "elsewhere.uff:1:1: warning: nodes are up to ") != NULL, moved);
    }
}

UNIT_TEST(one_point_tells_nothing_of_the_scatter_of_shapes)
{
    put_table("one.csv", 1, 0, 12, 1);
    put_table("two.csv", 2, 0, 12, 1);
    ema_says("one.csv two.csv", 0,
             "the scatter of shapes is not known: it takes two points that every test has\n*NOISE, FREQUENCY=");
    assert_null(strstr(uff_output, "SHAPE"));
}

UNIT_TEST(points_that_nothing_ties_to_the_others_are_told)
{
    put_two_parts("apart.csv", 0);
    put_two_parts("tied.csv", 1);
    ema_says("apart.csv -o apart.unv", 0, "2 of 4 are left out: nothing ties their functions to the others");
    ema_says("tied.csv -o tied.unv", 0, "5 transfer functions (accelerance), 4 points");
    assert_null(strstr(uff_output, "left out"));
}

UNIT_TEST(output_is_whole_or_not_there)
{
    make_excerpt("bar.uff");
    ema_says("bar.uff -o nowhere/modes.uff", 3, "nowhere/modes.uff: cannot be written: No such file or directory");
    ema_says("bar.uff --json nowhere/bar.json", 3, "nowhere/bar.json: No such file or directory");
    ema_says("bar.uff -o /dev/full", 3, "/dev/full: cannot be written");
    put_text("kept.uff", "kept");
    put_text("cut.uff", "    -1\n    58\n");
    ema_says("cut.uff -o kept.uff", 2, "cut.uff:");
    size_t length;
    char *text = read_file("kept.uff", &length);
    assert_string_equal(text, "kept");
    free(text);
    assert_int_equal(count_files("kept"), 1);
    assert_int_equal(count_files("nowhere"), 0);
}

TEST_GROUP(make_directory, remove_directory);
