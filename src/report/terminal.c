#include "report/report.h"

#include <errno.h>
#include <unistd.h>

#include "file/file.h"

/* text [length + 1], with a zero behind it; keep: the control characters that stay */
static void put(FILE *stream, const char *text, size_t length, const char *keep)
{
    const char *end = text + length, *from = text;
    while (text < end) {
        size_t bytes = text_visible(text);
        if (bytes || (*text && strchr(keep, *text))) {
            text += bytes ? bytes : 1;
            continue;
        }
        (void)fwrite(from, 1, (size_t)(text - from), stream);
        (void)fputs(TEXT_REPLACEMENT, stream);
        bytes = text_utf8(text);
        text += bytes ? bytes : 1;
        from = text;
    }
    (void)fwrite(from, 1, (size_t)(text - from), stream);
}

static struct {
    FILE *stream;
    char *text;
    size_t length;
    int reason;   /* why something did not arrive, an errno */
    int progress; /* a line of progress stands on standard error */
} out;

int terminal_open(void)
{
    if (file_hold_standard())
        return ROTID_ERROR_IO;
    out.stream = open_memstream(&out.text, &out.length);
    return out.stream ? ROTID_OK : ROTID_ERROR_MEMORY;
}

FILE *terminal_out(void)
{
    return out.stream;
}

void terminal_to_error(void)
{
    if (fflush(out.stream) == 0)
        put(stderr, out.text, out.length, "\n\t");
    rewind(out.stream);
}

static int arrived(void)
{
    if (!out.reason && (fflush(stdout) != 0 || ferror(stdout)))
        out.reason = errno ? errno : EIO;
    errno = out.reason;
    return out.reason ? ROTID_ERROR_IO : ROTID_OK;
}

static void end_progress(void)
{
    if (out.progress)
        (void)fputs("\r\033[K", stderr);
    out.progress = 0;
}

int terminal_flush(void)
{
    end_progress();
    if (!out.reason && (fflush(out.stream) != 0 || ferror(out.stream)))
        out.reason = ENOMEM;
    else if (!out.reason)
        put(stdout, out.text, out.length, "\n\t");
    rewind(out.stream); /* the next text begins where this one did */
    return arrived();
}

int terminal_print(const char *text)
{
    (void)terminal_flush();
    put(stdout, text, strlen(text), "\n\t");
    return arrived();
}

/* One line, or one that goes on: what is in front of its last line feed has none. */
static void put_line(const char *format, va_list values)
{
    char few[1024], *all = NULL; /* where memory is out, as much as fits */
    va_list again;
    va_copy(again, values);
    int count = vsnprintf(few, sizeof few, format, values);
    if (count >= (int)sizeof few && (all = malloc((size_t)count + 1)))
        (void)vsnprintf(all, (size_t)count + 1, format, again);
    va_end(again);
    const char *text = all ? all : few;
    size_t length = strlen(text), line = length && text[length - 1] == '\n' ? length - 1 : length;
    put(stderr, text, line, "\t");
    (void)fputs(text + line, stderr);
    free(all);
}

void terminal_say(const char *format, ...)
{
    va_list values;
    if (out.stream)
        (void)terminal_flush(); /* what was printed before stands before it */
    va_start(values, format);
    put_line(format, values);
    va_end(values);
}

static int has_colours(void)
{
    const char *none = getenv("NO_COLOR"), *term = getenv("TERM");
    return isatty(STDERR_FILENO) && !(none && *none) && term && *term && strcmp(term, "dumb") != 0;
}

void terminal_mark(enum terminal_mark mark)
{
    static const char *const sequence[] = {"\033[0m", "\033[1m", "\033[33m", "\033[31m"};
    if (!has_colours())
        return;
    if (out.stream)
        (void)terminal_flush();
    (void)fputs(sequence[mark], stderr);
}

void terminal_progress(const char *format, ...)
{
    va_list values;
    out.progress = 1;
    (void)fputc('\r', stderr);
    va_start(values, format);
    put_line(format, values);
    va_end(values);
    (void)fputs(" \033[K", stderr);
}
