#include "api/result_memory.h"

#include <string.h>

struct result_memory *result_memory_new(const rotid_environment *environment)
{
    struct pool pool;
    pool_open(&pool, environment ? environment->allocator : NULL);
    struct result_memory *memory = POOL_NEW(&pool, struct result_memory);
    if (memory)
        memory->pool = pool;
    return memory;
}

void result_memory_free(struct result_memory *memory)
{
    if (!memory)
        return;
    for (int i = 0; i < memory->nfit; i++)
        rotid_fit_free(memory->fit[i]);
    struct pool pool = memory->pool; /* it goes with its own blocks */
    pool_close(&pool);
}

void *result_room(struct result_memory *memory, ptrdiff_t count, size_t size)
{
    void *room = pool_get(&memory->pool, (size_t)count, size);
    memory->missing |= !room;
    return room;
}

void *result_copy(struct result_memory *memory, const void *source, ptrdiff_t count, size_t size)
{
    void *copy = source ? result_room(memory, count, size) : NULL;
    if (copy && count)
        memcpy(copy, source, (size_t)count * size);
    return copy;
}

const char *result_text(struct result_memory *memory, const char *text)
{
    return text ? result_copy(memory, text, (ptrdiff_t)strlen(text) + 1, 1) : NULL;
}

const char *result_text_or_empty(struct result_memory *memory, const char *text)
{
    return text ? result_text(memory, text) : "";
}

const rotid_message *result_messages(struct result_memory *memory, const struct message_list *list)
{
    _Static_assert((int)SEVERITY_NOTE == ROTID_NOTE && (int)SEVERITY_WARNING == ROTID_WARNING &&
                       (int)SEVERITY_ERROR == ROTID_ERROR,
                   "severities of the header");
    rotid_message *copy = result_room(memory, (ptrdiff_t)list->count, sizeof *copy);
    memory->missing |= list->out_of_memory;
    for (size_t i = 0; copy && i < list->count; i++) {
        const struct message *m = &list->item[i];
        copy[i] =
            (rotid_message){(int)m->severity, m->line, m->column, result_text(memory, m->file), result_text(memory, m->text)};
    }
    return copy;
}
