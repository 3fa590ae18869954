/* What every test uses. cmocka's own comparison of floating-point numbers casts to float, so tests compare with assert_close. */
#ifndef ROTID_TESTS_SUPPORT_H
#define ROTID_TESTS_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

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

/* A pool for one test at a time, as setup and teardown of cmocka. */
extern struct pool test_pool;
int open_test_pool(void **state);
int close_test_pool(void **state);

/* Threads of the BLAS, where it has any to set, as OpenBLAS does; 0 where not. */
void set_blas_threads(int threads);
int blas_threads(void);

/* A status by its name in failure messages. */
#define assert_status(status, expected) assert_string_equal(rotid_status_name(status), #expected)

#endif
