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

/* The same, but a field also ends where a sign cannot belong to it any more, as in -1.00000e+00-2.00000e+00: behind an
 * exponent, or where the number has no point (a sign behind digits with a point is an exponent without its letter). */
int uff_split_signs(const struct uff_lines *lines, struct uff_field *field, int limit);

/* What the columns start to start + width - 1 hold, without the blanks around it. */
struct uff_field uff_cut_column(const struct uff_lines *lines, size_t start, size_t width);

/* A real that touches its neighbour must show its point: else a long number would be cut in two valid ones, and a Fortran
 * reader would scale it. */
int uff_is_cut_off(const struct uff_lines *lines, struct uff_field field);

/* The error that this field is: ROTID_ERROR_SYNTAX. `expected` says what the record holds. */
int uff_fail_field(struct uff_lines *lines, const char *what, enum uff_fault fault, struct uff_field field, int is_integer,
                   const char *expected);

#endif
