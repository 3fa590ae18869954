#include "api/api.h"

void *call_keep(const struct call *call, const struct record *record, const void *made, void **memory)
{
    struct pool *pool = call->entry.scratch.out_of_memory ? NULL : pool_new(call->environment.allocator);
    *memory = pool;
    void *kept = pool ? record_copy(pool, record, made) : NULL;
    if (!kept)
        pool_free(pool);
    return kept;
}
