/* Universal files: nodes (15, 2411) and mode shapes (55) of a modal test. */
#ifndef ROTID_UFF_UFF_H
#define ROTID_UFF_UFF_H

#include "base/message.h"
#include "base/pool.h"
#include "uff/uff_data.h"

struct uff_file {
    int node_count, shape_count, extra_count;
    struct uff_node *node; /* ids distinct, in the order of the file */
    struct uff_shape *shape;
    struct uff_shape *extra; /* sets 55 of analysis type 0 that rotid has written itself: their first line begins with "ROTID " */
};

/* Reads a file. Sets 15, 2411, 781 give nodes, sets 55 shapes; all others are skipped, with one note for each type. Everything
 * found lives on the pool. Reading stops at the first malformed set: an error in the message list that names file, line, column,
 * the set, and what was expected. Returns ROTID_OK, ROTID_ERROR_SYNTAX (the list says why), ROTID_ERROR_IO (cannot be read; also
 * in the list) or ROTID_ERROR_MEMORY. *out is empty unless ROTID_OK. A file without a set 55 is ROTID_OK. */
int uff_read(struct pool *pool, const char *path, struct message_list *messages, struct uff_file *out);

#endif
