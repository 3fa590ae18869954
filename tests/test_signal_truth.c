/* Transfer functions of simulated hammer tests against the exact ones of the continuous system, and poles after the exponential
 * window. What is left are the aliases of the pulse, whose spectrum falls with the square of the frequency, and single precision.
 */
#include "support.h"

#include "struck.h"

static const struct struck_mode single[] = {{50, 0.02, 0.5}};
static const struct struck_mode three[] = {{40, 0.02, 0.5}, {90, 0.01, -0.3}, {170, 0.015, 0.4}};

/* One impact, its transfer function up to high_hz. */
static struct frf_set measure(const struct struck *hammer, double seconds, const struct transfer_options *options)
{
    struct transfer out;
    int bad;
    struct time_record record = struck_record((long long)(seconds * hammer->rate));
    struck_hit(hammer, 0.02, 100, record.count, struck_force(&record), struck_response(&record));
    assert_status(transfer_compute(&test_pool, 1, &record, hammer->rate, hammer->quantity, options, 1, &out, &bad), ROTID_OK);
    assert_int_equal(bad, -1);
    assert_int_equal(out.nimpact, 1);
    assert_true(out.impact[0].used && out.impact[0].tail < 1e-2);
    assert_int_equal(out.set.nfrf, 1);
    assert_int_equal(out.set.frf[0].averages, 1);
    assert_null(out.set.frf[0].variance);
    assert_null(out.set.frf[0].coherence);
    return out.set;
}

/* Largest error relative to the largest |H|. */
static double error_of(const struct struck *hammer, const struct frf_set *set)
{
    double worst = 0, largest = 0;
    for (int l = 0; l < set->nline; l++) {
        double complex exact = struck_transfer(hammer, CMPLX(set->window_decay, 2 * PI * set->frequency_hz[l]));
        worst = fmax(worst, cabs(set->frf[0].h[l] - exact));
        largest = fmax(largest, cabs(exact));
    }
    return worst / largest;
}

POOL_TEST(transfer_functions_are_those_of_the_continuous_system)
{
    static const enum frf_quantity quantity[] = {FRF_DISPLACEMENT, FRF_VELOCITY, FRF_ACCELERATION};
    for (int q = 0; q < 3; q++)
        for (int system = 0; system < 2; system++)
            for (int estimator = TRANSFER_H1; estimator <= TRANSFER_HV; estimator++) {
                struct struck hammer = {system ? 3 : 1, system ? three : single, quantity[q], 0.004, 51200};
                struct transfer_options options = {.estimator = estimator, .high_hz = 200};
                struct frf_set set = measure(&hammer, 4, &options);
                double error = error_of(&hammer, &set);
                if (estimator == TRANSFER_H1)
                    print_message("quantity %d, %d modes: error %.1e of the largest |H|\n", q, hammer.nmode, error);
                assert_true(error < 2e-5);
                assert_int_equal(set.quantity, quantity[q]);
                assert_true(set.window_decay == 0);
                assert_close(set.frequency_hz[0], set.frequency_hz[1] - set.frequency_hz[0], 1e-12, 0);
                assert_true(set.frequency_hz[set.nline - 1] <= 200);
            }
}

/* The pulse sampled twice as densely has a quarter of the aliases. */
POOL_TEST(what_is_left_are_the_aliases_of_the_pulse)
{
    double error[2];
    for (int i = 0; i < 2; i++) {
        struct struck hammer = {3, three, FRF_DISPLACEMENT, 0.005, i ? 12800 : 6400};
        struct transfer_options options = {.high_hz = 200};
        struct frf_set set = measure(&hammer, 4, &options);
        error[i] = error_of(&hammer, &set);
    }
    print_message("errors %.2e and %.2e\n", error[0], error[1]);
    assert_close(error[0] / error[1], 4, 0.1, 0);
}

/* Of one degree of freedom, 1/H = (s^2 - 2 Re(pole) s + |pole|^2)/R: linear in its two unknowns, from one line. */
static double complex pole_from(double complex h, double omega, double residue)
{
    double complex inverse = residue / h + omega * omega;
    double decay = cimag(inverse) / omega / 2, square = creal(inverse);
    return CMPLX(-decay, sqrt(square - decay * decay));
}

/* The block ends long before the motion does; with the window it is as if it did not, and the pole comes back exactly. */
POOL_TEST(the_exponential_window_shifts_poles_by_its_decay)
{
    static const struct struck_mode light[] = {{50, 0.001, 0.5}};
    static const double end[] = {1e-3, 1e-5, 1e-7};
    double complex exact = struck_pole(light);
    for (int i = 0; i < 3; i++) {
        struct struck hammer = {1, light, FRF_DISPLACEMENT, 0.004, 51200};
        struct transfer_options options = {.exponential = end[i], .low_hz = 30, .high_hz = 80};
        struct frf_set set = measure(&hammer, 2, &options);
        assert_close(set.window_decay, -log(end[i]) * (set.frequency_hz[1] - set.frequency_hz[0]), 1e-9, 0);
        double worst = 0, damping = 0;
        for (int l = 0; l < set.nline; l++) {
            /* both poles of the windowed system are lambda - decay, so 1/H = ((i omega + decay)^2 + ...)/R */
            double complex pole = pole_from(set.frf[0].h[l], 2 * PI * set.frequency_hz[l], light->residue) + set.window_decay;
            worst = fmax(worst, cabs(pole - exact) / cabs(exact));
            damping = fmax(damping, fabs(-creal(pole) / cabs(pole) / light->damping - 1));
        }
        print_message("window to %.0e: pole off by %.1e at most, damping ratio by %.1e\n", end[i], worst, damping);
        assert_true(worst < 2 * end[i] + 2e-5); /* what the block cuts off, and aliases */
        if (end[i] < 1e-4)
            assert_true(error_of(&hammer, &set) < 2e-5 + end[i]);
    }
}

/* Sampled systems have exact transfer functions of their own: y_j = a y_(j-1) + f_j gives 1/(1 - a exp(-i omega dt)) for any
 * force, and a exp(-decay dt) in place of a with the window. No aliases, so single precision is all that is left. */
POOL_TEST(windowed_recursion_is_exact_to_single_precision)
{
    const double a = 0.999;
    struct transfer_options options = {.exponential = 1e-6};
    struct transfer out;
    int bad;
    struct time_record record = struck_record(4096);
    double *f = struck_force(&record), *y = struck_response(&record), worst = 0, largest = 0;
    f[200] = 3, f[201] = 10, f[202] = 5, f[203] = 2;
    for (int j = 1; j < 4096; j++)
        y[j] = a * y[j - 1] + f[j];
    assert_status(transfer_compute(&test_pool, 1, &record, 1000, FRF_DISPLACEMENT, &options, 1, &out, &bad), ROTID_OK);
    for (int l = 0; l < out.set.nline; l++) {
        double complex turn = cexp(-CMPLX(out.set.window_decay, 2 * PI * out.set.frequency_hz[l]) / 1000);
        worst = fmax(worst, cabs(out.set.frf[0].h[l] - 1 / (1 - a * turn)));
        largest = fmax(largest, cabs(1 / (1 - a * turn)));
    }
    print_message("error %.1e of the largest |H| on all lines\n", worst / largest);
    assert_true(worst < 1e-6 * largest);
}
