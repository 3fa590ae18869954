/* What every test uses. cmocka's own comparison of floating-point numbers casts to float, so tests compare with assert_close. */
#ifndef ROTID_TESTS_SUPPORT_H
#define ROTID_TESTS_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/base.h"
#include "rotid.h"

#ifndef ROTID_SOURCE_DIR
#define ROTID_SOURCE_DIR "."
#endif

/* |value - expected| <= rtol |expected| + atol; a failure prints both numbers and the place. */
#define assert_close(value, expected, rtol, atol) assert_close_at((value), (expected), (rtol), (atol), #value, __FILE__, __LINE__)
void assert_close_at(double value, double expected, double rtol, double atol, const char *text, const char *file, int line);

/* Largest |a_i - b_i| over largest |b_i|. */
double relative_difference(size_t count, const double *a, const double *b);

/* An allocator that fails at the n-th allocation from now (n = 1, 2, ...; 0: never) and counts what is in use. */
struct failing_allocator {
    rotid_allocator allocator;
    long until_failure, in_use, served;
};
void failing_allocator_open(struct failing_allocator *failing, long fail_at);

/* A pool for one test at a time, as setup and teardown of cmocka; the state of the test. */
extern struct pool test_pool;
int open_test_pool(void **state);
int close_test_pool(void **state);

/* A test is its definition, UNIT_TEST(name) { ... }: it runs in the order of the file, by the main of tests/main.c, which takes a
 * pattern for those that are wanted. POOL_TEST has test_pool, FIXTURE_TEST a setup and teardown of its own; TEST_GROUP are those
 * around all of them. */
#define FIXTURE_TEST(name, setup, teardown)                                                                                      \
    static void name(void **state);                                                                                              \
    __attribute__((constructor)) static void enter_##name(void)                                                                  \
    {                                                                                                                            \
        test_enter(#name, name, setup, teardown);                                                                                \
    }                                                                                                                            \
    static void name(__attribute__((unused)) void **state)
#define UNIT_TEST(name) FIXTURE_TEST(name, NULL, NULL)
#define POOL_TEST(name) FIXTURE_TEST(name, open_test_pool, close_test_pool)
#define TEST_GROUP(setup, teardown)                                                                                              \
    __attribute__((constructor)) static void enter_group(void)                                                                   \
    {                                                                                                                            \
        test_enter_group(setup, teardown);                                                                                       \
    }                                                                                                                            \
    void test_enter_group(CMFixtureFunction setup_all, CMFixtureFunction teardown_all)
void test_enter(const char *name, CMUnitTestFunction test, CMFixtureFunction setup, CMFixtureFunction teardown);
void test_enter_group(CMFixtureFunction setup_all, CMFixtureFunction teardown_all);

/* What has been entered, or of it what matches argv[1]; for a main of its own. The number that failed. */
int test_main(int argc, char **argv);

/* Threads of the BLAS, where it has any to set, as OpenBLAS does; 0 where not. */
void set_blas_threads(int threads);
int blas_threads(void);

/* Sweeps of whole diagnoses go in steps so many times as large, unless make test-long has them whole. */
#define SPARSE (getenv("ROTID_LONG") ? 1 : 5)

/* The next allocation to fail in a sweep of a run: every one up to the hundredth, then each a twentieth later, unless make
 * test-long has all. */
#define NEXT_FAILURE(n) ((n) < 100 || SPARSE == 1 ? (n) + 1 : (n) + (n) / 20)

/* Processes by the hundred: under a sanitizer, which makes the start of one ten times as long, every third. */
#ifdef __SANITIZE_ADDRESS__
#define SLOW_START (getenv("ROTID_LONG") ? 1 : 3)
#else
#define SLOW_START 1
#endif

/* A status by its name in failure messages. */
#define assert_status(status, expected) assert_string_equal(rotid_status_name(status), #expected)

#endif
