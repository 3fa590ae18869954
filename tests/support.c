#include "support.h"

void assert_close_at(double value, double expected, double rtol, double atol, const char *text, const char *file, int line)
{
    double difference = fabs(value - expected);
    if (difference <= rtol * fabs(expected) + atol)
        return;
    print_error("%s = %.17g, expected %.17g: off by %.3g, relative %.3g, allowed %.3g relative + %.3g\n", text, value, expected,
                difference, difference / fabs(expected), rtol, atol);
    _fail(file, line);
}

double relative_difference(size_t count, const double *a, const double *b)
{
    double difference = 0, largest = 0;
    for (size_t i = 0; i < count; i++) {
        difference = fmax(difference, fabs(a[i] - b[i]));
        largest = fmax(largest, fabs(b[i]));
        if (isnan(a[i]) || isnan(b[i]))
            return INFINITY;
    }
    return largest > 0 ? difference / largest : difference;
}

static void *allocate(void *context, size_t bytes)
{
    struct failing_allocator *failing = context;
    if (failing->until_failure > 0 && --failing->until_failure == 0)
        return NULL;
    void *block = malloc(bytes);
    failing->in_use += block != NULL;
    failing->served++;
    return block;
}

static void release(void *context, void *block)
{
    struct failing_allocator *failing = context;
    failing->in_use--;
    free(block);
}

void failing_allocator_open(struct failing_allocator *failing, long fail_at)
{
    *failing = (struct failing_allocator){{allocate, release, failing}, fail_at, 0, 0};
}

struct pool test_pool;

int open_test_pool(void **state)
{
    *state = &test_pool;
    pool_open(&test_pool, NULL);
    return 0;
}

int close_test_pool(void **state)
{
    (void)state;
    pool_close(&test_pool);
    return 0;
}

__attribute__((weak)) void openblas_set_num_threads(int threads);
__attribute__((weak)) int openblas_get_num_threads(void);

void set_blas_threads(int threads)
{
    if (openblas_set_num_threads)
        openblas_set_num_threads(threads);
}

int blas_threads(void)
{
    return openblas_get_num_threads ? openblas_get_num_threads() : 0;
}
