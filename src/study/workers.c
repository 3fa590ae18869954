#include "study/study.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "base/base.h"
#include "result/result.h"

#define TICK        0.2 /* s between two looks at the clock */
#define GRACE       0.3 /* s for a worker to end by itself once it has been told to */
#define DIED_WITHIN 3   /* workers in a row that ended before they took a run: it is not the runs that kill them */

struct crew {
    struct pool *pool;
    const struct study *study;
    const struct workers_options *options;
    struct study_record *record;
    int count, unable; /* workers; how many in a row could not be started or died idle */
    int ending;        /* what is not finished is given up, not failed */
    struct worker *worker;
    struct pollfd *poll;
    double begun, shown;
    long computed;
};

static int is_stopped(const struct crew *crew)
{
    return crew->options->cancelled && crew->options->cancelled(crew->options->context);
}

static void show(struct crew *crew, double now)
{
    if (!crew->options->progress || now - crew->shown < TICK)
        return;
    crew->shown = now;
    const struct study_progress progress = {crew->record->done, crew->record->wanted, crew->record->failed, crew->computed,
                                            now - crew->begun};
    crew->options->progress(crew->options->context, &progress);
}

static int keep(struct crew *crew, long run, const char *line)
{
    crew->computed++;
    return record_append(crew->record, run, line, result_failed(line));
}

static int keep_failure(struct crew *crew, long run, const char *error, double seconds)
{
    char *line = study_run_failed(crew->study, run, error, seconds);
    int status = line ? keep(crew, run, line) : ROTID_ERROR_MEMORY;
    json_free(line);
    return status;
}

/* The worker is gone, or is to go with its run. */
static int bury(struct crew *crew, struct worker *worker, const char *why)
{
    long run = worker->run;
    double seconds = clock_seconds() - worker->begun;
    int ended = worker_end(worker);
    const char *error = why;
    crew->unable = run < 0 ? crew->unable + 1 : 0;
    if (!error && WIFSIGNALED(ended))
        error = pool_format(crew->pool, "worker ended by signal %d (%s)", WTERMSIG(ended),
                            WTERMSIG(ended) == SIGKILL   ? "killed, as for want of memory"
                            : WTERMSIG(ended) == SIGSEGV ? "segmentation fault"
                            : WTERMSIG(ended) == SIGABRT ? "abort"
                                                         : "see signal(7)");
    else if (!error && WEXITSTATUS(ended) == WORKER_NO_MEMORY)
        error = "worker ended for want of memory";
    else if (!error)
        error = WEXITSTATUS(ended) ? pool_format(crew->pool, "worker ended with exit code %d", WEXITSTATUS(ended))
                                   : "worker was told to end";
    return run < 0 || crew->ending || is_stopped(crew) ? ROTID_OK
           : error                                     ? keep_failure(crew, run, error, seconds)
                                                       : ROTID_ERROR_MEMORY;
}

/* A process for each place that has none and a run for each that is idle, while there are any. */
static int employ(struct crew *crew, long *ready)
{
    for (int i = 0; i < crew->count; i++) {
        struct worker *worker = &crew->worker[i];
        if (*ready < 0)
            *ready = record_take(crew->record);
        if (*ready < 0)
            return ROTID_OK;
        if (worker->process && worker->run >= 0)
            continue;
        if (!worker->process &&
            worker_start(crew->study, crew->options->cancelled, crew->options->context, crew->count, crew->worker, worker)) {
            int any = 0, reason = errno;
            for (int w = 0; w < crew->count; w++)
                any |= crew->worker[w].process != 0;
            errno = reason;
            if (!any && ++crew->unable >= DIED_WITHIN)
                return ROTID_ERROR_IO;
            continue; /* the others go on */
        }
        if (worker_give(worker, *ready)) { /* it is gone and never took the run */
            worker->run = -1;
            (void)bury(crew, worker, NULL);
            if (crew->unable >= DIED_WITHIN) {
                errno = ECHILD;
                return ROTID_ERROR_IO;
            }
            continue;
        }
        *ready = -1;
    }
    return ROTID_OK;
}

/* Everything that has arrived, from workers that are gone as well. */
static int listen_to(struct crew *crew, struct worker *worker)
{
    const char *line;
    long run = worker->run;
    int took = worker_take(worker, &line);
    if (took == 1) {
        crew->unable = 0;
        return keep(crew, run, line);
    }
    return took == ROTID_ERROR_IO ? bury(crew, worker, NULL) : took;
}

static int wait_for_answers(struct crew *crew)
{
    const double most = crew->options->timeout, tick = most > 0 ? fmin(most, TICK) : TICK;
    int count = 0, status = ROTID_OK;
    for (int i = 0; i < crew->count; i++)
        if (crew->worker[i].process)
            crew->poll[count++] = (struct pollfd){.fd = crew->worker[i].socket, .events = POLLIN};
    if (poll(crew->poll, (nfds_t)count, (int)ceil(1000 * tick)) <= 0)
        return ROTID_OK; /* a signal, too: who waits will see */
    for (int i = 0, p = 0; i < crew->count && !status; i++)
        if (crew->worker[i].process && crew->poll[p++].revents)
            status = listen_to(crew, &crew->worker[i]);
    return status;
}

static int end_late_ones(struct crew *crew, double now)
{
    double most = crew->options->timeout;
    int status = ROTID_OK;
    for (int i = 0; i < crew->count && most > 0 && !status; i++) {
        struct worker *worker = &crew->worker[i];
        if (!worker->process || worker->run < 0 || now - worker->begun < most)
            continue;
        const char *why = pool_format(crew->pool, "no result within %g s (--timeout)", most);
        worker_tell(worker, SIGKILL);
        status = why ? bury(crew, worker, why) : ROTID_ERROR_MEMORY;
    }
    return status;
}

static int is_busy(const struct crew *crew)
{
    for (int i = 0; i < crew->count; i++)
        if (crew->worker[i].process && crew->worker[i].run >= 0)
            return 1;
    return 0;
}

static int compute(struct crew *crew)
{
    long ready = -1;
    int status;
    while (!(status = employ(crew, &ready)) && (ready >= 0 || is_busy(crew))) {
        if (is_busy(crew))
            status = wait_for_answers(crew);
        double now = clock_seconds();
        if (!status)
            status = end_late_ones(crew, now);
        if (!status)
            status = record_sync(crew->record, now);
        if (status)
            return status;
        if (is_stopped(crew))
            return ROTID_STOP_CANCELLED;
        show(crew, now);
    }
    return status;
}

/* Ends every worker. With a stop, what is finished by then is kept, and what is not is given up. */
static int dismiss(struct crew *crew, int status)
{
    int reason = errno;
    crew->ending = 1;
    for (int i = 0; i < crew->count; i++)
        if (crew->worker[i].process)
            worker_tell(&crew->worker[i], status ? SIGTERM : 0);
    for (double limit = clock_seconds() + GRACE; clock_seconds() < limit && is_busy(crew);) {
        int failed = wait_for_answers(crew);
        if (failed && status >= 0) {
            status = failed;
            reason = errno;
        }
    }
    for (int i = 0; i < crew->count; i++) {
        if (crew->worker[i].process && crew->worker[i].run >= 0)
            worker_tell(&crew->worker[i], SIGKILL);
        if (crew->worker[i].process)
            (void)worker_end(&crew->worker[i]);
        free(crew->worker[i].answer);
    }
    errno = reason;
    return status;
}

int workers_run(struct pool *pool, const struct study *study, const struct workers_options *options, struct study_record *record)
{
    long missing = record->wanted - record->done;
    struct crew crew = {.pool = pool,
                        .study = study,
                        .options = options,
                        .record = record,
                        .count = missing < options->workers ? (int)missing : options->workers,
                        .begun = clock_seconds()};
    if (!missing)
        return ROTID_OK;
    crew.worker = POOL_ARRAY(pool, struct worker, crew.count);
    crew.poll = POOL_ARRAY(pool, struct pollfd, crew.count);
    if (!crew.worker || !crew.poll)
        return ROTID_ERROR_MEMORY;
    int status = dismiss(&crew, compute(&crew));
    if (record_sync(record, INFINITY) && status >= 0)
        status = ROTID_ERROR_IO;
    return status;
}
