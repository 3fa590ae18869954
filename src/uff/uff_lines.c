#include "uff/uff_lines.h"

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <string.h>
#include <sys/stat.h>

#include "base/host.h"
#include "file/open.h"

int uff_open_lines(struct uff_lines *lines)
{
    struct stat about;
    char why[HOST_ERROR_TEXT];
    errno = 0;
    lines->stream = file_open(lines->path, 1, &about); /* `buffer` is the only one */
    if (!lines->stream) {
        message_add(lines->messages, SEVERITY_ERROR, lines->path, 1, 1, "cannot be %s: %s", errno == EISDIR ? "read" : "opened",
                    file_error_text(errno, why));
        return ROTID_ERROR_IO;
    }
    lines->size = S_ISREG(about.st_mode) ? (long long)about.st_size : -1;
    return ROTID_OK;
}

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

void uff_warn(struct uff_lines *lines, const char *format, ...)
{
    char text[512];
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text, sizeof text, format, values);
    va_end(values);
    message_add(lines->messages, SEVERITY_WARNING, lines->path, lines->line, 1, "set %d: %s", lines->set, text);
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
    char why[HOST_ERROR_TEXT];
    message_add(lines->messages, SEVERITY_ERROR, lines->path, lines->line, 1, "cannot be read: %s", host_error_text(errno, why));
    return ROTID_ERROR_IO;
}

/* ROTID_OK when there are bytes in the buffer, UFF_END or ROTID_ERROR_IO. */
static int fill(struct uff_lines *lines)
{
    if (lines->at < lines->filled)
        return ROTID_OK;
    lines->base += (long long)lines->filled;
    lines->at = 0;
    errno = 0;
    lines->filled = fread(lines->buffer, 1, sizeof lines->buffer, lines->stream);
    if (lines->filled)
        return ROTID_OK;
    return ferror(lines->stream) ? fail_reading(lines) : UFF_END;
}

int uff_take_line(struct uff_lines *lines)
{
    int status = fill(lines);
    if (status != ROTID_OK)
        return status;

    lines->before.line = lines->line;
    lines->before.offset = lines->offset;
    lines->before.is_delimiter = uff_is_delimiter(lines, 0);
    lines->before.is_strict = uff_is_delimiter(lines, 1);
    lines->line += lines->line < INT_MAX;
    lines->offset = lines->base + (long long)lines->at;
    lines->overlong = 0;
    size_t length = 0;
    const char *end = NULL;
    while (!end && (status = fill(lines)) == ROTID_OK) {
        const char *start = lines->buffer + lines->at;
        size_t there = lines->filled - lines->at, room = UFF_LINE_LIMIT - length;
        end = memchr(start, '\n', there);
        size_t piece = end ? (size_t)(end - start) : there;
        lines->at += piece + (end != NULL);
        lines->overlong |= piece > room;
        piece = piece < room ? piece : room;
        memcpy(lines->text + length, start, piece);
        length += piece;
    }
    /* the carriage return of a file from Windows counts as a trailing blank */
    while (length && (lines->text[length - 1] == ' ' || lines->text[length - 1] == '\t' || lines->text[length - 1] == '\r'))
        --length;
    lines->text[length] = '\0';
    lines->length = length;
    return status == UFF_END ? ROTID_OK : status;
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

static int fail_short(struct uff_lines *lines, long long missing)
{
    return uff_fail(lines, 0, "the file ends %lld bytes before the binary data do", missing);
}

int uff_take_bytes(struct uff_lines *lines, size_t count, void *bytes)
{
    for (char *to = bytes; count;) {
        int status = fill(lines);
        if (status != ROTID_OK)
            return status == UFF_END ? fail_short(lines, (long long)count) : status;
        size_t there = lines->filled - lines->at, piece = there < count ? there : count;
        memcpy(to, lines->buffer + lines->at, piece);
        lines->at += piece;
        to += piece;
        count -= piece;
    }
    lines->length = 0; /* the line before is no neighbour of what comes now */
    return ROTID_OK;
}

int uff_skip_bytes(struct uff_lines *lines, long long count)
{
    long long here = lines->base + (long long)lines->at;
    if (lines->size >= 0 && count > lines->size - here)
        return fail_short(lines, count - (lines->size - here));
    if (lines->size >= 0)
        return uff_seek(lines, here + count, lines->line + 1);
    while (count > 0) {
        int status = fill(lines);
        if (status != ROTID_OK)
            return status == UFF_END ? fail_short(lines, count) : status;
        size_t there = lines->filled - lines->at, piece = (long long)there < count ? there : (size_t)count;
        lines->at += piece;
        count -= (long long)piece;
    }
    lines->length = 0;
    return ROTID_OK;
}

int uff_seek(struct uff_lines *lines, long long offset, int line)
{
    if (offset >= lines->base && offset - lines->base <= (long long)lines->filled) {
        lines->at = (size_t)(offset - lines->base);
    } else {
        errno = ESPIPE;
        if (lines->size < 0 || fseeko(lines->stream, (off_t)offset, SEEK_SET) != 0)
            return fail_reading(lines);
        lines->base = offset;
        lines->at = lines->filled = 0;
    }
    lines->length = 0;
    lines->line = line - 1;
    return ROTID_OK;
}

int uff_look_for_end(struct uff_lines *lines, long long count, int *found)
{
    char text[16] = {0};
    long long here = lines->base + (long long)lines->at, left = lines->size - here - count;
    *found = 0;
    if (lines->size < 0 || count > lines->size - here || left < 2)
        return ROTID_OK;
    size_t length = left < (long long)sizeof text ? (size_t)left : sizeof text, i = 0;
    int line = lines->line;
    int status = uff_seek(lines, here + count, line + 1);
    if (status == ROTID_OK)
        status = uff_take_bytes(lines, length, text);
    if (status == ROTID_OK)
        status = uff_seek(lines, here, line + 1);
    while (i < length && memchr("\r\n \t", text[i], 4))
        ++i;
    *found = status == ROTID_OK && i + 2 <= length && memcmp(text + i, "-1", 2) == 0 &&
             (i + 2 == length || memchr("\r\n \t", text[i + 2], 4));
    return status;
}
