#include "report/output.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "rotid.h"

static int write_stream(FILE *stream, const char *text)
{
    return fputs(text, stream) < 0 || fflush(stream) != 0;
}

int output_write(const char *path, const char *text)
{
    if (!strcmp(path, "-"))
        return write_stream(stdout, text) ? ROTID_ERROR_IO : ROTID_OK;
    char *beside = malloc(strlen(path) + sizeof ".XXXXXX");
    if (!beside)
        return ROTID_ERROR_MEMORY;
    (void)strcpy(beside, path);
    (void)strcat(beside, ".XXXXXX");
    int descriptor = mkstemp(beside), failed = descriptor < 0, reason = errno;
    if (!failed) {
        FILE *stream = fdopen(descriptor, "w");
        failed = !stream || write_stream(stream, text) || fsync(descriptor) != 0;
        reason = errno;
        if (stream && fclose(stream) != 0 && !failed) {
            failed = 1;
            reason = errno;
        }
        mode_t mask = umask(0); /* mkstemp makes private files; a result is as readable as any other file of the user */
        (void)umask(mask);
        (void)chmod(beside, 0666 & ~mask);
        if (!failed && rename(beside, path) != 0) {
            failed = 1;
            reason = errno;
        }
        if (failed)
            (void)unlink(beside);
    }
    free(beside);
    errno = reason;
    return failed ? ROTID_ERROR_IO : ROTID_OK;
}
