/* Tasks on several threads: each once, failures the same for any number of threads. `cc -fsanitize=thread` is clean on it. */
#define _GNU_SOURCE /* pthread_setattr_default_np */
#include "support.h"

#include <pthread.h>
#include <stdatomic.h>

#define MOST 1000

struct record {
    atomic_int runs[MOST], busy[PARALLEL_MOST];
    int fail[MOST]; /* status of each index */
    double value[MOST];
    pthread_t thread[MOST];
    int threads;
    atomic_int wrong, started;
};

static void open_record(struct record *record, int threads)
{
    memset(record, 0, sizeof *record);
    record->threads = threads;
}

/* Some take a hundred times as long as others. */
static int task(void *context, int index, int worker)
{
    struct record *record = context;
    atomic_fetch_add(&record->started, 1);
    atomic_fetch_add(&record->runs[index], 1);
    if (worker < 0 || worker >= PARALLEL_MOST || (record->threads > 0 && worker >= record->threads))
        atomic_fetch_add(&record->wrong, 1);
    else if (atomic_fetch_add(&record->busy[worker], 1))
        atomic_fetch_add(&record->wrong, 1);
    double sum = 0;
    for (int i = 0; i < (index % 10 ? 50 : 5000); i++)
        sum += (double)(i * index % 17);
    record->value[index] = sum;
    record->thread[index] = pthread_self();
    atomic_fetch_sub(&record->busy[worker], 1);
    return record->fail[index];
}

UNIT_TEST(every_index_runs_once_and_results_do_not_depend_on_the_threads)
{
    static const int threads[] = {-3, 0, 1, 2, 3, 8, 40, 2000}, counts[] = {0, 1, 2, 3, 7, 100, MOST};
    static struct record serial, record;
    open_record(&serial, 0);
    assert_int_equal(parallel_for(1, MOST, task, &serial), 0);
    for (size_t t = 0; t < sizeof threads / sizeof *threads; t++)
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
            open_record(&record, threads[t]);
            assert_int_equal(parallel_for(threads[t], counts[c], task, &record), 0);
            assert_int_equal(record.wrong, 0);
            for (int i = 0; i < MOST; i++)
                assert_int_equal(record.runs[i], i < counts[c]);
            assert_memory_equal(record.value, serial.value, (size_t)counts[c] * sizeof(double));
            for (int i = 0; i < counts[c] && threads[t] <= 1; i++)
                assert_true(pthread_equal(record.thread[i], pthread_self()));
        }
    assert_int_equal(parallel_for(4, -1, task, &record), 0);
}

UNIT_TEST(the_lowest_failure_is_returned_and_what_is_left_is_not_started)
{
    static struct record record;
    for (int repeat = 0; repeat < 20; repeat++)
        for (int threads = 1; threads <= 8; threads++) {
            open_record(&record, threads);
            record.fail[60] = ROTID_STOP_CANCELLED;
            record.fail[61] = record.fail[63] = ROTID_ERROR_CALLBACK;
            record.fail[62] = ROTID_ERROR_MEMORY;
            assert_int_equal(parallel_for(threads, MOST, task, &record), ROTID_STOP_CANCELLED);
            for (int i = 0; i <= 60; i++)
                assert_int_equal(record.runs[i], 1);
            if (threads == 1)
                assert_int_equal(record.started, 61);
            assert_int_equal(record.wrong, 0);
            record.fail[60] = 0;
            assert_int_equal(parallel_for(threads, MOST, task, &record), ROTID_ERROR_CALLBACK);
            open_record(&record, threads);
            for (int i = 3; i < MOST; i++)
                record.fail[i] = -i;
            assert_int_equal(parallel_for(threads, MOST, task, &record), -3);
            assert_true(record.started <= 3 + threads);
        }
}

/* Where no thread can be had, here because its stack would be larger than any memory, the caller does the work. */
UNIT_TEST(without_threads_the_caller_does_it_all)
{
    static struct record record;
    pthread_attr_t usual, huge;
    assert_int_equal(pthread_getattr_default_np(&usual), 0);
    assert_int_equal(pthread_attr_init(&huge), 0);
    assert_int_equal(pthread_attr_setstacksize(&huge, (size_t)1 << 60), 0);
    assert_int_equal(pthread_setattr_default_np(&huge), 0);
    open_record(&record, 8);
    int status = parallel_for(8, MOST, task, &record);
    assert_int_equal(pthread_setattr_default_np(&usual), 0);
    assert_int_equal(status, 0);
    assert_int_equal(record.wrong, 0);
    for (int i = 0; i < MOST; i++) {
        assert_int_equal(record.runs[i], 1);
        assert_true(pthread_equal(record.thread[i], pthread_self()));
    }
    (void)pthread_attr_destroy(&usual);
    (void)pthread_attr_destroy(&huge);
}
