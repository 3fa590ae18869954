/* Universal files, read one set after the other: nothing but the set at hand is in memory, and of a function only as many values
 * as are asked for, so a file may be larger than memory. */
#ifndef ROTID_UFF_UFF_READ_H
#define ROTID_UFF_UFF_READ_H

#include "base/message.h"
#include "base/pool.h"
#include "uff/uff_data.h"

enum { UFF_END = 1 }; /* beside the statuses of rotid.h: no further set, no further value */

struct uff_set {
    int number;       /* 58 of a set 58b */
    int is_binary;    /* 58b */
    int line;         /* of the '-1' that opens it, from 1; lines are not counted inside binary data */
    long long offset; /* of that line in the file, in bytes */
};

struct uff_reader; /* opaque; lives on the pool it was opened with */

/* Opens a file. What is wrong with it, now and later, goes to `messages` with file, line, column, set and what was expected.
 * ROTID_OK, ROTID_ERROR_IO, ROTID_ERROR_MEMORY. uff_close for a reader that was opened, NULL allowed. */
int uff_open(struct pool *pool, const char *path, struct message_list *messages, struct uff_reader **reader);
void uff_close(struct uff_reader *reader);

/* Goes on to the next set; the rest of the one before is read over (a binary set by its length). ROTID_OK, UFF_END, or
 * ROTID_ERROR_SYNTAX, _IO, _MEMORY. After an error of syntax in a set uff_next finds the next one, so a caller may go on. */
int uff_next(struct uff_reader *reader, struct uff_set *set);

/* Whether it can go back: a pipe cannot. */
int uff_can_return(const struct uff_reader *reader);

/* Goes back to a set that uff_next returned before, as if it had just been returned. ROTID_OK or ROTID_ERROR_IO. */
int uff_return_to(struct uff_reader *reader, const struct uff_set *set);

/* Each reads the set that uff_next has just returned, and fails with ROTID_ERROR_SYNTAX (messages say where), _IO or _MEMORY, or
 * with ROTID_ERROR_ARGUMENT when the set at hand is of another number or has been read. Arrays lie on `pool`; no memory is taken
 * for what is announced, only for what is there. Numbers that are not finite are errors. */
int uff_read_header(struct uff_reader *reader, struct uff_header *header);                                     /* 151 */
int uff_read_units(struct uff_reader *reader, struct uff_units *units);                                        /* 164 */
int uff_read_nodes(struct uff_reader *reader, struct pool *pool, int *count, struct uff_node **node);          /* 15, 781, 2411 */
int uff_read_shape_set(struct uff_reader *reader, struct pool *pool, struct uff_shape *shape);                 /* 55 */

/* The records 1 to 11 of a set 58 or 58b, then, in pieces of any length, its values in turn: `*got` <= most of them, x (of an
 * uneven abscissa as in the file, else start + i step; or NULL), real, imag (0 for real data; or NULL). ROTID_OK with *got = 0 at
 * the end of the values, after which the set has been checked to be complete. A wrong number of bytes of a 58b is a warning where
 * its end stands behind the bytes that its values need. DEC and IBM numbers are refused by uff_read_values. */
int uff_read_function(struct uff_reader *reader, struct uff_function *function);
int uff_read_values(struct uff_reader *reader, long long most, double *x, double *real, double *imag, long long *got);

/* What a value of this quantity must be multiplied with to be in SI: specific data types of set 58 (8 displacement, 11 velocity,
 * 12 acceleration, 13 and 9 force, 15 pressure, 16 mass, 17 time, 18 frequency) and the exponents of the axis under `units` (NULL
 * or factors of 0: 1). A unit text "g" or "gn" of an acceleration is 9.80665 m/s2, whatever set 164 says. */
double uff_si_factor(const struct uff_units *units, const struct uff_axis *axis);

#endif
