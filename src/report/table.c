/* One table for all ways to show it: the cells are made once, here, in the units people read; three renderers write them, as CSV,
 * lines of text and HTML. Before them what they write cells by, behind them the files of --csv's tables and the screen. */
#include "deck/deck.h"
#include "report/report.h"

void html_text(FILE *out, const char *text)
{
    while (*text) {
        size_t bytes = text_utf8(text);
        char c = *text;
        if (!text_visible(text) && c != '\n' && c != '\t')
            (void)fputs(TEXT_REPLACEMENT, out);
        else if (c == '&')
            (void)fputs("&amp;", out);
        else if (c == '<')
            (void)fputs("&lt;", out);
        else if (c == '>')
            (void)fputs("&gt;", out);
        else if (c == '"')
            (void)fputs("&quot;", out);
        else if (c == '\'')
            (void)fputs("&#39;", out);
        else
            (void)fwrite(text, 1, bytes, out);
        text += bytes ? bytes : 1;
    }
}

void html_element(FILE *out, const char *name, const char *text)
{
    (void)fprintf(out, "<%s>", name);
    html_text(out, text);
    (void)fprintf(out, "</%.*s>\n", (int)strcspn(name, " "), name);
}

/* A text is quoted where it has to be, and one that a spreadsheet would take for a formula gets an apostrophe in front. before:
 * "" or ",". */
static void csv_text(FILE *out, const char *before, const char *text)
{
    int formula = *text && strchr("=+-@\t", *text) != NULL, quoted = strpbrk(text, ",;\"\n\r\t") != NULL;
    (void)fprintf(out, "%s%s%s", before, quoted ? "\"" : "", formula ? "'" : "");
    for (; *text; text++)
        (void)fprintf(out, *text == '"' ? "\"\"" : "%c", *text);
    (void)fputs(quoted ? "\"" : "", out);
}

/* The digits that give the number back; blank where it is not finite. */
static void csv_number(FILE *out, const char *before, double value)
{
    char text[DECK_NUMBER_LENGTH];
    (void)fprintf(out, "%s%s", before, isfinite(value) ? deck_number_text(value, text) : "");
}

#define DASH "\xe2\x80\x93" /* of human_fixed */

struct table *table_open(struct pool *pool, const char *caption)
{
    struct table *table = POOL_NEW(pool, struct table);
    if (table)
        *table = (struct table){.pool = pool, .caption = caption ? caption : "", .note = "", .row_factor = 1};
    return table;
}

int table_rows(const struct table *table)
{
    return table->ncolumns ? table->ncells / table->ncolumns : 0;
}

/* Decimals move with the unit: 0.123456 m is 123.456 mm. */
static void take_unit(struct pool *pool, struct table_column *column, struct human_unit unit)
{
    int decimals = (int)(column->show >> SHOW_DIGITS_FROM & SHOW_DIGITS_MOST), format = (int)(column->show & SHOW_FORMAT),
        fewer = (int)lround(log10(unit.factor));
    column->factor = unit.factor;
    column->shown = *unit.text ? pool_copy_text(pool, unit.text) : NULL;
    if (format != (SHOW_FIXED(0) & SHOW_FORMAT) && format != (SHOW_SIGNED(0) & SHOW_FORMAT))
        return;
    decimals = decimals < fewer ? 0 : decimals - fewer;
    column->show = (column->show & ~((unsigned)SHOW_DIGITS_MOST << SHOW_DIGITS_FROM)) | (unsigned)decimals << SHOW_DIGITS_FROM;
}

/* The column of the next cell: of the first row a new one. NULL where memory is out, or was. */
static struct table_column *next_column(struct table *table, const char *name, const char *unit, unsigned show)
{
    if (!table || table->pool->out_of_memory)
        return NULL;
    if (table->ncolumns && !strcmp(name, table->column[0].name))
        table->is_made = 1;
    if (table->is_made && table->ncolumns)
        return &table->column[table->ncells % table->ncolumns];
    struct table_column column = {name, unit, unit, show, 1};
    if (unit && (!strcmp(unit, "m") || !strcmp(unit, "Hz")))
        take_unit(table->pool, &column, human_unit(1, unit));
    return POOL_ADD(table->pool, table->column, table->ncolumns, &column) ? NULL : &table->column[table->ncolumns - 1];
}

void table_note(struct table *table, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    if (table)
        table->note = pool_text_of(table->pool, format, values);
    va_end(values);
}

void row_note(struct table *table, const char *text)
{
    if (table && !table->pool->out_of_memory && *text)
        table->cell[table->ncells - table->ncolumns].note = text;
}

static void add_cell(struct table *table, struct table_cell is)
{
    if (is.text)
        (void)POOL_ADD(table->pool, table->cell, table->ncells, &is);
}

void text_column(struct table *table, const char *name, unsigned show, const char *text)
{
    if (next_column(table, name, NULL, show))
        add_cell(table, (struct table_cell){.text = text ? text : "", .value = NAN});
}

void unit_column(struct table *table, double value, double half, const char *unit)
{
    if (!next_column(table, "unit", NULL, SHOW_TEXT))
        return;
    struct human_unit shown = human_unit(value, unit);
    table->row_factor = shown.factor;
    table->row_decimals = human_decimals(value * shown.factor, half * shown.factor);
    add_cell(table, (struct table_cell){.text = *shown.text ? pool_copy_text(table->pool, shown.text) : "1",
                                        .csv = unit ? unit : "1",
                                        .value = NAN});
}

/* value: in the unit that is shown */
static const char *number_text(const struct table *table, unsigned show, double value)
{
    const unsigned format = show & SHOW_FORMAT;
    int digits = (int)(show >> SHOW_DIGITS_FROM) & SHOW_DIGITS_MOST;
    if (format == SHOW_CHANCE(0) && value < 0.001)
        return "<0.001";
    return format == SHOW_DIGITS(0) || format == SHOW_CHANCE(0) ? human_digits(table->pool, value, digits)
           : format == SHOW_TRIMMED(0)                          ? human_trimmed(table->pool, value, digits)
           : format == SHOW_ROW                                 ? human_fixed(table->pool, value, table->row_decimals)
                                : human_column(table->pool, value, digits, format == SHOW_SIGNED(0) ? "+" : "");
}

static void put_number(struct table *table, const struct table_column *column, double value)
{
    int of_row = column->unit && !*column->unit;
    const char *text = number_text(table, column->show, value * (of_row ? table->row_factor : column->factor));
    add_cell(table, (struct table_cell){.text = text, .value = value, .is_number = 1});
}

void number_column(struct table *table, const char *name, const char *unit, unsigned show, double value)
{
    const struct table_column *column = next_column(table, name, unit, show);
    if (column)
        put_number(table, column, value);
}

void scaled_column(struct table *table, const char *name, const char *unit, unsigned show, double typical, double value)
{
    struct table_column *column = next_column(table, name, unit && strcmp(unit, "1") != 0 ? unit : NULL, show);
    if (column && !table->is_made)
        take_unit(table->pool, column, human_unit(typical, unit));
    if (column)
        put_number(table, column, value);
}

static const struct table_cell *cell_at(const struct table *table, int row, int column)
{
    return &table->cell[row * table->ncolumns + column];
}

int table_column_is_shown(const struct table *table, int column)
{
    int filled = 0;
    for (int i = 0; i < table_rows(table) && !filled; i++) {
        const char *text = cell_at(table, i, column)->text;
        filled = *text && strcmp(text, DASH) != 0;
    }
    return filled && !(table->column[column].show & IN_CSV_ONLY);
}

/* "frequency [Hz]" */
static const char *head_of(const struct table *table, int column, const char *unit)
{
    const char *name = table->column[column].name;
    return unit && *unit ? pool_text(table->pool, "%s [%s]", name, unit) : name;
}

void table_write_csv(FILE *out, const struct table *table)
{
    for (int i = -1; i < table_rows(table); i++) {
        const char *before = "";
        for (int j = 0; j < table->ncolumns; j++) {
            if (table->column[j].show & NOT_IN_CSV)
                continue;
            const struct table_cell *cell = i < 0 ? NULL : cell_at(table, i, j);
            if (!cell)
                csv_text(out, before, head_of(table, j, table->column[j].unit));
            else if (cell->is_number)
                csv_number(out, before, cell->value);
            else
                csv_text(out, before, cell->csv ? cell->csv : cell->text);
            before = ",";
        }
        (void)fputc('\n', out);
    }
}

/* What a terminal of any kind shows: the signs of people's numbers and units as ASCII; other letters stay. */
static const char *ascii(struct pool *pool, const char *text)
{
    static const char *const signs[][2] = {{DASH, "-"},       {"\xe2\x88\x92", "-"},        {"\xc2\xa0", " "}, {"\xc2\xb1", "+-"},
                                           {"\xc2\xb7", "."}, {"\xcf\x87\xc2\xb2", "chi2"}, {"\xc2\xb2", "2"}, {"\xc2\xb3", "3"}};
    char *copy = pool_copy_text(pool, text), *to = copy;
    for (const char *from = copy; from && *from;) {
        size_t s = 0, count = sizeof signs / sizeof *signs;
        while (s < count && strncmp(from, signs[s][0], strlen(signs[s][0])) != 0)
            s++;
        const char *put = s < count ? signs[s][1] : (char[]){*from, 0}; /* no longer than the sign */
        from += s < count ? strlen(signs[s][0]) : 1;
        while (*put)
            *to++ = *put++;
    }
    if (copy)
        *to = 0;
    return copy ? copy : "";
}

static const char *shown_text(const struct table *table, int row, int column)
{
    return row < 0 ? head_of(table, column, table->column[column].shown) : cell_at(table, row, column)->text;
}

#define GAP   2 /* blanks between columns */
#define LEAST 8 /* columns that are left of a text */

/* Columns that are wide enough for head and cells, -1 of those that are not shown; their sum. */
static int column_widths(const struct table *table, int with_details, int width[])
{
    int sum = -GAP;
    for (int j = 0; j < table->ncolumns; j++) {
        int shown = table_column_is_shown(table, j) && (with_details || !(table->column[j].show & DETAIL));
        width[j] = -1;
        for (int i = -1; i < table_rows(table) && shown; i++) {
            int own = text_columns(shown_text(table, i, j));
            width[j] = own > width[j] ? own : width[j];
        }
        sum += shown ? width[j] + GAP : 0;
    }
    return sum;
}

static void write_line(FILE *out, const struct table *table, int row, const int width[])
{
    int before = -GAP; /* blanks that are owed; none at the end of a line */
    for (int j = 0; j < table->ncolumns; j++) {
        if (width[j] < 0)
            continue;
        const char *text = ascii(table->pool, shown_text(table, row, j));
        int gap = width[j] - text_columns(text); /* below 0: it is cut */
        int right = (table->column[j].show & SHOW_FORMAT) != SHOW_TEXT;
        if (*text) {
            before += GAP + (right ? gap : 0);
            (void)fprintf(out, "%*s", before > 0 ? before : 0, "");
            if (gap < 0)
                text_cell(out, width[j], text);
            else
                name_cell(out, 0, text);
            before = right || gap < 0 ? 0 : gap;
        } else {
            before += GAP + width[j];
        }
    }
    (void)fputc('\n', out);
}

/* Takes from the widest of those that may be cut. */
static void cut_columns(const struct table *table, int excess, int width[])
{
    while (excess-- > 0) {
        int widest = -1;
        for (int j = 0; j < table->ncolumns; j++)
            if (table->column[j].show & MAY_BE_CUT && width[j] > LEAST && (widest < 0 || width[j] > width[widest]))
                widest = j;
        if (widest < 0)
            return;
        width[widest]--;
    }
}

void table_write_text(FILE *out, const struct table *table, int width)
{
    int *columns = table && !table->pool->out_of_memory ? POOL_ARRAY(table->pool, int, table->ncolumns + 1) : NULL;
    if (!columns)
        return;
    if (*table->caption)
        wrap_text(out, 2, width, "", ascii(table->pool, table->caption));
    if (column_widths(table, 1, columns) > width)
        cut_columns(table, column_widths(table, 0, columns) - width, columns);
    for (int i = -1; i < table_rows(table) && table->ncells; i++) {
        write_line(out, table, i, columns);
        if (i >= 0 && cell_at(table, i, 0)->note)
            wrap_text(out, 6, width, "    ", ascii(table->pool, cell_at(table, i, 0)->note));
    }
    if (*table->note)
        wrap_text(out, 2, width, "", ascii(table->pool, table->note));
}

static void html_row(FILE *out, const struct table *table, int row, table_words *words)
{
    int first = 1, shown = 0;
    (void)fputs("<tr>", out);
    for (int j = 0; j < table->ncolumns; j++) {
        if (!table_column_is_shown(table, j))
            continue;
        const char *text = shown_text(table, row, j), *element = !*text    ? "td"
                                                                 : row < 0 ? "th scope=\"col\""
                                                                 : first   ? "th scope=\"row\""
                                                                           : "td";
        first &= !*text; /* the first cell that says something is the head of its row */
        shown++;
        (void)fprintf(out, "<%s%s>", element, (table->column[j].show & SHOW_FORMAT) != SHOW_TEXT ? " class=\"n\"" : "");
        html_text(out, words(table->pool, text));
        (void)fprintf(out, "</%.2s>", element);
    }
    (void)fputs("</tr>\n", out);
    if (row >= 0 && cell_at(table, row, 0)->note) {
        (void)fprintf(out, "<tr class=\"under\"><td colspan=\"%d\">", shown);
        html_text(out, words(table->pool, cell_at(table, row, 0)->note));
        (void)fputs("</td></tr>\n", out);
    }
}

void table_write_html(FILE *out, const struct table *table, int number, table_words *words)
{
    (void)fprintf(out,
                  "<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-labelledby=\"table-%d\">\n<table>\n<caption "
                  "id=\"table-%d\"><span>",
                  number, number);
    html_text(out, words(table->pool, table->caption));
    (void)fputs("</span></caption>\n<thead>", out);
    html_row(out, table, -1, words);
    (void)fputs("</thead>\n<tbody>\n", out);
    for (int i = 0; i < table_rows(table); i++)
        html_row(out, table, i, words);
    (void)fputs("</tbody></table></div>\n", out);
    if (*table->note)
        html_element(out, "p class=\"note\"", words(table->pool, table->note));
}

#define CSV_MOST_FILES 3

int csv_write(struct pool *pool, const char *path, const char *const *name, struct table *const *table, const char **failed)
{
    struct output output[CSV_MOST_FILES];
    const char *file[CSV_MOST_FILES];
    int files = 0, count = 0, status = ROTID_OK, which = 0;
    for (; name[files]; files++)
        file[files] = pool_text(pool, "%s.%s.csv", path, name[files]);
    if (pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    for (; count < files && !(status = output_open(&output[count], file[count])); count++)
        table_write_csv(output[count].stream, table[count]);
    for (int i = 0; i < count && status; i++)
        output_abandon(&output[i]);
    *failed = status ? file[count] : NULL;
    if (status)
        return status;
    status = output_close_all(files, output, &which);
    *failed = status ? file[which] : NULL;
    return status;
}

void screen_heading(const struct screen *to, const struct result_head *head)
{
    for (int i = 0; i < head->nheading; i++)
        wrap_text(to->out, 0, to->width, "", head->heading[i]);
    if (!head->nheading)
        wrap_text(to->out, 0, to->width, "", or_nothing(head->deck));
    (void)fputc('\n', to->out);
}

void screen_state(const struct screen *to, int i, const char *name)
{
    (void)fprintf(to->out, "%sstate %s\n", i ? "\n" : "", name);
}

void screen_result(const struct screen *to, const struct result *result, screen_of *print)
{
    screen_heading(to, &result->head);
    if (!result->nstates)
        print(to, result);
    for (int s = 0; s < result->nstates; s++) {
        const struct result own = result_of_state(to->pool, result, s);
        screen_state(to, s, result->states[s].name);
        print(to, &own);
    }
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
    va_list values;
    va_start(values, format);
    (void)fprintf(to->out, "%s\n", ascii(to->pool, pool_text_of(to->pool, format, values)));
    va_end(values);
}

void screen_paragraph(const struct screen *to, const char *head, const char *text)
{
    wrap_text(to->out, 4, to->width, head, ascii(to->pool, text));
}

void screen_reasons(const struct screen *to, const struct reasons *reasons)
{
    for (int i = 0; i < reasons->count; i++)
        screen_paragraph(to, "  ", reasons->text[i]);
}

void screen_table(const struct screen *to, const struct table *table)
{
    if (!table || table->pool->out_of_memory || !table_rows(table))
        return;
    (void)fputc('\n', to->out);
    table_write_text(to->out, table, to->width);
}

void screen_shown(const struct screen *to, const struct shown *shown)
{
    screen_reasons(to, &shown->said);
    for (int i = 0; shown->table[i]; i++)
        screen_table(to, shown->table[i]);
}
