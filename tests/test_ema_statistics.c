/* Standard deviations against the scatter over repeated measurements; the choice of modes over random systems. */
#include "ema_truth.h"
#include "support.h"

#define TRIALS 100
#define POINTS 10

struct tally {
    double sum, squares, stated; /* of (value - truth); of the stated variance */
    int covered, count;
};

static void add(struct tally *tally, double error, double std)
{
    tally->sum += error;
    tally->squares += error * error;
    tally->stated += std * std;
    tally->covered += fabs(error) < 1.96 * std;
    tally->count++;
}

/* Stated over true, rms; 95 % coverage within three of its own standard deviations. */
static void assert_honest(const struct tally *tally, double tolerance, const char *name)
{
    double ratio = sqrt(tally->stated / tally->squares), coverage = (double)tally->covered / tally->count;
    print_message("%s: stated/true %.3f, coverage %.3f\n", name, ratio, coverage);
    assert_close(ratio, 1, tolerance, 0);
    assert_close(coverage, 0.95, 0.05, 0);
}

static void scatter(int with_variance)
{
    struct tally frequency = {0}, damping = {0}, shape = {0};
    struct random_stream random = {.state = 99};
    struct truth truth;
    truth_beam(3, POINTS, 0, 60, 4e-3, &truth);
    for (int trial = 0; trial < TRIALS; trial++) {
        struct pool pool;
        struct frf_set set;
        struct ema ema;
        struct ema_options options = {.order = 24};
        pool_open(&pool, NULL);
        truth_measure(&pool, &truth, FRF_ACCELERATION, 40, 0.15, 2200, 2e-2, with_variance, &random, &set);
        assert_status(ema_compute(&pool, &set, &options, NULL, &ema), ROTID_OK);
        assert_int_equal(ema.nmode, 3);
        for (int r = 0; r < 3; r++) {
            const struct ema_mode *mode = &ema.mode[r];
            add(&frequency, mode->frequency_hz - truth.frequency_hz[r], mode->frequency_std);
            add(&damping, mode->damping - truth.damping[r], mode->damping_std);
            /* the scale is free: the one nearest to the truth */
            double ab = 0, bb = 0;
            for (int j = 0; j < POINTS; j++) {
                double w = 1 / (mode->shape_std[j] * mode->shape_std[j]);
                ab += w * mode->shape[j] * truth.phi[r][j];
                bb += w * truth.phi[r][j] * truth.phi[r][j];
            }
            for (int j = 0; j < POINTS; j++)
                add(&shape, mode->shape[j] - ab / bb * truth.phi[r][j], mode->shape_std[j] * sqrt((POINTS - 1.0) / POINTS));
        }
        pool_close(&pool);
    }
    assert_honest(&frequency, 0.1, "frequency");
    assert_honest(&damping, 0.1, "damping");
    assert_honest(&shape, 0.1, "shape");
}

UNIT_TEST(stated_deviations_are_the_true_ones)
{
    scatter(1);
}

UNIT_TEST(so_are_those_from_what_is_left_over)
{
    scatter(0);
}

/* 6 to 14 modes, damping 5e-4 to 3e-2, noise 1e-4 to 3e-2: exactly the true ones, but in one system of ten at most. */
UNIT_TEST(the_table_proposes_the_true_modes)
{
    int systems = 0, failures = 0;
    struct random_stream random = {.state = 2024};
    while (systems < 8) {
        struct truth truth;
        int n = 6 + (int)(9 * random_uniform(&random)), npoint = 8 + (int)(8 * random_uniform(&random));
        double zeta = pow(10, -3.3 + 1.8 * random_uniform(&random)), noise = pow(10, -4 + 2.5 * random_uniform(&random));
        double f = 40 + 20 * random_uniform(&random), narrowest = INFINITY;
        truth_beam(n + 2, npoint, 0, 50, zeta, &truth);
        for (int r = 0; r < n + 2; r++) {
            truth.frequency_hz[r] = f;
            narrowest = r < n ? fmin(narrowest, 2 * zeta * f) : narrowest;
            f *= r == 2 && zeta < 1.5e-3 ? 1.005 : fmax(1.05 + 0.3 * random_uniform(&random), 1 + 8 * zeta);
        }
        double low = 0.6 * truth.frequency_hz[0], high = (truth.frequency_hz[n - 1] + truth.frequency_hz[n]) / 2;
        double step = fmin(narrowest / 3, (high - low) / 400);
        if ((high - low) / step > 6000)
            continue;
        struct pool pool;
        struct frf_set set;
        struct ema ema;
        pool_open(&pool, NULL);
        truth_measure(&pool, &truth, FRF_ACCELERATION, low, step, (int)((high - low) / step), noise, 1, &random, &set);
        assert_status(ema_compute(&pool, &set, NULL, NULL, &ema), ROTID_OK);
        int right = ema.nmode == n;
        for (int r = 0; r < n && right; r++)
            right = fabs(ema.mode[r].frequency_hz / truth.frequency_hz[r] - 1) < fmax(0.001, zeta / 2);
        failures += !right;
        systems++;
        pool_close(&pool);
    }
    print_message("%d systems, %d not exactly right\n", systems, failures);
    assert_true(failures <= 1);
}
