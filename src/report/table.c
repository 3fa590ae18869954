#include "report/report.h"

void table_heading(FILE *out, const struct result_head *head)
{
    for (int i = 0; i < head->nheading; i++)
        (void)fprintf(out, "%s\n", head->heading[i]);
    if (!head->nheading)
        (void)fprintf(out, "%s\n", head->deck);
    (void)fputc('\n', out);
}

void table_state(FILE *out, int i, const char *name)
{
    (void)fprintf(out, "%sstate %s\n", i ? "\n" : "", name);
}

void table_notes(FILE *out, const struct message_list *notes)
{
    int any = 0;
    for (size_t i = 0; i < notes->count; i++)
        if (notes->item[i].severity == SEVERITY_WARNING &&
            !notes->item[i].file) { /* with a place: said on standard error already */
            (void)fprintf(out, "%snote: %s\n", any ? "" : "\n", notes->item[i].text);
            any = 1;
        }
}
