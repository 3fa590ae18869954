#include "deck/deck.h"
#include "file/file.h"

struct splitter {
    struct pool *pool;
    struct message_list *messages;
    struct table_text *table;
    char *at, *end, *cell_end; /* cell_end: where the zero behind the cell at hand goes, once what ends it is known */
    char separator;
    int row, column; /* of the cell at hand, from 1 */
    int cells;
    struct data_line line; /* the row at hand */
    int holds;             /* it has a cell that is not blank */
};

const char *table_cell_name(int row, int column, char name[TABLE_CELL_LENGTH])
{
    char letters[16];
    int count = 0;
    for (; column > 0 && count < 15; column = (column - 1) / 26)
        letters[count++] = (char)('A' + (column - 1) % 26);
    for (int i = 0; i < count; i++)
        name[i] = letters[count - 1 - i];
    (void)snprintf(name + count, TABLE_CELL_LENGTH - (size_t)count, "%d", row);
    return name;
}

int table_is_number(const char *text)
{
    char *end;
    (void)strtod(text, &end);
    return end != text && !*end;
}

__attribute__((format(printf, 4, 5))) static int refuse_table(struct splitter *s, int row, int column, const char *format, ...)
{
    char text[512], cell[TABLE_CELL_LENGTH];
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text, sizeof text, format, values);
    va_end(values);
    return message_refuse(s->messages, 1, s->table->path, row, column, "%s (cell %s)", text, table_cell_name(row, column, cell));
}

/* What was saved as something else than text. */
static int refuse_kind(struct splitter *s)
{
    size_t length = (size_t)(s->end - s->at);
    if (length >= 4 && (!memcmp(s->at, "PK\3\4", 4) || !memcmp(s->at, "\xd0\xcf\x11\xe0", 4)))
        return refuse_table(s, 1, 1, "the file is a workbook, expected its sheet saved as CSV");
    if (length >= 2 && (!memcmp(s->at, "\xff\xfe", 2) || !memcmp(s->at, "\xfe\xff", 2)))
        return refuse_table(s, 1, 1, "the file is text in UTF-16, expected CSV in UTF-8");
    return 0;
}

/* The first row decides, quoted text apart. */
static char find_separator(const char *at, const char *end)
{
    int quoted = 0, tab = 0;
    while (at < end && (*at == '\n' || *at == '\r'))
        at++;
    for (; at < end && (quoted || (*at != '\n' && *at != '\r')); at++) {
        quoted ^= *at == '"';
        if (!quoted && *at == ';')
            return ';';
        tab |= !quoted && *at == '\t';
    }
    return tab ? '\t' : ',';
}

/* Byte-order mark, and the line by which Excel is told the separator. */
static void begin(struct splitter *s)
{
    if (s->end - s->at >= 3 && !memcmp(s->at, "\xef\xbb\xbf", 3))
        s->at += 3;
    char *c = s->at;
    if (s->end - c >= 5 && !memcmp(c, "sep=", 4) && (s->end - c == 5 || c[5] == '\n' || c[5] == '\r')) {
        s->separator = c[4];
        s->at += 5; /* what is left of this row is blank */
    } else {
        s->separator = find_separator(s->at, s->end);
    }
}

static int ends_cell(const struct splitter *s, const char *c)
{
    return c == s->end || *c == s->separator || *c == '\n' || *c == '\r';
}

static int is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

static int check_character(struct splitter *s, const char *c, int quoted)
{
    unsigned code;
    if ((unsigned char)*c < ' ' && *c != '\t' && !(quoted && (*c == '\n' || *c == '\r')))
        return refuse_table(s, s->row, s->column, "byte 0x%02x is not text, expected a table as CSV", (unsigned char)*c);
    if (!is_blank(*c) && text_is_control(c, &code))
        return refuse_table(s, s->row, s->column,
                            "character U+%04X does not stand for itself, expected text without control characters", code);
    return 0;
}

/* From the quote to that which ends the text; doubled ones are halved. */
static char *quoted_text(struct splitter *s, char **end)
{
    char *from = ++s->at, *to = from;
    for (;; s->at++) {
        if (s->at == s->end)
            return refuse_table(s, s->row, s->column, "the quote is not closed, expected \" behind the text"), NULL;
        if (*s->at == '"' && (s->at + 1 == s->end || s->at[1] != '"'))
            break;
        s->at += *s->at == '"';
        if (check_character(s, s->at, 1))
            return NULL;
        *to++ = is_blank(*s->at) ? ' ' : *s->at; /* a line that goes on is one text */
    }
    s->at++;
    while (!ends_cell(s, s->at) && is_blank(*s->at))
        s->at++;
    if (!ends_cell(s, s->at))
        return refuse_table(s, s->row, s->column, "text stands behind a quote, expected '%c' or the end of the row",
                            s->separator),
               NULL;
    *end = to;
    return from;
}

static char *plain_text(struct splitter *s, char **end)
{
    char *from = s->at;
    for (; !ends_cell(s, s->at); s->at++)
        if (check_character(s, s->at, 0))
            return NULL;
    *end = s->at;
    return from;
}

/* One cell, up to what ends it. 0, or 1 after an error. */
static int take_cell(struct splitter *s)
{
    char *end, *text = s->at;
    while (!ends_cell(s, text) && is_blank(*text))
        text++;
    if (text < s->end && *text == '"') {
        s->at = text;
        text = quoted_text(s, &end);
    } else {
        text = plain_text(s, &end);
    }
    if (!text)
        return 1;
    while (text < end && is_blank(*text))
        text++;
    while (end > text && is_blank(end[-1]))
        end--;
    if (end - text > DECK_LINE_LENGTH)
        return refuse_table(s, s->row, s->column, "the text is longer than %d characters, expected a shorter one",
                            DECK_LINE_LENGTH);
    if (++s->cells > TABLE_MOST_CELLS)
        return refuse_table(s, s->row, s->column, "the table has more than %d cells, expected fewer", TABLE_MOST_CELLS);
    if (s->column > TABLE_MOST_COLUMNS)
        return refuse_table(s, s->row, s->column, "the row has more than %d cells, expected fewer", TABLE_MOST_COLUMNS);
    const struct field cell = {text, {s->table->path, s->row, s->column}, 0};
    if (POOL_ADD(s->pool, s->line.field, s->line.count, &cell))
        return 1;
    s->holds |= end > text;
    s->cell_end = end;
    return 0;
}

static int take_row(struct splitter *s)
{
    s->line = (struct data_line){.place = {s->table->path, s->row, 1}};
    s->holds = 0;
    s->column = 1;
    for (int more = 1; more; s->column++) {
        if (take_cell(s))
            return 1;
        more = s->at < s->end && *s->at == s->separator;
        if (s->at < s->end)
            s->at += *s->at == '\r' && s->at + 1 < s->end && s->at[1] == '\n' ? 2 : 1;
        *s->cell_end = 0;
    }
    s->line.end = (struct place){s->table->path, s->row, s->line.count + 1};
    if (!s->holds)
        return 0;
    return POOL_ADD(s->pool, s->table->row, s->table->nrow, &s->line);
}

/* 1,5 with one comma and digits around it */
static char *decimal_comma(const char *text)
{
    size_t digits = strspn(text, "+-0123456789");
    char *comma = text[digits] == ',' ? (char *)(text + digits) : NULL;
    if (!comma || comma[1] < '0' || comma[1] > '9')
        return NULL;
    *comma = '.';
    int number = table_is_number(text);
    *comma = ',';
    return number ? comma : NULL;
}

/* Numbers with a comma become numbers with a point; both in one table are thousands of one of them. */
static int take_decimal_commas(struct splitter *s)
{
    const struct field *point = NULL, *first = NULL;
    for (int r = 0; r < s->table->nrow && s->separator != ','; r++)
        for (int i = 0; i < s->table->row[r].count; i++) {
            const struct field *field = &s->table->row[r].field[i];
            char *comma = decimal_comma(field->text), *dot = strchr(field->text, '.');
            if (dot && !point && table_is_number(field->text))
                point = field;
            if (comma && !first)
                first = field;
            if (first && point) {
                char cell[TABLE_CELL_LENGTH];
                return refuse_table(
                    s, first->place.line, first->place.column,
                    "'%s' has a decimal comma and '%s' in cell %s a decimal point, expected one of them in a table", first->text,
                    point->text, table_cell_name(point->place.line, point->place.column, cell));
            }
        }
    for (int r = 0; r < s->table->nrow && first; r++)
        for (int i = 0; i < s->table->row[r].count; i++) {
            char *comma = decimal_comma(s->table->row[r].field[i].text);
            if (comma)
                *comma = '.';
        }
    return 0;
}

/* Splits `text` [length + 1, overwritten: the cells lie in it] into rows. Cells are separated by semicolons where the first row
 * has one outside quotes, else by tabs, else by commas, or by the character of a first line "sep=;"; a cell may stand in quotes,
 * "" is a quote in it. Behind semicolons and tabs 1,5 is the number 1.5 unless another number of the table has a point. `path`
 * is kept. Errors, which name row, column and cell, go to the list. ROTID_OK, ROTID_ERROR_SYNTAX or ROTID_ERROR_MEMORY. */
static int table_text_split(struct pool *pool, const char *path, size_t length, char *text, struct message_list *messages,
                            struct table_text *table)
{
    struct splitter s = {.pool = pool, .messages = messages, .table = table, .at = text, .end = text + length, .row = 1};
    *table = (struct table_text){.path = path};
    text[length] = 0;
    s.column = 1;
    if (refuse_kind(&s))
        return ROTID_ERROR_SYNTAX;
    begin(&s);
    for (; s.at < s.end; s.row++)
        if (take_row(&s))
            return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_ERROR_SYNTAX;
    if (!table->nrow)
        return refuse_table(&s, 1, 1, "the table is empty, expected rows of values"), ROTID_ERROR_SYNTAX;
    if (take_decimal_commas(&s))
        return ROTID_ERROR_SYNTAX;
    return messages->pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

int table_text_read(struct pool *pool, const char *path, struct place from, struct message_list *messages,
                    struct table_text *table)
{
    struct stat about;
    char why[HOST_ERROR_TEXT];
    size_t length;
    int failed;
    char *text = deck_read_file(pool, path, TABLE_MOST_BYTES, &about, &length, &failed);
    *table = (struct table_text){.path = path};
    if (!text && !failed)
        return ROTID_ERROR_MEMORY;
    if (failed)
        return message_refuse_at(messages, text ? ROTID_ERROR_IO : file_status(failed), from, "cannot read %s: %s%s", path,
                                 file_error_text(failed, why), text ? "" : ", expected a table as CSV");
    if (length > TABLE_MOST_BYTES)
        return message_refuse_at(messages, ROTID_ERROR_IO, from,
                                 "%s is larger than 16 MiB, expected a table of measured values or sections", path);
    return table_text_split(pool, path, length, text, messages, table);
}
