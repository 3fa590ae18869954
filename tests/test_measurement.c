/* From universal files to transfer functions: units, what belongs together, what is left out, and the modes that go back out. The
 * files are written here from closed forms. */
#include <unistd.h>

#include "import/import.h"
#include "support.h"
#include "uff/uff.h"

#define LINES 200
#define STEP  0.5

static char path[64];
static FILE *file;

static void begin(void)
{
    (void)snprintf(path, sizeof path, "/tmp/rotid_measurement_XXXXXX");
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    file = fdopen(descriptor, "wb");
    assert_non_null(file);
}

static int finish(const struct measurement_options *options, struct message_list *messages, struct measurement *out)
{
    assert_int_equal(fclose(file), 0);
    message_open(messages, &test_pool);
    int status = measurement_read(&test_pool, path, options, messages, out);
    (void)unlink(path);
    return status;
}

static double complex oscillator(int node, double hz)
{
    return node * 1.5 / (50.0 * 50 - hz * hz + 2 * I * 0.01 * 50 * hz);
}

static struct uff_function transfer_of(int node, int reference)
{
    struct uff_function f = {.type = UFF_TRANSFER,
                             .response_node = node,
                             .response_direction = 1,
                             .reference_node = reference,
                             .reference_direction = 1,
                             .ordinate = UFF_COMPLEX_DOUBLE,
                             .count = LINES,
                             .is_even = 1,
                             .step = STEP};
    f.abscissa.specific_type = 18;
    f.numerator.specific_type = 12;
    f.numerator.length = 1;
    f.denominator.specific_type = 13;
    f.denominator.force = 1;
    return f;
}

static void write_transfer(const struct uff_function *f, double factor)
{
    struct uff_function_writer writer;
    assert_status(uff_write_function(file, f, &writer), ROTID_OK);
    for (int n = 0; n < f->count; n++) {
        double complex h = factor * oscillator(f->response_node, f->start + n * f->step);
        double re = creal(h), im = cimag(h);
        assert_status(uff_write_values(&writer, 1, NULL, &re, &im), ROTID_OK);
    }
    assert_status(uff_end_function(&writer), ROTID_OK);
}

static void write_real(const struct uff_function *f, const double *value)
{
    struct uff_function_writer writer;
    assert_status(uff_write_function(file, f, &writer), ROTID_OK);
    assert_status(uff_write_values(&writer, f->count, NULL, value, NULL), ROTID_OK);
    assert_status(uff_end_function(&writer), ROTID_OK);
}

static int warnings(const struct message_list *list, const char *part)
{
    int count = 0;
    for (size_t i = 0; i < list->count; i++)
        count += list->item[i].severity == SEVERITY_WARNING && strstr(list->item[i].text, part);
    return count;
}

/* ------------------------------------------------------------------------------------------------ transfer functions */

POOL_TEST(millimetres_and_g_become_si)
{
    struct measurement m;
    struct message_list messages;
    const struct measurement_options options = {0};
    const struct uff_units units = {.code = 5, .description = "mm (newton)", .length = 1000, .force = 1, .temperature = 1};
    const struct uff_node node[2] = {{.id = 7, .x = {0, 0, 1500}}, {.id = 2, .x = {0, 0, 250}}};
    begin();
    assert_status(uff_write_units(file, &units), ROTID_OK);
    assert_status(uff_write_nodes(file, 2411, 2, node), ROTID_OK);
    struct uff_function f = transfer_of(2, 7);
    write_transfer(&f, 1000); /* mm/s2 */
    f = transfer_of(7, 7);
    (void)snprintf(f.numerator.unit, sizeof f.numerator.unit, "g");
    write_transfer(&f, 1 / 9.80665);
    assert_status(finish(&options, &messages, &m), ROTID_OK);
    assert_int_equal(m.node_count, 2);
    assert_int_equal(m.node[0].id, 2);
    assert_close(m.node[0].x[2], 0.25, 1e-12, 0);
    assert_close(m.node[1].x[2], 1.5, 1e-12, 0);
    assert_int_equal(m.set.nfrf, 2);
    assert_int_equal(m.set.nline, LINES);
    assert_int_equal(m.set.quantity, FRF_ACCELERATION);
    for (int n = 0; n < LINES; n++) {
        assert_close(m.set.frequency_hz[n], n * STEP, 1e-12, 0);
        for (int c = 0; c < 2; c++) {
            double complex h = oscillator(m.set.frf[c].response_node, n * STEP);
            assert_close(creal(m.set.frf[c].h[n]), creal(h), 1e-10, 1e-12);
            assert_close(cimag(m.set.frf[c].h[n]), cimag(h), 1e-10, 1e-12);
        }
    }
}

/* A text that contradicts what counts is warned of, once a file; two systems of units are refused. */
POOL_TEST(units_that_contradict_each_other_are_told)
{
    static const struct {
        int specific_type;
        const char *motion, *force, *abscissa, *said;
    } cases[] = {
        {12, "m/s2", "N", "Hz", NULL},
        {12, "g", "", "", NULL},
        {12, "mm/s2", "N", "Hz",
         "2 functions have unit texts other than the units that count, here 'mm/s2', which is 0.001 m/s2"},
        {0, "g", "N", "Hz", "here 'g', which is 9.80665 m/s2, where no set 164 does and values count as 1"},
        {12, "g/N", "", "", "here 'g/N', which is 9.80665 m/s2"},
        {8, "um", "N", "Hz", "here 'um', which is 1e-06 m"},
        {11, "m/s", "kN", "Hz", "here 'kN', which is 1000 N"},
        {12, "m/s2", "N", "kHz", "here 'kHz', which is 1000 Hz, where values count as 1"},
        {12, "m/s2", "N", "rad/s", "here 'rad/s', which is 0.159155 Hz"},
    };
    const struct measurement_options options = {0};
    struct measurement m;
    struct message_list messages;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        begin();
        for (int node = 1; node <= 2; node++) {
            struct uff_function f = transfer_of(node, 1);
            f.numerator.specific_type = cases[i].specific_type;
            f.numerator.length = cases[i].specific_type != 0;
            (void)snprintf(f.numerator.unit, sizeof f.numerator.unit, "%s", cases[i].motion);
            (void)snprintf(f.denominator.unit, sizeof f.denominator.unit, "%s", cases[i].force);
            (void)snprintf(f.abscissa.unit, sizeof f.abscissa.unit, "%s", cases[i].abscissa);
            write_transfer(&f, 1);
        }
        assert_status(finish(&options, &messages, &m), ROTID_OK);
        assert_int_equal(warnings(&messages, cases[i].said ? cases[i].said : "unit texts"), cases[i].said != NULL);
    }
    const struct uff_units si = {.code = 1, .length = 1, .force = 1, .temperature = 1},
                           mm = {.code = 5, .length = 1000, .force = 1, .temperature = 1};
    struct uff_function f = transfer_of(1, 1);
    begin();
    assert_status(uff_write_units(file, &si), ROTID_OK);
    write_transfer(&f, 1);
    assert_status(uff_write_units(file, &mm), ROTID_OK);
    assert_status(finish(&options, &messages, &m), ROTID_ERROR_ARGUMENT);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.item[0].text, "a second set 164 has other factors"));
    begin();
    for (int node = 1; node <= 2; node++) { /* the same units twice are one system */
        f = transfer_of(node, 1);
        assert_status(uff_write_units(file, &si), ROTID_OK);
        write_transfer(&f, 1);
    }
    assert_status(finish(&options, &messages, &m), ROTID_OK);
    assert_int_equal(m.set.nfrf, 2);
}

POOL_TEST(what_cannot_stand_beside_the_others_is_left_out)
{
    struct measurement m;
    struct message_list messages;
    const struct measurement_options options = {0};
    double zeros[LINES] = {0};
    begin();
    for (int node = 1; node <= 3; node++) {
        struct uff_function f = transfer_of(node, 1);
        write_transfer(&f, 1);
    }
    struct uff_function f = transfer_of(4, 1);
    f.step = 0.25;
    write_transfer(&f, 1);
    f = transfer_of(5, 1);
    f.numerator.specific_type = 8;
    write_transfer(&f, 1);
    f = transfer_of(6, 1);
    f.ordinate = UFF_REAL_DOUBLE;
    write_real(&f, zeros);
    f = transfer_of(2, 1);
    write_transfer(&f, 3);
    f = transfer_of(8, 1);
    f.numerator.specific_type = 15;
    write_transfer(&f, 1);
    assert_status(finish(&options, &messages, &m), ROTID_OK);
    assert_int_equal(m.set.nfrf, 3);
    assert_int_equal(warnings(&messages, "left out"), 5);
    assert_int_equal(warnings(&messages, "lines are not those"), 1);
    assert_int_equal(warnings(&messages, "another quantity"), 1);
    assert_int_equal(warnings(&messages, "expected complex ones"), 1);
    assert_int_equal(warnings(&messages, "same response and reference"), 1);
    assert_int_equal(warnings(&messages, "no displacement, velocity or acceleration"), 1);
    assert_close(cabs(m.set.frf[1].h[10]), cabs(oscillator(2, 5)), 1e-10, 0); /* the first of two */
}

POOL_TEST(band_reference_and_coherence_are_heeded)
{
    struct measurement m;
    struct message_list messages;
    const struct measurement_options options = {.low_hz = 20, .high_hz = 60.2, .reference = 1, .averages = 3};
    double coherence[LINES];
    for (int n = 0; n < LINES; n++)
        coherence[n] = 0.5 + 0.002 * n;
    begin();
    struct uff_function f = transfer_of(3, 1);
    write_transfer(&f, 1);
    f = transfer_of(3, 2);
    write_transfer(&f, 1);
    f = transfer_of(3, 1);
    f.type = UFF_COHERENCE;
    f.ordinate = UFF_REAL_DOUBLE;
    f.numerator = f.denominator = (struct uff_axis){0};
    write_real(&f, coherence);
    assert_status(finish(&options, &messages, &m), ROTID_OK);
    assert_int_equal(m.set.nfrf, 1);
    assert_int_equal(m.set.nline, 81);
    assert_close(m.set.frequency_hz[0], 20, 1e-12, 0);
    assert_close(m.set.frequency_hz[80], 60, 1e-12, 0);
    const struct frf *frf = &m.set.frf[0];
    for (int n = 0; n < 81; n++) {
        double g = coherence[n + 40], h = cabs(oscillator(3, 20 + n * STEP));
        assert_close(frf->coherence[n], g, 1e-10, 0);
        assert_close(frf->variance[n], (1 - g) / (3 * g) * h * h, 1e-9, 0);
    }
}

POOL_TEST(files_without_anything_usable_are_refused)
{
    struct measurement m;
    struct message_list messages;
    struct measurement_options options = {0};
    const struct uff_node node = {.id = 7};
    begin();
    assert_status(uff_write_nodes(file, 15, 1, &node), ROTID_OK);
    assert_status(finish(&options, &messages, &m), ROTID_ERROR_ARGUMENT);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.item[0].text, "0 functions, none of them a transfer function"));
    begin();
    struct uff_function f = transfer_of(3, 1);
    write_transfer(&f, 1);
    options.low_hz = 500;
    options.high_hz = 600;
    assert_status(finish(&options, &messages, &m), ROTID_ERROR_ARGUMENT);
    assert_non_null(strstr(messages.item[messages.count - 1].text, "0 of 200 lines"));
    message_open(&messages, &test_pool);
    assert_status(measurement_read(&test_pool, "/nonexistent/file.uff", &options, &messages, &m), ROTID_ERROR_IO);
    assert_int_equal(messages.errors, 1);
}

/* ------------------------------------------------------------------------------------------------ time records */

#define SAMPLES 1024
#define RATE    1024.0

/* A record of force at 1:+Z and one of response at node:+Z; order: the response in front. */
static void write_records(int load_case, int node, int ordinate, int count, const double *force, const double *response,
                          int order)
{
    struct uff_function f = {.type = UFF_TIME,
                             .response_node = 1,
                             .response_direction = 3,
                             .load_case = load_case,
                             .ordinate = ordinate,
                             .count = count,
                             .is_even = 1,
                             .step = 1 / RATE};
    f.abscissa.specific_type = 17;
    struct uff_function g = f;
    f.numerator.specific_type = 13;
    g.numerator.specific_type = 12;
    g.response_node = node;
    if (order)
        write_real(&g, response);
    write_real(&f, force);
    if (!order)
        write_real(&g, response);
}

/* A half-sine of 8 samples, and y = gain * force two samples later: H = gain exp(-2 i omega/rate). */
static void write_measurement(int load_case, int node, double gain, double start, int order)
{
    double force[SAMPLES] = {0}, response[SAMPLES] = {0};
    for (int i = 0; i < 9; i++)
        force[(int)start + i] = 100 * sin(3.141592653589793 * i / 8);
    for (int i = 2; i < SAMPLES; i++)
        response[i] = gain * force[i - 2];
    write_records(load_case, node, UFF_REAL_DOUBLE, SAMPLES, force, response, order);
}

static void check_records(const struct measurement *m)
{
    assert_true(m->from_records);
    assert_close(m->rate, RATE, 1e-9, 0);
    assert_int_equal(m->set.nfrf, 2);
    for (int c = 0; c < 2; c++) {
        const struct frf *frf = &m->set.frf[c];
        double gain = frf->response_node == 5 ? 2 : -3;
        assert_int_equal(frf->reference_node, 1);
        assert_int_equal(frf->reference_direction, 3);
        for (int n = 0; n < m->set.nline; n++) {
            double w = 2 * 3.141592653589793 * m->set.frequency_hz[n];
            if (m->set.frequency_hz[n] > 50) /* the pulse has no more there */
                break;
            assert_true(cabs(frf->h[n] - gain * cexp(-2 * I * w / RATE)) < 1e-4 * fabs(gain));
        }
    }
}

POOL_TEST(responses_find_their_force)
{
    struct measurement m;
    struct message_list messages;
    const struct measurement_options options = {0};
    begin(); /* by load case, the response in front of its force */
    for (int i = 0; i < 3; i++) {
        write_measurement(10 + i, 5, 2, 30 + i, 1);
        write_measurement(20 + i, 9, -3, 40 + i, 1);
    }
    assert_status(finish(&options, &messages, &m), ROTID_OK);
    check_records(&m);
    assert_int_equal(m.transfer.nimpact, 6);
    begin(); /* no load cases: the force in front */
    for (int i = 0; i < 3; i++) {
        write_measurement(0, 5, 2, 30 + i, 0);
        write_measurement(0, 9, -3, 40 + i, 0);
    }
    assert_status(finish(&options, &messages, &m), ROTID_OK);
    check_records(&m);
}

/* A sensor that was not connected at one of four impacts. */
POOL_TEST(an_impact_without_its_response_is_left_out)
{
    struct measurement m;
    struct message_list messages;
    const struct measurement_options options = {0};
    begin();
    for (int i = 0; i < 4; i++) {
        write_measurement(10 + i, 5, i == 1 ? 0 : 2, 30 + i, 1);
        write_measurement(20 + i, 9, -3, 40 + i, 1);
    }
    assert_status(finish(&options, &messages, &m), ROTID_OK);
    check_records(&m);
    assert_int_equal(m.transfer.nimpact, 8);
    assert_int_equal(m.set.frf[0].averages, 3);
}

/* One record of force and of response [2 * SAMPLES]: the messages about them. */
static void read_records(const struct measurement_options *options, int ordinate, const double *force, const double *response,
                         struct message_list *messages)
{
    struct measurement m;
    begin();
    write_records(0, 5, ordinate, 2 * SAMPLES, force, response, 0);
    assert_status(finish(options, messages, &m), ROTID_OK);
}

/* y' = -decay y + force: of a block of a second the last tenth has about exp(-0.95 decay) sqrt(2 decay) of the rms, which is
 * 0.142 for a decay of 3 and 0.012 for one of 6, on both sides of the tenth that is let pass. */
static int warnings_of_a_decay(double decay)
{
    static const struct measurement_options options = {.transfer = {.block = 1}};
    struct message_list messages;
    double force[2 * SAMPLES] = {0}, response[2 * SAMPLES] = {0};
    for (int i = 0; i < 9; i++)
        force[30 + i] = 100 * sin(3.141592653589793 * i / 8);
    for (int i = 1; i < 2 * SAMPLES; i++)
        response[i] = exp(-decay / RATE) * response[i - 1] + force[i - 1];
    read_records(&options, UFF_REAL_DOUBLE, force, response, &messages);
    return warnings(&messages, "end before the response has decayed");
}

POOL_TEST(blocks_that_end_before_the_decay_are_warned_of)
{
    assert_int_equal(warnings_of_a_decay(3), 1);
    assert_int_equal(warnings_of_a_decay(6), 0);
}

/* A decay that rings, in steps of 1/levels of its range, over a pulse of 28 samples in so many steps: what the messages say of
 * it. */
static int warnings_of_records(int force_levels, int levels, double decay, double window, const char *said)
{
    const struct measurement_options options = {.transfer = {.block = 1, .pretrigger = 25 / RATE, .force_window = window}};
    struct message_list messages;
    double force[2 * SAMPLES] = {0}, response[2 * SAMPLES] = {0};
    for (int i = 0; i < 29; i++)
        force[30 + i] = round(force_levels * sin(3.141592653589793 * i / 28)) / force_levels;
    for (int i = 30; i < 2 * SAMPLES; i++)
        response[i] = round(levels / 2. * exp(-decay * (i - 30) / RATE) * sin(0.9 * (i - 30))) / levels;
    read_records(&options, UFF_REAL_SINGLE, force, response, &messages);
    return warnings(&messages, said);
}

/* Converters of which more is in use, up to 24 bits, are not accused, nor decays of a few samples. */
POOL_TEST(records_of_few_levels_are_warned_of)
{
    static const double few[] = {0, 1, 2, 3, 5, 5}, grid[] = {-2, 0, 1, 3, 5, 9, 0, 0},
                        pulse[] = {0, 0.13, 0.52, 1.31, 0.9, 0.2, 0};
    assert_int_equal(
        warnings_of_records(1 << 16, 30, 8, 0, "1 of 2 channels have fewer than 256 levels (here the response at 5:+Z"), 1);
    assert_int_equal(warnings_of_records(30, 30, 8, 0, "2 of 2 channels have fewer than 256 levels"), 1);
    assert_int_equal(warnings_of_records(30, 1 << 16, 8, 0, "(here the force at 1:+Z, 31 from its least"), 1);
    for (int levels = 600; levels <= 1 << 24; levels *= 2)
        for (double decay = 8; decay < 1000; decay *= 5)
            assert_int_equal(warnings_of_records(levels, levels, decay, 0, "levels"), 0);
    assert_int_equal(values_levels(6, few), 0);
    assert_int_equal(values_levels(8, grid), 12);
    assert_int_equal(values_levels(7, pulse), 0);
}

/* A third of the pulse is kept, two thirds, all of it. */
POOL_TEST(a_force_window_that_cuts_the_pulse_is_warned_of)
{
    static const char said[] = "the force window cuts 1 of 1 pulses";
    assert_int_equal(warnings_of_records(1 << 16, 1 << 16, 8, 10 / RATE, said), 1);
    assert_int_equal(warnings_of_records(1 << 16, 1 << 16, 8, 20 / RATE, said), 1);
    assert_int_equal(warnings_of_records(1 << 16, 1 << 16, 8, 40 / RATE, said), 0);
    assert_int_equal(warnings_of_records(1 << 16, 1 << 16, 8, 0, said), 0);
    assert_int_equal(warnings_of_records(1 << 16, 1 << 16, 8, -1, said), 0);
}

POOL_TEST(records_that_do_not_fit_are_named)
{
    struct measurement m;
    struct message_list messages;
    const struct measurement_options options = {0};
    double zeros[SAMPLES] = {0};
    struct uff_function f = {
        .type = UFF_TIME, .response_node = 1, .ordinate = UFF_REAL_SINGLE, .count = SAMPLES, .is_even = 1, .step = 1 / RATE};
    begin();
    write_measurement(1, 5, 2, 30, 0);
    f.numerator.specific_type = 13;
    f.load_case = 2;
    write_real(&f, zeros);
    f.numerator.specific_type = 12;
    f.response_node = 6;
    write_real(&f, zeros);
    assert_status(finish(&options, &messages, &m), ROTID_OK); /* one bad point is no reason to lose the test */
    assert_int_equal(m.set.nfrf, 1);
    assert_int_equal(warnings(&messages, "node 6 over node 1 left out: no impact"), 1);
    begin();
    write_real(&f, zeros);
    f.numerator.specific_type = 13;
    f.response_node = 1;
    write_real(&f, zeros);
    assert_status(finish(&options, &messages, &m), ROTID_ERROR_ARGUMENT);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.item[messages.count - 1].text, "no time record is left to use"));
    f.numerator.specific_type = 12;
    begin();
    write_measurement(1, 5, 2, 30, 0);
    write_measurement(1, 9, -3, 30, 0);
    f.count = SAMPLES / 2;
    f.load_case = 0;
    write_real(&f, zeros);
    assert_status(finish(&options, &messages, &m), ROTID_OK);
    assert_int_equal(m.set.nfrf, 2);
    assert_int_equal(warnings(&messages, "not sampled like its force"), 1);
}

/* Every allocation in turn: a status, no crash, nothing left behind. */
POOL_TEST(memory_may_run_out_anywhere)
{
    const struct measurement_options options = {.averages = 3};
    double coherence[LINES];
    long n = 0;
    int status = ROTID_ERROR_MEMORY;
    for (int i = 0; i < LINES; i++)
        coherence[i] = 0.9;
    begin();
    for (int node = 1; node <= 3; node++) {
        struct uff_function f = transfer_of(node, 1);
        f.is_even = 0; /* its abscissa has to be read to be found even */
        struct uff_function_writer writer;
        assert_status(uff_write_function(file, &f, &writer), ROTID_OK);
        for (int i = 0; i < LINES; i++) {
            double x = 10 + i * STEP, re = creal(oscillator(node, x)), im = cimag(oscillator(node, x));
            assert_status(uff_write_values(&writer, 1, &x, &re, &im), ROTID_OK);
        }
        assert_status(uff_end_function(&writer), ROTID_OK);
    }
    struct uff_function f = transfer_of(1, 1);
    f.type = UFF_COHERENCE;
    f.ordinate = UFF_REAL_DOUBLE;
    f.start = 10;
    write_real(&f, coherence);
    assert_int_equal(fclose(file), 0);
    while (status) {
        struct failing_allocator failing;
        struct pool pool;
        struct message_list messages;
        struct measurement m;
        failing_allocator_open(&failing, ++n);
        pool_open(&pool, &failing.allocator);
        message_open(&messages, &pool);
        status = measurement_read(&pool, path, &options, &messages, &m);
        if (status)
            assert_status(status, ROTID_ERROR_MEMORY);
        else {
            assert_int_equal(m.set.nfrf, 3);
            assert_close(m.set.frequency_hz[10], 15, 1e-6, 0);
            assert_non_null(m.set.frf[0].variance);
        }
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
        assert_true(n < 1000);
    }
    (void)unlink(path);
    print_message("%ld allocations\n", n - 1);
}
