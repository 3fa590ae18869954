/* `rotid frf` end to end: the paper's Figure 15, measured functions out of a universal file that the oracle made, what comes out
 * as JSON and universal file, and what is refused. */
#include <sys/wait.h>
#include <unistd.h>

#include "exact_receptance.h"
#include "folder.h"
#include "import/import.h"
#include "json_value.h"
#include "support.h"
#include "uff/uff.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"

static char output[1 << 20], errors[1 << 16];

static void read_into(const char *path, char *text, size_t size)
{
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    size_t length = fread(text, 1, size - 1, stream);
    text[length] = 0;
    (void)fclose(stream);
}

/* Exit code of rotid frf with the arguments; keeps what it writes. */
static int frf(const char *arguments)
{
    char command[2048];
    (void)snprintf(command, sizeof command, "%s frf %s > %s 2> %s", ROTID_PROGRAM, arguments, folder_path("out"),
                   folder_path("err"));
    int status = system(command); /* NOLINT: a fixed command of the test */
    read_into(folder_path("out"), output, sizeof output);
    read_into(folder_path("err"), errors, sizeof errors);
    return WEXITSTATUS(status);
}

static int frf_of(const char *deck, const char *options)
{
    char arguments[1024];
    (void)snprintf(arguments, sizeof arguments, "%s %s", deck, options);
    return frf(arguments);
}

static void write_deck(const char *name, const char *text, const char *more)
{
    FILE *stream = fopen(folder_path(name), "wb");
    assert_non_null(stream);
    assert_true(fprintf(stream, "%s%s", text, more) > 0 && fclose(stream) == 0);
}

static cJSON *json_of(const char *path)
{
    static char text[1 << 23];
    read_into(path, text, sizeof text);
    cJSON *json = cJSON_ParseWithOpts(text, NULL, 1);
    assert_true(cJSON_IsObject(json));
    return json;
}

static int list_of(const cJSON *json, const char *key, double *value, int most)
{
    int count = 0;
    const cJSON *item;
    cJSON_ArrayForEach(item, get(json, key))
    {
        assert_true(count < most);
        value[count++] = item->valuedouble;
    }
    return count;
}

/* ------------------------------------------------------------------------------------------------ Figure 15 */

/* A x = b, complex, 5 x 5, row pivots. */
static void solve(double complex a[5][5], double complex b[5])
{
    for (int k = 0; k < 5; k++) {
        int pivot = k;
        for (int i = k; i < 5; i++)
            pivot = cabs(a[i][k]) > cabs(a[pivot][k]) ? i : pivot;
        for (int j = 0; j < 5; j++) {
            double complex t = a[k][j];
            a[k][j] = a[pivot][j];
            a[pivot][j] = t;
        }
        double complex t = b[k];
        b[k] = b[pivot];
        b[pivot] = t;
        for (int i = k + 1; i < 5; i++) {
            double complex f = a[i][k] / a[k][k];
            for (int j = k; j < 5; j++)
                a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    for (int k = 4; k >= 0; k--) {
        for (int j = k + 1; j < 5; j++)
            b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
}

/* The pole p = w (i zeta + sqrt(1 - zeta^2)) of one mode and what all others add, a cubic in x = omega/w - 1, through five lines
 * around the peak: h (omega/w - p) = a0 + a1 x + a2 x^2 + a3 x^3. Returns zeta, half the bandwidth at half power over w. */
static double damping_at(const double *hz, const double complex *h, double resonance, double half_width, double *pole_hz)
{
    double complex a[5][5], b[5];
    for (int i = 0, l = 0; i < 5; i++) {
        while (hz[l] < resonance + half_width * (i - 2) / 2)
            l++;
        double x = hz[l] / resonance - 1;
        double complex row[5] = {h[l] / cabs(h[0]), 1, x, x * x, x * x * x};
        memcpy(a[i], row, sizeof row);
        b[i] = hz[l] / resonance * row[0];
    }
    solve(a, b);
    *pole_hz = resonance * cabs(b[0]);
    return cimag(b[0]) / cabs(b[0]);
}

POOL_TEST(figure_15_has_the_identified_frequencies_and_the_damping_of_table_4)
{
    static const double table4[] = {6.008e-3, 9.205e-3, 1.592e-2, 1.045e-2, 1.935e-2, 1.893e-2};
    static double hz[15001], re[15001], im[15001];
    static double complex receptance[15001];
    char options[512];
    assert_int_equal(frf_of(PAPER, ""), 0);
    assert_non_null(strstr(output, "19 over 1: acceleration [m/(s2 N)]"));
    assert_non_null(strstr(output, "1601 lines from 200 to 3200 Hz"));
    (void)snprintf(options, sizeof options, "--quiet --set FRF.LINES=15001 --json %s", folder_path("paper.json"));
    assert_int_equal(frf_of(PAPER, options), 0);
    cJSON *json = json_of(folder_path("paper.json"));
    const cJSON *function = cJSON_GetArrayItem(get(json, "functions"), 0), *modes = get(json, "modes");
    assert_close(number_of(function, "response"), 19, 0, 0);
    assert_close(number_of(function, "reference"), 1, 0, 0);
    assert_int_equal(list_of(function, "frequency_hz", hz, 15001), 15001);
    assert_int_equal(list_of(function, "synthesised_re", re, 15001), 15001);
    assert_int_equal(list_of(function, "synthesised_im", im, 15001), 15001);
    for (int l = 0; l < 15001; l++) {
        double omega = TWO_PI * hz[l];
        receptance[l] = -(re[l] + I * im[l]) / (omega * omega);
    }
    for (int k = 0; k < 6; k++) {
        const cJSON *mode = cJSON_GetArrayItem(modes, 2 + k);
        double model = number_of(mode, "model_hz"), pole;
        assert_close(number_of(mode, "mode"), k + 1, 0, 0);
        assert_close(number_of(mode, "damping"), table4[k], 1e-12, 0);
        double zeta = damping_at(hz, receptance, model, table4[k] * model, &pole);
        assert_close(pole, model, 1e-4, 0);
        assert_close(zeta, table4[k], 5e-3, 0);
    }
    cJSON_Delete(json);
}

/* ------------------------------------------------------------------------------------------------ measured functions */

#define SHAFT                                                                                                                    \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"                                                             \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.06, 0, 60\n*SHAFT, NAME=core, MATERIAL=steel\n0.5, 0.12, 0, 100\n"                \
    "*SHAFT, NAME=right, MATERIAL=steel\n0.3, 0.07, 0, 60\n"
#define SENSORS "*SENSORS\n1, start\n2, 0.41\n"
#define LINES   380

/* Exact receptances of that shaft; point 3 lies at 0.8 m by the nodes of the file alone. */
static void exact_functions(double complex h[3][LINES], double *hz)
{
    static const double z[3] = {0, 0.41, 0.8};
    static struct group group[3];
    static struct segment segment[3];
    static struct exact exact;
    const struct material steel = {.name = "steel", .e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1};
    const double length[3] = {0.3, 0.5, 0.3}, diameter[3] = {0.06, 0.12, 0.07};
    for (int g = 0; g < 3; g++) {
        group[g] = (struct group){.layer_of = -1, .name = "part", .material = steel};
        segment[g] =
            (struct segment){.group = g, .elements = 1, .length = length[g], .outer = diameter[g], .stiff_outer = diameter[g]};
    }
    const struct rotor rotor = {.ngroup = 3, .group = group, .nsegment = 3, .segment = segment};
    exact_open(&rotor, &exact);
    for (int l = 0; l < LINES; l++) {
        double receptance[3], omega = TWO_PI * (hz[l] = 101 + 5 * l);
        exact_receptance(&exact, omega, 3, z, 0, receptance);
        for (int i = 0; i < 3; i++)
            h[i][l] = -omega * omega * receptance[i];
    }
}

static void write_measured(const char *name, int reversed)
{
    static const struct uff_node nodes[] = {{.id = 1}, {.id = 2, .x = {0, 0, 0.41}}, {.id = 3, .x = {0, 0, 0.8}}};
    static const struct uff_units si = {1, "SI", 2, 1, 1, 1, 273.15};
    static double complex h[3][LINES];
    double hz[LINES], re[LINES], im[LINES];
    exact_functions(h, hz);
    FILE *stream = fopen(folder_path(name), "wb");
    assert_non_null(stream);
    assert_status(uff_write_units(stream, &si), ROTID_OK);
    assert_status(uff_write_nodes(stream, 2411, 3, nodes), ROTID_OK);
    for (int i = 0; i < 3; i++) {
        struct uff_function f = {.type = UFF_TRANSFER,
                                 .response_node = i + 1,
                                 .response_direction = i == reversed ? -1 : 1,
                                 .reference_node = 1,
                                 .reference_direction = 1,
                                 .ordinate = UFF_COMPLEX_DOUBLE,
                                 .count = LINES,
                                 .is_even = 1,
                                 .start = hz[0],
                                 .step = hz[1] - hz[0],
                                 .abscissa = {.specific_type = 18},
                                 .numerator = {.specific_type = 12},
                                 .denominator = {.specific_type = 13}};
        struct uff_function_writer writer;
        for (int l = 0; l < LINES; l++) {
            re[l] = (i == reversed ? -1 : 1) * creal(h[i][l]);
            im[l] = 0;
        }
        assert_status(uff_write_function(stream, &f, &writer), ROTID_OK);
        assert_status(uff_write_values(&writer, LINES, NULL, re, im), ROTID_OK);
        assert_status(uff_end_function(&writer), ROTID_OK);
    }
    assert_int_equal(fclose(stream), 0);
}

POOL_TEST(measured_functions_of_the_exact_beam_agree)
{
    char options[512];
    write_measured("exact.uff", 1);
    write_deck("deck.inp", SHAFT SENSORS, "*FRF, FILE=exact.uff, DAMPING=1e-5\n");
    (void)snprintf(options, sizeof options, "--json %s", folder_path("exact.json"));
    assert_int_equal(frf_of(folder_path("deck.inp"), options), 0);
    assert_non_null(strstr(output, "at meas. Hz"));
    cJSON *json = json_of(folder_path("exact.json"));
    const cJSON *functions = get(json, "functions"), *function;
    assert_int_equal(cJSON_GetArraySize(functions), 3);
    cJSON_ArrayForEach(function, functions)
    {
        assert_close(number_of(function, "frac"), 1, 2e-3,
                     0); /* lines beside resonances without damping magnify the mesh error */
        assert_close(number_of(function, "scale"), 1, 5e-2, 0);
        assert_int_equal(cJSON_GetArraySize(get(function, "measured_re")), LINES);
        assert_int_equal(cJSON_IsTrue(get(function, "measured_reversed")), number_of(function, "response") == 2);
    }
    assert_close(number_of(cJSON_GetArrayItem(functions, 2), "response_z_m"), 0.8, 1e-9, 0);
    cJSON_Delete(json);
}

POOL_TEST(the_output_is_read_back_as_the_same_functions)
{
    char options[512];
    struct message_list messages;
    struct measurement first, again;
    const struct measurement_options all = {.threads = 1};
    write_measured("exact.uff", -1);
    write_deck("deck.inp", SHAFT SENSORS, "*FRF, FILE=exact.uff, DAMPING=1e-5\n");
    (void)snprintf(options, sizeof options, "--quiet -o %s", folder_path("synthesised.uff"));
    assert_int_equal(frf_of(folder_path("deck.inp"), options), 0);
    assert_string_equal(output, "");
    message_open(&messages, &test_pool);
    assert_status(measurement_read(&test_pool, folder_path("synthesised.uff"), &all, &messages, &first), ROTID_OK);
    assert_int_equal(messages.errors, 0);
    assert_true(first.set.nfrf == 3 && first.set.nline == LINES && first.node_count == 3 && first.units);
    assert_int_equal(first.set.quantity, FRF_ACCELERATION);
    assert_close(first.node[2].x[2], 0.8, 1e-9, 0);
    /* its own output as the measured one: the same to the digits of the file */
    write_deck("deck.inp", SHAFT SENSORS, "*FRF, FILE=synthesised.uff, DAMPING=1e-5\n");
    (void)snprintf(options, sizeof options, "--quiet -o %s --json %s", folder_path("again.uff"), folder_path("again.json"));
    assert_int_equal(frf_of(folder_path("deck.inp"), options), 0);
    assert_status(measurement_read(&test_pool, folder_path("again.uff"), &all, &messages, &again), ROTID_OK);
    for (int c = 0; c < 3; c++)
        for (int l = 0; l < LINES; l++)
            assert_true(cabs(first.set.frf[c].h[l] - again.set.frf[c].h[l]) <= 1e-6 * cabs(first.set.frf[c].h[l]) + 1e-12);
    cJSON *json = json_of(folder_path("again.json"));
    assert_close(number_of(get(json, "agreement"), "frac"), 1, 1e-9, 0);
    cJSON_Delete(json);
}

/* ------------------------------------------------------------------------------------------------ what is refused */

POOL_TEST(what_cannot_be_synthesised_is_refused)
{
    static const struct {
        const char *more, *says;
    } wrong[] = {
        {"*FRF, LOW=10, HIGH=100\n", "no mode has a damping ratio, expected one as third value of *MODES"},
        {"*FRF, DAMPING=0.01\n", "expected LOW and HIGH [Hz] on *FRF"},
        {"*FRF, LOW=10, HIGH=100, DAMPING=0.01\n1, 3\n", "sensor 3 is not among *SENSORS"},
        {"*FRF, FILE=exact.uff, DAMPING=0.01\n2, 3\n", "there is no lateral transfer function between 2 and 3"},
        {"*FRF, FILE=exact.uff, DAMPING=0.01, LOW=5000\n", "expected"},
        {"*FRF, FILE=missing.uff, DAMPING=0.01\n", "No such file or directory"},
        {"*FRF, FILE=deck.inp, DAMPING=0.01\n", "expected"},
        {"*FRF, LOW=200, HIGH=100, DAMPING=0.01\n", "expected HIGH above LOW"},
    };
    write_measured("exact.uff", -1);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char options[512];
        (void)snprintf(options, sizeof options, "--json %s -o %s", folder_path("no.json"), folder_path("no.uff"));
        write_deck("deck.inp", SHAFT SENSORS, wrong[i].more);
        int code = frf_of(folder_path("deck.inp"), options);
        if (code != 2 || *output || !strstr(errors, wrong[i].says))
            print_error("%s: exit code %d, output '%s', errors '%s'\n", wrong[i].more, code, output, errors);
        assert_true(code == 2 && !*output && strstr(errors, wrong[i].says));
        assert_true(access(folder_path("no.json"), F_OK) && access(folder_path("no.uff"), F_OK));
    }
    assert_int_equal(frf(""), 2);
    assert_int_equal(frf_of(PAPER, "--extended x"), 2);
    assert_int_equal(frf_of(PAPER, "--format dmig -o x"), 2);
    assert_int_equal(frf_of(PAPER, "-o /nowhere/at/all.uff"), 3);
    assert_non_null(strstr(errors, "cannot write /nowhere/at/all.uff"));
    assert_int_equal(frf_of(PAPER, "--json /nowhere/at/all.json"), 3);
}

/* Shapes that no fit resembles, which a fit would say: what is known beforehand is refused before it. */
POOL_TEST(a_deck_without_damping_is_refused_before_the_fit)
{
    static const char *const modes = "*SENSORS\n1, start\n2, 0.1\n3, 0.5\n4, end\n*MODES\n1, 500\n2, 1400\n"
                                     "*SHAPE, MODE=1\n1, 1\n2, -1\n3, 1\n4, -1\n*SHAPE, MODE=2\n1, -1\n2, -1\n3, 1\n4, -1\n"
                                     "*IDENTIFY\ncore.E, 1e10, 3e11, 1.5e11\n";
    write_deck("deck.inp", SHAFT, modes);
    (void)frf_of(folder_path("deck.inp"), "--set FRF.DAMPING=0.01");
    assert_non_null(strstr(output, "no measured shape resembles a mode of the model"));
    assert_int_equal(frf_of(folder_path("deck.inp"), ""), 2);
    assert_non_null(strstr(errors, "no mode has a damping ratio"));
    assert_null(strstr(errors, "no measured shape"));
}

/* A core that no shear modulus within its bounds makes stiff enough: computed, and not to be trusted. */
POOL_TEST(an_identification_at_a_bound_is_said)
{
    write_deck("deck.inp", SHAFT SENSORS, "*MODES\n1, 900, 0.01\n*FRF, LINES=50\n*IDENTIFY\ncore.E, 1e10, 2e11, 1.5e11\n");
    assert_int_equal(frf_of(folder_path("deck.inp"), ""), 1);
    assert_non_null(strstr(output, "the identification is not reliable"));
}

POOL_TEST(many_functions_are_summed_up_unless_asked_for)
{
    char options[256];
    assert_int_equal(frf_of(ROTID_SOURCE_DIR "/input/solid_rotor.inp", "--set FRF.DAMPING=0.01"), 0);
    assert_non_null(strstr(output, " transfer function"));
    (void)snprintf(options, sizeof options, "--set FRF.DAMPING=0.01 --set FRF.LINES=100000 --json %s", folder_path("many.json"));
    assert_int_equal(frf_of(ROTID_SOURCE_DIR "/input/solid_rotor.inp", options), 0);
    assert_non_null(strstr(output, "the JSON has no curves"));
    cJSON *json = json_of(folder_path("many.json"));
    assert_true(cJSON_IsFalse(get(json, "with_curves")));
    cJSON_Delete(json);
}

TEST_GROUP(folder_make, folder_remove);
