/* How probable a scan's frequencies are as noise: shares of simulated noise, and closed forms. */
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

/* A scan as scan_run leaves it, with an orthonormal basis and without columns. */
static struct scan random_scan(int nrow, int nfrequency, int nbasis)
{
    struct random_stream stream = {11};
    struct scan scan = {.nrow = nrow, .nfrequency = nfrequency, .nfree = nbasis, .dof = nrow - nbasis};
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
    return scan;
}

/* Sound data: white noise, and what the scan makes of it. */
static void simulate(struct scan *scan, struct random_stream *stream)
{
    draw(stream, scan->nrow, scan->r);
    take_out(scan, scan->r);
    scan->chi2_frequency = dot(scan->nfrequency, scan->r, scan->r);
}

/* What is fitted takes parts of the frequencies that are no whole numbers. */
POOL_TEST(sound_frequencies_are_as_probable_as_said)
{
    static const int size[][3] = {{60, 8, 4}, {12, 8, 5}, {7, 5, 3}, {5, 5, 3}}; /* rows, frequencies, fitted */
    static const double level[] = {0.01, 0.05, 0.3, 0.7};
    struct random_stream stream = {3};
    for (size_t c = 0; c < sizeof size / sizeof *size; c++) {
        struct scan scan = random_scan(size[c][0], size[c][1], size[c][2]);
        const int draws = 20000;
        int below[4] = {0};
        for (int i = 0; i < draws; i++) {
            simulate(&scan, &stream);
            double p = scan_chance_of_frequencies(&test_pool, &scan);
            for (int k = 0; k < 4; k++)
                below[k] += p < level[k];
        }
        for (int k = 0; k < 4; k++)
            assert_close((double)below[k] / draws, level[k], 0, 0.002 + 0.03 * level[k]);
    }
}

/* A basis that leaves the frequencies alone, one within them, and one that is all of them. */
POOL_TEST(chances_of_whole_numbers)
{
    for (int inside = 0; inside < 2; inside++) {
        struct scan scan = random_scan(20, 6, 2);
        for (int i = 0; i < 2 * scan.nrow; i++)
            scan.basis[i] = i == (inside ? 1 : 11) || i == scan.nrow + (inside ? 4 : 17);
        scan.chi2_frequency = 9.5;
        assert_close(scan_chance_of_frequencies(&test_pool, &scan), chi_square_tail(9.5, inside ? 4 : 6), 0, 1e-14);
    }
    struct scan all = random_scan(3, 3, 3);
    all.chi2_frequency = 1e-20;
    assert_true(scan_chance_of_frequencies(&test_pool, &all) == 1);
    struct scan none = random_scan(8, 0, 2);
    assert_true(scan_chance_of_frequencies(&test_pool, &none) == 1);
}

/* Of any number of degrees of freedom: that of two is exp(-x/2), and half ones lie between the whole ones. */
UNIT_TEST(a_tail_between_whole_degrees_of_freedom)
{
    for (int i = 0; i < 7; i++) {
        double x = ldexp(0.5, i);
        assert_close(chi_square_tail(x, 2), exp(-x / 2), 0, 1e-14);
        assert_true(chi_square_tail(x, 2.5) > chi_square_tail(x, 2) && chi_square_tail(x, 2.5) < chi_square_tail(x, 3));
    }
    /* 0.5 degrees: the incomplete gamma function of 1/4, by its series */
    double y = 0.3, term = pow(y, 0.25) / 0.25, sum = term;
    for (int k = 1; k < 40; k++) {
        term *= -y / k;
        sum += term * 0.25 / (0.25 + k);
    }
    assert_close(chi_square_tail(2 * y, 0.5), 1 - sum / tgamma(0.25), 0, 1e-13);
}
