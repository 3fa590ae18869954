#include "api/holding.h"

#include <string.h>

struct holding *holding_new(const rotid_environment *environment)
{
    struct pool pool;
    pool_open(&pool, environment ? environment->allocator : NULL);
    struct holding *holding = POOL_NEW(&pool, struct holding);
    if (holding)
        holding->pool = pool;
    return holding;
}

void holding_free(struct holding *holding)
{
    if (!holding)
        return;
    for (int i = 0; i < HOLDING_FITS; i++)
        rotid_fit_free(holding->fit[i]);
    struct pool pool = holding->pool; /* it goes with its own blocks */
    pool_close(&pool);
}

void *holding_copy(struct holding *holding, const void *source, ptrdiff_t count, size_t size)
{
    if (!source)
        return NULL;
    void *copy = pool_get(&holding->pool, (size_t)count, size);
    if (!copy)
        holding->missing = 1;
    else if (count)
        memcpy(copy, source, (size_t)count * size);
    return copy;
}

const char *holding_text(struct holding *holding, const char *text)
{
    return text ? holding_copy(holding, text, (ptrdiff_t)strlen(text) + 1, 1) : NULL;
}

const rotid_parameter *holding_parameters(struct holding *holding, int count, const rotid_parameter *parameter)
{
    rotid_parameter *copy = HOLDING_COPY(holding, parameter, count);
    for (int p = 0; copy && p < count; p++) {
        copy[p].name = holding_text(holding, parameter[p].name);
        copy[p].unit = holding_text(holding, parameter[p].unit);
    }
    return copy;
}

const rotid_message *holding_messages(struct holding *holding, const struct message_list *list)
{
    _Static_assert((int)SEVERITY_NOTE == ROTID_NOTE && (int)SEVERITY_WARNING == ROTID_WARNING &&
                       (int)SEVERITY_ERROR == ROTID_ERROR,
                   "severities of the header");
    rotid_message *copy = POOL_ARRAY(&holding->pool, rotid_message, list->count);
    holding->missing |= !copy || list->out_of_memory;
    for (size_t i = 0; copy && i < list->count; i++) {
        const struct message *m = &list->item[i];
        copy[i] =
            (rotid_message){(int)m->severity, m->line, m->column, holding_text(holding, m->file), holding_text(holding, m->text)};
    }
    return copy;
}
