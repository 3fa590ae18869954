/* Where the fields of a line stand. Internal to uff_fields.c, uff_columns.c and uff_values.c. */
#ifndef ROTID_UFF_UFF_FIELDS_H
#define ROTID_UFF_UFF_FIELDS_H

#include "uff/uff_lines.h"
#include "uff/uff_numbers.h"

struct uff_field {
    size_t start, length;
};

/* Blank-separated fields, at most `limit` of them. */
int uff_split_blanks(const struct uff_lines *lines, struct uff_field *field, int limit);

/* What the columns start to start + width - 1 hold, without the blanks around it. */
struct uff_field uff_cut_column(const struct uff_lines *lines, size_t start, size_t width);

/* The error that this field is: ROTID_ERROR_SYNTAX. `expected` describes the record. */
int uff_fail_field(struct uff_lines *lines, const char *what, enum uff_fault fault, struct uff_field field, int is_integer,
                   const char *expected);

#endif
