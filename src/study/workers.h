/* Runs of a study in processes of this machine. Each takes the number of a run, computes it and gives back its line; one that
 * dies costs its run, which is recorded as failed, and is replaced. */
#ifndef ROTID_STUDY_WORKERS_H
#define ROTID_STUDY_WORKERS_H

#include "study/record.h"

struct study_progress {
    long done, wanted, failed; /* of the file */
    long computed;             /* by this program */
    double seconds;            /* since it began with them */
};

struct workers_options {
    int workers;    /* >= 1 */
    double timeout; /* [s] a run may take, 0: any time */
    int (*cancelled)(void *context);
    void (*progress)(void *context, const struct study_progress *progress); /* NULL, or called a few times a second */
    void *context;
};

/* Computes the runs that are missing in the record. Handlers of signals are inherited by the workers, of which `cancelled` is
 * asked as well. ROTID_OK: every run is there; ROTID_STOP_CANCELLED: what was finished is there; ROTID_ERROR_IO (errno): the file
 * cannot be written, or no process can be started; ROTID_ERROR_MEMORY. Leaves no process behind. */
int workers_run(struct pool *pool, const struct study *study, const struct workers_options *options, struct study_record *record);

#endif
