/* What can go wrong in the virtual hammer test: faults of channels and impacts, and wrong options. */
#include <unistd.h>

#include "hammer/hammer_command.h"
#include "hammer_bench.h"
#include "support.h"

static const double pi = 3.14159265358979323846;

enum { POINT = 12 };

struct pair {
    struct hammer_bench bench;
    struct hammer_test test;
    double *force, *response, *clean_force, *clean;
    struct hammer_impact drawn;
};

/* A record of the point with what the options say, and the same impact without faults. */
static void open_pair(struct pair *p)
{
    size_t count;
    hammer_bench_test(&p->bench, &p->test);
    count = (size_t)p->test.count;
    p->force = malloc(count * sizeof(double));
    p->response = malloc(count * sizeof(double));
    p->clean_force = malloc(count * sizeof(double));
    p->clean = malloc(count * sizeof(double));
    assert_true(p->force && p->response && p->clean_force && p->clean);
    hammer_record(&p->test, 4, POINT, 0, p->force, p->response, &p->drawn);
    struct hammer_test sound = p->test;
    struct hammer_impact other;
    sound.options.faults = 0;
    sound.options.double_hits = sound.options.clipped = 0;
    hammer_record(&sound, 4, POINT, 0, p->clean_force, p->clean, &other);
}

static void close_pair(struct pair *p)
{
    free(p->force);
    free(p->response);
    free(p->clean_force);
    free(p->clean);
    hammer_close(&p->test);
    hammer_bench_close(&p->bench);
}

static void with_fault(enum hammer_fault_kind kind, long other, double value, struct pair *p)
{
    hammer_bench_open("paper", &p->bench);
    p->bench.options.faults = 1;
    p->bench.options.fault[0] = (struct hammer_fault){.kind = kind, .id = POINT + 1, .other = other, .value = value};
    open_pair(p);
}

UNIT_TEST(flip_and_gain)
{
    struct pair p;
    with_fault(HAMMER_FLIP, 0, 0, &p);
    for (int n = 0; n < p.test.count; n++)
        assert_close(p.response[n], -p.clean[n], 0, 0);
    assert_memory_equal(p.force, p.clean_force, (size_t)p.test.count * sizeof(double));
    close_pair(&p);
    with_fault(HAMMER_GAIN, 0, 1.3, &p);
    for (int n = 0; n < p.test.count; n++)
        assert_close(p.response[n], 1.3 * p.clean[n], 1e-15, 0);
    close_pair(&p);
}

UNIT_TEST(dead_and_duplicate)
{
    struct pair p;
    double dead = 0, alive = 0;
    with_fault(HAMMER_DEAD, 0, 0, &p);
    for (int n = 0; n < p.test.count; n++) {
        dead += p.response[n] * p.response[n];
        alive += p.clean[n] * p.clean[n];
    }
    assert_close(sqrt(dead / alive), 1e-3, 0.05, 0);
    close_pair(&p);
    with_fault(HAMMER_DUPLICATE, 41, 0, &p);
    hammer_record(&p.test, 4, 40, 0, p.clean_force, p.clean, &p.drawn);
    assert_memory_equal(p.response, p.clean, (size_t)p.test.count * sizeof(double));
    close_pair(&p);
}

static double complex through_mount(const struct hammer_test *test, double hz, const void *data)
{
    double f = *(const double *)data;
    double complex x = CMPLX(0, hz / f);
    return hammer_frf(test, POINT, CMPLX(0, 2 * pi * hz)) / (1 + 2 * 0.02 * x + x * x);
}

UNIT_TEST(loose_sensor)
{
    const double mount = 1500;
    struct pair p;
    with_fault(HAMMER_LOOSE, 0, mount, &p);
    struct hammer_misfit m = hammer_compare(&p.test, p.force, p.response, 100.5, 3200, 43, through_mount, &mount);
    assert_true(m.error < 2e-4 * m.largest);
    close_pair(&p);
}

static double complex as_it_is(const struct hammer_test *test, double hz, const void *data)
{
    (void)data;
    return hammer_frf(test, POINT, CMPLX(0, 2 * pi * hz));
}

/* Two hits are still an input and its output; both pulses are in the force. */
UNIT_TEST(double_hit)
{
    struct pair p;
    double second = 0;
    hammer_bench_open("paper", &p.bench);
    p.bench.options.double_hits = 1;
    open_pair(&p);
    assert_true(p.drawn.second_peak >= 0.25 * p.drawn.peak && p.drawn.second_peak <= 0.7 * p.drawn.peak);
    assert_true(p.drawn.second_start - p.drawn.start >= 0.004 && p.drawn.second_start - p.drawn.start <= 0.02);
    for (int n = 0; n < p.test.count; n++)
        if (n / p.test.options.rate > p.drawn.second_start)
            second = fmax(second, p.force[n]);
    assert_true(second > 0.3 * p.drawn.second_peak && second < 1.2 * p.drawn.second_peak);
    struct hammer_misfit m = hammer_compare(&p.test, p.force, p.response, 100.5, 3200, 43, as_it_is, NULL);
    assert_true(m.error < 1e-3 * m.largest); /* the force has minima, at which what is folded down counts more */
    close_pair(&p);
}

UNIT_TEST(clipped)
{
    struct pair p;
    hammer_bench_open("paper", &p.bench);
    p.bench.options.clipped = 1;
    open_pair(&p);
    for (uint64_t seed = 0; seed < 100; seed++) {
        int peak = 0, equal = 0;
        hammer_record(&p.test, seed, POINT, 0, p.force, p.response, &p.drawn);
        for (int n = 0; n < p.test.count; n++)
            peak = p.force[n] > p.force[peak] ? n : peak;
        while (p.force[peak + equal] >= p.force[peak])
            equal++;
        assert_true(p.drawn.clipped && equal >= 2);
    }
    close_pair(&p);
}

/* How far the filter lets a short pulse ring, which a search for double hits has to bear; 3 ms later it is over. */
UNIT_TEST(ringing)
{
    struct pair p;
    double lobe = 0, undershoot = 0, late = 0;
    hammer_bench_open("paper", &p.bench);
    open_pair(&p);
    for (uint64_t seed = 0; seed < 300; seed++) {
        int peak = 0, zero;
        hammer_record(&p.test, seed, POINT, 0, p.force, p.response, &p.drawn);
        for (int n = 0; n < p.test.count; n++)
            peak = p.force[n] > p.force[peak] ? n : peak;
        for (zero = peak; p.force[zero] > 0;)
            zero++;
        for (int n = zero; n < p.test.count; n++) {
            lobe = fmax(lobe, p.force[n] / p.force[peak]);
            undershoot = fmin(undershoot, p.force[n] / p.force[peak]);
            if (n > peak + 0.003 * p.test.options.rate)
                late = fmax(late, fabs(p.force[n]) / p.force[peak]);
        }
    }
    print_message("ringing of the force: %.0f %% below zero, %.0f %% above, 3 ms later %.1f %% of its peak\n", -100 * undershoot,
                  100 * lobe, 100 * late);
    assert_true(lobe < 0.4 && undershoot > -0.5 && late < 0.03);
    close_pair(&p);
}

/* ---- Wrong options ---- */

static void refused(const struct hammer_bench *bench, const char *expected)
{
    struct hammer_test test;
    char message[600] = "";
    assert_int_equal(
        hammer_open(bench->deck, "deck", bench->truths, bench->truth, 1, &bench->options, &test, message, sizeof message),
        HAMMER_INPUT);
    if (!strstr(message, expected))
        fail_msg("'%s' does not say '%s'", message, expected);
    hammer_close(&test);
}

#define REFUSED(member, value, expected)                                                                                         \
    do {                                                                                                                         \
        hammer_bench_open("beam", &b);                                                                                           \
        b.options.member = (value);                                                                                              \
        refused(&b, expected);                                                                                                   \
        hammer_bench_close(&b);                                                                                                  \
    } while (0)

UNIT_TEST(options_out_of_range)
{
    struct hammer_bench b;
    REFUSED(rate, -1, "--rate -1: expected 100 to 1e6 Hz");
    REFUSED(rate, NAN, "--rate");
    REFUSED(band_hz, 4000, "--band 4000: expected above 0 and at most 0.4 of the rate");
    REFUSED(seconds, 1e-3, "expected more than the pretrigger");
    REFUSED(impacts, 0, "--impacts 0: expected 1 to 100");
    REFUSED(pulse_short, 5e-4, "expected two durations in rising order");
    REFUSED(force, 0, "expected above 0 N");
    REFUSED(sensor_mass, -1, "--sensor-mass -1");
    REFUSED(noise, -1, "expected noise of 0 to 1000");
    REFUSED(clipped, 1.5, "expected probabilities of 0 to 1");
    REFUSED(drift, 0.2, "--drift 0.2: expected 0 to 0.1");
    REFUSED(damping[1], 0, "damping ratio 0: expected 1e-6 to 0.99");
    REFUSED(fixed, 99, "--fixed 99: expected a sensor of the deck");
    hammer_bench_open("beam", &b);
    b.options.faults = 1;
    b.options.fault[0] = (struct hammer_fault){.kind = HAMMER_FLIP, .id = 99};
    refused(&b, "--fault at 99: expected a sensor of the deck");
    b.options.fault[0] = (struct hammer_fault){.kind = HAMMER_DUPLICATE, .id = 3, .other = 3};
    refused(&b, "--fault duplicate of 3: expected another sensor");
    b.options.fault[0] = (struct hammer_fault){.kind = HAMMER_LOOSE, .id = 3, .value = 1e5};
    refused(&b, "--fault loose at 100000 Hz");
    hammer_bench_close(&b);
}

/* What the command line says on standard error, with its exit code. The words of the line live in copy[LINE]. */
enum { LINE = 400 };

static int command(const char *line, char *copy, struct hammer_command *c, char *said, size_t room)
{
    char *word[40], *save = NULL;
    const char *truth[40];
    int words = 0, keep = dup(STDERR_FILENO), code;
    FILE *file = tmpfile();
    assert_non_null(file);
    snprintf(copy, LINE, "hammer %s", line);
    for (char *w = strtok_r(copy, " ", &save); w; w = strtok_r(NULL, " ", &save))
        word[words++] = w;
    word[words] = NULL;
    fflush(stderr);
    dup2(fileno(file), STDERR_FILENO);
    optind = 0; /* begins anew */
    code = hammer_command_read(words, word, truth, c);
    fflush(stderr);
    dup2(keep, STDERR_FILENO);
    close(keep);
    rewind(file);
    said[fread(said, 1, room - 1, file)] = 0;
    fclose(file);
    return code;
}

UNIT_TEST(command_line)
{
    static const char *const wrong[][2] = {{"paper", "usage: hammer ROTOR"},
                                           {"-o x paper beam", "usage: hammer ROTOR"},
                                           {"paper -o x --bogus", "bogus"},
                                           {"paper -o x --rate fast", "expected a number, not 'fast'"},
                                           {"paper -o x --impacts 2.5", "expected an integer, not '2.5'"},
                                           {"paper -o x --seed -3", "expected an integer not below zero, not '-3'"},
                                           {"paper -o x --pulse 1e-4", "expected two numbers separated by ':'"},
                                           {"paper -o x --pulse 1:2:3", "expected at most two numbers"},
                                           {"paper -o x --roving cat", "expected sensor or hammer, not 'cat'"},
                                           {"paper -o x --fault flip", "expected dead:ID"},
                                           {"paper -o x --fault gain:3", "expected dead:ID"},
                                           {"paper -o x --fault dead:x", "expected an integer"}};
    struct hammer_command c;
    char said[8000], copy[LINE];
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(command(wrong[i][0], copy, &c, said, sizeof said), HAMMER_INPUT);
        if (!strstr(said, wrong[i][1]))
            fail_msg("%s: '%s' does not say '%s'", wrong[i][0], said, wrong[i][1]);
    }
    assert_int_equal(
        command("beam -o a --truth b --deck c --true bar.E=2e11 --seed 7 --roving hammer --fixed 3 --sensor-mass 0.03 "
                "--pulse 1e-4:2e-4 --force 500:0.1 --damping 0.01,0.02 --fault gain:4=1.2 --fault duplicate:5=6",
                copy, &c, said, sizeof said),
        HAMMER_OK);
    assert_string_equal(said, "");
    assert_string_equal(c.rotor, "beam");
    assert_true(c.seed == 7 && c.options.roving_hammer && c.options.fixed == 3 && c.truths == 1 && c.options.faults == 2);
    assert_close(c.options.pulse_long, 2e-4, 0, 0);
    assert_close(c.options.force_spread, 0.1, 0, 0);
    assert_true(c.options.dampings == 2 && c.damping_given);
    assert_close(c.options.damping[1], 0.02, 0, 0);
    assert_close(c.options.fault[0].value, 1.2, 0, 0);
    assert_int_equal(c.options.fault[1].other, 6);
    assert_int_equal(command("--help", copy, &c, said, sizeof said), HAMMER_OK);
    assert_true(c.help);
}

/* A file that cannot be written is said so, and none is left. */
UNIT_TEST(files)
{
    struct pair p;
    char message[600] = "";
    hammer_bench_open("beam", &p.bench);
    p.bench.options.seconds = 0.5;
    open_pair(&p);
    assert_int_equal(hammer_write(&p.test, 1, 0, "/nonexistent/x.unv", message, sizeof message), HAMMER_FAILURE);
    assert_non_null(strstr(message, "/nonexistent/x.unv: No such file"));
    assert_int_equal(hammer_write_truth(&p.test, 1, "/nonexistent/x.json", message, sizeof message), HAMMER_FAILURE);
    assert_int_equal(hammer_write_deck(&p.test, "m.unv", "/nonexistent/x.inp", message, sizeof message), HAMMER_FAILURE);
    close_pair(&p);
}
