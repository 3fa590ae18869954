/* The functions, points and units of a universal file, without the values of the functions. */
#ifndef ROTID_IMPORT_CONTENTS_H
#define ROTID_IMPORT_CONTENTS_H

#include "base/message.h"
#include "base/pool.h"
#include "uff/uff_read.h"

struct content {
    struct uff_set set; /* where it stands */
    struct uff_function
        function; /* is_even, start and step also where an uneven abscissa is even to the digits it was written with */
    double *x;    /* [function.count] of one that is not, NULL else */
};

struct contents {
    int count;
    struct content *item; /* [count] sets 58 and 58b in the order of the file */
    int node_count;
    struct uff_node *node; /* ids distinct: the first of several wins, with a warning where they differ; metres */
    struct uff_units units;
    int has_units;
};

/* Reads over a file from its beginning. ROTID_OK or the statuses of uff_next and of the readers. */
int contents_read(struct pool *pool, struct uff_reader *reader, const char *path, struct message_list *messages,
                  struct contents *contents);

/* Values first ... first + count - 1 of a function, times a factor: real [count], imag [count] (NULL: of a real one). Statuses of
 * uff_return_to and of the readers; fewer values than the function has are not asked for. */
int contents_values(struct uff_reader *reader, const struct content *item, long long first, long long count, double factor,
                    double *real, double *imag);

/* Quantity of an axis as enum frf_quantity: -1 where it is no motion. A type that is not given is told by the text of the unit.
 */
int motion_of(const struct uff_axis *axis);
int is_force(const struct uff_axis *axis);

#endif
