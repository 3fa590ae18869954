/* The programs of docs/embedding.md, built against the library as it is installed, by the commands that stand there, with CC, CXX
 * and FC, shared and static: what they print, against what is known without librotid. */
#include "compilers.h"
#include "embedding_oracle.h"
#include "fortran_twin.h"
#include "shell.h"
#include "support.h"

#define EXAMPLES ROTID_SOURCE_DIR "/docs/examples/"
#define BAD_DECK "*MATERIAL, NAME=steel\n*ELASTIC, TIPE=SHEAR\n2e11, 0.3\n"

static struct pool group_pool; /* of what lives as long as the folder */
static const char *folder;

static int install_and_build(void **state)
{
    (void)state;
    pool_open(&group_pool, NULL);
    folder = make_folder(&group_pool);
    double hz[4];
    struct header header;
    embedding_rotor_hz(1.1e11, 4e10, hz);
    (void)shell(&group_pool, "mkdir '%s/hosts'", folder);
    const char *hosts = pool_format(&group_pool, "%s/hosts", folder);
    (void)write_file(&group_pool, hosts, "good.inp", pool_format(&group_pool, EMBEDDING_DECK, hz[0], hz[1], hz[2], hz[3]));
    (void)write_file(&group_pool, hosts, "bad.inp", BAD_DECK);
    assert_int_equal(header_read(&group_pool, ROTID_SOURCE_DIR "/include/rotid.h", &header), 0);
    FILE *callers = fopen(pool_format(&group_pool, "%s/callers.f90", hosts), "w");
    assert_non_null(callers);
    assert_int_equal(write_fortran_callers(callers, &header), 0);
    assert_int_equal(fclose(callers), 0);
    (void)shell(&group_pool, "cd '%s' && make -s install BUILD='%s' PREFIX='%s/prefix'", ROTID_SOURCE_DIR, ROTID_BUILD, folder);
    /* one by one, so that a compiler that is missing takes only its own hosts along */
    static const char *const kind[][2] = {{"c", "CC"}, {"cxx", "CXX"}, {"fortran", "FC"}};
    for (size_t i = 0; i < sizeof kind / sizeof *kind; i++)
        if (has_compiler(&group_pool, kind[i][1]))
            (void)shell(
                &group_pool, "cd '%s' && KIND=%s CC='%s' CXX='%s' FC='%s' FLAGS='%s' sh tests/embedding/run '%s/prefix' '%s'",
                ROTID_SOURCE_DIR, kind[i][0], compiler("CC"), compiler("CXX"), compiler("FC"), ROTID_FLAGS, folder, hosts);
    return 0;
}

static int remove_all(void **state)
{
    (void)state;
    remove_folder(&group_pool, folder);
    pool_close(&group_pool);
    return 0;
}

/* ---- what a host left behind */

static const char *left(const char *host, const char *what)
{
    return shell_file(&test_pool, pool_format(&test_pool, "%s/hosts/%s.%s", folder, host, what));
}

/* Its exit code and the whole of its standard error; returns its standard output. */
static const char *ran(const char *host, const char *code, const char *error)
{
    const char *out = left(host, "out"), *err = left(host, "err");
    if (strcmp(left(host, "code"), pool_format(&test_pool, "%s\n", code)) != 0 || strcmp(err, error) != 0)
        fail_msg("%s: exit code %sexpected %s; standard error:\n%s\nexpected:\n%s\nstandard output:\n%s", host,
                 left(host, "code"), code, err, error, out);
    return out;
}

/* What it loads when it starts: the shared library that was installed, or none. */
static void loads(const char *host)
{
    const char *libraries = left(host, "libraries");
    int shared = strstr(host, "-shared") != NULL;
    const char *found = strstr(libraries, pool_format(&test_pool, "librotid.so.%d => %s/prefix/", ROTID_VERSION_MAJOR, folder));
    if (shared ? !found : strstr(libraries, "librotid") != NULL)
        fail_msg("%s loads:\n%s", host, libraries);
}

/* Each host as C, C++ or Fortran, shared and static: the test for one of them. */
static void for_each(const char *name, const char *const *kind, void (*test)(const char *host))
{
    static const char *const linked[] = {"shared", "static"};
    static const char *const variable[][2] = {{"c", "CC"}, {"cxx", "CXX"}, {"fortran", "FC"}};
    int ran_any = 0;
    for (; *kind; kind++)
        for (size_t v = 0; v < 3; v++)
            if (strcmp(variable[v][0], *kind) == 0 && has_compiler(&test_pool, variable[v][1]))
                for (int l = 0; l < 2; l++) {
                    const char *host = pool_format(&test_pool, "%s-%s-%s", name, *kind, linked[l]);
                    loads(host);
                    test(host);
                    ran_any = 1;
                }
    if (!ran_any)
        skip();
}
static const char *const in_c[] = {"c", "cxx", NULL}, *const in_fortran[] = {"fortran", NULL};

/* ---- the hosts */

static void deck_is_run(const char *host)
{
    double e, g, e_low, e_high, g_low, g_high;
    int end = 0;
    const char *out = ran(host, "0", "");
    assert_int_equal(sscanf(out, "core.E %lf Pa, 95 %% interval %lf ... %lf core.G %lf Pa, 95 %% interval %lf ... %lf %n", &e,
                            &e_low, &e_high, &g, &g_low, &g_high, &end),
                     6);
    assert_true(end > 0 && !out[end]);
    /* the truth, up to what the mesh costs, and the intervals that the exact frequencies and their noise give */
    double std[2];
    embedding_rotor_std(1e-3, std);
    assert_close(e, 1.1e11, 0, 0.1 * std[0]);
    assert_close(g, 4e10, 0, 0.1 * std[1]);
    assert_close(e_high - e_low, 2 * 1.95996 * std[0], 0.02, 0);
    assert_close(g_high - g_low, 2 * 1.95996 * std[1], 0.02, 0);
}

POOL_TEST(run_deck_finds_the_moduli_behind_exact_frequencies)
{
    for_each("run_deck", in_c, deck_is_run);
}

static void bad_deck_is_told(const char *host)
{
    const char *out = ran(host, "1",
                          "bad.inp:2:11: option TIPE of *ELASTIC is not known, expected TYPE\n"
                          "bad.inp:1:1: material steel has no *DENSITY, expected one behind *MATERIAL\n"
                          "bad.inp:3:10: the deck has no *SHAFT and no *BEAM, expected at least one\n");
    assert_string_equal(out, "");
}

POOL_TEST(run_deck_tells_every_error_with_its_place)
{
    for_each("bad_deck", in_c, bad_deck_is_told);
}

static void curve_is_certified(const char *host)
{
    /* NIST StRD, Eckerle4: certified to 11 digits */
    static const double certified[4] = {1.5543827178, 4.0888321754, 451.54121844, 1.4635887487e-3};
    double b[4];
    int end = 0;
    const char *out = ran(host, "0", "");
    assert_int_equal(sscanf(out, "b1 = %lf, b2 = %lf, b3 = %lf sum of squares %lf %n", &b[0], &b[1], &b[2], &b[3], &end), 4);
    assert_true(end > 0 && !out[end]);
    for (int i = 0; i < 4; i++)
        assert_close(b[i], certified[i], 5e-8, 0); /* eight digits are printed */
}

POOL_TEST(curve_agrees_with_the_values_that_nist_certifies)
{
    for_each("curve", in_c, curve_is_certified);
}

static void wrong_column_is_named(const char *host)
{
    const char *out = ran(host, "1", "column 3 of the Jacobian is wrong by 2 of its length\na callback reported a failure\n");
    assert_string_equal(out, "");
}

POOL_TEST(a_derivative_of_the_wrong_sign_is_found_before_the_fit)
{
    for_each("wrong_curve", in_c, wrong_column_is_named);
}

static void nothing_is_printed(const char *host)
{
    assert_string_equal(ran(host, "0", ""), "");
}

POOL_TEST(the_library_prints_nothing_in_good_and_in_bad_fortune)
{
    for_each("silent", in_c, nothing_is_printed);
}

/* `count` numbers of the source behind a text, whatever stands between them. */
static void numbers_behind(const char *source, const char *text, int count, double *value)
{
    const char *at = strstr(source, text);
    assert_non_null(at);
    at += strlen(text);
    for (int i = 0; i < count; i++) {
        at += strcspn(at, "-0123456789");
        char *end;
        value[i] = strtod(at, &end);
        at = strncmp(end, "_dp", 3) == 0 ? end + 3 : end;
    }
}

static double stepped_hz[STEPPED_MODES], stepped_shape[STEPPED_MODES * STEPPED_SENSORS];

static void read_stepped(void)
{
    const char *source = shell_file(&test_pool, EXAMPLES "stepped_beam.f90");
    numbers_behind(source, "hz(4) = [", STEPPED_MODES, stepped_hz);
    numbers_behind(source, "0.001_dp * reshape([", STEPPED_MODES * STEPPED_SENSORS, stepped_shape);
    for (int i = 0; i < STEPPED_MODES * STEPPED_SENSORS; i++)
        stepped_shape[i] /= 1000;
}

/* What the program says of its measured values is so. */
POOL_TEST(the_stepped_beams_measurements_are_exact_ones_with_their_noise)
{
    const double truth[2] = {1.2e11, 8e5};
    double hz[STEPPED_MODES], shape[STEPPED_MODES * STEPPED_SENSORS], square = 0, shape_square = 0;
    read_stepped();
    embedding_stepped(truth, hz, shape);
    for (int k = 0; k < STEPPED_MODES; k++) {
        square += pow((stepped_hz[k] / hz[k] - 1) / 0.0005, 2);
        for (int s = 0; s < STEPPED_SENSORS; s++) /* the exact shape, at whatever sign, the measured ones were made from it */
            shape_square +=
                pow((stepped_shape[s + k * STEPPED_SENSORS] - shape[s + k * STEPPED_SENSORS]) / 0.01, 2) / STEPPED_SENSORS;
    }
    assert_true(square > 0.3 && square < 13.3);                    /* chi square of 4, 1 % on either side */
    assert_true(shape_square * 6 > 10.9 && shape_square * 6 < 43); /* of 24 */
}

static void stepped_beam_is_identified(const char *host)
{
    double x[2], low[2], high[2], measured[4], predicted[4], hz[STEPPED_MODES], shape[STEPPED_MODES * STEPPED_SENSORS];
    double step[2], std[2], chi2;
    const char *at = ran(host, "0", "");
    int end = 0;
    assert_int_equal(sscanf(at, "E %lf Pa,   95 %% interval %lf ... %lf k %lf N/m,  95 %% interval %lf ... %lf %n", &x[0],
                            &low[0], &high[0], &x[1], &low[1], &high[1], &end),
                     6);
    for (int k = 0; k < 4; k++) {
        int number, more = 0;
        at += end;
        assert_int_equal(sscanf(at, "mode %d: measured %lf Hz, model %lf Hz %n", &number, &measured[k], &predicted[k], &more), 3);
        assert_int_equal(number, k + 1);
        end = more;
    }
    assert_true(!at[end]);

    /* the truth, which the program does not know */
    assert_true(low[0] < 1.2e11 && 1.2e11 < high[0] && low[1] < 8e5 && 8e5 < high[1]);
    /* the same model, solved exactly: its mesh of 21 elements costs 4e-5 in mode 4 */
    embedding_stepped(x, hz, shape);
    for (int k = 0; k < 4; k++) {
        assert_close(measured[k], stepped_hz[k], 0, 0.005);
        assert_close(predicted[k], hz[k], 5e-5, 0.01);
    }
    /* the optimum and the intervals, by linear least squares on the exact solution */
    embedding_stepped_estimate(x, stepped_hz, stepped_shape, 0.0005, 0.01, step, std, &chi2);
    double widened = fmax(1, sqrt(chi2 / (STEPPED_RESIDUALS - 2 - STEPPED_MODES)));
    for (int p = 0; p < 2; p++) {
        assert_close(step[p] / std[p], 0, 0, 0.1); /* what the mesh costs, in units of the noise */
        assert_true(high[p] - low[p] > 2 * 1.9599 * std[p] * 0.99 && high[p] - low[p] < 2 * 1.96 * std[p] * widened * 1.01);
    }
}

POOL_TEST(the_fortran_solver_finds_modulus_and_bearing)
{
    read_stepped();
    for_each("stepped_beam", in_fortran, stepped_beam_is_identified);
}

POOL_TEST(a_solver_that_traps_floating_point_errors_is_not_trapped_by_the_library)
{
    needs_compiler(&test_pool, "FC");
    if (!strstr(shell(&test_pool, "%s --version", compiler("FC")), "GNU"))
        skip();
    read_stepped();
    for_each("trapping", in_fortran, stepped_beam_is_identified);
}

static void fortran_checks_hold(const char *host)
{
    int checks, misses;
    const char *out = left(host, "out");
    if (strcmp(left(host, "code"), "0\n") != 0 || sscanf(out, "%d checks, %d misses", &checks, &misses) != 2 || misses ||
        checks < 70)
        fail_msg("%s:\n%s%s", host, out, left(host, "err"));
}

POOL_TEST(what_rotid_f90_has_for_fortran_does_what_it_says)
{
    for_each("fortran_host", in_fortran, fortran_checks_hold);
}

/* The numbers of another host of the same deck: both print rounded speeds of all critical speeds. */
static void critical_speeds_are_those_of_the_other_language(const char *host)
{
    const char *mine = ran(host, "0", ""), *other = left("margins-c-shared", "out");
    int count = 0, number, rpm, deviation;
    for (const char *line = mine; line && *line; line = strchr(line, '\n'), line += line != NULL) {
        char whirl[16], of_other[64];
        if (sscanf(line, "%d %15s %d rpm, standard deviation %d rpm", &number, whirl, &rpm, &deviation) != 4)
            continue;
        assert_int_equal(number, ++count);
        (void)snprintf(of_other, sizeof of_other, "%d %-8s %5d rpm (", number, whirl, rpm);
        assert_non_null(strstr(other, of_other));
        assert_true(deviation > 0);
    }
    assert_true(count >= 4);
    assert_non_null(strstr(mine, "% by bearing de"));
}

POOL_TEST(a_machine_is_computed_from_c_and_fortran)
{
    for_each("critical", in_fortran, critical_speeds_are_those_of_the_other_language);
}

static void every_routine_is_there(const char *host)
{
    struct header header;
    assert_int_equal(header_read(&test_pool, ROTID_SOURCE_DIR "/include/rotid.h", &header), 0);
    assert_string_equal(ran(host, "0", ""), pool_format(&test_pool, "%d\n", header.nfunction));
}

POOL_TEST(every_routine_of_the_header_links_from_fortran)
{
    for_each("callers", in_fortran, every_routine_is_there);
}

/* A post at 60 % of its stiffness, with E as it was stated to the noise; built and run once. */
POOL_TEST(what_a_frame_lacks_is_named)
{
    needs_compiler(&test_pool, "CC");
    const char *out = ran("frame-c-shared", "0", ""), *share = strstr(out, "its share: "), *modulus = strstr(out, "posts.E = ");
    double value, std, low, high;
    assert_non_null(strstr(out, "member 2: probability 1.000\n"));
    assert_true(share && sscanf(share, "its share: %lf +- %lf", &value, &std) == 2);
    assert_true(fabs(value - 0.4) < 3 * std && std < 0.01);
    assert_true(modulus && sscanf(modulus, "posts.E = %*f, 95 %% interval %lf ... %lf", &low, &high) == 2);
    assert_true(low < 2.06e11 && 2.04e11 < high && high - low < 0.02e11);
}

/* The same with a frame that Fortran assembles by Euler's beams. */
static void a_post_is_named(const char *host)
{
    const char *out = ran(host, "0", "");
    double value, std, low[2], high[2];
    int end = 0;
    assert_int_equal(sscanf(out,
                            "nothing 0.000, something else 0.000 post 6: probability 1.000 its share: %lf +- %lf "
                            "E1 = %*f, 95 %% interval %lf ... %lf E2 = %*f, 95 %% interval %lf ... %lf %n",
                            &value, &std, &low[0], &high[0], &low[1], &high[1], &end),
                     6);
    assert_true(end > 0 && !out[end]);
    assert_true(fabs(value - 0.4) < 3 * std && std < 0.01);
    assert_true(low[0] < 2.05e11 && 2.05e11 < high[0] && low[1] < 1.9e11 && 1.9e11 < high[1] && high[1] - low[1] < 0.015e11);
}

POOL_TEST(what_a_frame_of_fortran_lacks_is_named)
{
    for_each("tower", in_fortran, a_post_is_named);
}

/* ---- the document */

/* Every file of docs/examples is linked from it. */
POOL_TEST(the_document_links_every_program_that_was_built)
{
    const char *document = shell_file(&test_pool, ROTID_SOURCE_DIR "/docs/embedding.md");
    int files = 0;
    for (const char *name = shell(&test_pool, "ls " EXAMPLES); *name; name += strcspn(name, "\n") + 1, files++)
        assert_non_null(strstr(document, pool_format(&test_pool, "(examples/%.*s)", (int)strcspn(name, "\n"), name)));
    assert_true(files >= 10);
}

/* The output that it shows of the programs. */
POOL_TEST(the_document_shows_what_the_programs_print)
{
    const char *document = shell_file(&test_pool, ROTID_SOURCE_DIR "/docs/embedding.md");
    const char *built[] = {"paper-c-shared", "curve-c-shared", "margins-c-shared", "frame-c-shared",
                           "stepped_beam-fortran-shared"};
    for (int i = 0; i < 5; i++) {
        if (i == 4 && !has_compiler(&test_pool, "FC"))
            continue;
        if (!strstr(document, pool_format(&test_pool, "\n```\n%s```\n", left(built[i], "out"))))
            fail_msg("%s prints something else than docs/embedding.md says:\n%s", built[i], left(built[i], "out"));
    }
}

TEST_GROUP(install_and_build, remove_all);
