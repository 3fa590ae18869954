#include "report/report.h"

#include <errno.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include "file/file.h"

static volatile sig_atomic_t open_outputs;

/* The path with what mkstemp fills in behind it, to be freed; NULL where memory is out. */
static char *template_of(const char *path)
{
    char *name = malloc(strlen(path) + sizeof ".XXXXXX");
    return name ? strcat(strcpy(name, path), ".XXXXXX") : NULL;
}

int output_is_open(void)
{
    return open_outputs > 0;
}

/* A device or a pipe is written to as it is: there is nothing to keep whole, and a rename would put a file in its place. */
static int is_special(const char *path)
{
    struct stat existing;
    return stat(path, &existing) == 0 && !S_ISREG(existing.st_mode) && !S_ISDIR(existing.st_mode);
}

/* The stream of a file that does not exist yet, named beside the final one; NULL with errno. */
static FILE *open_beside(char *name)
{
    int descriptor = mkstemp(name);
    FILE *stream = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
    if (descriptor >= 0 && !stream) {
        int reason = errno;
        (void)close(descriptor);
        (void)unlink(name);
        errno = reason;
    }
    return stream;
}

/* Ends an output that has its final name, or removes what stands beside it; errno is kept. */
static void forget(struct output *output, int remove)
{
    int reason = errno;
    if (remove && output->beside)
        (void)unlink(output->beside);
    open_outputs -= output->beside != NULL;
    free(output->beside);
    *output = (struct output){0};
    errno = reason;
}

int output_open(struct output *output, const char *path)
{
    *output = (struct output){.path = path};
    output->stream = file_open_own(path);
    if (!output->stream && errno)
        return ROTID_ERROR_IO;
    if (output->stream) { /* it may be standard output: what was printed before stands before */
        (void)terminal_flush();
        return ROTID_OK;
    }
    if (is_special(path)) {
        output->stream = file_open_device(path);
        return output->stream ? ROTID_OK : ROTID_ERROR_IO;
    }
    if (!(output->beside = template_of(path)))
        return ROTID_ERROR_MEMORY;
    open_outputs++;
    output->stream = open_beside(output->beside);
    if (output->stream)
        return ROTID_OK;
    forget(output, 0);
    return ROTID_ERROR_IO;
}

/* Everything is on the disk, under the name beside the final one; 1 with errno where something failed. */
static int finish(struct output *output)
{
    int failed = fflush(output->stream) != 0 || ferror(output->stream), reason = errno;
    if (!failed && output->beside && fsync(fileno(output->stream)) != 0) {
        failed = 1;
        reason = errno;
    }
    if (fclose(output->stream) != 0 && !failed) {
        failed = 1;
        reason = errno;
    }
    output->stream = NULL;
    errno = reason;
    return failed;
}

/* The file that is there now takes its final name; 1 with errno where it cannot. */
static int take_name(const struct output *output)
{
    struct stat existing;
    mode_t mask = umask(0); /* mkstemp makes private files; a new result is as readable as any other file of the user */
    (void)umask(mask);
    int replaces = stat(output->path, &existing) == 0 && S_ISREG(existing.st_mode); /* which may be private on purpose */
    (void)chmod(output->beside, replaces ? existing.st_mode & 0777 : 0666 & ~mask);
    return rename(output->beside, output->path) != 0;
}

int output_close(struct output *output, int status)
{
    if (status) {
        output_abandon(output);
        return status;
    }
    int failed = finish(output) || (output->beside && take_name(output));
    forget(output, failed);
    return failed ? ROTID_ERROR_IO : ROTID_OK;
}

/* A second name of what is at the path now; NULL where there is nothing or where it cannot have one. *absent: there is nothing.
 */
static char *keep_old(const char *path, int *absent)
{
    struct stat existing;
    *absent = lstat(path, &existing) != 0;
    char *name = *absent ? NULL : template_of(path);
    int descriptor = name ? mkstemp(name) : -1;
    if (descriptor >= 0) {
        (void)close(descriptor);
        (void)unlink(name); /* link() wants a name that is free */
        if (link(path, name) == 0)
            return name;
    }
    free(name);
    return NULL;
}

struct old_file {
    char *name;
    int absent;
};

/* How many of the files took their names: all, or those before one that could not, with errno. */
static int take_names(int count, const struct output *output, struct old_file *old)
{
    for (int i = 0; i < count; i++) {
        if (!output[i].beside)
            continue;
        old[i].name = keep_old(output[i].path, &old[i].absent);
        if (take_name(&output[i]))
            return i;
    }
    return count;
}

static void put_back(int count, const struct output *output, const struct old_file *old)
{
    for (int i = 0; i < count; i++)
        if (output[i].beside && old[i].name)
            (void)rename(old[i].name, output[i].path);
        else if (output[i].beside && old[i].absent)
            (void)unlink(output[i].path);
}

int output_close_all(int count, struct output *output, int *failed)
{
    int done = 0, reason = 0;
    struct old_file *old = calloc((size_t)count, sizeof *old);
    *failed = -1;
    for (int i = 0; i < count; i++)
        if ((!old || finish(&output[i])) && *failed < 0) {
            *failed = i;
            reason = old ? errno : ENOMEM;
        }
    if (*failed < 0 && (done = take_names(count, output, old)) < count) {
        *failed = done;
        reason = errno;
        put_back(done, output, old);
    }
    for (int i = 0; i < count; i++) {
        if (!old)
            (void)fclose(output[i].stream);
        else if (old[i].name)
            (void)unlink(old[i].name);
        free(old ? old[i].name : NULL);
        forget(&output[i], *failed >= 0);
    }
    free(old);
    errno = reason;
    return *failed < 0 ? ROTID_OK : ROTID_ERROR_IO;
}

void output_abandon(struct output *output)
{
    int reason = errno;
    (void)fclose(output->stream); /* what did not arrive is not wanted */
    errno = reason;
    forget(output, 1);
}

const char *output_error(void)
{
    return errno == ENXIO ? FILE_NOBODY : strerror(errno);
}

int output_write(const char *path, const char *text)
{
    if (!strcmp(path, "-"))
        return terminal_print(text);
    struct output output;
    int status = output_open(&output, path);
    if (status)
        return status;
    return output_close(&output, fputs(text, output.stream) < 0 ? ROTID_ERROR_IO : ROTID_OK);
}
