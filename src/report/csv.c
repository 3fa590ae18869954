#include "report/report.h"

#include <math.h>
#include <string.h>

#include "deck/deck.h"
#include "rotid.h"

void csv_text(FILE *out, const char *before, const char *text)
{
    int formula = *text && strchr("=+-@\t", *text) != NULL, quoted = strpbrk(text, ",;\"\n\r\t") != NULL;
    (void)fprintf(out, "%s%s%s", before, quoted ? "\"" : "", formula ? "'" : "");
    for (; *text; text++)
        (void)fprintf(out, *text == '"' ? "\"\"" : "%c", *text);
    (void)fputs(quoted ? "\"" : "", out);
}

void csv_number(FILE *out, const char *before, double value)
{
    char text[DECK_NUMBER_LENGTH];
    (void)fprintf(out, "%s%s", before, isfinite(value) ? deck_number_text(value, text) : "");
}

int csv_table(FILE *out, const struct table *table)
{
    if (!table || table->pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    table_write_csv(out, table);
    return ROTID_OK;
}

const char *csv_path(struct pool *pool, const char *path, const struct csv_part *part)
{
    return pool_format(pool, "%s.%s.csv", path, part->suffix);
}

int csv_write(struct pool *pool, const char *path, const struct csv_part part[CSV_MOST_FILES], const void *from,
              const char **failed)
{
    struct output output[CSV_MOST_FILES];
    const char *name[CSV_MOST_FILES];
    int files = 0, count = 0, status = ROTID_OK, which = 0;
    for (; files < CSV_MOST_FILES && part[files].write; files++)
        ;
    for (int i = 0; i < files; i++)
        if (!(name[i] = csv_path(pool, path, &part[i])))
            return ROTID_ERROR_MEMORY;
    while (count < files && !status) {
        *failed = name[count];
        status = output_open(&output[count], name[count]);
        if (status)
            break;
        status = part[count].write(output[count].stream, pool, from);
        count++;
    }
    for (int i = 0; i < count && status; i++)
        output_abandon(&output[i]);
    if (status)
        return status;
    status = output_close_all(files, output, &which);
    *failed = status ? name[which] : NULL;
    return status;
}
