#include "report/report.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

const char *layout_number(char text[64], int digits, double value)
{
    if (isfinite(value))
        (void)snprintf(text, 64, "%.*g", digits, value);
    else
        (void)strcpy(text, "-");
    return text;
}

const char *layout_unit(const char *unit)
{
    return unit && strcmp(unit, "1") != 0 ? unit : "";
}

const char *layout_gap(const char *unit)
{
    return *layout_unit(unit) ? " " : "";
}

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

static void new_line(struct wrap *wrap)
{
    (void)fprintf(wrap->out, "\n%*s", wrap->indent, "");
    wrap->column = wrap->indent;
    wrap->fresh = 1;
}

/* A piece that is not broken unless it is longer than a line. Punctuation stays with what it follows: every line keeps a column
 * for it. */
static void put(struct wrap *wrap, const char *text, size_t bytes)
{
    if (bytes && strchr(";,:", *text)) {
        if (!wrap->fresh) { /* there is something to follow */
            (void)fputc(*text, wrap->out);
            wrap->column++;
        }
        for (text++, bytes--; bytes && *text == ' '; bytes--)
            text++;
    }
    if (!bytes)
        return;
    if (!wrap->fresh && wrap->column + 1 + columns_of(text, bytes) >= wrap->width) {
        new_line(wrap);
    } else if (!wrap->fresh) {
        (void)fputc(' ', wrap->out);
        wrap->column++;
    }
    for (const char *end = text + bytes; text < end; text += next_column(text)) {
        if (wrap->column >= wrap->width - 1)
            new_line(wrap);
        wrap->column++;
        text_character(wrap->out, text);
    }
    wrap->fresh = 0;
}

struct wrap wrap_open(FILE *out, int indent, int width, const char *head)
{
    (void)fputs(head, out);
    return (struct wrap){out, indent, width, columns_of(head, strlen(head)), 1};
}

void wrap_words(struct wrap *wrap, const char *text)
{
    while (*text) {
        size_t bytes = strcspn(text, " \t\n");
        if (bytes)
            put(wrap, text, bytes);
        text += bytes;
        text += strspn(text, " \t\n");
    }
}

void wrap_item(struct wrap *wrap, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (text_columns(text) < wrap->width - wrap->indent)
        put(wrap, text, strlen(text));
    else
        wrap_words(wrap, text);
}

void wrap_close(struct wrap *wrap)
{
    (void)fputc('\n', wrap->out);
}

void wrap_text(FILE *out, int indent, int width, const char *head, const char *text)
{
    struct wrap wrap = wrap_open(out, indent, width, head);
    wrap_words(&wrap, text);
    wrap_close(&wrap);
}
