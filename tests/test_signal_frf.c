/* Conversions between quantities, bands, and the FRAC. */
#include "support.h"

#include <math.h>

#include "struck.h"

#define LINES 50

static const struct struck_mode modes[] = {{40, 0.02, 0.5}, {90, 0.01, -0.3}};

struct bench {
    double frequency_hz[LINES], variance[LINES], coherence[LINES];
    double complex h[LINES];
    struct frf frf[2];
    struct frf_set set;
};

static double complex truth(enum frf_quantity quantity, double decay, double frequency_hz)
{
    struct struck hammer = {2, modes, quantity, 0, 0};
    return struck_transfer(&hammer, CMPLX(decay, 2 * PI * frequency_hz));
}

static void fill(struct bench *bench, enum frf_quantity quantity, double first_hz, double decay)
{
    static double complex other[LINES];
    *bench = (struct bench){.set = {LINES, bench->frequency_hz, quantity, decay, 2, bench->frf}};
    for (int l = 0; l < LINES; l++) {
        bench->frequency_hz[l] = first_hz + 3 * l;
        bench->h[l] = truth(quantity, decay, bench->frequency_hz[l]);
        bench->variance[l] = pow(cabs(bench->h[l]), 2) / 100;
        bench->coherence[l] = l;
    }
    bench->frf[0] = (struct frf){.h = bench->h, .variance = bench->variance, .coherence = bench->coherence};
    bench->frf[1] = (struct frf){.h = other}; /* without variance and coherence */
}

static void quantities_differ_by_powers_of_s(void **state)
{
    static const double first[] = {0, 5}, decay[] = {0, 7};
    (void)state;
    for (enum frf_quantity from = FRF_DISPLACEMENT; from <= FRF_ACCELERATION; from++)
        for (enum frf_quantity to = FRF_DISPLACEMENT; to <= FRF_ACCELERATION; to++)
            for (int c = 0; c < 4; c++) {
                struct bench bench;
                fill(&bench, from, first[c % 2], decay[c / 2]);
                frf_convert(&bench.set, to);
                int dropped = from != to && c == 0; /* 0 Hz without a window */
                assert_int_equal(bench.set.quantity, to);
                assert_int_equal(bench.set.nline, LINES - dropped);
                for (int l = 0; l < bench.set.nline; l++) {
                    double complex exact = truth(to, decay[c / 2], bench.set.frequency_hz[l]), h = bench.set.frf[0].h[l];
                    assert_true(cabs(h - exact) <= 1e-13 * cabs(exact));
                    assert_close(bench.set.frf[0].variance[l], pow(cabs(exact), 2) / 100, 1e-12, 0);
                    assert_true(bench.set.frf[0].coherence[l] == l + dropped);
                }
                assert_null(bench.set.frf[1].variance);
                assert_null(bench.set.frf[1].coherence);
            }
}

static void a_band_leaves_its_lines(void **state)
{
    static const double low[] = {-1, 5, 11, 12, 40, 152.5, 500}, high[] = {1000, 152, 11, 20, 30, 1000, 600};
    (void)state;
    for (int b = 0; b < 7; b++) {
        struct bench bench;
        fill(&bench, FRF_VELOCITY, 5, 0);
        frf_cut(&bench.set, low[b], high[b]);
        int expected = 0;
        for (int l = 0; l < LINES; l++)
            if (5 + 3 * l >= low[b] && 5 + 3 * l <= high[b]) {
                assert_true(bench.set.frequency_hz[expected] == 5 + 3 * l);
                assert_true(bench.set.frf[0].h[expected] == bench.h[l]);
                assert_true(bench.set.frf[0].variance[expected] == bench.variance[l]);
                assert_true(bench.set.frf[0].coherence[expected] == l);
                expected++;
            }
        assert_int_equal(bench.set.nline, expected);
    }
}

static void frac_is_one_for_multiples_and_zero_across(void **state)
{
    static const double scale[] = {1e-200, 1, 1e200};
    static const double complex zero[4];
    double complex a[4] = {1, 2 * I, -3, CMPLX(1, 1)}, b[4], across[4] = {2 * I, 1, 0, 0};
    (void)state;
    for (int s = 0; s < 3; s++) {
        for (int l = 0; l < 4; l++)
            b[l] = CMPLX(-0.3, 2) * a[l] * scale[s];
        assert_close(frf_assurance(4, a, b), 1, 1e-14, 0);
        assert_close(frf_assurance(4, b, b), 1, 1e-14, 0);
    }
    across[0] = conj(2 * I), across[1] = 1; /* a^H across = -2i - 2i */
    assert_close(frf_assurance(4, a, across), 16.0 / (16 * 5), 1e-14, 0);
    across[0] = 2, across[1] = -I; /* 2 - 2i(-i)... = 2 - 2 */
    assert_close(frf_assurance(4, a, across), 0, 0, 1e-28);
    assert_true(frf_assurance(4, a, zero) == 0);
    assert_true(frf_assurance(0, a, a) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantities_differ_by_powers_of_s),
        cmocka_unit_test(a_band_leaves_its_lines),
        cmocka_unit_test(frac_is_one_for_multiples_and_zero_across),
    };
    return cmocka_run_group_tests_name("signal_frf", tests, NULL, NULL);
}
