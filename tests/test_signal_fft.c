/* The transform against its definition in double precision, Parseval's theorem, and lengths. */
#include "support.h"

#include "signal/signal.h"

#define MOST 6000

static double x[MOST];
static double complex line[MOST / 2 + 1];

static void fill(int n, uint64_t seed)
{
    struct random_stream stream = {seed};
    for (int j = 0; j < n; j++)
        x[j] = random_normal(&stream);
}

/* Angles are reduced in integers, so that the reference is exact to double precision. */
static double complex definition(int n, int k)
{
    double complex sum = 0;
    for (int j = 0; j < n; j++)
        sum += x[j] * cexp(-2 * I * PI * (double)((long long)j * k % n) / n);
    return sum;
}

static double power(int n)
{
    double sum = 0;
    for (int j = 0; j < n; j++)
        sum += x[j] * x[j];
    return sum;
}

POOL_TEST(lines_are_those_of_the_definition)
{
    static const int length[] = {2, 4, 6, 10, 14, 30, 62, 128, 750, 1000, 1024, 1934, 2250, 4096};
    double worst = 0, worst_rms = 0;
    for (size_t l = 0; l < sizeof length / sizeof *length; l++) {
        struct fft fft;
        int n = length[l];
        double squares = 0;
        fill(n, (uint64_t)n);
        assert_status(fft_open(&test_pool, n, &fft), ROTID_OK);
        fft_real(&fft, x, line);
        for (int k = 0; k <= n / 2; k++) {
            double error = cabs(line[k] - definition(n, k));
            assert_true(error <= FFT_ACCURACY * sqrt(n * power(n)));
            worst = fmax(worst, error / sqrt(n * power(n)));
            squares += error * error;
        }
        if (fft_length(n) == n) /* rounding grows with the largest prime factor */
            worst_rms = fmax(worst_rms, sqrt(squares / (n / 2 + 1) / power(n)));
    }
    print_message("largest error %.1e of sqrt(n sum x^2), root mean square %.1e of that of the lines\n", worst, worst_rms);
    assert_true(worst_rms < 2e-7);
}

POOL_TEST(energy_is_kept)
{
    static const int length[] = {2, 48, 486, 5000};
    for (size_t l = 0; l < sizeof length / sizeof *length; l++) {
        struct fft fft;
        int n = length[l];
        fill(n, 7);
        assert_status(fft_open(&test_pool, n, &fft), ROTID_OK);
        fft_real(&fft, x, line);
        double sum = 0;
        for (int k = 0; k <= n / 2; k++)
            sum += (k == 0 || k == n / 2 ? 1 : 2) * pow(cabs(line[k]), 2);
        assert_close(sum / n, power(n), 1e-6, 0);
    }
}

/* A scale by a power of two changes no digit, wherever single precision would overflow or underflow. */
POOL_TEST(units_do_not_matter)
{
    static const int exponent[] = {-1000, -160, -40, 0, 40, 160, 1000};
    static double complex first[51];
    struct fft fft;
    assert_status(fft_open(&test_pool, 100, &fft), ROTID_OK);
    for (size_t e = 0; e < sizeof exponent / sizeof *exponent; e++) {
        fill(100, 3);
        for (int j = 0; j < 100; j++)
            x[j] = ldexp(x[j], exponent[e]);
        fft_real(&fft, x, line);
        for (int k = 0; k <= 50; k++) {
            double complex scaled = CMPLX(ldexp(creal(line[k]), -exponent[e]), ldexp(cimag(line[k]), -exponent[e]));
            if (e == 0)
                first[k] = scaled;
            assert_true(scaled == first[k]);
        }
    }
    for (int j = 0; j < 100; j++)
        x[j] = 0;
    fft_real(&fft, x, line);
    for (int k = 0; k <= 50; k++)
        assert_true(line[k] == 0);
}

static int is_smooth(int n)
{
    if (n < 2 || n % 2)
        return 0;
    for (int p = 2; p <= 5; p++)
        while (n % p == 0)
            n /= p;
    return n == 1;
}

UNIT_TEST(length_is_the_largest_with_small_factors)
{
    int best = 0;
    for (int n = -2; n < 20000; n++) {
        if (is_smooth(n))
            best = n;
        assert_int_equal(fft_length(n), best);
        if (n >= 8)
            assert_true(best >= 0.8 * n);
    }
    assert_int_equal(fft_length(51200), 51200);
    assert_int_equal(fft_length(1LL << 60), FFT_LONGEST);
    assert_int_equal(fft_length(-(1LL << 60)), 0);
}

POOL_TEST(impossible_lengths_are_refused)
{
    static const int length[] = {-2, 0, 1, 3, 999, FFT_LONGEST + 2};
    struct fft fft;
    for (size_t l = 0; l < sizeof length / sizeof *length; l++)
        assert_status(fft_open(&test_pool, length[l], &fft), ROTID_ERROR_ARGUMENT);
}
