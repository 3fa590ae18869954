/* Universal files, written set by set to a stream that the caller has opened and will close and check (ferror): the formats of
 * the sets that uff_read.h reads, with the same structs. Reading what was written gives the same values to the digits of the
 * format, and bit by bit for binary sets. Every routine returns ROTID_OK, ROTID_ERROR_IO, or ROTID_ERROR_ARGUMENT for what the
 * format cannot hold: a value that is not finite (binary sets hold it), a line of text that looks like the end of a set, a label
 * beyond the width of its field. The stream may hold a part of the set then. */
#ifndef ROTID_UFF_UFF_WRITE_H
#define ROTID_UFF_UFF_WRITE_H

#include <stdio.h>

#include "uff/uff_data.h"

int uff_write_header(FILE *stream, const struct uff_header *header);                /* 151 */
int uff_write_units(FILE *stream, const struct uff_units *units);                   /* 164 */
int uff_write_nodes(FILE *stream, int set, int count, const struct uff_node *node); /* 15 or 2411 */
int uff_write_shape(FILE *stream, const struct uff_shape *shape);                   /* 55 */

/* Set 58, as text; function->binary.is_binary is ROTID_ERROR_ARGUMENT. The values come in pieces: uff_write_function writes the
 * records before them, uff_write_values any number of values (x only of an uneven abscissa, imag only of complex ones), until
 * function->count are there; uff_end_function closes the set. */
struct uff_function_writer {
    FILE *stream;
    const struct uff_function *function;
    long long written;
    int on_line; /* numbers on the current line of text */
};
int uff_write_function(FILE *stream, const struct uff_function *function, struct uff_function_writer *writer);
int uff_write_values(struct uff_function_writer *writer, long long count, const double *x, const double *real,
                     const double *imag);
int uff_end_function(struct uff_function_writer *writer);

#endif
