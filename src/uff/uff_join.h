/* The nodes of a file as one list. Internal to uff_*.c. */
#ifndef ROTID_UFF_UFF_JOIN_H
#define ROTID_UFF_UFF_JOIN_H

#include "uff/uff.h"
#include "uff/uff_reader.h"

/* All nodes of the list to *out, those of several sets joined. The same id twice in a set, or in two sets with different
 * coordinates, is an error at its line of `path`. ROTID_OK, ROTID_ERROR_SYNTAX or ROTID_ERROR_MEMORY. */
int uff_join_nodes(struct pool *pool, struct pool *scratch, const char *path, const struct uff_node_list *list,
                   struct message_list *messages, struct uff_file *out);

#endif
