#include "report/report.h"

#include <stdarg.h>

void screen_heading(const struct screen *to, const struct result_head *head)
{
    for (int i = 0; i < head->nheading; i++)
        (void)fprintf(to->out, "%s\n", head->heading[i]);
    if (!head->nheading)
        (void)fprintf(to->out, "%s\n", head->deck);
    (void)fputc('\n', to->out);
}

void screen_state(const struct screen *to, int i, const char *name)
{
    (void)fprintf(to->out, "%sstate %s\n", i ? "\n" : "", name);
}

void screen_notes(const struct screen *to, const struct message_list *notes)
{
    int any = 0;
    for (size_t i = 0; i < notes->count; i++)
        if (notes->item[i].severity == SEVERITY_WARNING && !notes->item[i].file)
            (void)fprintf(to->out, "%snote: %s\n", any++ ? "" : "\n", notes->item[i].text);
}

void screen_say(const struct screen *to, const char *format, ...)
{
    va_list arguments;
    char text[512];
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    (void)fprintf(to->out, "%s\n", text);
}

void screen_table(const struct screen *to, const struct table *table)
{
    if (!table || table->pool->out_of_memory || !table_rows(table))
        return;
    (void)fputc('\n', to->out);
    table_write_text(to->out, table, to->width);
}
