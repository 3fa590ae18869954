/* Ids that must not occur twice. */
#include <stdlib.h>

#include "uff/uff_reader.h"

int uff_add_label(struct pool *pool, struct uff_label_list *labels, int id)
{
    struct uff_label *grown = pool_grow(pool, labels->item, labels->count, &labels->capacity, sizeof *grown);
    if (!grown)
        return ROTID_ERROR_MEMORY;
    labels->item = grown;
    labels->item[labels->count] = (struct uff_label){id, (int)labels->count};
    ++labels->count;
    return ROTID_OK;
}

static int compare_labels(const void *first, const void *second)
{
    const struct uff_label *a = first, *b = second;
    if (a->id != b->id)
        return a->id < b->id ? -1 : 1;
    return (a->order > b->order) - (a->order < b->order);
}

void uff_sort_labels(struct uff_label_list *labels)
{
    size_t sorted = 1;
    while (sorted < labels->count && labels->item[sorted - 1].id < labels->item[sorted].id)
        ++sorted;
    if (sorted < labels->count) /* most writers sort */
        qsort(labels->item, labels->count, sizeof *labels->item, compare_labels);
}
