/* One worker process, seen from the one that hands out the runs. */
#ifndef ROTID_STUDY_WORKER_H
#define ROTID_STUDY_WORKER_H

#include <stddef.h>
#include <sys/types.h>

#include "study/study.h"

#define WORKER_NO_MEMORY 3 /* exit code of a process that had no room for its line */

struct worker {
    pid_t process; /* 0: there is none */
    int socket;
    long run;     /* under way, -1: none */
    double begun; /* on the clock */
    char *answer; /* [room] the bytes that have arrived: its length, then the line */
    size_t count, room;
};

/* Starts a process; others [nothers] are the workers there are, whose sockets it must not keep open. ROTID_OK, or ROTID_ERROR_IO
 * with errno. */
int worker_start(const struct study *study, int (*cancelled)(void *context), void *context, int nothers,
                 const struct worker *others, struct worker *worker);

/* Hands out a run. ROTID_OK, or ROTID_ERROR_IO where the process is gone. */
int worker_give(struct worker *worker, long run);

/* Takes what has arrived. 1: the answer is whole, its line in *line until the next call and the run no longer under way; 0: not
 * yet; ROTID_ERROR_IO: the process is gone; ROTID_ERROR_MEMORY. */
int worker_take(struct worker *worker, const char **line);

/* Tells it to end: at once with the signal, 0: when it reads on. */
void worker_tell(struct worker *worker, int signal_number);

/* Waits until it has ended and forgets it; returns what waitpid says. */
int worker_end(struct worker *worker);

#endif
