#include "api/api.h"

#include <stdio.h>
#include <string.h>

static int cancelled(void *context)
{
    struct call *call = context;
    const rotid_environment *given = &call->entry.environment;
    if (!atomic_load(&call->cancelled) && given->cancelled(given->context))
        atomic_store(&call->cancelled, 1);
    return atomic_load(&call->cancelled);
}

static void progress(void *context, const char *stage, int step)
{
    struct call *call = context;
    if (!atomic_load(&call->cancelled))
        call->entry.environment.progress(call->entry.environment.context, stage, step);
}

int call_open(struct call *call, const rotid_environment *given, char *failure, void *result, const char *name)
{
    int status = entry_open(&call->entry, given, failure);
    const rotid_environment *taken = &call->entry.environment;
    atomic_init(&call->cancelled, 0);
    call->environment = (rotid_environment){.size = sizeof call->environment,
                                            .allocator = taken->allocator,
                                            .cancelled = taken->cancelled ? cancelled : NULL,
                                            .progress = taken->progress ? progress : NULL,
                                            .context = call};
    message_open(&call->notes, &call->entry.scratch);
    if (result)
        memset(result, 0, sizeof(void *)); /* of whatever type it is */
    call->job = NULL;
    if (!status && !result)
        status = refuse(failure, "%s is NULL, expected the address of a pointer", name);
    if (!status)
        status = host_enter_locale(&call->locale);
    call->entered = status == ROTID_OK;
    return status;
}

static void explain(const struct call *call, char *failure)
{
    size_t length = 0;
    for (size_t i = 0; i < call->notes.count; i++) {
        const rotid_message *m = &call->notes.item[i];
        char place[64];
        if (m->severity != SEVERITY_ERROR)
            continue;
        length = failure_append(failure, length, length ? "; " : "");
        if (m->file) {
            (void)snprintf(place, sizeof place, ":%d:%d: ", m->line, m->column);
            length = failure_append(failure, failure_append(failure, length, m->file), place);
        }
        length = failure_append(failure, length, m->text);
    }
}

int call_close(struct call *call, int status)
{
    char *failure = call->entry.failure;
    if (call->job && status < 0)
        check_sections(call->job, status, &call->notes);
    if (failure && !*failure && status < 0)
        explain(call, failure);
    if (call->entered)
        host_leave_locale(&call->locale);
    return entry_close(&call->entry, status);
}

void *call_keep(const struct call *call, const struct record *record, const void *made, void **memory)
{
    struct pool *pool = call->entry.scratch.out_of_memory ? NULL : pool_new(call->environment.allocator);
    *memory = pool;
    void *kept = pool ? record_copy(pool, record, made) : NULL;
    if (!kept)
        pool_free(pool);
    return kept;
}
