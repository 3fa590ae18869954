/* The comments of the members of structs, as headers have them: the one place where a key of a result is explained. */
#ifndef ROTID_TOOLS_SCHEMA_COMMENTS_H
#define ROTID_TOOLS_SCHEMA_COMMENTS_H

#include "base/base.h"

struct comment {
    const char *structure, *member; /* member NULL: of the struct itself */
    const char *text;               /* in one line, "NULL" and "NaN" as JSON has them: null */
};

struct comments {
    struct pool *pool;
    int count;
    size_t capacity;
    struct comment *item;
};

/* Adds what a header says, as its text. ROTID_OK or ROTID_ERROR_MEMORY. */
int comments_add(struct comments *comments, const char *header);

/* NULL where there is none. */
const char *comments_find(const struct comments *comments, const char *structure, const char *member);

#endif
