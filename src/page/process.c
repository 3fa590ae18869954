#include "page/process.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"

extern char **environ;

#define POLL_MS 50 /* an interrupt is noticed within that */

struct stream {
    int descriptor[2];
    char *text;
    size_t used;
};

static int open_streams(struct stream stream[2])
{
    for (int i = 0; i < 2; i++)
        if (pipe(stream[i].descriptor) != 0) {
            if (i) {
                (void)close(stream[0].descriptor[0]);
                (void)close(stream[0].descriptor[1]);
            }
            return ROTID_ERROR_IO;
        }
    for (int i = 0; i < 2; i++)
        for (int end = 0; end < 2; end++)
            (void)fcntl(stream[i].descriptor[end], F_SETFD, FD_CLOEXEC);
    return ROTID_OK;
}

/* Goes into a folder: the descriptor of the one before, -1 where it cannot. */
static int enter(int folder)
{
    int before = open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (before < 0 || fchdir(folder) == 0)
        return before;
    int reason = errno;
    (void)close(before);
    errno = reason;
    return -1;
}

static int start(const char *const argv[], struct stream stream[2], pid_t *child)
{
    posix_spawn_file_actions_t actions;
    if (posix_spawn_file_actions_init(&actions) != 0) {
        errno = ENOMEM;
        return ROTID_ERROR_IO;
    }
    int reason = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    for (int i = 0; i < 2 && !reason; i++)
        reason = posix_spawn_file_actions_adddup2(&actions, stream[i].descriptor[1], i ? STDERR_FILENO : STDOUT_FILENO);
    if (!reason)
        reason = posix_spawnp(child, argv[0], &actions, NULL, (char *const *)argv, environ);
    (void)posix_spawn_file_actions_destroy(&actions);
    errno = reason;
    return reason ? ROTID_ERROR_IO : ROTID_OK;
}

/* What there is to read now; 0 at the end of the stream. */
static int drain(struct stream *stream)
{
    char piece[4096];
    ssize_t got = read(stream->descriptor[0], piece, sizeof piece);
    if (got <= 0)
        return got < 0 && errno == EINTR;
    size_t room = PROCESS_TEXT - 1 - stream->used, kept = (size_t)got < room ? (size_t)got : room;
    memcpy(stream->text + stream->used, piece, kept);
    stream->used += kept;
    return 1;
}

/* Until both streams have ended, or it is told to end. */
static void attend(struct stream stream[2], pid_t child, double until, const rotid_environment *environment,
                   struct process_result *result)
{
    struct pollfd waiting[2] = {{stream[0].descriptor[0], POLLIN, 0}, {stream[1].descriptor[0], POLLIN, 0}};
    while (waiting[0].fd >= 0 || waiting[1].fd >= 0) {
        int ready = poll(waiting, 2, POLL_MS);
        for (int i = 0; i < 2 && ready > 0; i++)
            if (waiting[i].fd >= 0 && waiting[i].revents && !drain(&stream[i]))
                waiting[i].fd = -1;
        result->cancelled |= environment && environment->cancelled && environment->cancelled(environment->context);
        result->timed_out |= clock_seconds() > until;
        if (result->cancelled || result->timed_out) {
            (void)kill(child, SIGKILL);
            return;
        }
    }
}

/* posix_spawn changes no folder before POSIX.1-2024. */
static int start_in(int folder, const char *const argv[], struct stream stream[2], pid_t *child)
{
    int before = folder == PROCESS_HERE ? -1 : enter(folder);
    if (folder != PROCESS_HERE && before < 0)
        return ROTID_ERROR_IO;
    int status = start(argv, stream, child), reason = errno;
    if (before >= 0) {
        (void)!fchdir(before);
        (void)close(before);
    }
    errno = reason;
    return status;
}

int process_run(const char *const argv[], int folder, double seconds, const rotid_environment *environment,
                struct process_result *result)
{
    struct stream stream[2] = {{.text = result->out}, {.text = result->err}};
    pid_t child;
    int state;
    memset(result, 0, sizeof *result);
    if (open_streams(stream))
        return ROTID_ERROR_IO;
    int status = start_in(folder, argv, stream, &child), reason = errno;
    for (int i = 0; i < 2; i++)
        (void)close(stream[i].descriptor[1]);
    if (!status) {
        attend(stream, child, clock_seconds() + seconds, environment, result);
        while (waitpid(child, &state, 0) < 0 && errno == EINTR)
            continue;
        result->exit_code = WIFEXITED(state) ? WEXITSTATUS(state) : -1;
    }
    for (int i = 0; i < 2; i++)
        (void)close(stream[i].descriptor[0]);
    errno = reason;
    return status;
}
