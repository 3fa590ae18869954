#include "base/base.h"

void message_open(struct message_list *list, struct pool *pool)
{
    *list = (struct message_list){.pool = pool};
}

void message_add(struct message_list *list, enum severity severity, const char *file, int line, int column, const char *format,
                 ...)
{
    char text[1024];
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text, sizeof text, format, values);
    va_end(values);
    size_t errors = list->errors < MESSAGE_LIMIT ? (size_t)list->errors : MESSAGE_LIMIT; /* kept */
    int is_error = severity == SEVERITY_ERROR;
    list->errors += is_error;
    if ((is_error ? errors : list->count - errors) >= MESSAGE_LIMIT)
        return;
    rotid_message *grown = pool_grow(list->pool, list->item, list->count, &list->capacity, sizeof *grown);
    if (grown)
        list->item = grown; /* now: the capacity already is that of the new array */
    char *copy = grown ? pool_copy_text(list->pool, text) : NULL;
    char *place = copy && file ? pool_copy_text(list->pool, file) : NULL;
    if (copy && (!file || place))
        list->item[list->count++] = (rotid_message){severity, line, column, place, copy};
}

const char **message_warnings(const struct message_list *list, struct pool *pool, int *count)
{
    const char **text = POOL_ARRAY(pool, const char *, list->count);
    *count = 0;
    for (size_t i = 0; i < list->count && text; i++)
        if (list->item[i].severity == SEVERITY_WARNING)
            text[(*count)++] = list->item[i].text;
    return text;
}

const char *message_errors(const struct message_list *list, struct pool *pool)
{
    const char *text = "";
    for (size_t i = 0; i < list->count; i++) {
        const rotid_message *m = &list->item[i];
        if (m->severity != SEVERITY_ERROR)
            continue;
        const char *place = m->file ? pool_text(pool, "%s:%d:%d: ", m->file, m->line, m->column) : "";
        text = pool_text(pool, "%s%s%s%s", text, *text ? "; " : "", place, m->text);
    }
    return text;
}
