#include "api/call.h"

#include <stdio.h>
#include <string.h>

static int cancelled(void *context)
{
    struct call *call = context;
    if (!atomic_load(&call->cancelled) && call->given->cancelled(call->given->context))
        atomic_store(&call->cancelled, 1);
    return atomic_load(&call->cancelled);
}

static void progress(void *context, const char *stage, int step)
{
    struct call *call = context;
    if (!atomic_load(&call->cancelled))
        call->given->progress(call->given->context, stage, step);
}

int call_open(struct call *call, const rotid_environment *given, const void *result)
{
    const rotid_allocator *allocator = given ? given->allocator : NULL;
    call->given = given;
    atomic_init(&call->cancelled, 0);
    call->environment = (rotid_environment){.allocator = allocator,
                                            .cancelled = given && given->cancelled ? cancelled : NULL,
                                            .progress = given && given->progress ? progress : NULL,
                                            .context = call};
    pool_open(&call->scratch, allocator);
    message_open(&call->notes, &call->scratch);
    int status = result ? host_enter(&call->host) : ROTID_ERROR_ARGUMENT;
    call->entered = status == ROTID_OK;
    return status;
}

void call_close(struct call *call)
{
    pool_close(&call->scratch);
    if (call->entered)
        host_leave(&call->host);
}

/* As much of the text as fits; returns the length then, and that of a full buffer once something was cut off. */
static size_t append(char *failure, size_t length, const char *text)
{
    const size_t full = FAILURE_LENGTH - 1;
    size_t count = strlen(text), room = full - length;
    int cut = count > room;
    if (cut)
        for (count = room; count && ((unsigned char)text[count] & 0xc0) == 0x80;)
            count--; /* not within a character of UTF-8 */
    memcpy(failure + length, text, count);
    failure[length + count] = 0;
    return cut ? full : length + count;
}

void call_explain(const struct call *call, int status, char *failure)
{
    size_t length = 0;
    if (!failure)
        return;
    *failure = 0;
    for (size_t i = 0; i < call->notes.count && status; i++) {
        const struct message *m = &call->notes.item[i];
        char place[64];
        if (m->severity != SEVERITY_ERROR)
            continue;
        length = append(failure, length, length ? "; " : "");
        if (m->file) {
            (void)snprintf(place, sizeof place, ":%d:%d: ", m->line, m->column);
            length = append(failure, append(failure, length, m->file), place);
        }
        length = append(failure, length, m->text);
    }
    if (status && (!length || status == ROTID_ERROR_MEMORY))
        (void)append(failure, 0, rotid_status_text(status));
}
