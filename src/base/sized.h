/* Structs that a host fills and that may grow: their first member is the size that the host was compiled with. */
#ifndef ROTID_BASE_SIZED_H
#define ROTID_BASE_SIZED_H

#include <stddef.h>

#include "rotid.h"

/* In the order of the table in sized.c. */
enum sized {
    SIZED_ENVIRONMENT,
    SIZED_DIAGNOSE_OPTIONS,
    SIZED_SUGGEST_OPTIONS,
    SIZED_MODEL,
    SIZED_MEASURED,
    SIZED_STATE,
    SIZED_FIT_OPTIONS,
    SIZED_LM_OPTIONS
};

/* *copy := the struct of this library with what the host has of it, zeros in what it was compiled without. `given` is not NULL.
 * ROTID_ERROR_ARGUMENT, with the reason in failure, where size is below that of the first version (0 above all: it was not set),
 * or where a byte that this library does not know of is not zero: the host asks for something that it would not get. */
int sized_take(enum sized which, const void *given, char *failure, void *copy);

/* The same for a struct [known] of whose first version hosts have `first` bytes; names for the reason. */
struct sized_struct {
    const char *type, *argument;
    size_t first, known;
};
int sized_copy(const struct sized_struct *structure, const void *given, char *failure, void *copy);

#endif
