#include "file/file.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <time.h>
#include <unistd.h>

#include "base/base.h"

#define LOOK_AGAIN_MS 50
#define DESCRIPTORS   256 /* looked through: a shell gives its children single digits, bash from 10 or from 63 down */

int file_hold_standard(void)
{
    int descriptor = STDIN_FILENO;
    while (descriptor >= 0 && descriptor <= STDERR_FILENO)
        descriptor = open("/", O_RDONLY); /* the lowest number that is free */
    if (descriptor >= 0)
        (void)close(descriptor);
    return descriptor < 0 && errno != EMFILE; /* then the three are open */
}

/* Closes and keeps errno, for a return. */
static int give_up(int descriptor, int reason)
{
    (void)close(descriptor);
    errno = reason;
    return -1;
}

/* From here on reading and writing wait, as they do for any other file. */
static int let_wait(int descriptor)
{
    int flags = fcntl(descriptor, F_GETFL);
    return flags < 0 || fcntl(descriptor, F_SETFL, flags & ~O_NONBLOCK) < 0;
}

int file_descriptor(const char *path, struct stat *about)
{
    int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor >= 0 && fstat(descriptor, about) != 0)
        return give_up(descriptor, errno);
    return descriptor;
}

static FILE *stream_of(int descriptor, const char *mode)
{
    FILE *stream = fdopen(descriptor, mode);
    if (!stream)
        (void)give_up(descriptor, errno);
    return stream;
}

FILE *file_open_regular(const char *path, struct stat *about)
{
    int descriptor = file_descriptor(path, about);
    if (descriptor >= 0 && !S_ISREG(about->st_mode))
        descriptor = give_up(descriptor, S_ISDIR(about->st_mode) ? EISDIR : EINVAL);
    return descriptor < 0 ? NULL : stream_of(descriptor, "rb");
}

/* Waits until there is something to read from a pipe, or its writers have come and gone. Nothing within FILE_WAIT: nonzero with
 * errno where it has no writer; *byte >= 0 where the question, which only a read answers, has found one. */
static int await_writer(int descriptor, int *byte)
{
    struct pollfd pipe = {.fd = descriptor, .events = POLLIN};
    unsigned char first;
    int ready = poll(&pipe, 1, (int)(1000 * FILE_WAIT));
    if (ready)
        return ready < 0;
    ssize_t got = read(descriptor, &first, 1);
    if (got == 1)
        *byte = first;
    if (got == 0)
        errno = ENXIO;
    return got == 0 || (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK);
}

FILE *file_open(const char *path, int unbuffered, struct stat *about)
{
    int byte = -1, descriptor = file_descriptor(path, about);
    if (descriptor < 0)
        return NULL;
    if (S_ISDIR(about->st_mode))
        errno = EISDIR;
    if (S_ISDIR(about->st_mode) || (S_ISFIFO(about->st_mode) && await_writer(descriptor, &byte)) || let_wait(descriptor)) {
        (void)give_up(descriptor, errno);
        return NULL;
    }
    FILE *stream = stream_of(descriptor, "rb");
    if (stream && unbuffered)
        (void)setvbuf(stream, NULL, _IONBF, 0);
    if (stream && byte >= 0)
        (void)ungetc(byte, stream);
    return stream;
}

FILE *file_open_device(const char *path)
{
    const struct timespec pause = {.tv_nsec = LOOK_AGAIN_MS * 1000000L};
    const double until = clock_seconds() + FILE_WAIT;
    for (;;) {
        struct stat about;
        int descriptor = open(path, O_WRONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
        if (descriptor >= 0 && let_wait(descriptor))
            descriptor = give_up(descriptor, errno);
        if (descriptor >= 0)
            return stream_of(descriptor, "wb");
        if (errno != ENXIO || stat(path, &about) != 0 || !S_ISFIFO(about.st_mode))
            return NULL;
        if (clock_seconds() > until) {
            errno = ENXIO;
            return NULL;
        }
        if (nanosleep(&pause, NULL) != 0)
            return NULL; /* a signal */
    }
}

FILE *file_open_own(const char *path)
{
    struct stat link, about, other;
    int reason = 0;
    if (lstat(path, &link) == 0 && S_ISLNK(link.st_mode) && stat(path, &about) == 0)
        for (int d = 0; d < DESCRIPTORS; d++) {
            if (fstat(d, &other) != 0 || other.st_dev != about.st_dev || other.st_ino != about.st_ino)
                continue;
            int copy = (fcntl(d, F_GETFL) & O_ACCMODE) == O_RDONLY ? -1 : fcntl(d, F_DUPFD_CLOEXEC, 0);
            if (copy >= 0)
                return stream_of(copy, "wb");
            reason = EBADF;
        }
    errno = reason;
    return NULL;
}

int file_status(int number)
{
    return number == ENOMEM ? ROTID_ERROR_MEMORY : ROTID_ERROR_IO;
}

const char *file_error_text(int number, char *text)
{
    return number == ENXIO ? FILE_NOBODY : host_error_text(number, text);
}
