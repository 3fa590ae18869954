/* Runs of a study in processes of this machine: the worker, a process that reads numbers of runs from its socket and writes back
 * the length and the text of a line each; and the crew, which hands out the runs, keeps the lines and replaces workers that die.
 */
#include "study/study.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#define TICK             0.2 /* s between two looks at the clock */
#define GRACE            0.3 /* s for a worker to end by itself once it has been told to */
#define DIED_WITHIN      3   /* workers in a row that ended before they took a run: it is not the runs that kill them */
#define WORKER_NO_MEMORY 3   /* exit code of a process that had no room for its line */

/* ---- a worker, seen from the process that hands out the runs */

struct worker {
    pid_t process; /* 0: there is none */
    int socket;
    long run;     /* under way, -1: none */
    double begun; /* on the clock */
    char *answer; /* [room] the bytes that have arrived: its length, then the line */
    size_t count, room;
};

struct worker_stop {
    int (*cancelled)(void *context);
    void *context;
};

static int is_told_to_stop(void *context)
{
    const struct worker_stop *stop = context;
    return stop->cancelled && stop->cancelled(stop->context);
}

/* All bytes, or nonzero where the other side is gone or the work is to stop. */
static int give(int socket, const void *bytes, size_t count)
{
    const char *from = bytes;
    while (count) {
        ssize_t sent = send(socket, from, count, MSG_NOSIGNAL);
        if (sent < 0 && errno != EINTR)
            return 1;
        from += sent > 0 ? sent : 0;
        count -= sent > 0 ? (size_t)sent : 0;
    }
    return 0;
}

static int take(int socket, void *bytes, size_t count, struct worker_stop *stop)
{
    char *to = bytes;
    while (count) {
        ssize_t got = recv(socket, to, count, 0);
        if (got == 0 || (got < 0 && errno != EINTR) || is_told_to_stop(stop))
            return 1;
        to += got > 0 ? got : 0;
        count -= got > 0 ? (size_t)got : 0;
    }
    return 0;
}

/* The worker itself: until there is nothing to read any more, or it is stopped. Its exit code. */
static int work(const struct study *study, int socket, struct worker_stop *stop)
{
    const rotid_environment environment = {.size = sizeof environment, .cancelled = is_told_to_stop, .context = stop};
    struct jobs jobs;
    int64_t run;
    int status = ROTID_OK;
    jobs_open(study, &jobs);
    while (!take(socket, &run, sizeof run, stop)) {
        char *line = NULL;
        status = study_run(&jobs, (long)run, &environment, &line);
        if (status)
            break;
        uint64_t length = strlen(line);
        int gone = give(socket, &length, sizeof length) || give(socket, line, length);
        json_free(line);
        if (gone)
            break;
    }
    jobs_close(&jobs);
    return status < 0 ? WORKER_NO_MEMORY : 0;
}

/* Starts a process; others [nothers] are the workers there are, whose sockets it must not keep open. ROTID_OK, or ROTID_ERROR_IO
 * with errno. */
static int worker_start(const struct study *study, int (*cancelled)(void *context), void *context, int nothers,
                        const struct worker *others, struct worker *worker)
{
    struct worker_stop stop = {cancelled, context};
    int pair[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair))
        return ROTID_ERROR_IO;
    const pid_t parent = getpid(), process = fork();
    (void)parent;
    if (process == 0) {
#ifdef __linux__ /* whatever it is doing then, nobody would hear of it */
        if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent)
            _exit(0);
#endif
        /* the others see the end of this program only when nobody but it holds the other end of their sockets */
        for (int i = 0; i < nothers; i++)
            if (others[i].process)
                (void)close(others[i].socket);
        (void)close(pair[0]);
        _exit(work(study, pair[1], &stop)); /* what the parent has in its buffers is the parent's to write */
    }
    int reason = errno;
    (void)close(pair[1]);
    if (process < 0) {
        (void)close(pair[0]);
        errno = reason;
        return ROTID_ERROR_IO;
    }
    char *answer = worker->answer; /* of the one before it */
    size_t room = worker->room;
    *worker = (struct worker){.process = process, .socket = pair[0], .run = -1, .answer = answer, .room = room};
    return ROTID_OK;
}

/* Hands out a run. ROTID_OK, or ROTID_ERROR_IO where the process is gone. */
static int worker_give(struct worker *worker, long run)
{
    int64_t number = run;
    worker->run = run;
    worker->begun = clock_seconds();
    worker->count = 0;
    return give(worker->socket, &number, sizeof number) ? ROTID_ERROR_IO : ROTID_OK;
}

/* Takes what has arrived. 1: the answer is whole, its line in *line until the next call and the run no longer under way; 0: not
 * yet; ROTID_ERROR_IO: the process is gone; ROTID_ERROR_MEMORY. */
static int worker_take(struct worker *worker, const char **line)
{
    const size_t block = 65536;
    uint64_t length;
    if (worker->room < worker->count + block + 1) {
        char *larger = realloc(worker->answer, 2 * worker->room + block + 1);
        if (!larger)
            return ROTID_ERROR_MEMORY;
        worker->answer = larger;
        worker->room = 2 * worker->room + block + 1;
    }
    ssize_t got = recv(worker->socket, worker->answer + worker->count, block, MSG_DONTWAIT);
    if (got < 0 && (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK))
        return 0;
    if (got <= 0)
        return ROTID_ERROR_IO;
    worker->count += (size_t)got;
    if (worker->count < sizeof length)
        return 0;
    memcpy(&length, worker->answer, sizeof length);
    if (worker->count < sizeof length + length)
        return 0;
    worker->answer[sizeof length + length] = 0;
    *line = worker->answer + sizeof length;
    worker->run = -1;
    worker->count = 0;
    return 1;
}

/* Tells it to end: at once with the signal, 0: when it reads on. */
static void worker_tell(struct worker *worker, int signal_number)
{
    if (signal_number)
        (void)kill(worker->process, signal_number);
    (void)shutdown(worker->socket, SHUT_WR);
}

/* Waits until it has ended and forgets it; returns what waitpid says. */
static int worker_end(struct worker *worker)
{
    int status = 0;
    while (waitpid(worker->process, &status, 0) < 0 && errno == EINTR)
        ;
    (void)close(worker->socket);
    worker->process = 0;
    worker->run = -1;
    return status;
}

/* ---- the crew */

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
    return record_append(crew->record, run, line);
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
