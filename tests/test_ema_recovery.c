/* Modes come back from transfer functions summed in closed form. */
#include "ema_truth.h"
#include "support.h"

static void compute(const struct frf_set *set, const struct ema_options *options, struct ema *out)
{
    assert_status(ema_compute(&test_pool, set, options, NULL, out), ROTID_OK);
}

/* The modes of the truth inside the band, no more and no less. */
static void assert_modes(const struct ema *ema, const struct truth *truth, int n, double frequency, double damping)
{
    assert_int_equal(ema->nmode, n);
    for (int r = 0; r < n; r++) {
        assert_close(ema->mode[r].frequency_hz, truth->frequency_hz[r], frequency, 0);
        assert_close(ema->mode[r].damping, truth->damping[r], damping, 0);
    }
}

POOL_TEST(poles_are_exact_without_noise)
{
    for (int q = FRF_DISPLACEMENT; q <= FRF_ACCELERATION; q++) {
        struct truth truth;
        struct frf_set set;
        struct ema ema;
        truth_beam(4, 9, 0, 60, 2e-3, &truth);
        truth_measure(&test_pool, &truth, (enum frf_quantity)q, 20, 0.1, 6500, 0, 0, NULL, &set);
        compute(&set, NULL, &ema);
        assert_modes(&ema, &truth, 4, 1e-8, 1e-6);
        for (int r = 0; r < 4; r++) {
            /* A = phi_j phi_d/(2 i omega_d m) */
            double wd = TWO_PI * truth.frequency_hz[r] * sqrt(1 - truth.damping[r] * truth.damping[r]);
            for (int j = 0; j < 9; j++) {
                assert_close(cimag(ema.mode[r].residue[j]), -truth.phi[r][j] * truth.phi[r][0] / (2 * wd), 1e-5, 1e-9 / wd);
                assert_close(ema.mode[r].shape[j] * truth.phi[r][0], truth.phi[r][j] * ema.mode[r].shape[0], 1e-5, 1e-7);
            }
            assert_close(ema.mode[r].modal_mass, 1, 1e-5, 0);
            assert_close(ema.mode[r].mpc, 1, 1e-8, 0);
            assert_close(ema.mac[r + 4 * r], 1, 1e-12, 0);
        }
    }
}

POOL_TEST(modes_outside_the_band_leave_the_inner_ones_alone)
{
    struct truth truth;
    struct frf_set set;
    struct ema ema;
    truth_beam(12, 9, 0, 60, 5e-3, &truth);
    truth_measure(&test_pool, &truth, FRF_ACCELERATION, 20, 0.2, 3300, 0, 0, NULL, &set);
    compute(&set, NULL, &ema);
    assert_modes(&ema, &truth, 4, 1e-5, 2e-3);
}

/* Four modes of a beam, the third `ratio` times the second, with noise: lines from 20 Hz in steps. */
static void measure_close(int points, double damping, double ratio, double step, int nline, unsigned long seed,
                          struct truth *truth, struct frf_set *set)
{
    struct random_stream random = {.state = seed};
    truth_beam(4, points, 0, 60, damping, truth);
    truth->frequency_hz[2] = truth->frequency_hz[1] * ratio;
    truth_measure(&test_pool, truth, FRF_ACCELERATION, 20, step, nline, 1e-3, 1, &random, set);
}

POOL_TEST(two_modes_half_a_percent_apart)
{
    struct truth truth;
    struct frf_set set;
    struct ema ema;
    measure_close(9, 1e-3, 1.005, 0.05, 8000, 7, &truth, &set);
    compute(&set, NULL, &ema);
    assert_int_equal(ema.nmode, 3);
    for (int r = 0; r < 3; r++) {
        assert_close(ema.mode[r].frequency_hz, truth.frequency_hz[r], 1e-5, 0);
        assert_close(ema.mode[r].damping, truth.damping[r], 1e-2, 0);
    }
    assert_true(!(ema.mode[0].quality_flags & EMA_CLOSE));
    assert_int_equal(ema.std_from_impacts, 1);
}

/* Poles that are not refined are off alike in all channels, so that more channels make the scatter less and not the error. */
POOL_TEST(deviations_of_poles_that_are_not_refined_hold_their_error)
{
    struct truth truth;
    struct frf_set set;
    struct ema ema;
    measure_close(8, 3e-3, 1.02, 0.25, 2400, 1, &truth, &set);
    struct ema_options options = {.no_refinement = 1};
    compute(&set, &options, &ema);
    assert_int_equal(ema.nmode, 4);
    for (int r = 0; r < 4; r++) {
        assert_close(ema.mode[r].frequency_hz, truth.frequency_hz[r], 0, 1.5 * ema.mode[r].frequency_std);
        assert_close(ema.mode[r].damping, truth.damping[r], 0, 1.5 * ema.mode[r].damping_std);
    }
}

POOL_TEST(the_window_comes_off_the_damping)
{
    struct truth truth;
    struct frf_set set;
    struct ema ema;
    truth_beam(1, 5, 0, 60, 5e-3, &truth);
    truth_measure(&test_pool, &truth, FRF_ACCELERATION, 20, 0.1, 1000, 0, 0, NULL, &set);
    set.window_decay = 0.8;
    compute(&set, NULL, &ema);
    double w = TWO_PI * truth.frequency_hz[0];
    assert_int_equal(ema.nmode, 1);
    assert_close(creal(ema.mode[0].pole), -truth.damping[0] * w + 0.8, 1e-6, 0);
    /* and the synthesis puts it back on */
    double complex h[2];
    ema_synthesise(&ema, &set, 0, 2, set.frequency_hz + 400, h);
    assert_close(cabs(h[0] - set.frf[0].h[400]), 0, 0, 1e-6 * cabs(h[0]));
}

/* A mass m at the point that is measured: f_j = f (1 - m phi_j^2/(2 M)), up to 0.9 % where the half-power bandwidth is 0.4 %. */
static void a_moving_mass(int with_variance)
{
    struct truth truth;
    struct frf_set set;
    struct ema ema;
    struct random_stream random = {.state = 11};
    truth_beam(5, 13, 0, 60, 2e-3, &truth);
    truth.moving_mass = 0.018;
    truth_measure(&test_pool, &truth, FRF_ACCELERATION, 30, 0.1, 4500, 1e-3, with_variance, &random, &set);
    struct ema_options options = {.per_point = 1};
    compute(&set, &options, &ema);
    assert_int_equal(ema.nmode, 3);
    for (int r = 0; r < 3; r++) {
        assert_true(ema.mode[r].quality_flags & EMA_DOUBLE_PEAK);
        assert_non_null(ema.mode[r].local_pole);
        double known[13], median;
        size_t count = 0;
        for (int j = 0; j < 13; j++)
            if (isfinite(ema.mode[r].point_frequency_hz[j]))
                known[count++] = ema.mode[r].point_frequency_hz[j];
        median = median_of(count, known);
        assert_close(ema.mode[r].frequency_hz, median, 1e-12, 0);
        for (size_t j = 0; j < count; j++)
            known[j] = fabs(known[j] - median);
        /* of normal numbers the median distance is 0.6745 standard deviations, and their median scatters by sqrt(pi/2) of the
         * mean */
        assert_close(ema.mode[r].frequency_std, sqrt(1.570796 / (double)count) * median_of(count, known) / 0.67449, 1e-3, 0);
        for (int j = 0; j < 13; j++) {
            double shifted = truth.frequency_hz[r] * (1 - truth.moving_mass * truth.phi[r][j] * truth.phi[r][j] / 2);
            if (fabs(truth.phi[r][j]) > 0.15)
                assert_close(ema.mode[r].point_frequency_hz[j], shifted, 2e-4, 0);
            if (fabs(truth.phi[r][j]) > 0.15)
                assert_close(ema.mode[r].shape[j], truth.phi[r][j] * ema.mode[r].shape[0], 0.05, 0);
        }
    }
}

POOL_TEST(a_moving_mass_shifts_each_point)
{
    a_moving_mass(1);
    a_moving_mass(0);
}

POOL_TEST(nothing_to_find)
{
    struct truth truth;
    struct frf_set set;
    struct ema ema;
    struct random_stream random = {.state = 3};
    truth_beam(1, 6, 0, 60, 5e-3, &truth);
    truth_measure(&test_pool, &truth, FRF_ACCELERATION, 200, 0.5, 800, 1e-2, 1, &random, &set);
    compute(&set, NULL, &ema);
    assert_int_equal(ema.nmode, 0);
}

POOL_TEST(one_channel_and_picked_frequencies)
{
    struct truth truth;
    struct frf_set set;
    struct ema ema;
    struct random_stream random = {.state = 5};
    truth_beam(3, 1, 0, 60, 5e-3, &truth);
    truth_measure(&test_pool, &truth, FRF_ACCELERATION, 20, 0.2, 2000, 1e-3, 1, &random, &set);
    compute(&set, NULL, &ema);
    assert_modes(&ema, &truth, 3, 1e-4, 2e-2);
    double pick[2] = {truth.frequency_hz[2] * 1.003, truth.frequency_hz[0]};
    struct ema_options options = {.npick = 2, .pick_hz = pick};
    compute(&set, &options, &ema);
    assert_int_equal(ema.nmode, 2);
    assert_close(ema.mode[0].frequency_hz, truth.frequency_hz[0], 1e-4, 0);
    assert_close(ema.mode[1].frequency_hz, truth.frequency_hz[2], 1e-4, 0);
}

POOL_TEST(quadrature_picking_finds_the_peaks)
{
    struct truth truth;
    struct frf_set set;
    struct ema ema;
    truth_beam(4, 9, 0, 60, 5e-3, &truth);
    for (int q = FRF_DISPLACEMENT; q <= FRF_ACCELERATION; q++) {
        truth_measure(&test_pool, &truth, (enum frf_quantity)q, 20, 0.05, 13000, 0, 0, NULL, &set);
        struct ema_options options = {.method = EMA_QUADRATURE};
        compute(&set, &options, &ema);
        assert_modes(&ema, &truth, 4, 1e-4, 2e-2);
        for (int r = 0; r < 4; r++)
            for (int j = 0; j < 9; j++)
                assert_close(ema.mode[r].shape[j] * truth.phi[r][0], truth.phi[r][j] * ema.mode[r].shape[0], 0.02, 0.01);
    }
}
