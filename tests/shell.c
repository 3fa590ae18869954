#include "shell.h"

#include <sys/wait.h>

#include "support.h"

static const char *read_all(struct pool *pool, FILE *stream)
{
    char *text = NULL;
    size_t length = 0, capacity = 0;
    for (int c = getc(stream); c != EOF; c = getc(stream)) {
        text = pool_grow(pool, text, length, &capacity, 1);
        assert_non_null(text);
        text[length++] = (char)c;
    }
    text = pool_grow(pool, text, length, &capacity, 1);
    assert_non_null(text);
    text[length] = 0;
    return text;
}

static int run(struct pool *pool, const char **output, const char *command)
{
    (void)fflush(NULL);
    FILE *stream = popen(command, "r");
    assert_non_null(stream);
    const char *text = read_all(pool, stream);
    int status = pclose(stream);
    assert_true(status >= 0);
    if (output)
        *output = text;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

static const char *command_of(struct pool *pool, const char *format, va_list list)
{
    char text[8192];
    int length = vsnprintf(text, sizeof text, format, list);
    assert_true(length >= 0 && (size_t)length < sizeof text);
    const char *command =
        pool_format(pool, "exec 2>&1; unset MAKEFLAGS MFLAGS MAKELEVEL MAKEOVERRIDES; LC_ALL=C; export LC_ALL; %s", text);
    assert_non_null(command);
    return command;
}

int shell_code(struct pool *pool, const char **output, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const char *command = command_of(pool, format, list);
    va_end(list);
    return run(pool, output, command);
}

const char *shell(struct pool *pool, const char *format, ...)
{
    const char *output;
    va_list list;
    va_start(list, format);
    const char *command = command_of(pool, format, list);
    va_end(list);
    int code = run(pool, &output, command);
    if (code)
        fail_msg("exit code %d of\n%s\n%s", code, command, output);
    return output;
}

const char *shell_file(struct pool *pool, const char *path)
{
    FILE *stream = fopen(path, "r");
    if (!stream)
        fail_msg("%s cannot be read", path);
    const char *text = read_all(pool, stream);
    (void)fclose(stream);
    return text;
}
