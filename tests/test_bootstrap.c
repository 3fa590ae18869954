/* The bootstrap of the scan: closed forms for one column, probabilities that are what they say on sound data, numbers that do not
 * depend on the threads. */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/base.h"
#include "diagnose/diagnose.h"
#include "fit/fit.h"
#include "support.h"

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static void take_out(const struct scan *scan, double *v)
{
    for (int b = 0; b < scan->nbasis; b++) {
        const double *q = scan->basis + (ptrdiff_t)b * scan->nrow;
        double along = dot(scan->nrow, q, v);
        for (int i = 0; i < scan->nrow; i++)
            v[i] -= along * q[i];
    }
}

static void draw(struct random_stream *stream, int n, double *v)
{
    for (int i = 0; i < n; i++)
        v[i] = random_normal(stream);
}

static void normalise(int n, double *v)
{
    double length = sqrt(dot(n, v, v));
    for (int i = 0; i < n; i++)
        v[i] /= length;
}

/* A scan as scan_run leaves it: an orthonormal basis, columns of unit length orthogonal to it. Each third column is two-sided. */
static struct scan random_scan(int nrow, int nfrequency, int nbasis, int nitem)
{
    struct random_stream stream = {11};
    struct scan scan = {.nrow = nrow, .nfrequency = nfrequency, .nfree = nbasis, .dof = nrow - nbasis, .nitem = nitem};
    scan.item = POOL_ARRAY(&test_pool, struct scan_item, nitem);
    scan.column = POOL_ARRAY(&test_pool, double, nrow *nitem);
    scan.basis = POOL_ARRAY(&test_pool, double, nrow *nbasis);
    scan.r = POOL_ARRAY(&test_pool, double, nrow);
    scan.is_frequency = POOL_ARRAY(&test_pool, char, nrow);
    for (int i = 0; i < nfrequency; i++)
        scan.is_frequency[i] = 1;
    for (; scan.nbasis < nbasis; scan.nbasis++) {
        double *q = scan.basis + (ptrdiff_t)scan.nbasis * nrow;
        draw(&stream, nrow, q);
        take_out(&scan, q);
        normalise(nrow, q);
    }
    for (int i = 0; i < nitem; i++) {
        double *c = scan.column + (ptrdiff_t)i * nrow;
        draw(&stream, nrow, c);
        take_out(&scan, c);
        normalise(nrow, c);
        scan.item[i] = (struct scan_item){.unit = 1, .usable = 1, .norm = 1, .side = i % 3 - 1};
    }
    return scan;
}

/* Sound data: white noise, and what the scan makes of it. */
static void simulate(struct scan *scan, struct random_stream *stream)
{
    draw(stream, scan->nrow, scan->r);
    take_out(scan, scan->r);
    scan->chi2 = dot(scan->nrow, scan->r, scan->r);
    scan->chi2_frequency = dot(scan->nfrequency, scan->r, scan->r);
    scan->largest = 0;
    for (int i = 0; i < scan->nitem; i++) {
        double amplitude = -dot(scan->nrow, scan->column + (ptrdiff_t)i * scan->nrow, scan->r);
        if (amplitude * scan->item[i].side >= 0)
            scan->largest = fmax(scan->largest, amplitude * amplitude);
    }
}

static void run(const struct scan *scan, int replicates, unsigned long seed, int threads, struct bootstrap *b)
{
    assert_status(bootstrap_run(&test_pool, scan, replicates, seed, threads, NULL, b), ROTID_OK);
}

/* Of one column the drop is chi2 with one degree of freedom, of a one-sided one half of the time zero. Without frequencies the
 * whole chi2 takes a third of the alarms; over many rows it has little to do with the column. */
POOL_TEST(one_column_has_the_analytic_threshold)
{
    const double expected = (FAMILY_WISE - BLOCK_LEVEL) / (1 - BLOCK_LEVEL);
    for (int side = -1; side <= 1; side++) {
        struct scan scan = random_scan(150, 0, 2, 1);
        struct bootstrap b;
        double share = side ? 0.5 : 1;
        scan.item[0].side = side;
        run(&scan, 20000, 5, 1, &b);
        assert_close(share * chi_square_tail(b.threshold, 1), expected, 0, 0.004);
        int zero = 0;
        for (int i = 0; i < b.replicates; i++)
            zero += b.largest[i] == 0;
        assert_close((double)zero / b.replicates, side ? 0.5 : 0, 0, 0.015);
        for (double drop = 1; drop < 9; drop += 2)
            assert_close(bootstrap_p(&b, drop), share * chi_square_tail(drop, 1), 0, 0.012);
    }
}

/* Columns at right angles are independent: the largest of m has the tail 1 - (1 - p)^m. */
POOL_TEST(many_orthogonal_columns)
{
    enum { columns = 25 };
    struct scan scan = random_scan(120, 0, 0, columns);
    struct bootstrap b;
    memset(scan.column, 0, sizeof(double) * 120 * columns);
    for (int i = 0; i < columns; i++) {
        scan.column[i + i * 120] = 1;
        scan.item[i].side = 0;
    }
    run(&scan, 20000, 5, 1, &b);
    for (double drop = 6; drop < 13; drop += 2)
        assert_close(bootstrap_p(&b, drop), 1 - pow(1 - chi_square_tail(drop, 1), columns), 0, 0.012);
    for (int i = 1; i < b.replicates; i++)
        assert_true(b.largest[i] >= b.largest[i - 1] && b.frequency[i] >= b.frequency[i - 1]);
}

static int compare(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* Kolmogorov's distance of values from the uniform distribution on [0, 1]. */
static double from_uniform(int n, double *value)
{
    double most = 0;
    qsort(value, (size_t)n, sizeof *value, compare);
    for (int i = 0; i < n; i++)
        most = fmax(most, fmax((i + 1.0) / n - value[i], value[i] - (double)i / n));
    return most;
}

/* share of sorted values at least as large */
static double tail(int n, const double *sorted, double value)
{
    int count = 0;
    for (int i = n - 1; i >= 0 && sorted[i] >= value; i--)
        count++;
    return (count + 1.0) / (n + 1.0);
}

POOL_TEST(sound_data_alarm_as_often_as_stated)
{
    enum { cases = 4000 };
    struct scan scan = random_scan(70, 6, 5, 40);
    struct random_stream stream = {2024};
    struct bootstrap b;
    double *p[3];
    int alarms = 0;
    for (int t = 0; t < 3; t++)
        p[t] = POOL_ARRAY(&test_pool, double, cases);
    run(&scan, 8000, 3, 2, &b);
    for (int i = 0; i < cases; i++) {
        simulate(&scan, &stream);
        p[0][i] = bootstrap_p(&b, scan.largest);
        p[1][i] = tail(b.replicates, b.frequency, scan.chi2_frequency);
        p[2][i] = chi_square_tail(scan.chi2, scan.dof);
        alarms += scan.largest > b.threshold || p[1][i] <= BLOCK_LEVEL || p[2][i] <= BLOCK_LEVEL;
    }
    /* binomial: 0.27 % standard deviation, and 0.19 % of the bootstrap's own */
    assert_close((double)alarms / cases, FAMILY_WISE, 0, 3 * hypot(0.0027, 0.0019));
    for (int t = 0; t < 3; t++) { /* Kolmogorov at 0.001, and the same of the bootstrap */
        double apart = from_uniform(cases, p[t]);
        if (!(apart < 1.95 / sqrt(cases) + 1.95 / sqrt(8000)))
            print_error("test %d: %g from uniform\n", t, apart);
        assert_true(apart < 1.95 / sqrt(cases) + 1.95 / sqrt(8000));
    }
}

/* The three probabilities of a bootstrap are those of the scan that it was given. */
POOL_TEST(probabilities_belong_to_the_scan)
{
    struct scan scan = random_scan(60, 5, 3, 20);
    struct random_stream stream = {77};
    struct bootstrap b;
    simulate(&scan, &stream);
    run(&scan, 1000, 9, 1, &b);
    assert_close(b.p_scan, bootstrap_p(&b, scan.largest), 0, 0);
    assert_close(b.p_frequency, tail(1000, b.frequency, scan.chi2_frequency), 1e-15, 0);
    assert_close(b.p_total, chi_square_tail(scan.chi2, 57), 1e-15, 0);
    assert_close(bootstrap_p(&b, 1e6), 1.0 / 1001, 1e-15, 0); /* never zero */
    assert_close(bootstrap_p(&b, 0), 1, 0, 0);
}

POOL_TEST(the_same_numbers_for_any_number_of_threads)
{
    static const int threads[] = {2, 3, 8};
    struct scan scan = random_scan(90, 6, 4, 33);
    struct random_stream stream = {5};
    simulate(&scan, &stream);
    for (int replicates = 37; replicates < 1000; replicates += 693) { /* less than a block, and blocks with a rest */
        struct bootstrap one, other;
        run(&scan, replicates, 4, 1, &one);
        for (int t = 0; t < 3; t++) {
            run(&scan, replicates, 4, threads[t], &other);
            assert_memory_equal(one.largest, other.largest, (size_t)replicates * sizeof(double));
            assert_memory_equal(one.frequency, other.frequency, (size_t)replicates * sizeof(double));
            assert_true(one.threshold == other.threshold && one.p_scan == other.p_scan);
            assert_true(one.p_frequency == other.p_frequency && one.p_total == other.p_total);
        }
        run(&scan, replicates, 5, 1, &other);
        assert_memory_not_equal(one.largest, other.largest, (size_t)replicates * sizeof(double));
    }
}

POOL_TEST(nothing_to_look_for)
{
    struct scan scan = random_scan(30, 5, 2, 0);
    struct bootstrap b;
    run(&scan, 500, 1, 2, &b);
    for (int i = 0; i < 500; i++)
        assert_true(b.largest[i] == 0);
    assert_true(b.p_scan == 1 && b.threshold >= 0);
}

struct host {
    atomic_int left;
};

static int cancelled(void *context)
{
    return atomic_fetch_sub(&((struct host *)context)->left, 1) <= 0;
}

POOL_TEST(a_host_can_cancel)
{
    struct scan scan = random_scan(40, 5, 2, 10);
    struct bootstrap b;
    for (int after = 0; after < 12; after += 5)
        for (int threads = 1; threads < 5; threads += 3) {
            struct host host = {after};
            const rotid_environment environment = {.size = sizeof environment, .cancelled = cancelled, .context = &host};
            assert_status(bootstrap_run(&test_pool, &scan, 1000, 1, threads, &environment, &b), ROTID_STOP_CANCELLED);
        }
    struct host patient = {1000};
    const rotid_environment environment = {.size = sizeof environment, .cancelled = cancelled, .context = &patient};
    assert_status(bootstrap_run(&test_pool, &scan, 1000, 1, 2, &environment, &b), ROTID_OK);
}

POOL_TEST(memory_that_runs_out)
{
    struct scan scan = random_scan(40, 5, 2, 10);
    int status = ROTID_ERROR_MEMORY, n = 0;
    while (status == ROTID_ERROR_MEMORY && n < 100) {
        struct failing_allocator failing;
        struct pool pool;
        struct bootstrap b;
        failing_allocator_open(&failing, ++n);
        pool_open(&pool, &failing.allocator);
        status = bootstrap_run(&pool, &scan, 200, 1, 2, NULL, &b);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
    }
    assert_status(status, ROTID_OK);
    assert_true(n > 5);
}
