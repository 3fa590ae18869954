#include "report/report.h"

#include <math.h>
#include <string.h>

#define DASH "\xe2\x80\x93" /* of human_fixed */

struct table *table_open(struct pool *pool, const char *caption)
{
    struct table *table = POOL_NEW(pool, struct table);
    if (table)
        *table = (struct table){.pool = pool, .caption = caption ? caption : "", .failed = !caption};
    return table;
}

void table_add_column(struct table *table, const char *name, const char *unit, enum table_format format, int digits)
{
    if (!table || table->failed)
        return;
    struct table_column *column =
        pool_grow(table->pool, table->column, (size_t)table->ncolumns, &table->column_room, sizeof *table->column);
    if (!column || !name) {
        table->failed = 1;
        return;
    }
    table->column = column;
    column[table->ncolumns++] = (struct table_column){name, unit, format, digits};
}

void table_add_columns(struct table *table, int count, const struct table_column column[])
{
    for (int j = 0; j < count; j++)
        table_add_column(table, column[j].name, column[j].unit, column[j].format, column[j].digits);
}

int table_rows(const struct table *table)
{
    return table->ncolumns ? (table->ncells + table->ncolumns - 1) / table->ncolumns : 0;
}

static void add_cell(struct table *table, struct table_cell is)
{
    if (!table || table->failed)
        return;
    struct table_cell *cell = pool_grow(table->pool, table->cell, (size_t)table->ncells, &table->cell_room, sizeof *table->cell);
    if (!cell || !is.text) {
        table->failed = 1;
        return;
    }
    table->cell = cell;
    cell[table->ncells++] = is;
}

void cell_text(struct table *table, const char *text)
{
    add_cell(table, (struct table_cell){.text = text ? text : "", .value = NAN});
}

void cell_number(struct table *table, double value)
{
    if (!table || table->failed)
        return;
    const struct table_column *column = &table->column[table->ncells % table->ncolumns];
    const char *text = column->format == TABLE_FIXED                     ? human_fixed(table->pool, value, column->digits)
                       : column->format == TABLE_SIGNED                  ? human_signed(table->pool, value, column->digits)
                       : column->format == TABLE_TRIMMED                 ? human_trimmed(table->pool, value, column->digits)
                       : column->format == TABLE_CHANCE && value < 0.001 ? "<0.001"
                                                                         : human_digits(table->pool, value, column->digits);
    add_cell(table, (struct table_cell){.text = text, .value = value, .is_number = 1});
}

void cell_decimals(struct table *table, double value, int decimals)
{
    if (table)
        add_cell(table, (struct table_cell){human_fixed(table->pool, value, decimals), value, 1});
}

void cell_interval(struct table *table, double value, const double ci95[2], const char *unit)
{
    if (!table)
        return;
    struct human_unit shown = human_unit(value, unit);
    double f = shown.factor;
    int decimals = human_decimals(value * f, (ci95[1] - ci95[0]) / 2 * f);
    cell_text(table, *shown.text ? pool_copy_text(table->pool, shown.text) : "1");
    cell_decimals(table, value * f, decimals);
    cell_decimals(table, ci95[0] * f, decimals);
    cell_decimals(table, ci95[1] * f, decimals);
}

static const struct table_cell *cell_at(const struct table *table, int row, int column)
{
    static const struct table_cell blank = {.text = "", .value = NAN};
    int i = row * table->ncolumns + column;
    return i < table->ncells ? &table->cell[i] : &blank;
}

int table_column_is_shown(const struct table *table, int column)
{
    int filled = !column || !table->ncells;
    for (int i = 0; i < table_rows(table) && !filled; i++) {
        const char *text = cell_at(table, i, column)->text;
        filled = *text && strcmp(text, DASH) != 0;
    }
    return filled;
}

/* "frequency [Hz]" */
static const char *head_of(const struct table *table, int column)
{
    const struct table_column *is = &table->column[column];
    const char *text = is->unit ? pool_format(table->pool, "%s [%s]", is->name, is->unit) : is->name;
    return text ? text : "";
}

void table_write_csv(FILE *out, const struct table *table)
{
    for (int j = 0; j < table->ncolumns; j++)
        csv_text(out, j ? "," : "", head_of(table, j));
    (void)fputc('\n', out);
    for (int i = 0; i < table_rows(table); i++) {
        for (int j = 0; j < table->ncolumns; j++) {
            const struct table_cell *cell = cell_at(table, i, j);
            if (cell->is_number)
                csv_number(out, j ? "," : "", cell->value);
            else
                csv_text(out, j ? "," : "", cell->text);
        }
        (void)fputc('\n', out);
    }
}

static void blanks(FILE *out, int count)
{
    (void)fprintf(out, "%*s", count > 0 ? count : 0, "");
}

static void write_line(FILE *out, const struct table *table, int row, const int width[])
{
    int before = 0, first = 1;
    for (int j = 0; j < table->ncolumns; j++) {
        if (width[j] < 0)
            continue;
        const char *text = row < 0 ? head_of(table, j) : cell_at(table, row, j)->text;
        int gap = width[j] - text_columns(text), right = table->column[j].format != TABLE_TEXT;
        blanks(out, before + (first ? 0 : 2) + (right ? gap : 0));
        name_cell(out, 0, text);
        before = right ? 0 : gap; /* none at the end of a line */
        first = 0;
    }
    (void)fputc('\n', out);
}

void table_write_text(FILE *out, const struct table *table, int width)
{
    int *columns = POOL_ARRAY(table->pool, int, table->ncolumns);
    if (!columns)
        return;
    wrap_text(out, 2, width, "", table->caption);
    for (int j = 0; j < table->ncolumns; j++) {
        columns[j] = table_column_is_shown(table, j) ? text_columns(head_of(table, j)) : -1;
        for (int i = 0; i < table_rows(table) && columns[j] >= 0; i++) {
            int own = text_columns(cell_at(table, i, j)->text);
            columns[j] = own > columns[j] ? own : columns[j];
        }
    }
    for (int i = -1; i < table_rows(table); i++)
        write_line(out, table, i, columns);
    if (table->note)
        wrap_text(out, 2, width, "", table->note);
}

static void html_row(FILE *out, const struct table *table, int row)
{
    (void)fputs("<tr>", out);
    for (int j = 0; j < table->ncolumns; j++) {
        const char *element = row < 0 ? "th scope=\"col\"" : j ? "td" : "th scope=\"row\"";
        if (!table_column_is_shown(table, j))
            continue;
        (void)fprintf(out, "<%s%s>", element, table->column[j].format != TABLE_TEXT ? " class=\"n\"" : "");
        html_text(out, row < 0 ? head_of(table, j) : cell_at(table, row, j)->text);
        (void)fprintf(out, "</%.2s>", element);
    }
    (void)fputs("</tr>\n", out);
}

void table_write_html(FILE *out, const struct table *table, int number)
{
    (void)fprintf(out,
                  "<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-labelledby=\"table-%d\">\n<table>\n<caption "
                  "id=\"table-%d\"><span>",
                  number, number);
    html_text(out, table->caption);
    (void)fputs("</span></caption>\n<thead>", out);
    html_row(out, table, -1);
    (void)fputs("</thead>\n<tbody>\n", out);
    for (int i = 0; i < table_rows(table); i++)
        html_row(out, table, i);
    (void)fputs("</tbody></table></div>\n", out);
    if (table->note)
        html_element(out, "p class=\"note\"", table->note);
}
