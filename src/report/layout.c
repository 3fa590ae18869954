#include "report/report.h"

/* Bytes of the next column: of a character, or one that is shown in its place. */
static size_t next_column(const char *text)
{
    size_t bytes = text_utf8(text);
    return bytes ? bytes : 1;
}

static int columns_of(const char *text, size_t bytes)
{
    int columns = 0;
    for (const char *end = text + bytes; text < end; text += next_column(text))
        columns++;
    return columns;
}

void text_character(FILE *out, const char *text)
{
    size_t bytes = text_visible(text);
    if (bytes)
        (void)fwrite(text, 1, bytes, out);
    else
        (void)fputs(TEXT_REPLACEMENT, out); /* a line feed among them: it would end the row */
}

int text_columns(const char *text)
{
    return columns_of(text, strlen(text));
}

static void put_columns(FILE *out, int columns, const char *text)
{
    for (; columns > 0; columns--, text += next_column(text))
        text_character(out, text);
}

void text_cell(FILE *out, int width, const char *text)
{
    int columns = text_columns(text), shown = columns > width ? width - 1 : columns;
    put_columns(out, shown, text);
    (void)fprintf(out, "%*s", width - shown, columns > width ? "~" : "");
}

void name_cell(FILE *out, int width, const char *text)
{
    int columns = text_columns(text);
    put_columns(out, columns, text);
    (void)fprintf(out, "%*s", columns < width ? width - columns : 0, "");
}

#define BLANKS " \t\n"

static int new_line(FILE *out, int indent)
{
    (void)fprintf(out, "\n%*s", indent, "");
    return indent;
}

void wrap_text(FILE *out, int indent, int width, const char *head, const char *text)
{
    int column = text_columns(head), fresh = 1; /* nothing stands behind the head, or the indent, yet */
    (void)fputs(head, out);
    for (text += strspn(text, BLANKS); *text; text += strspn(text, BLANKS)) {
        const char *end = text + strcspn(text, BLANKS);
        if (!fresh && column + 1 + columns_of(text, (size_t)(end - text)) < width)
            column += fputc(' ', out) != EOF;
        else if (!fresh)
            column = new_line(out, indent);
        for (; text < end; text += next_column(text)) { /* a word that is longer than a line is broken */
            column = column >= width - 1 ? new_line(out, indent) : column;
            column++;
            text_character(out, text);
        }
        fresh = 0;
    }
    (void)fputc('\n', out);
}
