#include "report/table.h"

static void print_heading(FILE *out, int count, const char *const *line, const char *deck)
{
    for (int i = 0; i < count; i++)
        (void)fprintf(out, "%s\n", line[i]);
    if (!count)
        (void)fprintf(out, "%s\n", deck);
    (void)fputc('\n', out);
}

void table_heading(FILE *out, const struct result_head *head)
{
    print_heading(out, head->nheading, head->heading, head->deck);
}

void table_job_heading(FILE *out, const struct job *job)
{
    print_heading(out, job->nheading, job->heading, job->deck);
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
