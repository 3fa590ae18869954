/* Runs of a study in processes of this machine: the worker, a process that reads numbers of runs from its socket and writes back
 * a line each; and the crew, which hands out the runs, keeps the lines and replaces workers that die. */
#include "study/study.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
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

/* ---- a worker */

struct worker {
    pid_t process; /* 0: there is none */
    FILE *answers; /* of its socket, by whose other end it is asked as well; one line for each run that it was given */
    long run;      /* under way, -1: none */
    double begun;  /* on the clock */
    char *line;    /* [room] its last answer */
    size_t room;
};

/* Of the options of the crew. */
static int is_told_to_stop(void *context)
{
    const struct workers_options *options = context;
    return options->cancelled && options->cancelled(options->context);
}

/* The next run. 0 where there is none any more, or the work is to stop. */
static int take(int socket, struct workers_options *options, long *run)
{
    ssize_t got;
    do
        got = recv(socket, run, sizeof *run, MSG_WAITALL);
    while (got < 0 && errno == EINTR && !is_told_to_stop(options));
    return got == sizeof *run && !is_told_to_stop(options);
}

/* The worker itself: until there is nothing to do any more, or it is stopped. Its exit code. */
static int work(const struct study *study, int socket, struct workers_options *options)
{
    const rotid_environment environment = {.size = sizeof environment, .cancelled = is_told_to_stop, .context = options};
    FILE *answers = fdopen(socket, "w");
    struct jobs jobs;
    long run;
    int status = answers ? ROTID_OK : ROTID_ERROR_MEMORY;
    jobs_open(study, &jobs);
    while (!status && take(socket, options, &run)) {
        char *line = NULL;
        status = study_run(&jobs, run, &environment, &line);
        if (!status && (fputs(line, answers) < 0 || fflush(answers)))
            status = ROTID_STOP_CANCELLED; /* nobody listens */
        free(line);
    }
    jobs_close(&jobs);
    return status < 0 ? WORKER_NO_MEMORY : 0;
}

/* Tells it to end: at once with the signal, 0: when it reads on. */
static void worker_tell(const struct worker *worker, int signal_number)
{
    if (signal_number)
        (void)kill(worker->process, signal_number);
    (void)shutdown(fileno(worker->answers), SHUT_WR);
}

/* Waits until it has ended and forgets it; returns what waitpid says. */
static int worker_end(struct worker *worker)
{
    int status = 0;
    while (waitpid(worker->process, &status, 0) < 0 && errno == EINTR)
        ;
    (void)fclose(worker->answers);
    worker->process = 0;
    worker->run = -1;
    return status;
}

/* ---- the crew */

struct crew {
    struct pool *pool;
    const struct study *study;
    struct workers_options options;
    struct study_record *record;
    int count, unable; /* workers; how many in a row could not be started or died idle */
    int ending;        /* what is not finished is given up, not failed */
    struct worker *worker;
    struct pollfd *poll;
    double begun, shown;
    long computed;
};

/* Starts a process. ROTID_OK, or ROTID_ERROR_IO with errno. */
static int worker_start(struct crew *crew, struct worker *worker)
{
    int pair[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair))
        return ROTID_ERROR_IO;
    const pid_t parent = getpid();
    FILE *answers = fdopen(pair[0], "r");
    const pid_t process = answers ? fork() : -1;
    (void)parent;
    if (process == 0) {
#ifdef __linux__ /* whatever it is doing then, nobody would hear of it */
        if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent)
            _exit(0);
#endif
        /* the others see the end of this program only when nobody but it holds the other end of their sockets */
        for (int i = 0; i < crew->count; i++)
            if (crew->worker[i].process)
                (void)close(fileno(crew->worker[i].answers));
        (void)close(pair[0]);
        _exit(work(crew->study, pair[1], &crew->options)); /* what the parent has in its buffers is the parent's to write */
    }
    int reason = errno;
    (void)close(pair[1]);
    if (process < 0) {
        if (answers)
            (void)fclose(answers);
        else
            (void)close(pair[0]);
        errno = reason;
        return ROTID_ERROR_IO;
    }
    worker->process = process;
    worker->answers = answers;
    worker->run = -1;
    return ROTID_OK;
}

static void show(struct crew *crew, double now)
{
    if (!crew->options.progress || now - crew->shown < TICK)
        return;
    crew->shown = now;
    crew->options.progress(crew->record, crew->computed, now - crew->begun);
}

static int keep(struct crew *crew, const char *line)
{
    crew->computed++;
    return record_append(crew->record, line);
}

static int keep_failure(struct crew *crew, long run, const char *error, double seconds)
{
    char *line = study_run_failed(crew->study, run, error, seconds);
    int status = line ? keep(crew, line) : ROTID_ERROR_MEMORY;
    free(line);
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
    return run < 0 || crew->ending || is_told_to_stop(&crew->options) ? ROTID_OK
           : error                                                    ? keep_failure(crew, run, error, seconds)
                                                                      : ROTID_ERROR_MEMORY;
}

static int is_busy(const struct crew *crew)
{
    for (int i = 0; i < crew->count; i++)
        if (crew->worker[i].process && crew->worker[i].run >= 0)
            return 1;
    return 0;
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
        if (!worker->process && worker_start(crew, worker)) {
            if (!is_busy(crew) && ++crew->unable >= DIED_WITHIN)
                return ROTID_ERROR_IO;
            continue; /* the others go on */
        }
        worker->begun = clock_seconds();
        if (send(fileno(worker->answers), ready, sizeof *ready, MSG_NOSIGNAL) != sizeof *ready) {
            (void)bury(crew, worker, NULL); /* it is gone and never took the run */
            if (crew->unable >= DIED_WITHIN) {
                errno = ECHILD;
                return ROTID_ERROR_IO;
            }
            continue;
        }
        worker->run = *ready;
        *ready = -1;
    }
    return ROTID_OK;
}

/* Takes the answer that has begun to arrive, which a worker writes at once: its line, or its end. */
static int listen_to(struct crew *crew, struct worker *worker)
{
    ssize_t length = getline(&worker->line, &worker->room, worker->answers);
    if (length > 0 && worker->line[length - 1] == '\n') {
        worker->run = -1;
        crew->unable = 0;
        return keep(crew, worker->line);
    }
    if (ferror(worker->answers)) /* by a signal to this program: what was read of the line is lost */
        worker_tell(worker, SIGKILL);
    return bury(crew, worker, NULL);
}

static int wait_for_answers(struct crew *crew)
{
    const double most = crew->options.timeout, tick = most > 0 ? fmin(most, TICK) : TICK;
    int count = 0, status = ROTID_OK;
    for (int i = 0; i < crew->count; i++)
        if (crew->worker[i].process)
            crew->poll[count++] = (struct pollfd){.fd = fileno(crew->worker[i].answers), .events = POLLIN};
    if (poll(crew->poll, (nfds_t)count, (int)ceil(1000 * tick)) <= 0)
        return ROTID_OK; /* a signal, too: who waits will see */
    for (int i = 0, p = 0; i < crew->count && !status; i++)
        if (crew->worker[i].process && crew->poll[p++].revents)
            status = listen_to(crew, &crew->worker[i]);
    return status;
}

static int end_late_ones(struct crew *crew, double now)
{
    double most = crew->options.timeout;
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
        if (is_told_to_stop(&crew->options))
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
        free(crew->worker[i].line);
    }
    errno = reason;
    return status;
}

int workers_run(struct pool *pool, const struct study *study, const struct workers_options *options, struct study_record *record)
{
    long missing = record->wanted - record->done;
    struct crew crew = {.pool = pool,
                        .study = study,
                        .options = *options,
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
