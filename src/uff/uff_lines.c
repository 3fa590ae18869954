#include "uff/uff_lines.h"

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <string.h>

int uff_fail(struct uff_lines *lines, int column, const char *format, ...)
{
    char text[512];
    va_list values;
    column = column > 0 ? column : 1; /* the line as a whole */
    va_start(values, format);
    (void)vsnprintf(text, sizeof text, format, values);
    va_end(values);
    if (lines->set)
        message_add(lines->messages, SEVERITY_ERROR, lines->path, lines->line, column, "set %d: %s", lines->set, text);
    else
        message_add(lines->messages, SEVERITY_ERROR, lines->path, lines->line, column, "%s", text);
    return ROTID_ERROR_SYNTAX;
}

const char *uff_excerpt(const char *text, size_t length, char buffer[UFF_EXCERPT])
{
    size_t shown = length < UFF_EXCERPT ? length : UFF_EXCERPT - 4;
    for (size_t i = 0; i < shown; ++i)
        buffer[i] = (char)(text[i] >= ' ' && text[i] <= '~' ? text[i] : '?');
    memcpy(buffer + shown, shown < length ? "..." : "", shown < length ? 4 : 1);
    return buffer;
}

static int fail_reading(struct uff_lines *lines)
{
    message_add(lines->messages, SEVERITY_ERROR, lines->path, lines->line, 1, "cannot be read: %s", strerror(errno));
    return ROTID_ERROR_IO;
}

int uff_take_line(struct uff_lines *lines)
{
    int c = getc(lines->stream);
    if (c == EOF)
        return ferror(lines->stream) ? fail_reading(lines) : UFF_END;

    lines->line += lines->line < INT_MAX;
    lines->overlong = 0;
    size_t length = 0;
    for (; c != EOF && c != '\n'; c = getc(lines->stream)) {
        if (length < UFF_LINE_LIMIT)
            lines->text[length++] = (char)c;
        else
            lines->overlong = 1;
    }
    if (ferror(lines->stream))
        return fail_reading(lines);
    /* the carriage return of a file from Windows counts as a trailing blank */
    while (length && (lines->text[length - 1] == ' ' || lines->text[length - 1] == '\t' || lines->text[length - 1] == '\r'))
        --length;
    lines->text[length] = '\0';
    lines->length = length;
    return ROTID_OK;
}

int uff_expect_line(struct uff_lines *lines, const char *expected)
{
    int status = uff_take_line(lines);
    if (status == UFF_END)
        return uff_fail(lines, 0, "the file ends after this line; expected %s", expected);
    if (status == ROTID_OK && lines->overlong)
        return uff_fail(lines, UFF_LINE_LIMIT, "the line is longer than %d bytes; expected %s", UFF_LINE_LIMIT, expected);
    return status;
}

int uff_is_delimiter(const struct uff_lines *lines, int strict)
{
    const char *text = lines->text;
    size_t length = lines->length; /* without trailing blanks */
    if (length < 2 || lines->overlong || memcmp(text + length - 2, "-1", 2) != 0)
        return 0;
    if (strict && length != 6)
        return 0;
    for (size_t i = 0; i < length - 2; ++i)
        if (text[i] != ' ' && (strict || text[i] != '\t'))
            return 0;
    return 1;
}

int uff_skip_bytes(struct uff_lines *lines, long long count)
{
    while (count > 0) {
        size_t wanted = count < UFF_LINE_LIMIT ? (size_t)count : UFF_LINE_LIMIT;
        size_t got = fread(lines->text, 1, wanted, lines->stream);
        for (size_t i = 0; i < got; ++i) /* so that line numbers stay those an editor shows */
            lines->line += lines->text[i] == '\n' && lines->line < INT_MAX;
        count -= (long long)got;
        if (got < wanted)
            return ferror(lines->stream) ? fail_reading(lines)
                                         : uff_fail(lines, 0, "the file ends %lld bytes before the binary data do", count);
    }
    return ROTID_OK;
}
