/* The file of results while a study writes it. Each line goes to its end with one write, so that whatever ends the program leaves
 * whole lines and at most one that is cut, which the next start removes. One process at a time holds its lock. */
#ifndef ROTID_STUDY_RECORD_H
#define ROTID_STUDY_RECORD_H

#include <sys/types.h>

#include "base/message.h"
#include "study/header.h"

enum record_state { RUN_MISSING, RUN_DONE, RUN_FAILED };

struct study_record {
    int descriptor;
    char *path; /* without symbolic links */
    struct header header;
    char study[DIGEST_LETTERS + 1]; /* stamp of its lines */
    char *state;                    /* [header.runs] of enum record_state; failed ones that are to be tried again are missing */
    long wanted, done, failed;      /* of the shard; failed ones are among those done */
    long next;                      /* where record_take goes on */
    long last;                      /* of the last line, -1 where there is none */
    int in_order;                   /* the lines stand in order of the runs, once each */
    off_t length;
    int unsynced;
    double synced; /* on the clock */
};

/* Opens or creates the file of the study that the header tells, and locks it. What is cut at its end goes; everything else stays
 * as it is. ROTID_OK; ROTID_ERROR_ARGUMENT where the file is something else, of another study or in use, ROTID_ERROR_IO: the list
 * says why; ROTID_ERROR_MEMORY. Without ROTID_OK nothing is open. */
int record_open(struct pool *pool, const char *path, const struct header *header, int retry_failed, struct message_list *messages,
                struct study_record *record);

/* The next run that is missing and was not given out yet, or -1. */
long record_take(struct study_record *record);

/* Appends the line of a run, stamped. ROTID_OK; ROTID_ERROR_IO with errno, ROTID_ERROR_MEMORY: the file then ends with the line
 * before. */
int record_append(struct study_record *record, long run, const char *line, int failed);

/* To the disk, where there is something new and the last time is a second ago; now [s] of the clock, infinity: in any case.
 * ROTID_OK or ROTID_ERROR_IO with errno. */
int record_sync(struct study_record *record, double now);

/* With every run there: writes the lines in order of the runs to a new file, which takes the place of this one, unless they stand
 * so already. ROTID_OK; ROTID_ERROR_IO with errno, ROTID_ERROR_MEMORY: the file is as it was. */
int record_finish(struct pool *pool, struct study_record *record);

void record_close(struct study_record *record);

#endif
