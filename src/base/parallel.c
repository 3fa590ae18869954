#include <pthread.h>
#include <stdatomic.h>
#include <time.h>

#include "base/base.h"

double clock_seconds(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now); /* which nobody sets */
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

struct shared {
    atomic_int next;
    int count;
    int (*task)(void *context, int index, int worker);
    void *context;
    fenv_t floating; /* of the caller, and its locale: a new thread has those of the process */
    locale_t locale;
};

struct worker {
    struct shared *shared;
    int number;
    int failed, status; /* index that ended it, and how */
};

static void *work(void *argument)
{
    struct worker *worker = argument;
    struct shared *shared = worker->shared;
    for (int index; (index = atomic_fetch_add(&shared->next, 1)) < shared->count;) {
        worker->status = shared->task(shared->context, index, worker->number);
        if (worker->status) {
            worker->failed = index;
            atomic_store(&shared->next, shared->count);
            break;
        }
    }
    return NULL;
}

static void *work_as_caller(void *argument)
{
    const struct worker *worker = argument;
    (void)fesetenv(&worker->shared->floating);
    (void)uselocale(worker->shared->locale);
    return work(argument);
}

int parallel_for(int threads, int count, int (*task)(void *context, int index, int worker), void *context)
{
    pthread_t thread[PARALLEL_MOST];
    struct worker worker[PARALLEL_MOST];
    struct shared shared = {.count = count, .task = task, .context = context};
    atomic_init(&shared.next, 0);
    (void)fegetenv(&shared.floating);
    shared.locale = uselocale((locale_t)0);
    threads = threads < count ? threads : count;
    threads = threads < PARALLEL_MOST ? threads : PARALLEL_MOST;
    int running = 1, lowest = 0;
    worker[0] = (struct worker){.shared = &shared};
    for (; running < threads; running++) {
        worker[running] = (struct worker){.shared = &shared, .number = running};
        if (pthread_create(&thread[running], NULL, work_as_caller, &worker[running]))
            break;
    }
    (void)work(&worker[0]);
    for (int t = 1; t < running; t++)
        (void)pthread_join(thread[t], NULL);
    for (int t = 1; t < running; t++)
        if (worker[t].status && (!worker[lowest].status || worker[t].failed < worker[lowest].failed))
            lowest = t;
    return worker[lowest].status;
}

int environment_cancelled(const rotid_environment *environment)
{
    return environment && environment->cancelled && environment->cancelled(environment->context);
}

void environment_progress(const rotid_environment *environment, const char *stage, int step)
{
    if (environment && environment->progress)
        environment->progress(environment->context, stage, step);
}
