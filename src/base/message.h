/* What a job has to say about its input, kept until somebody prints it: each message names the place. */
#ifndef ROTID_BASE_MESSAGE_H
#define ROTID_BASE_MESSAGE_H

#include "base/pool.h"

enum severity { SEVERITY_NOTE = ROTID_NOTE, SEVERITY_WARNING = ROTID_WARNING, SEVERITY_ERROR = ROTID_ERROR };

/* Errors past this many are counted and not kept: a binary file makes one a byte. Nor are as many of the others, apart from them:
 * why a deck is refused has to be said behind any number of warnings. */
#define MESSAGE_LIMIT 200

struct message_list {
    struct pool *pool;
    rotid_message *item;
    size_t count, capacity;
    int errors; /* of any number, also those not kept */
    int out_of_memory;
};

void message_open(struct message_list *list, struct pool *pool);
void message_add(struct message_list *list, enum severity severity, const char *file, int line, int column, const char *format,
                 ...) __attribute__((format(printf, 6, 7)));
/* The texts of the warnings (pool) and how many there are; NULL where memory is out. */
const char **message_warnings(const struct message_list *list, struct pool *pool, int *count);

#endif
