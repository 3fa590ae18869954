/* Shards, or other parts of one study, into one file of results in order of the runs: byte for byte what one program alone would
 * have written, but for the times. */
#ifndef ROTID_STUDY_MERGE_H
#define ROTID_STUDY_MERGE_H

#include "base/message.h"

struct merge {
    long runs, missing, failed;
    const char *list; /* of the runs that are missing, "3, 7-9"; the first few of many */
};

/* Reads `part` [count] and writes `path`, which must not exist. A run in several parts must have the same result in all, but for
 * its time; where it failed in some and not in others, it is taken from those where it did not. What is missing is no error: the
 * file is then that of a study which goes on. ROTID_OK; ROTID_ERROR_ARGUMENT where the parts are not of one study or contradict
 * each other, ROTID_ERROR_SYNTAX, ROTID_ERROR_IO: the list says so, and nothing is written; ROTID_ERROR_MEMORY. */
int merge_results(struct pool *pool, int count, char *const *part, const char *path, struct message_list *messages,
                  struct merge *merge);

#endif
