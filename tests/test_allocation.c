/* A host's allocator that fails at the n-th request, for every n, and a host that cancels at the k-th poll. */
#include "fit/fit.h"
#include "paper_fit.h"
#include "support.h"

UNIT_TEST(test_pool_says_when_memory_is_out_and_stays_usable)
{
    struct failing_allocator failing;
    struct pool pool;
    failing_allocator_open(&failing, 3);
    pool_open(&pool, &failing.allocator);
    char *first = pool_copy_text(&pool, "kept");
    assert_non_null(first);
    assert_non_null(pool_get(&pool, 0, 8)); /* nothing at all is still a place */
    assert_null(POOL_ARRAY(&pool, double, 1000));
    assert_string_equal(first, "kept");
    double *later = POOL_ARRAY(&pool, double, 1000);
    assert_non_null(later);
    for (int i = 0; i < 1000; i++)
        assert_true(later[i] == 0);
    assert_int_equal((uintptr_t)later % _Alignof(max_align_t), 0);
    assert_int_equal(failing.in_use, 3);
    pool_close(&pool);
    assert_int_equal(failing.in_use, 0);
}

UNIT_TEST(test_pool_refuses_a_size_that_overflows)
{
    struct failing_allocator failing;
    struct pool pool;
    failing_allocator_open(&failing, 0);
    pool_open(&pool, &failing.allocator);
    assert_null(pool_get(&pool, SIZE_MAX, 2));
    assert_null(pool_get(&pool, SIZE_MAX / 8 + 1, 8));
    assert_null(pool_get(&pool, 1, SIZE_MAX));
    assert_int_equal(failing.served, 0);
    pool_close(&pool);
}

UNIT_TEST(test_array_that_cannot_grow_keeps_what_it_has)
{
    struct failing_allocator failing;
    struct pool pool;
    size_t capacity = 0, count = 0;
    failing_allocator_open(&failing, 3);
    pool_open(&pool, &failing.allocator);
    int *array = NULL, *larger;
    while ((larger = pool_grow(&pool, array, count, &capacity, sizeof *array))) {
        array = larger;
        array[count] = (int)count;
        count++;
    }
    assert_int_equal(count, 16); /* 8, 16, and no 32 */
    assert_int_equal(capacity, 16);
    for (size_t i = 0; i < count; i++)
        assert_int_equal(array[i], i);
    pool_close(&pool);
    assert_int_equal(failing.in_use, 0);
}

UNIT_TEST(test_model_of_a_rotor_survives_every_failing_allocation)
{
    int status = ROTID_ERROR_MEMORY, n = 0;
    while (status == ROTID_ERROR_MEMORY) {
        struct failing_allocator failing;
        struct pool pool;
        struct rotor_model client;
        int failed;
        failing_allocator_open(&failing, ++n);
        pool_open(&pool, &failing.allocator);
        struct rotor *rotor = paper_rotor(BUNDLE_TUBE, 0);
        rotor->sling = 0.5; /* two more springs to make room for */
        status = model_open(&pool, NULL, rotor, 2, paper_parameters, 1, &client, &failed);
        if (status)
            assert_int_equal(failing.until_failure, 0);
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
        assert_true(n < 1000);
    }
    assert_status(status, ROTID_OK);
    print_message("model_open: %d allocations\n", n - 1);
    assert_true(n > 10);
}

static int run_with(struct paper_fit *fit, const rotid_environment *environment, rotid_fit_result **result)
{
    *result = (void *)fit; /* must be overwritten in any case */
    return rotid_fit(&fit->client.equations, fit->parameter, &fit->measured, &fit->options, environment, NULL, result);
}

/* Returns how many allocations the fit needs. */
static int sweep(struct paper_fit *fit)
{
    for (int n = 1; n < 1000; n++) {
        struct failing_allocator failing;
        rotid_fit_result *result;
        failing_allocator_open(&failing, n);
        rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
        int status = run_with(fit, &environment, &result);
        if (!status) {
            assert_true(failing.until_failure > 0); /* no failure was passed over in silence */
            assert_true(result->converged);
            rotid_fit_free(result);
            assert_int_equal(failing.in_use, 0);
            return n - 1;
        }
        assert_status(status, ROTID_ERROR_MEMORY);
        assert_null(result);
        rotid_fit_free(result); /* as a host's one cleanup path would */
        assert_int_equal(failing.in_use, 0);
    }
    fail_msg("still failing after 1000 allocations");
    return 0;
}

UNIT_TEST(test_fit_survives_every_failing_allocation)
{
    static const rotid_fit_options options[] = {
        {.size = sizeof *options, .functional = ROTID_LIKELIHOOD, .reduction = ROTID_REDUCTION_NONE},
        {.size = sizeof *options, .functional = ROTID_LIKELIHOOD, .reduction = ROTID_GUYAN, .derivative = ROTID_MODAL},
        {.size = sizeof *options, .functional = ROTID_HYBRID, .reduction = ROTID_IRS, .derivative = ROTID_NELSON},
        {.size = sizeof *options, .functional = ROTID_HYBRID, .reduction = ROTID_GUYAN, .baseline = 1},
    };
    for (size_t k = 0; k < sizeof options / sizeof *options; k++) {
        struct paper_fit fit;
        paper_fit_open(&fit, BUNDLE_TUBE);
        paper_synthesise(&fit, scipy_optimum, 1e-3, 0.015);
        if (options[k].baseline) /* the last allocations follow on whole minimisations, so frequencies alone */
            fit.measured.shape = NULL;
        fit.options = options[k];
        int count = sweep(&fit);
        print_message("functional %d reduction %d baseline %d: %d allocations\n", options[k].functional, options[k].reduction,
                      options[k].baseline, count);
        assert_true(count > 30);
        paper_fit_close(&fit);
    }
}

/* Memory is a matter of the sizes, not of the number of iterations (the history has its place from the beginning). */
UNIT_TEST(test_iterations_allocate_nothing)
{
    struct paper_fit fit;
    long served[2];
    paper_fit_open(&fit, BUNDLE_TUBE);
    for (int k = 0; k < 2; k++) {
        struct failing_allocator failing;
        rotid_fit_result *result;
        failing_allocator_open(&failing, 0);
        rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
        fit.options.max_iterations = k ? 50 : 1;
        assert_status(run_with(&fit, &environment, &result), ROTID_OK);
        assert_int_equal(result->status == ROTID_STOP_ITERATIONS, !k);
        served[k] = failing.served;
        rotid_fit_free(result);
    }
    assert_int_equal(served[0], served[1]);
    paper_fit_close(&fit);
}

struct host {
    int polls, stop_at;
};

static int cancelled(void *context)
{
    struct host *host = context;
    return ++host->polls >= host->stop_at;
}

/* The best point so far, with everything that is said about it. */
UNIT_TEST(test_cancelled_fit_returns_the_best_point_so_far)
{
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    fit.options.baseline = 1;
    double before = INFINITY;
    for (int k = 1; k <= 8; k++) {
        struct host host = {.stop_at = k};
        rotid_environment environment = {.size = sizeof environment, .cancelled = cancelled, .context = &host};
        rotid_fit_result *result;
        assert_status(run_with(&fit, &environment, &result), ROTID_OK);
        assert_status(result->status, ROTID_STOP_CANCELLED);
        assert_int_equal(host.polls, k);
        assert_int_equal(result->iterations, k - 1);
        assert_int_equal(result->nhistory, k);
        assert_int_equal(result->nbaseline, 0);
        assert_true(!result->converged);
        if (k == 1)
            for (int p = 0; p < 2; p++)
                assert_close(result->x[p], paper_start[p], 1e-14, 0);
        assert_close(result->objective, paper_objective(&fit, result->x), 1e-9, 0);
        assert_true(result->objective < before);
        before = result->objective;
        for (int m = 0; m < PAPER_MODES; m++)
            assert_true(isfinite(result->predicted_hz[m]) && isfinite(result->residual[m]));
        for (int p = 0; p < 2; p++)
            assert_true(result->x[p] > fit.parameter[p].lower && result->x[p] < fit.parameter[p].upper &&
                        isfinite(result->std[p]));
        rotid_fit_free(result);
    }
    paper_fit_close(&fit);
}

/* Cancelled while NLopt runs: the fit itself was done, and nothing is said of a baseline. */
UNIT_TEST(test_cancelled_baseline_leaves_the_finished_fit)
{
    if (!baseline_count(2))
        skip(); /* built without NLopt */
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    fit.options.baseline = 1;
    for (int k = 0; k < 3; k++) {
        struct host host = {.stop_at = 20 + 40 * k};
        rotid_environment environment = {.size = sizeof environment, .cancelled = cancelled, .context = &host};
        rotid_fit_result *result;
        assert_status(run_with(&fit, &environment, &result), ROTID_OK);
        assert_true(result->converged && result->nhistory < 20 && result->nbaseline == 0);
        assert_close(result->x[0], scipy_optimum[0], 1e-7, 0);
        assert_true(host.polls <= host.stop_at + 1);
        rotid_fit_free(result);
    }
    paper_fit_close(&fit);
}
