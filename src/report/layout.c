#include "report/layout.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

void number_cell(FILE *out, int width, int decimals, double value)
{
    if (isfinite(value))
        (void)fprintf(out, "%*.*f", width, decimals, value);
    else
        (void)fprintf(out, "%*s", width, "-");
}

void signed_cell(FILE *out, int width, int decimals, double value)
{
    if (isfinite(value))
        (void)fprintf(out, "%+*.*f", width, decimals, value);
    else
        (void)fprintf(out, "%*s", width, "-");
}

void digits_cell(FILE *out, int width, int digits, double value)
{
    if (isfinite(value))
        (void)fprintf(out, "%*.*g", width, digits, value);
    else
        (void)fprintf(out, "%*s", width, "-");
}

void chance_cell(FILE *out, int width, double value)
{
    if (value < 0.001)
        (void)fprintf(out, "%*s", width, "<0.001");
    else
        number_cell(out, width, 3, value);
}

static int begins_character(char c)
{
    return ((unsigned char)c & 0xc0) != 0x80;
}

static int columns_of(const char *text, size_t bytes)
{
    int columns = 0;
    for (size_t i = 0; i < bytes; i++)
        columns += begins_character(text[i]);
    return columns;
}

void text_cell(FILE *out, int width, const char *text)
{
    int columns = columns_of(text, strlen(text)), shown = columns > width ? width - 1 : columns, column = 0;
    for (; *text; text++) {
        column += begins_character(*text);
        if (column > shown)
            break;
        (void)fputc(*text, out);
    }
    (void)fprintf(out, "%*s", width - shown, columns > width ? "~" : "");
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
    for (size_t i = 0; i < bytes; i++) {
        if (begins_character(text[i])) {
            if (wrap->column >= wrap->width - 1)
                new_line(wrap);
            wrap->column++;
        }
        (void)fputc(text[i], wrap->out);
    }
    wrap->fresh = 0;
}

void wrap_open(struct wrap *wrap, FILE *out, int indent, int width, const char *head)
{
    (void)fputs(head, out);
    *wrap = (struct wrap){out, indent, width, columns_of(head, strlen(head)), 1};
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
    if (columns_of(text, strlen(text)) < wrap->width - wrap->indent)
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
    struct wrap wrap;
    wrap_open(&wrap, out, indent, width, head);
    wrap_words(&wrap, text);
    wrap_close(&wrap);
}
