/* Nodes: set 15 in single precision, one line a node; sets 2411 and 781 in double precision, two lines a node. */
#include <limits.h>

#include "uff/uff_reader.h"
#include "uff/uff_record.h"

static int add_node(struct uff_reader *reader, struct pool *pool, struct uff_node_list *list, int line,
                    const struct uff_node *node)
{
    if (list->count >= INT_MAX)
        return uff_fail(&reader->lines, 0, "more than %d nodes", INT_MAX);
    struct uff_placed_node *grown = pool_grow(pool, list->item, list->count, &list->capacity, sizeof *grown);
    if (!grown)
        return ROTID_ERROR_MEMORY;
    list->item = grown;
    list->item[list->count++] =
        (struct uff_placed_node){.node = *node, .line = line, .set = reader->set.number, .set_line = reader->set.line};
    return ROTID_OK;
}

/* One node, of which the first line is at hand. */
static int read_node(struct uff_lines *lines, int number, struct uff_node *node)
{
    if (number == 15)
        return uff_take_record(lines, &uff_node_15, node);
    int status = uff_take_record(lines, &uff_node_2411, node);
    return status == ROTID_OK ? uff_read_record(lines, &uff_place_2411, node) : status;
}

int uff_append_nodes(struct uff_reader *reader, struct pool *pool, struct uff_node_list *list)
{
    int number = reader->set.number;
    int status = number == 15 || number == 781 || number == 2411 ? uff_begin(reader, number) : ROTID_ERROR_ARGUMENT;
    if (status != ROTID_OK)
        return status;
    for (;;) {
        struct uff_node node;
        int is_end;
        status = uff_next_record(reader, "a node or '-1'", &is_end);
        if (status != ROTID_OK || is_end)
            return uff_end(reader, status, UFF_BETWEEN);
        int line = reader->lines.line;
        status = read_node(&reader->lines, number, &node);
        if (status == ROTID_OK)
            status = add_node(reader, pool, list, line, &node);
        if (status != ROTID_OK)
            return uff_end(reader, status, UFF_BETWEEN);
    }
}

int uff_read_nodes(struct uff_reader *reader, struct pool *pool, int *count, struct uff_node **node)
{
    struct pool scratch; /* what grows grows there and is copied to its length */
    struct uff_node_list list = {0};
    *count = 0;
    *node = NULL;
    pool_open(&scratch, reader->allocator);
    int status = uff_append_nodes(reader, &scratch, &list);
    if (status == ROTID_OK) {
        *node = POOL_ARRAY(pool, struct uff_node, list.count);
        status = *node ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    for (size_t i = 0; i < list.count && status == ROTID_OK; ++i)
        (*node)[i] = list.item[i].node;
    *count = status == ROTID_OK ? (int)list.count : 0;
    pool_close(&scratch);
    return status;
}
