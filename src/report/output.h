/* Files that are whole or not there: written beside their final name, then renamed. */
#ifndef ROTID_REPORT_OUTPUT_H
#define ROTID_REPORT_OUTPUT_H

#include <stdio.h>

/* Writes text to path, "-" being standard output. ROTID_OK or ROTID_ERROR_IO (errno tells why), ROTID_ERROR_MEMORY. */
int output_write(const char *path, const char *text);

/* The same for a file that is written piece by piece: the caller writes to `stream`, then closes the output. */
struct output {
    FILE *stream;
    const char *path; /* of the caller, who keeps it until the end */
    char *beside;
};

/* ROTID_OK, ROTID_ERROR_IO (errno tells why) or ROTID_ERROR_MEMORY; then there is nothing to close. */
int output_open(struct output *output, const char *path);
/* status: of the caller's writing. Renames the file when that is ROTID_OK and all has arrived, else removes it and keeps errno.
 * Returns the status, or ROTID_ERROR_IO (errno). */
int output_close(struct output *output, int status);
/* The same for several files, all of them or none: those that had taken their names when one could not are put back as they were
 * (where the file system has hard links). *failed is the index of that one. */
int output_close_all(int count, struct output *output, int *failed);
/* Whether there is a file that is not closed yet, for the handler of a signal. */
int output_is_open(void);
/* Removes it; errno stays. */
void output_abandon(struct output *output);
/* Why one of these failed, by errno. */
const char *output_error(void);

#endif
