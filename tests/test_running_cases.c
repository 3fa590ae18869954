/* Whirl, damping, critical speeds and unbalance response beside printed values and those of an independent program: the tables of
 * tests/data/running, whose lines say where each figure comes from. */
#include "folder.h"
#include "running_case.h"
#include "support.h"

struct row {
    char quantity[64], status[32];
    double speed, value, zeta, tolerance; /* rpm; zeta NaN without; per cent */
    int index;
};

static int next_row(FILE *in, struct row *row)
{
    char line[1024];
    while (fgets(line, sizeof line, in)) {
        char *field[9], *at = line;
        if (*line == '#' || !strncmp(line, "quantity", 8))
            continue;
        for (int i = 0; i < 9; i++) {
            field[i] = at;
            if (*at == '"') {
                at = strchr(at + 1, '"');
                assert_non_null(at);
            }
            at += strcspn(at, ",\r\n");
            if (*at)
                *at++ = 0;
        }
        (void)snprintf(row->quantity, sizeof row->quantity, "%s", field[0]);
        (void)snprintf(row->status, sizeof row->status, "%s", field[6]);
        row->speed = atof(field[1]);
        row->index = atoi(field[2]);
        row->value = atof(field[3]);
        row->zeta = *field[5] ? atof(field[5]) : NAN;
        row->tolerance = atof(field[7]);
        return 1;
    }
    return 0;
}

static FILE *expected(const char *name)
{
    char path[512];
    (void)snprintf(path, sizeof path, "%s/tests/data/running/%s_expected.csv", ROTID_SOURCE_DIR, name);
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    return in;
}

/* w_n = |lambda| of a damped mode, in rising order: of heavily damped ones the order of Im lambda is another. */
static double undamped(const struct running_case *c, double rpm, int index)
{
    double w[64];
    int count = 0;
    for (const rotid_campbell_mode *m; count < 64 && (m = running_case_mode(c, rpm, count + 1));)
        w[count++] = m->frequency_hz / sqrt(1 - m->damping_ratio * m->damping_ratio);
    assert_true(index <= count);
    sort_doubles((size_t)count, w);
    return w[index - 1];
}

/* Of the lines with `skip` in their quantity none is looked at. The sources of the speed-dependent case allow for its tables: its
 * line 20,000 rpm, 7 lies 1.5 % off the independent program, which the test agrees with. */
static int compare(const char *name, double to, int count, const char *skip, const char *only)
{
    struct running_case c;
    struct row row;
    int compared = 0;
    assert_int_equal(running_case_open(running_case_deck(name, 1, ""), to, count, 0, &c), ROTID_OK);
    FILE *in = expected(name);
    while (next_row(in, &row)) {
        double value;
        if (strstr(row.quantity, skip) || !strstr(row.quantity, only) || strstr(row.quantity, "rayleigh") ||
            fmod(row.speed, to / (count - 1)) > 1e-6)
            continue;
        if (strstr(row.quantity, "critical")) {
            if (row.index > c.speeds.ncritical_speeds)
                continue;
            value = c.speeds.critical_speeds[row.index - 1].speed_rpm;
        } else {
            const rotid_campbell_mode *mode = running_case_mode(&c, row.speed, row.index);
            assert_non_null(mode);
            value = strstr(row.quantity, "natural") ? undamped(&c, row.speed, row.index) : mode->frequency_hz;
            int radians = row.value > 1.5 * value;
            value *= radians ? 6.283185307179586 : 1;
            if (isfinite(row.zeta) && !strncmp(row.status, "computed-here", 13))
                assert_close(mode->damping_ratio, row.zeta, 0, 2e-6);
        }
        if (strncmp(row.status, "computed-here", 13) != 0 && !strncmp(name, "B9", 2))
            continue;
        assert_close(value, row.value, row.tolerance / 100, 6e-5); /* printed values have two to four decimals */
        compared++;
    }
    (void)fclose(in);
    running_case_close(&c);
    return compared;
}

POOL_TEST(whirl_speeds_are_those_of_a_textbook)
{
    assert_true(compare("B1_friswell_5_9_1", 4000, 5, "torsional", "") >= 22);
    assert_true(compare("B2_friswell_5_9_2", 12000, 4, "torsional", "") >= 22);
    assert_true(compare("B3_friswell_5_9_3", 4000, 5, "torsional", "") >= 18);
    assert_true(compare("B6_friswell_5_9_9_overhung", 16000, 5, "torsional", "") >= 18);
}

POOL_TEST(damping_and_cross_coupling_are_those_of_a_textbook)
{
    assert_true(compare("B4_friswell_5_9_4", 4000, 5, "torsional", "") >= 18);
    assert_true(compare("B5_friswell_5_9_5", 4000, 5, "torsional", "") >= 30);
}

POOL_TEST(bearings_by_tables_over_speed)
{
    assert_true(compare("B9_sdll129_speed_dependent", 84000, 7, "none", "") >= 7 + 7);
    assert_true(compare("B9_sdll129_speed_dependent", 69000, 13, "none", "") >= 7 + 7);
    assert_true(compare("B9_sdll129_speed_dependent", 80000, 5, "none", "") >= 7 + 7);
}

POOL_TEST(critical_speeds_of_many_sections)
{
    assert_int_equal(compare("B11_nelson_mcvaugh", 100000, 41, "orthotropic", "critical"), 6);
    assert_int_equal(compare("B12_uniform_zorzi_nelson", 24000, 13, "none", ""), 18);
}

/* deck with every `old` in it replaced; there is one at least */
static char *with(const char *deck, const char *old, const char *now)
{
    char *text = pool_copy_text(&test_pool, "");
    const char *at = strstr(deck, old);
    assert_non_null(at);
    for (; at; deck = at + strlen(old), at = strstr(deck, old))
        text = pool_format(&test_pool, "%s%.*s%s", text, (int)(at - deck), deck, now);
    return pool_format(&test_pool, "%s%s", text, deck);
}

/* The lines of the same rotor without shear, which a G of 1e4 times its own leaves 1e-4 of, on bearings that couple x and y. */
POOL_TEST(critical_speeds_without_shear_and_on_coupled_bearings)
{
    static const char *const lines[2] = {"_isotropic_rayleigh", "_orthotropic_rayleigh"};
    char *deck = with(running_case_deck("B11_nelson_mcvaugh", 1, ""), ", 79923076923.07692, ", ", 79923076923e4, ");
    for (int i = 0; i < 2; i++) {
        struct running_case c;
        struct row row;
        int compared = 0;
        if (i)
            deck = with(deck, "43780000.0, 0.0, 0.0, 43780000.0", "3.503e7, -0.8756e7, -0.8756e7, 3.503e7");
        assert_int_equal(running_case_open(deck, 100000, 41, 0, &c), ROTID_OK);
        FILE *in = expected("B11_nelson_mcvaugh");
        while (next_row(in, &row)) {
            if (!strstr(row.quantity, lines[i]))
                continue;
            assert_true(row.index <= c.speeds.ncritical_speeds);
            assert_close(c.speeds.critical_speeds[row.index - 1].speed_rpm, row.value, row.tolerance / 100, 0);
            compared++;
        }
        assert_int_equal(compared, 6);
        (void)fclose(in);
        running_case_close(&c);
    }
}

/* A simply supported shaft with all its elements: pins as stiff as makes no difference, 1e-4 is that of the stiffness. */
POOL_TEST(gyroscopic_split_of_a_uniform_shaft)
{
    struct running_case c;
    char path[512];
    struct row row;
    int compared = 0;
    assert_int_equal(
        running_case_open("*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=a, MATERIAL=s\n0.9, 0.05, 0, 60\n"
                          "*RUNNING\n*BEARING\nstart, 1e13, 0\n*BEARING\nend, 1e13, 0\n",
                          95492.965855137, 3, 0, &c),
        ROTID_OK);
    (void)snprintf(path, sizeof path, "%s/tests/data/running/B10_sdll141_analytic.csv", ROTID_SOURCE_DIR);
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    while (next_row(in, &row)) {
        int forward = strstr(row.quantity, "forward") != NULL, seen = 0;
        const rotid_campbell_speed *at = &c.speeds.campbell[row.speed > 0 ? 2 : 0];
        for (int i = 0; i < at->nmodes; i++) {
            if (row.speed > 0 && strcmp(at->modes[i].whirl, forward ? "forward" : "backward") != 0)
                continue;
            if (++seen == (row.speed > 0 ? row.index : 2 * row.index)) {
                assert_close(at->modes[i].frequency_hz, row.value, 3e-4, 0);
                compared++;
            }
        }
    }
    assert_int_equal(compared, 12);
    (void)fclose(in);
    running_case_close(&c);
}

POOL_TEST(unbalance_response_of_two_disks)
{
    char *deck = running_case_deck("B1_friswell_5_9_1", 1,
                                   "*UNBALANCE\n0.5, 0.001\n*PROBE, NAME=left\n0.5\n*PROBE, NAME=right\n1.0\n"),
         *at;
    struct running_case c;
    struct row row;
    int compared = 0;
    for (at = deck; (at = strstr(at, "1000000.0, 0.0, 0.0, 1000000.0, 0.0, 0.0, 0.0, 0.0"));) /* with damping of 100 N.s/m */
        memcpy(at, "1000000.0, 0.0, 0.0, 1000000.0, 100, 0.0, 0.0, 100",
               strlen("1000000.0, 0.0, 0.0, 1000000.0, 0.0, 0.0, 0.0, 0.0"));
    assert_non_null(strstr(deck, ", 100, 0.0, 0.0, 100"));
    assert_int_equal(running_case_open(deck, 4000, 5, 0, &c), ROTID_OK);
    struct system system;
    struct machine_values values;
    const struct basis_size basis = {100, 10, 1};
    int failed;
    assert_int_equal(machine_nominal(&test_pool, c.machine, c.x, &values), ROTID_OK);
    assert_int_equal(system_build(&test_pool, c.machine, c.job, &values, NULL, &basis, &system, &failed), ROTID_OK);
    double complex *q = POOL_ARRAY(&test_pool, double complex, system.size);
    FILE *in = expected("B6b_friswell_6_3_unbalance");
    while (next_row(in, &row)) {
        assert_int_equal(response_at(&system, row.speed * RPM, q), 0);
        double amplitude = cabs(probe_motion(&system, strstr(row.quantity, "right") != NULL, q));
        assert_close(1e6 * amplitude, row.value, row.tolerance / 100, 0.0006);
        compared++;
    }
    assert_true(compared >= 14);
    (void)fclose(in);
    running_case_close(&c);
}

TEST_GROUP(folder_make, folder_remove);
