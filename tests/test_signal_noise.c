/* Estimators under noise: what each is blind to, what each sees, and whether the stated variance is the scatter. The system is
 * sampled, x_j = sum of recursions, so that its transfer function is exact and only the noise is left. */
#include "support.h"

#include "signal/signal.h"
#include "struck.h"

#define RATE   1000.0
#define BLOCK  1000 /* samples, a product of 2 and 5 */
#define MOST   (40 * BLOCK)
#define RADIUS 0.99 /* of the poles, which turn by 0.3 pi a sample: 150 Hz, damping 1 % */

struct trial {
    int impacts;
    double force_noise, response_noise;
    int uneven; /* impacts of 50 ... 150 % */
    struct transfer_options options;
};

/* With an exponential window: at i omega + decay. */
static double complex exact(double frequency_hz, double decay)
{
    double complex turn = cexp(CMPLX(-decay / RATE, -2 * PI * frequency_hz / RATE));
    return 1 / (1 - 2 * RADIUS * cos(0.3 * PI) * turn + RADIUS * RADIUS * turn * turn);
}

/* Impacts every BLOCK samples, a record of them all. */
static void run(const struct trial *trial, uint64_t *seed, struct transfer *out)
{
    static double force[MOST + BLOCK], response[MOST + BLOCK];
    long long count = (long long)trial->impacts * BLOCK;
    struct time_record record = {.count = count, .force = force, .response = response};
    struct transfer_options options = trial->options;
    int bad;
    memset(force, 0, sizeof force);
    for (int k = 0; k < trial->impacts; k++) {
        double peak = trial->uneven ? 50 + 100.0 * k / (trial->impacts - 1) : 100;
        force[k * BLOCK + 21] = force[k * BLOCK + 19] = peak / 2;
        force[k * BLOCK + 20] = peak;
    }
    for (long long j = 0; j < count; j++)
        response[j] = force[j] + (j > 0 ? 2 * RADIUS * cos(0.3 * PI) * response[j - 1] : 0) -
                      (j > 1 ? RADIUS * RADIUS * response[j - 2] : 0);
    struck_noise(seed, trial->force_noise, count, force);
    struck_noise(seed, trial->response_noise, count, response);
    options.block = 0.96; /* 960 samples fit before the next impact */
    options.force_window = -1;
    options.high_hz = 300;
    assert_status(transfer_compute(&test_pool, 1, &record, RATE, FRF_ACCELERATION, &options, 1, out, &bad), ROTID_OK);
    assert_int_equal(out->set.frf[0].averages, trial->impacts);
}

/* Mean over trials and lines of H/H_true - 1, by energy: sum conj(H_true) H/sum |H_true|^2 - 1. */
static double bias(const struct trial *trial, int repeats)
{
    uint64_t seed = 11;
    double top = 0, bottom = 0;
    for (int r = 0; r < repeats; r++) {
        struct transfer out;
        run(trial, &seed, &out);
        for (int l = 0; l < out.set.nline; l++) {
            double complex h = exact(out.set.frequency_hz[l], out.set.window_decay);
            top += creal(conj(h) * out.set.frf[0].h[l]);
            bottom += creal(conj(h) * h);
        }
        assert_int_equal(close_test_pool(NULL), 0);
    }
    return top / bottom - 1;
}

/* Noise of variance s per sample has |N|^2 = 960 s; the pulse has |F|^2 = 1e4 (1 + cos w)^2, so the averaged estimates are off by
 * the ratio of noise to signal in the channel that they trust. */
POOL_TEST(each_estimator_is_blind_to_the_noise_of_one_channel)
{
    struct trial on_response = {.impacts = 20, .response_noise = 6}, on_force = {.impacts = 20, .force_noise = 1};
    double b[6];
    for (int e = TRANSFER_H1; e <= TRANSFER_HV; e++) {
        on_response.options.estimator = on_force.options.estimator = e;
        b[e] = bias(&on_response, 20);
        b[3 + e] = bias(&on_force, 20);
    }
    print_message("response noise: H1 %+.4f, H2 %+.4f, Hv %+.4f\n", b[0], b[1], b[2]);
    print_message("force noise:    H1 %+.4f, H2 %+.4f, Hv %+.4f\n", b[3], b[4], b[5]);
    assert_true(fabs(b[TRANSFER_H1]) < 0.002);
    assert_true(b[TRANSFER_H2] > 0.01);
    assert_true(fabs(b[3 + TRANSFER_H2]) < 0.002);
    assert_true(b[3 + TRANSFER_H1] < -0.01);
}

/* Noise in both channels of the same share of their energy: H1 is low, H2 high, Hv in the middle without bias. */
POOL_TEST(hv_is_unbiased_where_both_channels_have_the_same_share_of_noise)
{
    struct trial trial = {.impacts = 20, .force_noise = 1.5};
    struct transfer out;
    uint64_t seed = 1;
    double b[3];
    run(&trial, &seed, &out);
    double ff = 0, xx = 0;
    for (int l = 0; l < out.set.nline; l++) {
        double force = pow(1 + cos(2 * PI * out.set.frequency_hz[l] / RATE), 2);
        ff += force;
        xx += force * pow(cabs(exact(out.set.frequency_hz[l], out.set.window_decay)), 2);
    }
    trial.response_noise = trial.force_noise * sqrt(xx / ff);
    for (int e = TRANSFER_H1; e <= TRANSFER_HV; e++) {
        trial.options.estimator = e;
        b[e] = bias(&trial, 40);
    }
    print_message("noise on both: H1 %+.4f, H2 %+.4f, Hv %+.4f\n", b[0], b[1], b[2]);
    assert_true(b[0] < -0.01 && b[1] > 0.01 && fabs(b[2]) < 0.003);
}

/* Hv by the definition of an eigenvector, and free of units. */
UNIT_TEST(hv_is_the_eigenvector_of_the_larger_eigenvalue)
{
    static const double scale[] = {1, 1e-6, 1e6};
    double complex h[3];
    for (int i = 0; i < 3; i++) {
        double ff = 2, xx = 5 * scale[i] * scale[i];
        double complex xf = CMPLX(1.5, -2) * scale[i];
        struct spectra sum = {&ff, &xx, &xf};
        double balance = estimator_balance(1, &sum);
        assert_close(balance, xx / ff, 1e-15, 0);
        for (int b = 0; b < 3; b++) {
            double s = sqrt(balance * pow(10, b - 1)); /* any balance, on both sides of the difference of two large numbers */
            estimator_transfer(TRANSFER_HV, s * s, 1, &sum, &h[i]);
            double a11 = ff, a22 = xx / (s * s);
            double complex a21 = xf / s, v = h[i] / s; /* (1, v) */
            double lambda = creal(a11 + conj(a21) * v);
            assert_close(cabs(a21 + a22 * v - lambda * v), 0, 0, 1e-12 * lambda);
            assert_true(lambda > a11 + a22 - lambda);
        }
        estimator_transfer(TRANSFER_HV, balance, 1, &sum, &h[i]);
        assert_close(cabs(h[i] / scale[i] - h[0]), 0, 0, 1e-12);
    }
}

/* gamma^2 = 1/(1 + 1/SNR), SNR = |H F|^2/(noise of the response), up to the bias (1 - gamma^2)^2/K of K impacts. */
POOL_TEST(coherence_tells_the_signal_to_noise_ratio)
{
    struct trial trial = {.impacts = 40, .response_noise = 8};
    uint64_t seed = 5;
    double sum = 0, expected = 0, lowest = 1;
    int count = 0;
    for (int r = 0; r < 20; r++) {
        struct transfer out;
        run(&trial, &seed, &out);
        for (int l = 0; l < out.set.nline; l++) {
            double f = out.set.frequency_hz[l], signal = pow(100 * (1 + cos(2 * PI * f / RATE)) * cabs(exact(f, 0)), 2);
            double truth = 1 / (1 + 960 * 64 / signal);
            expected += truth + (1 - truth) * (1 - truth) / 40;
            lowest = fmin(lowest, truth);
            sum += out.set.frf[0].coherence[l];
            count++;
        }
        assert_int_equal(close_test_pool(NULL), 0);
    }
    print_message("mean coherence %.4f, expected %.4f, lowest %.2f\n", sum / count, expected / count, lowest);
    assert_close(sum / count, expected / count, 0, 0.003);
    assert_true(lowest < 0.3);
}

/* Mean of |H - H_true|^2 over mean variance, and the largest deviation from 1 of the mean over bands of 40 lines. */
static double honesty(const struct trial *trial, int repeats, double *worst_band)
{
    uint64_t seed = 3;
    double error = 0, variance = 0, band_error[10] = {0}, band_variance[10] = {0};
    for (int r = 0; r < repeats; r++) {
        struct transfer out;
        run(trial, &seed, &out);
        for (int l = 0; l < out.set.nline; l++) {
            double distance = pow(cabs(out.set.frf[0].h[l] - exact(out.set.frequency_hz[l], out.set.window_decay)), 2);
            error += distance;
            variance += out.set.frf[0].variance[l];
            band_error[l / 40] += distance;
            band_variance[l / 40] += out.set.frf[0].variance[l];
        }
        assert_int_equal(close_test_pool(NULL), 0);
    }
    *worst_band = 0;
    for (int b = 0; b < 10; b++)
        if (band_variance[b] > 0)
            *worst_band = fmax(*worst_band, fabs(band_error[b] / band_variance[b] - 1));
    return error / variance;
}

POOL_TEST(variance_is_the_scatter_of_the_estimate)
{
    static const struct trial trial[] = {
        {.impacts = 2, .response_noise = 2},
        {.impacts = 3, .response_noise = 2},
        {.impacts = 3, .response_noise = 2, .uneven = 1},
        {.impacts = 5, .response_noise = 2, .uneven = 1},
        {.impacts = 5, .response_noise = 2, .options = {.exponential = 0.01}},
        {.impacts = 5, .force_noise = 0.3},
        {.impacts = 5, .force_noise = 0.3, .options = {.estimator = TRANSFER_H2}},
        {.impacts = 5, .force_noise = 0.2, .response_noise = 1, .options = {.estimator = TRANSFER_HV}},
    };
    for (size_t t = 0; t < sizeof trial / sizeof *trial; t++) {
        double worst, ratio = honesty(&trial[t], 400, &worst);
        print_message(
            "%d impacts%s, noise %.1f on force, %.1f on response: |error|^2/variance %.3f, in bands of 40 lines within %.2f\n",
            trial[t].impacts, trial[t].uneven ? " of unequal force" : "", trial[t].force_noise, trial[t].response_noise, ratio,
            worst);
        /* noise of the force follows |H|^2, which bends within the 31 lines that share a variance, and biases H1 */
        assert_true(trial[t].force_noise > 0 ? ratio > 0.85 && ratio < 1.2 : ratio > 0.97 && ratio < 1.03);
        assert_true(worst < (trial[t].force_noise > 0 ? 0.5 : 0.12));
    }
}

/* S_nn/sum |F|^2 line by line, and how much the smoothed variance scatters about it. */
POOL_TEST(smoothed_variance_has_many_degrees_of_freedom)
{
    struct trial trial = {.impacts = 3, .response_noise = 2};
    uint64_t seed = 8;
    double squares = 0, largest = 0;
    int count = 0;
    for (int r = 0; r < 100; r++) {
        struct transfer out;
        run(&trial, &seed, &out);
        for (int l = 0; l < out.set.nline; l++) {
            double force = pow(100 * (1 + cos(2 * PI * out.set.frequency_hz[l] / RATE)), 2);
            double ratio = out.set.frf[0].variance[l] / (960 * 4 / (3 * force));
            squares += (ratio - 1) * (ratio - 1);
            largest = fmax(largest, fmax(ratio, 1 / ratio));
            count++;
        }
        assert_int_equal(close_test_pool(NULL), 0);
    }
    double deviation = sqrt(squares / count);
    print_message("variance scatters by %.2f, factor %.1f at most\n", deviation, largest);
    assert_true(deviation < 0.16); /* 1/sqrt(2 * 31) = 0.127, more at the ends; of single lines it would be 0.71 */
    assert_true(largest < 2.5);
}

/* A resonance where the impacts scatter does not spoil the lines beside it, nor do these hide it; what is flat stays flat. */
UNIT_TEST(smoothing_keeps_a_peak_to_itself)
{
    enum { LINES = 200, PEAK = 100 };
    double force[LINES], variance[LINES], work[LINES + 2 * ESTIMATOR_SMOOTH + 2];
    for (int n = 1; n <= LINES; n += n < 2 ? 1 : 198) {
        for (int l = 0; l < n; l++) {
            force[l] = 1 + l; /* flat noise of the response is no flat variance */
            variance[l] = (l >= PEAK && l < PEAK + 3 ? 900 + 100 * (l - PEAK) : 1 + 0.5 * (l % 2)) / force[l];
        }
        estimator_smooth(n, force, variance, work);
        for (int l = 0; l < n; l++)
            if (l >= PEAK && l < PEAK + 3)
                assert_close(variance[l] * force[l], 1000, 1e-12, 0);
            else
                assert_close(variance[l] * force[l], n == 1 ? 1 : 1.25, 0.03, 0);
    }
}
