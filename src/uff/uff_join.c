#include "uff/uff_join.h"

#include <math.h>

/* Set 15 has six digits: the same node in set 2411 differs in the last of them. */
static int is_same_place(const double *a, const double *b)
{
    for (int i = 0; i < 3; ++i)
        if (fabs(a[i] - b[i]) > 1e-5 * fmax(fabs(a[i]), fabs(b[i])))
            return 0;
    return 1;
}

static int check_repeated(const char *path, const struct uff_placed_node *first, const struct uff_placed_node *again,
                          struct message_list *messages)
{
    const char *wrong = NULL;
    if (first->set_line == again->set_line)
        wrong = "occurs twice in the set";
    else if (!is_same_place(first->node.x, again->node.x))
        wrong = "was elsewhere in an earlier set";
    if (!wrong)
        return ROTID_OK;
    message_add(messages, SEVERITY_ERROR, path, again->line, 1, "set %d: node %d %s, line %d", again->set, again->node.id, wrong,
                first->line);
    return ROTID_ERROR_SYNTAX;
}

int uff_join_nodes(struct pool *pool, struct pool *scratch, const char *path, const struct uff_node_list *list,
                   struct message_list *messages, struct uff_file *out)
{
    struct uff_label_list labels = {0};
    for (size_t i = 0; i < list->count; ++i)
        if (uff_add_label(scratch, &labels, list->item[i].node.id) != ROTID_OK)
            return ROTID_ERROR_MEMORY;
    uff_sort_labels(&labels);

    char *dropped = POOL_ARRAY(scratch, char, list->count);
    if (!dropped)
        return ROTID_ERROR_MEMORY;
    size_t kept = list->count;
    for (size_t i = 1; i < labels.count; ++i) {
        if (labels.item[i].id != labels.item[i - 1].id)
            continue;
        int status = check_repeated(path, &list->item[labels.item[i - 1].order], &list->item[labels.item[i].order], messages);
        if (status != ROTID_OK)
            return status;
        dropped[labels.item[i].order] = 1; /* the first one stays */
        --kept;
    }

    out->node = POOL_ARRAY(pool, struct uff_node, kept);
    if (!out->node)
        return ROTID_ERROR_MEMORY;
    for (size_t i = 0; i < list->count; ++i)
        if (!dropped[i])
            out->node[out->node_count++] = list->item[i].node;
    return ROTID_OK;
}
