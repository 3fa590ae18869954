#include "result/result.h"

#include <errno.h>
#include <sys/stat.h>

#include "file/file.h"

/* The whole file with a zero byte behind it. */
static int read_text(struct pool *pool, const char *file, struct message_list *messages, char **text, size_t *length)
{
    struct stat is = {.st_size = 0};
    FILE *stream = file_open_regular(file, &is);
    int status = ROTID_ERROR_IO;
    const char *why = NULL;
    if (!stream && errno == ENOMEM)
        status = ROTID_ERROR_MEMORY;
    if (!stream)
        why = errno == EISDIR   ? "is a folder, expected a file of JSON"
              : errno == EINVAL ? "is no regular file, expected one of JSON"
                                : strerror(errno);
    else if (is.st_size > JSON_FILE_MOST)
        why = "is larger than 64 MiB, more than any result of rotid";
    if (!why) {
        *text = POOL_ARRAY(pool, char, is.st_size + 1);
        status = *text ? ROTID_OK : ROTID_ERROR_MEMORY;
        *length = *text ? fread(*text, 1, (size_t)is.st_size, stream) : 0;
        if (*text && ferror(stream)) {
            why = strerror(errno);
            status = ROTID_ERROR_IO;
        }
    }
    if (why)
        message_add(messages, SEVERITY_ERROR, NULL, 0, 0, "%s: %s", file, why);
    if (stream)
        (void)fclose(stream);
    return status;
}

const char *json_text_too_dense(const char *text, size_t length)
{
    enum { VALUE = 80, STRING = 48 }; /* with what the allocator adds */
    const size_t most = length > JSON_MEMORY_FREE / JSON_MEMORY_MOST ? JSON_MEMORY_MOST * length : (size_t)JSON_MEMORY_FREE;
    size_t memory = VALUE;
    int quoted = 0;
    for (const char *c = text; c < text + length; c++) {
        if (*c == '"') {
            quoted = !quoted;
            memory += quoted ? STRING : 0;
        } else if (quoted) {
            c += *c == '\\';
            memory++;
        } else {
            memory += *c == ',' || *c == '[' || *c == '{' ? VALUE : 0;
        }
        if (memory > most)
            return c;
    }
    return NULL;
}

int json_parse(const char *text, size_t length, const char **rest, cJSON **json)
{
    const char *ignored;
    errno = 0;
    *json = cJSON_ParseWithLengthOpts(text, length, rest ? rest : &ignored, 0);
    return *json ? ROTID_OK : errno == ENOMEM ? ROTID_ERROR_MEMORY : ROTID_ERROR_SYNTAX; /* malloc sets it */
}

static const char *skip_blanks(const char *c, const char *end)
{
    while (c < end && (*c == ' ' || *c == '\t' || *c == '\n' || *c == '\r'))
        c++;
    return c;
}

/* Whether a value begins here that the file does not end; begin: of all values. */
static int is_cut_off(const char *begin, const char *at, const char *end)
{
    if (at < end && *at == '"') {
        for (at++; at < end && *at != '"'; at++)
            at += *at == '\\';
        return at >= end;
    }
    return skip_blanks(at, end) >= end || (at > skip_blanks(begin, end) && at + strcspn(at, ",]}:\n") >= end);
}

#define TOO_DENSE 2

/* cut_off: the file ends here; TOO_DENSE: it has too many values. */
static void say_where(const char *file, struct message_list *messages, const char *text, const char *at, int cut_off)
{
    int line = 1, column = 1;
    for (const char *c = text; c < at; c++) {
        column = *c == '\n' ? 1 : column + 1;
        line += *c == '\n';
    }
    if (cut_off == TOO_DENSE)
        message_add(messages, SEVERITY_ERROR, file, line, column,
                    "the values up to here would take more memory than %d times the size of the file, expected a result of rotid",
                    JSON_MEMORY_MOST);
    else if (cut_off)
        message_add(messages, SEVERITY_ERROR, file, line, column, "the file ends within a value, expected the rest of it");
    else if (*at < 0x20 || *at > 0x7e)
        message_add(messages, SEVERITY_ERROR, file, line, column, "byte %d is no JSON, expected a value, a comma or a bracket",
                    (unsigned char)*at);
    else
        message_add(messages, SEVERITY_ERROR, file, line, column,
                    "'%.*s' is no JSON, expected a value, a comma or a bracket: a result of --json?",
                    (int)strcspn(at, "\r\n \t,]}") + !strcspn(at, "\r\n \t,]}"), at);
}

/* What follows the first value, each value beginning on a line of its own. */
static int read_lines(const char *file, struct message_list *messages, const char *text, const char *at, const char *end,
                      cJSON **json)
{
    cJSON *list = cJSON_CreateArray(), *first = *json;
    const char *next;
    *json = list;
    if (!list || !cJSON_AddItemToArray(list, first)) {
        cJSON_Delete(first);
        return ROTID_ERROR_MEMORY;
    }
    while ((at = skip_blanks(at, end)) < end) {
        cJSON *value;
        int status = json_parse(at, (size_t)(end - at), &next, &value);
        if (status == ROTID_ERROR_MEMORY)
            return status;
        if (value && cJSON_AddItemToArray(list, value)) {
            at = next;
            continue;
        }
        if (memchr(at, '\n', (size_t)(end - at))) {
            say_where(file, messages, text, next, is_cut_off(at, next, end));
            return ROTID_ERROR_SYNTAX;
        }
        message_warn(messages, "%s: the last line is not complete and left out", file);
        break;
    }
    return ROTID_OK;
}

int json_file_read(struct pool *pool, const char *file, struct message_list *messages, cJSON **json, int *is_lines)
{
    char *text;
    size_t length;
    const char *rest = NULL, *end;
    *json = NULL;
    *is_lines = 0;
    int status = read_text(pool, file, messages, &text, &length);
    if (status)
        return status;
    end = text + length;
    if (skip_blanks(text, end) == end)
        return message_refuse(messages, ROTID_ERROR_SYNTAX, NULL, 0, 0, "%s: is empty, expected JSON", file);
    const char *dense = json_text_too_dense(text, length);
    if (dense) {
        say_where(file, messages, text, dense, TOO_DENSE);
        return ROTID_ERROR_SYNTAX;
    }
    status = json_parse(text, length, &rest, json);
    if (status == ROTID_ERROR_MEMORY)
        return status;
    if (status) {
        rest = rest ? rest : text;
        say_where(file, messages, text, rest, is_cut_off(text, rest, end));
        return ROTID_ERROR_SYNTAX;
    }
    rest = skip_blanks(rest, end);
    if (rest < end && *rest == '{' && cJSON_IsObject(*json) && memchr(text, '\n', (size_t)(rest - text))) {
        *is_lines = 1;
        status = read_lines(file, messages, text, rest, end, json);
    } else if (rest < end) {
        say_where(file, messages, text, rest, 0);
        status = ROTID_ERROR_SYNTAX;
    }
    if (status) {
        cJSON_Delete(*json);
        *json = NULL;
    }
    return status;
}
