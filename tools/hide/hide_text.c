#include "hide_text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int hide_fail(const struct hide_message *message, int status, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    if (message->room > 0)
        vsnprintf(message->text, message->room, format, list);
    va_end(list);
    return status;
}

static int make_room(struct hide_text *text, size_t more)
{
    if (text->failed || text->room - text->length > more)
        return text->failed;
    size_t room = 2 * (text->length + more) + 1024;
    char *larger = realloc(text->data, room);
    if (!larger)
        return text->failed = 1;
    text->data = larger;
    text->room = room;
    return 0;
}

void hide_add_bytes(struct hide_text *text, const char *bytes, size_t count)
{
    if (make_room(text, count))
        return;
    memcpy(text->data + text->length, bytes, count);
    text->length += count;
    text->data[text->length] = 0;
}

void hide_add(struct hide_text *text, const char *format, ...)
{
    va_list list, again;
    va_start(list, format);
    va_copy(again, list);
    int needed = vsnprintf(NULL, 0, format, list);
    va_end(list);
    if (needed < 0)
        text->failed = 1;
    else if (!make_room(text, (size_t)needed + 1)) {
        vsnprintf(text->data + text->length, (size_t)needed + 1, format, again);
        text->length += (size_t)needed;
    }
    va_end(again);
}

int hide_same(const char *a, const char *b)
{
    while (*a && tolower((unsigned char)*a) == tolower((unsigned char)*b)) {
        a++;
        b++;
    }
    return *a == 0 && *b == 0;
}

int hide_read_number(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && *end == 0 && isfinite(*value);
}

char *hide_trim(char *text)
{
    size_t length;
    while (isspace((unsigned char)*text))
        text++;
    length = strlen(text);
    while (length > 0 && isspace((unsigned char)text[length - 1]))
        text[--length] = 0;
    return text;
}

int hide_fields(char *line, int most, char **field)
{
    int count = 0;
    for (char *rest = line; rest;) {
        char *comma = strchr(rest, ',');
        if (comma)
            *comma = 0;
        rest = hide_trim(rest);
        if (!comma && !*rest)
            break;
        if (count == most)
            return -1;
        field[count++] = rest;
        rest = comma ? comma + 1 : NULL;
    }
    return count;
}

char *hide_read_file(const char *program, const char *path, const char *hint)
{
    struct hide_text text = {NULL, 0, 0, 0};
    char block[4096];
    size_t count;
    FILE *file = fopen(path, "rb");
    if (!file) {
        fprintf(stderr, "%s: %s: %s%s\n", program, path, strerror(errno), hint);
        return NULL;
    }
    hide_add(&text, "%s", "");
    while ((count = fread(block, 1, sizeof block, file)) > 0)
        hide_add_bytes(&text, block, count);
    int bad = ferror(file) || text.failed || strlen(text.data) != text.length;
    fclose(file);
    if (!bad)
        return text.data;
    fprintf(stderr, "%s: %s: expected a text that can be read\n", program, path);
    free(text.data);
    return NULL;
}
