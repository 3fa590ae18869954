#include "page/series.h"

#include <math.h>
#include <string.h>

#include "page/human.h"

struct series {
    struct document *document;
    const char *name;
    int rows, columns;
    const struct column *column; /* [columns] */
    double **value;              /* [columns][rows] */
    const char **text;           /* [rows * columns] by rows, NULL: the number */
};

/* The same with texts of its own; name NULL: memory is out. */
static struct column keep(struct pool *pool, const struct column *column)
{
    struct column kept = *column;
    kept.name = column->name ? pool_copy_text(pool, column->name) : NULL;
    kept.unit = column->unit ? pool_copy_text(pool, column->unit) : NULL;
    if (column->unit && !kept.unit)
        kept.name = NULL;
    return kept;
}

struct series *series_new(struct document *document, const char *name, int rows, int columns, const struct column column[])
{
    struct pool *pool = document->pool;
    struct series *series = POOL_NEW(pool, struct series);
    struct column *kept = POOL_ARRAY(pool, struct column, columns);
    double **value = POOL_ARRAY(pool, double *, columns), *number = POOL_ARRAY(pool, double, (size_t)rows *(size_t)columns);
    const char **text = POOL_ARRAY(pool, const char *, (size_t)rows *(size_t)columns);
    int failed = !series || !kept || !value || !number || !text || !name;
    for (int j = 0; j < columns && !failed; j++) {
        kept[j] = keep(pool, &column[j]);
        value[j] = number + (ptrdiff_t)j * rows;
        for (int i = 0; i < rows; i++)
            value[j][i] = NAN;
        failed = !kept[j].name;
    }
    document->failed |= failed;
    if (failed)
        return NULL;
    *series = (struct series){document, name, rows, columns, kept, value, text};
    return series;
}

void series_row(struct series *series, int row, const double value[])
{
    for (int j = 0; series && j < series->columns; j++)
        if (series->column[j].look != AS_TEXT)
            series->value[j][row] = *value++;
}

void series_text(struct series *series, int row, int column, const char *text)
{
    if (!series)
        return;
    series->document->failed |= !text;
    series->text[row * series->columns + column] = text;
}

int series_rows(const struct series *series)
{
    return series ? series->rows : 0;
}

double *series_values(struct series *series, int column)
{
    return series ? series->value[column] : NULL;
}

static const char *cell_of(const struct series *series, int row, int column)
{
    const struct column *c = &series->column[column];
    const char *text = series->text[row * series->columns + column];
    struct pool *pool = series->document->pool;
    double value = series->value[column][row];
    if (text || c->look == AS_TEXT)
        return text;
    return c->look == AS_FIXED     ? human_fixed(pool, value, c->digits)
           : c->look == AS_SIGNED  ? human_signed(pool, value, c->digits)
           : c->look == AS_TRIMMED ? human_trimmed(pool, value, c->digits)
                                   : human_digits(pool, value, c->digits);
}

static int columns_shown(const struct series *series)
{
    int shown = 0;
    for (int j = 0; j < series->columns; j++)
        shown += series->column[j].look != AS_PLACE;
    return shown;
}

/* Column k of the table, from 0. */
static int shown_column(const struct series *series, int k)
{
    int j = 0;
    while (series->column[j].look == AS_PLACE || k--)
        j++;
    return j;
}

static const char *head_of(const struct series *series, int k)
{
    const struct column *c = &series->column[shown_column(series, k)];
    const char *text = c->unit ? pool_format(series->document->pool, "%s [%s]", c->name, c->unit) : c->name;
    return text ? text : "";
}

struct number_table *series_table_of(int count, const struct series *const series[])
{
    int rows = 0, row = 0;
    for (int s = 0; s < count; s++) {
        if (!series[s])
            return NULL;
        rows += series[s]->rows;
    }
    int columns = columns_shown(series[0]);
    struct pool *pool = series[0]->document->pool;
    struct number_table *table = table_new(pool, rows, columns);
    for (int k = 0; k < columns; k++) {
        const char *head = head_of(series[0], k);
        for (int s = 1; s < count && head; s++)
            if (strcmp(head_of(series[s], k), head_of(series[0], k)) != 0)
                head = pool_format(pool, "%s, or %s", head, head_of(series[s], k));
        table_head(table, k, head);
    }
    for (int s = 0; s < count; s++)
        for (int i = 0; i < series[s]->rows; i++, row++)
            for (int k = 0; k < columns; k++)
                table_cell(table, row, k, cell_of(series[s], i, shown_column(series[s], k)));
    return table;
}

struct number_table *series_table(const struct series *series)
{
    return series_table_of(1, &series);
}

static void write_values(FILE *out, const struct series *series, int row)
{
    const char *between = "";
    for (int j = 0; j < series->columns; j++) {
        if (series->column[j].look == AS_TEXT)
            continue;
        double value = series->value[j][row];
        if (isfinite(value))
            (void)fprintf(out, "%s%.7g", between, value);
        else
            (void)fprintf(out, "%sNaN", between);
        between = " ";
    }
    (void)fputc('\n', out);
}

void plot_series(struct plot *plot, const struct series *series)
{
    int count = 0;
    if (!series)
        return;
    (void)fprintf(plot->out, "# columns of $%s\n", series->name);
    for (int j = 0; j < series->columns; j++) {
        const struct column *c = &series->column[j];
        if (c->look == AS_TEXT)
            continue;
        (void)fprintf(plot->out, "#   %d ", ++count);
        plot_comment(plot, c->name);
        (void)fputs(" [", plot->out);
        plot_comment(plot, c->unit ? c->unit : "1");
        (void)fputs("]\n", plot->out);
    }
    (void)fprintf(plot->out, "$%s << end\n", series->name);
    for (int i = 0; i < series->rows; i++)
        write_values(plot->out, series, i);
    (void)fputs("end\n", plot->out);
}

int figure_begin(struct document *document, struct figure *figure, const char *source, struct plot *plot)
{
    int status = plot_open(plot, document->pool, figure, source);
    document->failed |= status != ROTID_OK;
    return !status;
}

void figure_end(struct document *document, struct plot *plot)
{
    const struct figure *figure = plot->figure;
    int status = plot_close(plot);
    document->failed |= status != ROTID_OK || !figure->title || !figure->caption || !figure->alt;
}

void plot_mode_tics(struct plot *plot, int count, const rotid_compared_mode *mode, int most)
{
    (void)fputs("set xtics (", plot->out);
    for (int k = 0; k < count; k += 1 + count / most)
        (void)fprintf(plot->out, "%s'%d%s' %d", k ? ", " : "", mode[k].mode, mode[k].holdout ? "*" : "", k + 1);
    (void)fputs(")\n", plot->out);
}
