/* Another program, run without a shell, with nothing on its standard input. */
#ifndef ROTID_PAGE_PROCESS_H
#define ROTID_PAGE_PROCESS_H

#include "base/pool.h"

#define PROCESS_TEXT 8192 /* bytes of what it writes that are kept */

struct process_result {
    int exit_code; /* -1: ended by a signal */
    int timed_out, cancelled;
    char out[PROCESS_TEXT], err[PROCESS_TEXT]; /* the beginning of what it wrote */
};

/* Runs argv[0], looked up in PATH where it has no slash, in the folder of a descriptor, and waits for it. It is ended after
 * `seconds`, or as soon as environment->cancelled (may be NULL) says so. ROTID_OK however it ended; ROTID_ERROR_IO: it could not
 * be started, errno tells why. While it starts, this process is in that folder as well. */
#define PROCESS_HERE (-1) /* for folder: the one this process is in */
int process_run(const char *const argv[], int folder, double seconds, const rotid_environment *environment,
                struct process_result *result);

#endif
