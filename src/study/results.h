/* Reading a file of results, line by line, without ever holding more than one. */
#ifndef ROTID_STUDY_RESULTS_H
#define ROTID_STUDY_RESULTS_H

#include <sys/types.h>

#include "base/message.h"
#include "result/study.h"
#include "study/header.h"
#include "study/stamp.h"

struct results {
    int descriptor; /* the caller's: it stays open, and where it stands does not matter */
    const char *path;
    struct message_list *messages;
    struct header header;
    char study[DIGEST_LETTERS + 1]; /* what its lines are stamped with */
    char *there;                    /* [header.runs] 1: a line of the run failed, 2: one did not */
    int number;                     /* of the line read last, from 1 */
    off_t next;                     /* where the next line begins; at the end: where the last whole one ends */
    off_t size;                     /* of the file, beyond `next` where the last line is cut */
    struct pool line;               /* of the line read last */
    char *buffer;
    size_t capacity, first, count; /* bytes of the buffer not yet given out */
};

struct result_line {
    long run;
    int failed;
    const char *text; /* [length] with the line feed; until the next line is read */
    size_t length;
    off_t offset;
    const struct study_run *said; /* until the next line is read */
};

/* Reads the header. ROTID_OK; ROTID_ERROR_SYNTAX where the file is something else, ROTID_ERROR_IO: the list says so;
 * ROTID_ERROR_MEMORY. Header texts go to the pool; results_close also after an error. */
int results_open(struct pool *pool, int descriptor, const char *path, struct message_list *messages, struct results *results);
/* ROTID_OK with the next line, 1 behind the last whole one, ROTID_ERROR_SYNTAX, _IO (both with a message) or _MEMORY. *line: the
 * one before, or zeros. A line that was changed, is of another study or of a run that stands there already, unless that had
 * failed, is an error: which of the two counts, or what the line said, nobody knows here. */
int results_next(struct results *results, struct result_line *line);
void results_close(struct results *results);

struct result_place { /* of the line that counts for a run, the last one; length 0: there is none */
    off_t offset;
    size_t length;
};

/* Where the runs of a file stand: *place [header->runs]; *most: the length of the longest line. Statuses of results_next. */
int results_index(struct pool *pool, int descriptor, const char *path, struct message_list *messages, struct header *header,
                  struct result_place **place, size_t *most);

/* The run of a line, on the pool. NULL, or the mistake in the line; "" where memory is out. */
const char *results_line_read(struct pool *pool, const char *text, size_t length, struct study_run *run);

/* Whether the line is that of a run that failed. */
int result_failed(const char *line);

/* A line by its place into text [length]. ROTID_OK or ROTID_ERROR_IO. */
int results_fetch(int descriptor, struct result_place place, char *text);

#endif
