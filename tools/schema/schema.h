/* The JSON schema (2020-12) of a result, from its table and the comments of its structs. */
#ifndef ROTID_TOOLS_SCHEMA_SCHEMA_H
#define ROTID_TOOLS_SCHEMA_SCHEMA_H

#include <stdio.h>

#include "comments.h"
#include "record/record.h"

/* Writes the schema of a result of `command`. Returns the number of keys that have no comment, each told on standard error. */
int schema_write(FILE *out, const char *command, const struct record *record, const struct comments *comments);

/* The same of a file that has a line of one table first, and then lines of another one. */
int schema_write_lines(FILE *out, const struct record *first, const struct record *other, const struct comments *comments);

#endif
