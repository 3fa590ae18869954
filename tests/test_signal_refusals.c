/* What transfer_compute refuses, with the record at fault; memory that runs out; any number of threads; lines without force. */
#include "support.h"

#include "signal/signal.h"
#include "struck.h"

#define LENGTH 2000
#define RATE   1000.0

/* Three impacts a record, of a sampled system with white noise on the response. */
static struct time_record usual(int node)
{
    struct time_record record = struck_record(LENGTH);
    double *f = struck_force(&record), *x = struck_response(&record);
    uint64_t seed = (uint64_t)node;
    for (int k = 0; k < 3; k++) {
        f[100 + 650 * k] = 50;
        f[101 + 650 * k] = 100;
        f[102 + 650 * k] = 60;
    }
    for (int j = 2; j < LENGTH; j++)
        x[j] = f[j] + 1.7 * x[j - 1] - 0.95 * x[j - 2];
    struck_noise(&seed, 1, LENGTH, x);
    record.response_node = node;
    return record;
}

static void assert_refused(int nrecord, const struct time_record *record, double rate, const struct transfer_options *options,
                           int expected)
{
    struct transfer out;
    int bad = 99;
    assert_status(transfer_compute(&test_pool, nrecord, record, rate, FRF_ACCELERATION, options, 1, &out, &bad),
                  ROTID_ERROR_ARGUMENT);
    assert_int_equal(bad, expected);
}

POOL_TEST(options_out_of_range_are_refused)
{
    struct time_record record = usual(1);
    const struct transfer_options wrong[] = {
        {.estimator = -1},
        {.estimator = 3},
        {.threshold = -0.1},
        {.threshold = 1},
        {.threshold = NAN},
        {.pretrigger = -1},
        {.pretrigger = NAN},
        {.pretrigger = INFINITY},
        {.block = -1},
        {.block = NAN},
        {.block = INFINITY},
        {.block = 1e300},
        {.block = 0.005},
        {.block = 1e-9},
        {.force_window = NAN},
        {.force_window = INFINITY},
        {.exponential = -0.1},
        {.exponential = 1.1},
        {.exponential = NAN},
        {.low_hz = -1},
        {.low_hz = NAN},
        {.low_hz = 501},
        {.low_hz = 451},
        {.high_hz = -1},
        {.high_hz = INFINITY},
        {.high_hz = 1e-3},
        {.low_hz = 20, .high_hz = 10},
    };
    static const double rate[] = {0, -1, NAN, INFINITY, -INFINITY, 1e300, 1e-300};
    struct transfer out;
    int bad;
    for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++)
        assert_refused(1, &record, RATE, &wrong[w], -1);
    for (size_t r = 0; r < sizeof rate / sizeof *rate; r++)
        assert_refused(1, &record, rate[r], &(struct transfer_options){0}, -1);
    assert_refused(0, &record, RATE, &(struct transfer_options){0}, -1);
    assert_refused(-3, NULL, RATE, &(struct transfer_options){0}, -1);
    for (int q = -1; q <= 3; q += 4)
        assert_status(
            transfer_compute(&test_pool, 1, &record, RATE, (enum frf_quantity)q, &(struct transfer_options){0}, 1, &out, &bad),
            ROTID_ERROR_ARGUMENT);
    assert_status(transfer_compute(&test_pool, 1, &record, RATE, FRF_VELOCITY, &(struct transfer_options){0}, 0, &out, &bad),
                  ROTID_ERROR_ARGUMENT);
    assert_int_equal(bad, -1);
    assert_status(transfer_compute(&test_pool, 1, &record, RATE, FRF_VELOCITY,
                                   &(struct transfer_options){.high_hz = 1e9, .force_window = -1, .pretrigger = 0.3}, 1, &out,
                                   &bad),
                  ROTID_OK); /* no further than half the rate, and no more before an impact than there is */
    assert_close(out.set.frequency_hz[out.set.nline - 1], RATE / 2, 1e-12, 0);
}

POOL_TEST(records_without_an_impact_are_named)
{
    struct transfer_options options = {0};
    uint64_t seed = 2;
    for (int kind = 0; kind < 12; kind++) {
        struct time_record record[] = {usual(1), usual(2), usual(2)};
        double *f = struck_force(&record[2]), *x = struck_response(&record[2]);
        options = (struct transfer_options){0};
        if (kind < 6)
            memset(f, 0, LENGTH * sizeof *f);
        switch (kind) {
        case 0: /* silence */
            break;
        case 1: /* noise */
            struck_noise(&seed, 1, LENGTH, f);
            break;
        case 2: /* a shaker */
            for (int j = 0; j < LENGTH; j++)
                f[j] = sin(0.1 * j);
            break;
        case 3: /* an offset that rounds */
            for (int j = 0; j < LENGTH; j++)
                f[j] = 0.1;
            break;
        case 4: /* one sample */
            f[0] = 1;
            record[2].count = 1;
            break;
        case 5: /* so small that its square is zero */
            f[500] = 1e-200;
            break;
        case 6:
            f[LENGTH - 1] = NAN;
            break;
        case 7:
            x[7] = INFINITY;
            break;
        case 8: /* so large that squares overflow */
            x[7] = -1e300;
            break;
        case 9:
            record[2].count = 0;
            break;
        case 10:
            record[2].response = NULL;
            break;
        default: /* shorter than the block */
            options.block = 0.6;
            record[2].count = 500;
        }
        assert_refused(3, record, RATE, &options, 2);
    }
}

/* All impacts of node 2 are overloaded or cut: its first record is named. */
POOL_TEST(transfer_functions_without_a_usable_impact_are_named)
{
    struct time_record record[] = {usual(1), usual(2), usual(2)};
    for (int r = 1; r < 3; r++)
        for (int j = 0; j < LENGTH; j++)
            struck_response(&record[r])[j] = fmax(-10, fmin(10, record[r].response[j]));
    assert_refused(3, record, RATE, &(struct transfer_options){0}, 1);
    assert_refused(1, record, RATE, &(struct transfer_options){.block = 1.5}, 0); /* all are second hits of the first */
}

static int compute(struct pool *pool, int nrecord, const struct time_record *record, int threads, struct transfer *out)
{
    int bad;
    struct transfer_options options = {.estimator = TRANSFER_HV, .exponential = 0.1};
    return transfer_compute(pool, nrecord, record, RATE, FRF_ACCELERATION, &options, threads, out, &bad);
}

POOL_TEST(every_failing_allocation_is_reported)
{
    struct time_record record[] = {usual(1), usual(2), usual(1), usual(3)};
    int status = ROTID_ERROR_MEMORY, n = 0;
    while (status == ROTID_ERROR_MEMORY) {
        struct failing_allocator failing;
        struct pool pool;
        struct transfer out;
        failing_allocator_open(&failing, ++n);
        pool_open(&pool, &failing.allocator);
        status = compute(&pool, 4, record, 2, &out);
        assert_true(status == ROTID_OK ? failing.until_failure > 0 : failing.until_failure == 0);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
        assert_true(n < 1000);
    }
    assert_status(status, ROTID_OK);
    print_message("%d allocations\n", n - 1);
    assert_true(n > 30);
}

POOL_TEST(results_do_not_depend_on_the_threads)
{
    enum { FUNCTIONS = 9 };
    struct time_record record[FUNCTIONS];
    struct transfer serial, out;
    for (int r = 0; r < FUNCTIONS; r++)
        record[r] = usual(r);
    assert_status(compute(&test_pool, FUNCTIONS, record, 1, &serial), ROTID_OK);
    for (int threads = 2; threads <= 300; threads = threads < 4 ? threads + 1 : 10 * threads - 10) {
        assert_status(compute(&test_pool, FUNCTIONS, record, threads, &out), ROTID_OK);
        size_t n = (size_t)serial.set.nline, all = n * (size_t)serial.first[FUNCTIONS];
        assert_int_equal(out.set.nline, serial.set.nline);
        assert_memory_equal(out.single, serial.single, all * sizeof(double complex));
        assert_memory_equal(out.single_force, serial.single_force, all * sizeof(double));
        assert_memory_equal(out.single_response, serial.single_response, all * sizeof(double));
        for (int f = 0; f < FUNCTIONS; f++) {
            assert_memory_equal(out.set.frf[f].h, serial.set.frf[f].h, n * sizeof(double complex));
            assert_memory_equal(out.set.frf[f].variance, serial.set.frf[f].variance, n * sizeof(double));
            assert_memory_equal(out.set.frf[f].coherence, serial.set.frf[f].coherence, n * sizeof(double));
        }
        assert_memory_equal(out.impact, serial.impact, (size_t)serial.nimpact * sizeof *serial.impact);
    }
}

/* The single spectra give the estimate again, and any other choice of impacts. */
POOL_TEST(single_impacts_add_up_to_the_estimate)
{
    struct time_record record[] = {usual(1), usual(2)};
    struct transfer out;
    assert_status(compute(&test_pool, 2, record, 1, &out), ROTID_OK);
    size_t n = (size_t)out.set.nline, at = n * (size_t)out.first[1];
    struct spectra column = {out.single_force + at, out.single_response + at, out.single + at};
    struct spectra sum = {POOL_ARRAY(&test_pool, double, n), POOL_ARRAY(&test_pool, double, n),
                          POOL_ARRAY(&test_pool, double complex, n)};
    double complex *h = POOL_ARRAY(&test_pool, double complex, n);
    assert_int_equal(out.first[2] - out.first[1], 3);
    estimator_sum((int)n, 3, &column, NULL, &sum);
    estimator_transfer(TRANSFER_HV, estimator_balance((int)n, &sum), (int)n, &sum, h);
    assert_memory_equal(h, out.set.frf[1].h, n * sizeof *h);
    estimator_sum((int)n, 3, &column, (const double[]){0, 1, 0}, &sum);
    estimator_transfer(TRANSFER_H1, 0, (int)n, &sum, h);
    for (size_t l = 0; l < n; l++)
        assert_true(cabs(h[l] - column.xf[n + l] / column.ff[n + l]) <= 1e-15 * cabs(h[l]));
}

/* Where there is no force nothing is known: h = 0, infinite variance, coherence 0; the lines beside are as without it. A silent
 * response has h = 0 with variance 0. */
UNIT_TEST(lines_without_force_say_nothing)
{
    enum { LINES = 60, GAP = 20 };
    double ff[2 * LINES], xx[2 * LINES], variance[LINES], coherence[LINES], sums[2 * LINES], weight[2];
    double smooth[LINES + 2 * ESTIMATOR_SMOOTH + 2];
    double complex xf[2 * LINES], h[LINES], part[LINES], sum_xf[LINES];
    struct spectra column = {ff, xx, xf}, sum = {sums, sums + LINES, sum_xf};
    for (int estimator = TRANSFER_H1; estimator <= TRANSFER_HV; estimator++)
        for (int silent = 0; silent < 2; silent++) {
            for (int i = 0; i < 2 * LINES; i++) {
                double f = i % LINES == GAP ? 0 : 2, x = silent ? 0 : i < LINES ? 6 : 8;
                ff[i] = f * f, xx[i] = x * x, xf[i] = x * f;
            }
            estimator_sum(LINES, 2, &column, NULL, &sum);
            estimator_transfer(estimator, estimator_balance(LINES, &sum), LINES, &sum, h);
            estimator_coherence(LINES, &sum, coherence);
            estimator_jackknife(estimator, LINES, 2, &column, h, variance, &sum, part, weight);
            estimator_sum(LINES, 2, &column, NULL, &sum);
            estimator_smooth(LINES, sum.ff, variance, smooth);
            for (int l = 0; l < LINES; l++) {
                assert_true(l != GAP || (h[l] == 0 && isinf(variance[l]) && coherence[l] == 0));
                if (l != GAP && silent)
                    assert_true(h[l] == 0 && variance[l] == 0 && coherence[l] == 0);
                if (l != GAP && !silent && estimator == TRANSFER_H1) {
                    assert_close(creal(h[l]), 3.5, 1e-14, 0);
                    assert_close(variance[l], 0.25, 1e-13, 0); /* of the mean of 3 and 4: |d|^2/4 */
                    assert_close(coherence[l], 14.0 * 14 / (2 * 100), 1e-14, 0);
                }
                if (l != GAP && !silent)
                    assert_true(variance[l] > 0.2 && variance[l] < 0.3);
            }
        }
}

/* Force and response in units as far apart as samples may be: the same digits. */
POOL_TEST(units_may_be_of_any_size)
{
    struct time_record plain = usual(1), scaled = usual(1);
    struct transfer out, far;
    int bad;
    for (int estimator = TRANSFER_H1; estimator <= TRANSFER_HV; estimator++)
        for (int sign = -1; sign <= 1; sign += 2) {
            struct transfer_options options = {.estimator = estimator, .exponential = 0.1};
            double unit = ldexp(1, sign * 140);
            for (int j = 0; j < LENGTH; j++) {
                struck_force(&scaled)[j] = plain.force[j] * unit;
                struck_response(&scaled)[j] = plain.response[j] / unit;
            }
            assert_status(transfer_compute(&test_pool, 1, &plain, RATE, FRF_VELOCITY, &options, 1, &out, &bad), ROTID_OK);
            assert_status(transfer_compute(&test_pool, 1, &scaled, RATE, FRF_VELOCITY, &options, 1, &far, &bad), ROTID_OK);
            for (int l = 0; l < out.set.nline; l++) {
                assert_true(cabs(far.set.frf[0].h[l] * unit * unit - out.set.frf[0].h[l]) <= 1e-13 * cabs(out.set.frf[0].h[l]));
                assert_close(far.set.frf[0].variance[l] * unit * unit * unit * unit, out.set.frf[0].variance[l], 1e-11, 0);
                assert_close(far.set.frf[0].coherence[l], out.set.frf[0].coherence[l], 1e-12, 0);
            }
        }
}
