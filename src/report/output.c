#include "report/output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "rotid.h"

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

int output_open(struct output *output, const char *path)
{
    *output = (struct output){.path = path};
    if (is_special(path)) {
        output->stream = fopen(path, "wb");
        return output->stream ? ROTID_OK : ROTID_ERROR_IO;
    }
    output->beside = malloc(strlen(path) + sizeof ".XXXXXX");
    if (!output->beside)
        return ROTID_ERROR_MEMORY;
    (void)strcpy(output->beside, path);
    (void)strcat(output->beside, ".XXXXXX");
    output->stream = open_beside(output->beside);
    if (output->stream)
        return ROTID_OK;
    int reason = errno;
    free(output->beside);
    output->beside = NULL;
    errno = reason;
    return ROTID_ERROR_IO;
}

/* The file that is there now takes its final name, unless something failed. */
static int take_name(struct output *output, int failed)
{
    int reason = errno;
    mode_t mask = umask(0); /* mkstemp makes private files; a result is as readable as any other file of the user */
    (void)umask(mask);
    (void)chmod(output->beside, 0666 & ~mask);
    if (!failed && rename(output->beside, output->path) != 0) {
        failed = 1;
        reason = errno;
    }
    if (failed)
        (void)unlink(output->beside);
    free(output->beside);
    errno = reason;
    return failed;
}

int output_close(struct output *output)
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
    errno = reason;
    if (output->beside)
        failed = take_name(output, failed);
    *output = (struct output){0};
    return failed ? ROTID_ERROR_IO : ROTID_OK;
}

void output_abandon(struct output *output)
{
    (void)fclose(output->stream); /* what did not arrive is not wanted */
    if (output->beside)
        (void)unlink(output->beside);
    free(output->beside);
    *output = (struct output){0};
}

int output_write(const char *path, const char *text)
{
    if (!strcmp(path, "-"))
        return fputs(text, stdout) < 0 || fflush(stdout) != 0 ? ROTID_ERROR_IO : ROTID_OK;
    struct output output;
    int status = output_open(&output, path);
    if (status)
        return status;
    if (fputs(text, output.stream) < 0) {
        int reason = errno;
        output_abandon(&output);
        errno = reason;
        return ROTID_ERROR_IO;
    }
    return output_close(&output);
}
