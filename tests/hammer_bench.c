#include "hammer_bench.h"

#include "hidden.h"

static const double two_pi = 6.28318530717958647692;

void hammer_bench_open(const char *rotor, struct hammer_bench *bench)
{
    bench->options = hammer_options_default();
    bench->truths = 0;
    bench->truth = NULL;
    if (strstr(rotor, ".inp")) {
        char path[256];
        (void)snprintf(path, sizeof path, "%s/input/%s", ROTID_SOURCE_DIR, rotor);
        bench->deck = hidden_read(path);
    } else {
        bench->deck = hammer_rotor_deck(rotor, &bench->options, &bench->truths, &bench->truth);
    }
    assert_non_null(bench->deck);
}

void hammer_bench_close(struct hammer_bench *bench)
{
    free(bench->deck);
}

void hammer_bench_test(const struct hammer_bench *bench, struct hammer_test *test)
{
    char message[600] = "";
    if (hammer_open(bench->deck, "deck", bench->truths, bench->truth, 1, &bench->options, test, message, sizeof message))
        fail_msg("%s", message);
}

double complex hammer_transform(int count, const double *y, double rate, double hz)
{
    double complex sum = 0;
    for (int n = 0; n < count; n++)
        sum += y[n] * cexp(CMPLX(0, -two_pi * hz * n / rate));
    return sum;
}

struct hammer_misfit hammer_compare(const struct hammer_test *test, const double *force, const double *response, double low,
                                    double high, double step,
                                    double complex (*expected)(const struct hammer_test *test, double hz, const void *data),
                                    const void *data)
{
    struct hammer_misfit misfit = {0, 0};
    for (double hz = low; hz < high; hz += step) {
        double complex h = hammer_transform(test->count, response, test->options.rate, hz) /
                           hammer_transform(test->count, force, test->options.rate, hz);
        double complex truth = expected(test, hz, data);
        misfit.error = fmax(misfit.error, cabs(h - truth));
        misfit.largest = fmax(misfit.largest, cabs(truth));
    }
    return misfit;
}
