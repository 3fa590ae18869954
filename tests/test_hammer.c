/* Records of the virtual hammer test: transfer functions, closed forms, noise, random numbers. */
#include <time.h>

#include "hammer_bench.h"
#include "support.h"

static const double pi = 3.14159265358979323846;

struct bench_state {
    struct hammer_bench bench;
    struct hammer_test test;
    double *force, *response, *other;
};

static void open_state(struct bench_state *s)
{
    hammer_bench_test(&s->bench, &s->test);
    s->force = malloc((size_t)s->test.count * sizeof(double));
    s->response = malloc((size_t)s->test.count * sizeof(double));
    s->other = malloc((size_t)s->test.count * sizeof(double));
    assert_true(s->force && s->response && s->other);
}

static void close_state(struct bench_state *s)
{
    free(s->force);
    free(s->response);
    free(s->other);
    hammer_close(&s->test);
    hammer_bench_close(&s->bench);
}

/* The accelerance from modes of the rotor by itself, summed here; static terms as the test has them. */
static double complex modal_sum(const struct hammer_test *test, double hz, const void *data)
{
    int point = *(const int *)data;
    double complex s = CMPLX(0, 2 * pi * hz), sum = 0;
    for (int j = 0; j < HAMMER_REST; j++)
        sum += test->rest[HAMMER_REST * point + j] * cpow(-s * s, j);
    for (int k = 0; k < test->modes; k++) {
        const double *shape = test->bare_shape + (ptrdiff_t)k * test->points;
        double omega = 2 * pi * test->bare_hz[k];
        int elastic = k - test->rigid;
        double damping = k < test->rigid
                             ? test->options.suspension_damping
                             : test->options.damping[elastic < test->options.dampings ? elastic : test->options.dampings - 1];
        sum += shape[point] * shape[test->fixed] / (omega * omega + s * s + 2 * damping * omega * s);
    }
    return s * s * sum;
}

/* Off the lines of a transform of the record, on which leakage of what has not decayed would hide. What is left comes from the
 * suspension, which swings on, and from what the filter lets through above half the sampling rate. */
UNIT_TEST(records_hold_the_accelerance)
{
    static const char *const rotor[] = {"paper", "beam"};
    for (int r = 0; r < 2; r++) {
        struct bench_state s;
        struct hammer_impact drawn;
        double worst = 0;
        hammer_bench_open(rotor[r], &s.bench);
        open_state(&s);
        for (int point = 0; point < s.test.points; point += 4) {
            hammer_record(&s.test, 3, point, 0, s.force, s.response, &drawn);
            struct hammer_misfit m = hammer_compare(&s.test, s.force, s.response, 50.25, 3200, 61.3, modal_sum, &point);
            worst = fmax(worst, m.error / m.largest);
        }
        print_message("%s: response over force differs from the accelerance by %.1e of its largest value\n", rotor[r], worst);
        assert_true(worst < 2e-4);
        close_state(&s);
    }
}

/* From 100 Hz on, where the suspension does not matter, and at a higher sampling rate the error falls to what has not decayed. */
UNIT_TEST(records_are_exact_at_a_higher_rate)
{
    struct bench_state s;
    struct hammer_impact drawn;
    double worst = 0;
    hammer_bench_open("paper", &s.bench);
    s.bench.options.rate = 4 * 8192;
    s.bench.options.suspension_damping = 0.9; /* gone before the record ends */
    s.bench.options.seconds = 8;
    open_state(&s);
    for (int point = 0; point < s.test.points; point += 17) {
        hammer_record(&s.test, 3, point, 0, s.force, s.response, &drawn);
        struct hammer_misfit m = hammer_compare(&s.test, s.force, s.response, 50.25, 3200, 241.3, modal_sum, &point);
        worst = fmax(worst, m.error / m.largest);
    }
    print_message("paper at 32768 Hz: %.1e\n", worst);
    assert_true(worst < 1e-7);
    close_state(&s);
}

/* Simpson's rule on int exp(p (t - u)) sin(pi u/T) du, and the exponential that is multiplied on for 1e5 samples. */
UNIT_TEST(pulse_and_recursion)
{
    enum { count = 100000, steps = 2000 };
    const double rate = 8192, start = 0.3 / rate, duration = 3.1e-4, amplitude = 7;
    struct hammer_poles poles = {.count = 1, .pole = {CMPLX(-2, 9000)}, .residue = {CMPLX(0.3, -1.2)}};
    double *y = calloc(count, sizeof *y), worst = 0;
    hammer_pulse_add(&poles, rate, start, duration, amplitude, count, y);
    for (int n = 0; n < count; n = n < 8 ? n + 1 : n + 997) {
        double t = n / rate - start, end = fmin(fmax(t, 0), duration), h = end / steps;
        double complex sum = 0;
        for (int i = 0; i <= steps; i++) {
            double weight = i == 0 || i == steps ? 1 : i % 2 ? 4 : 2;
            sum += weight * h / 3 * cexp(poles.pole[0] * (t - i * h)) * sin(pi * i * h / duration);
        }
        double expected = 2 * amplitude * creal(poles.residue[0] * sum);
        worst = fmax(worst, fabs(y[n] - expected) / (exp(-2 * fmax(t, 0)) * amplitude * duration));
    }
    print_message("pulse and recursion over %d samples: %.1e of the envelope\n", count, worst);
    assert_true(worst < 1e-9); /* Simpson's own error is below 1e-12; the rest is rounding */
    free(y);
}

/* Partial fractions against the product; flat to 0.1 dB in the band and 80 dB down where 0.39 of the rate is folded from. */
UNIT_TEST(filter)
{
    struct hammer_filter f;
    hammer_filter_open(8192, &f);
    assert_close(cabs(hammer_filter_at(&f, 0)), 1, 1e-12, 0);
    for (double hz = 0; hz < 8000; hz += 57) {
        double complex s = CMPLX(0, 2 * pi * hz), sum = 0, product = hammer_filter_at(&f, s);
        for (int i = 0; i < HAMMER_FILTER_PAIRS; i++)
            sum += f.residue[i] / (s - f.pole[i]) + conj(f.residue[i]) / (s - conj(f.pole[i]));
        assert_true(cabs(sum - product) < 1e-11);
        if (hz < 0.4 * 8192)
            assert_true(fabs(20 * log10(cabs(product))) < 0.11);
        if (hz > 0.61 * 8192)
            assert_true(cabs(product) < 1.2e-4);
    }
}

static double rms(int count, const double *y)
{
    double sum = 0;
    for (int n = 0; n < count; n++)
        sum += y[n] * y[n];
    return sqrt(sum / count);
}

/* The same impact with and without noise. */
UNIT_TEST(noise_is_as_asked)
{
    struct bench_state s;
    struct hammer_impact drawn;
    double *clean, peak = 0;
    hammer_bench_open("paper", &s.bench);
    s.bench.options.force_noise = 2e-3;
    s.bench.options.noise = 0.05;
    open_state(&s);
    clean = malloc((size_t)s.test.count * sizeof *clean);
    hammer_record(&s.test, 9, 11, 1, s.force, s.response, &drawn);
    s.test.options.noise = s.test.options.force_noise = 0;
    hammer_record(&s.test, 9, 11, 1, s.other, clean, &drawn);
    for (int n = 0; n < s.test.count; n++) {
        peak = fmax(peak, s.other[n]);
        s.force[n] -= s.other[n];
        s.response[n] -= clean[n];
    }
    assert_close(rms(s.test.count, s.response), 0.05 * rms(s.test.count, clean), 0.03, 0);
    assert_close(rms(s.test.count, s.force), 2e-3 * peak, 0.03, 0);
    s.test.options.floor = 1e-4;
    hammer_record(&s.test, 9, 11, 1, s.force, s.response, &drawn);
    for (int n = 0; n < s.test.count; n++)
        s.force[n] -= s.other[n];
    assert_close(rms(s.test.count, s.force), 1e-4 * peak, 0.03, 0);
    free(clean);
    close_state(&s);
}

UNIT_TEST(seeds)
{
    struct bench_state s;
    struct hammer_impact first, again, drawn;
    size_t bytes;
    double lowest = 1e9, highest = 0, latest = 0, earliest = 1;
    hammer_bench_open("paper", &s.bench);
    s.bench.options.noise = 0.01;
    open_state(&s);
    bytes = (size_t)s.test.count * sizeof(double);
    hammer_record(&s.test, 5, 20, 2, s.force, s.response, &first);
    hammer_record(&s.test, 5, 19, 2, s.force, s.other, &again);
    assert_memory_not_equal(s.response, s.other, bytes);
    hammer_record(&s.test, 5, 20, 2, s.force, s.other, &again);
    assert_memory_equal(s.response, s.other, bytes);
    assert_close(again.peak, first.peak, 0, 0);
    hammer_record(&s.test, 6, 20, 2, s.force, s.other, &again);
    assert_memory_not_equal(s.response, s.other, bytes);
    for (uint64_t seed = 0; seed < 200; seed++) {
        hammer_record(&s.test, seed, 0, 0, s.force, s.response, &drawn);
        lowest = fmin(lowest, drawn.peak);
        highest = fmax(highest, drawn.peak);
        earliest = fmin(earliest, drawn.start);
        latest = fmax(latest, drawn.start);
        assert_true(drawn.duration >= 2e-4 && drawn.duration <= 4e-4 && drawn.second_peak == 0 && !drawn.clipped);
    }
    assert_true(lowest >= 800 && lowest < 810 && highest <= 1200 && highest > 1190);
    assert_true(latest - earliest < 1.0 / 8192 && latest - earliest > 0.95 / 8192);
    close_state(&s);
}

static double complex drifted(const struct hammer_test *test, double hz, const void *data)
{
    double drift = *(const double *)data; /* all frequencies times drift: A(s) of the others at s/drift */
    return hammer_frf(test, 30, CMPLX(0, 2 * pi * hz / drift));
}

UNIT_TEST(drift)
{
    enum { draws = 400 };
    struct bench_state s;
    struct hammer_impact drawn, other;
    double sum = 0, square = 0;
    hammer_bench_open("paper", &s.bench);
    s.bench.options.drift = 2e-3;
    s.bench.options.seconds = 0.5;
    open_state(&s);
    for (uint64_t seed = 0; seed < draws; seed++) {
        hammer_record(&s.test, seed, 30, 0, s.force, s.response, &drawn);
        sum += drawn.drift - 1;
        square += pow(drawn.drift - 1, 2);
    }
    assert_close(sqrt(square / draws), 2e-3, 0.1, 0);
    assert_close(sum / draws, 0, 0, 3 * 2e-3 / sqrt(draws));
    hammer_record(&s.test, 1, 30, 1, s.force, s.response, &other);
    hammer_record(&s.test, 1, 30, 0, s.force, s.response, &drawn);
    assert_close(drawn.drift, other.drift, 0, 0); /* of the point, not of the impact */
    struct hammer_misfit m = hammer_compare(&s.test, s.force, s.response, 102, 3200, 100, drifted, &drawn.drift);
    assert_true(fabs(drawn.drift - 1) > 1e-4 && m.error < 1e-3 * m.largest);
    close_state(&s);
}

/* 20,000 records of 8192 samples have to be made in a test of coverage. Twenty times what a quiet machine takes. */
UNIT_TEST(speed)
{
    struct bench_state s;
    struct hammer_impact drawn;
    struct timespec begin, end;
    hammer_bench_open("paper", &s.bench);
    s.bench.options.noise = 0.01;
    open_state(&s);
    assert_int_equal(s.test.count, 8192);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &begin);
    for (int i = 0; i < 50; i++)
        hammer_record(&s.test, 1, i, 0, s.force, s.response, &drawn);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
    double milliseconds = ((double)(end.tv_sec - begin.tv_sec) * 1e3 + (double)(end.tv_nsec - begin.tv_nsec) * 1e-6) / 50;
    print_message("a record with noise takes %.2f ms\n", milliseconds);
    assert_true(milliseconds < 20);
    close_state(&s);
}
