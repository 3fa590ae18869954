#include <stdio.h>
#include <string.h>

#include "export/ross_parts.h"

static int is_taken(const struct ross_names *names, const char *name)
{
    for (int i = 0; i < names->count; i++)
        if (!strcmp(names->item[i], name))
            return 1;
    return 0;
}

const char *ross_name(struct ross_names *names, const char *wanted, const char *otherwise)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
    char *word = pool_copy_text(names->pool, wanted && *wanted ? wanted : otherwise);
    for (char *c = word; c && *c; c++)
        if (!strchr(plain, *c))
            *c = '_';
    const char *name = word;
    for (int number = 2; name && is_taken(names, name); number++)
        name = pool_format(names->pool, "%s_%d", word, number);
    const char **item = name ? pool_grow(names->pool, names->item, (size_t)names->count, &names->capacity, sizeof *item) : NULL;
    if (!item)
        return NULL;
    names->item = item;
    names->item[names->count++] = name;
    return name;
}
