/* What the tests of tools/hammer share. */
#ifndef ROTID_TESTS_HAMMER_BENCH_H
#define ROTID_TESTS_HAMMER_BENCH_H

#include "hammer/hammer.h"
#include "support.h"

/* Defaults of the built-in rotor, or the deck of that name in input, of whose moduli others are drawn; the deck is to be freed.
 */
struct hammer_bench {
    struct hammer_options options;
    char *deck;
    int truths;
    const char *const *truth;
};
void hammer_bench_open(const char *rotor, struct hammer_bench *bench);
void hammer_bench_close(struct hammer_bench *bench);

/* Opens the test with the options of the bench; a failure fails the test. */
void hammer_bench_test(const struct hammer_bench *bench, struct hammer_test *test);

/* sum_n y[n] exp(-2 pi i hz n/rate), the plain sum. */
double complex hammer_transform(int count, const double *y, double rate, double hz);

/* Largest |response/force - expected| and largest |expected| at hz = low, low + step, ... below high. */
struct hammer_misfit {
    double error, largest;
};
struct hammer_misfit hammer_compare(const struct hammer_test *test, const double *force, const double *response, double low,
                                    double high, double step,
                                    double complex (*expected)(const struct hammer_test *test, double hz, const void *data),
                                    const void *data);

#endif
