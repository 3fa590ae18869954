#include "study/study.h"

#include <errno.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "base/base.h"
#include "result/result.h"

struct worker_stop {
    int (*cancelled)(void *context);
    void *context;
};

static int is_stopped(void *context)
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
        if (got == 0 || (got < 0 && errno != EINTR) || is_stopped(stop))
            return 1;
        to += got > 0 ? got : 0;
        count -= got > 0 ? (size_t)got : 0;
    }
    return 0;
}

/* The worker itself: until there is nothing to read any more, or it is stopped. Its exit code. */
static int work(const struct study *study, int socket, struct worker_stop *stop)
{
    const rotid_environment environment = {.size = sizeof environment, .cancelled = is_stopped, .context = stop};
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

int worker_start(const struct study *study, int (*cancelled)(void *context), void *context, int nothers,
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

int worker_give(struct worker *worker, long run)
{
    int64_t number = run;
    worker->run = run;
    worker->begun = clock_seconds();
    worker->count = 0;
    return give(worker->socket, &number, sizeof number) ? ROTID_ERROR_IO : ROTID_OK;
}

int worker_take(struct worker *worker, const char **line)
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

void worker_tell(struct worker *worker, int signal_number)
{
    if (signal_number)
        (void)kill(worker->process, signal_number);
    (void)shutdown(worker->socket, SHUT_WR);
}

int worker_end(struct worker *worker)
{
    int status = 0;
    while (waitpid(worker->process, &status, 0) < 0 && errno == EINTR)
        ;
    (void)close(worker->socket);
    worker->process = 0;
    worker->run = -1;
    return status;
}
