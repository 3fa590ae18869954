/* A universal file written anew with its functions as text (58) or binary (58b). */
#ifndef ROTID_IMPORT_CONVERT_H
#define ROTID_IMPORT_CONVERT_H

#include <stdio.h>

#include "base/message.h"
#include "base/pool.h"

enum convert_format { CONVERT_OTHER, CONVERT_ASCII, CONVERT_BINARY }; /* OTHER: than that of the first function */

struct convert_options {
    int format;
    int (*cancelled)(void *context); /* asked now and then, NULL allowed */
    void *context;
};

struct convert_result {
    int is_binary;                 /* of the functions written */
    int functions, others, copied; /* sets: functions, others written anew, others copied byte by byte */
};

/* Reads `path` set by set and writes to `out`. Single precision stays single in binary; as text, whose single precision has six
 * digits, numbers from a binary file are written as double (13 digits), numbers from text as they were. A set that is not known,
 * or that its struct does not hold whole (18, 2420, 2414 on nodes of elements, 55 of transients), or that does not fit its
 * format, is copied. A set that is malformed ends it. ROTID_OK; ROTID_STOP_CANCELLED; ROTID_ERROR_SYNTAX or _ARGUMENT (a value
 * that text cannot hold), both in `messages`; ROTID_ERROR_IO with `messages` for reading and without for writing (errno);
 * ROTID_ERROR_MEMORY. */
int convert_file(const char *path, const struct convert_options *options, FILE *out, struct message_list *messages,
                 struct convert_result *result);

#endif
