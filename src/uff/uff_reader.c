/* The sets of a universal file in turn: between two lines '-1', a line with the number of the set and its records. */
#include "uff/uff_reader.h"

#include <string.h>

int uff_open(struct pool *pool, const char *path, struct message_list *messages, struct uff_reader **out)
{
    struct uff_reader *reader = POOL_NEW(pool, struct uff_reader);
    *out = NULL;
    if (!reader)
        return ROTID_ERROR_MEMORY;
    reader->allocator = pool->allocator;
    reader->lines.path = path;
    reader->lines.messages = messages;
    int status = uff_open_lines(&reader->lines);
    if (status == ROTID_OK)
        *out = reader;
    else
        uff_close(reader);
    return status;
}

void uff_close(struct uff_reader *reader)
{
    if (reader && reader->lines.stream)
        (void)fclose(reader->lines.stream); /* nothing was written that could fail to arrive */
    if (reader)
        reader->lines.stream = NULL;
}

/* The number of a set in the current line, 0 when it is none. */
static int parse_number(const struct uff_lines *lines, int *is_binary, size_t *end)
{
    size_t i = 0;
    int number = 0;
    while (lines->text[i] == ' ' || lines->text[i] == '\t')
        ++i;
    for (; lines->text[i] >= '0' && lines->text[i] <= '9' && number < 1000000; ++i)
        number = 10 * number + (lines->text[i] - '0');
    *end = i;
    *is_binary = lines->text[i] == 'b' || lines->text[i] == 'B';
    i += (size_t)*is_binary;
    return lines->text[i] && lines->text[i] != ' ' && lines->text[i] != '\t' ? 0 : number;
}

/* Behind an error: the next line that looks like the number of a set behind a '-1', in the columns where the set that failed
 * had its own. The set that failed is not taken again. ROTID_OK with that line at hand, UFF_END or ROTID_ERROR_IO. */
static int find_opener(struct uff_reader *reader)
{
    struct uff_lines *lines = &reader->lines;
    for (;;) {
        size_t end;
        int is_binary;
        if (lines->before.is_delimiter && lines->before.line != reader->set.line && parse_number(lines, &is_binary, &end) &&
            (!lines->strict || (lines->before.is_strict && end <= 6)))
            return ROTID_OK;
        int status = uff_take_line(lines);
        if (status != ROTID_OK)
            return status;
    }
}

/* The '-1' that opens a set, and the line behind it. */
static int read_opener(struct uff_reader *reader)
{
    struct uff_lines *lines = &reader->lines;
    int status, is_first = !reader->opened_sets;
    lines->set = 0;
    do
        status = uff_take_line(lines);
    while (status == ROTID_OK && !lines->length); /* blank lines between sets, and at the end */
    int is_opener = status == ROTID_OK && uff_is_delimiter(lines, 0);
    if (is_first && (status == UFF_END || (status == ROTID_OK && !is_opener))) {
        reader->opened_sets = 1; /* say so once */
        if (status == ROTID_OK && memchr(lines->text, '\r', lines->length))
            return uff_fail(lines, 0, "lines end with a carriage return alone; expected line feeds");
        return uff_fail(lines, 0, "no universal file: expected a line '    -1'");
    }
    if (status != ROTID_OK)
        return status;
    if (!is_opener) {
        char excerpt[UFF_EXCERPT];
        return uff_fail(lines, 1, "expected a line '    -1' that opens a set, found '%s'",
                        uff_excerpt(lines->text, lines->length, excerpt));
    }
    return uff_expect_line(lines, "the number of a set");
}

/* 58b: its first line says how many lines and then how many bytes follow. */
static int read_binary_line(struct uff_reader *reader)
{
    static const int start[] = {7, 13, 19, 31}, width[] = {6, 6, 12, 12}, field[] = {1, 2, 3, 4};
    struct uff_binary *binary = &reader->binary;
    long long value[4];
    if (!uff_find_integers(&reader->lines, 4, start, width, field, value) || value[2] < 0 || value[3] < 0)
        return uff_fail(&reader->lines, 0, "binary; expected byte order, number format, number of lines and number of bytes");
    binary->is_binary = 1;
    /* anything but 1 to 3 is refused when the values are read */
    binary->order = value[0] == 1 || value[0] == 2 ? (int)value[0] : 0;
    binary->format = value[1] >= 1 && value[1] <= 3 ? (int)value[1] : 0;
    /* the format fixes 11 for set 58, and some writers leave 0 there */
    binary->text_lines = reader->set.number == 58 && value[2] < 11 ? 11 : value[2];
    binary->bytes = value[3];
    return ROTID_OK;
}

/* From the line with the number, which is at hand. */
static int enter_set(struct uff_reader *reader, struct uff_set *set)
{
    struct uff_lines *lines = &reader->lines;
    size_t end;
    int is_binary;
    int number = parse_number(lines, &is_binary, &end);
    reader->opened_sets = 1;
    reader->binary = (struct uff_binary){0};
    reader->values.is_finished = 0;
    lines->strict = lines->before.is_strict;
    lines->set = number;
    reader->set =
        (struct uff_set){.number = number, .is_binary = is_binary, .line = lines->before.line, .offset = lines->before.offset};
    if (!number) {
        char excerpt[UFF_EXCERPT];
        return uff_fail(lines, 1, "expected the number of a set behind '    -1', found '%s'",
                        uff_excerpt(lines->text, lines->length, excerpt));
    }
    if (is_binary) {
        int status = read_binary_line(reader);
        if (status != ROTID_OK)
            return status;
    }
    *set = reader->set;
    return ROTID_OK;
}

int uff_next(struct uff_reader *reader, struct uff_set *set)
{
    int status = ROTID_OK;
    *set = (struct uff_set){0};
    if (reader->place == UFF_BROKEN)
        return ROTID_ERROR_IO;
    if (reader->place == UFF_AT_BODY || reader->place == UFF_AT_DATA)
        status = uff_skip_set(reader);
    if (status == ROTID_OK && reader->place == UFF_LOST)
        status = find_opener(reader);
    else if (status == ROTID_OK)
        status = read_opener(reader);
    if (status == UFF_END) {
        reader->place = UFF_BETWEEN;
        return status;
    }
    if (status == ROTID_OK)
        status = enter_set(reader, set);
    return uff_end(reader, status, UFF_AT_BODY);
}

int uff_can_return(const struct uff_reader *reader)
{
    return reader->lines.size >= 0;
}

int uff_return_to(struct uff_reader *reader, const struct uff_set *set)
{
    struct uff_set again = {0};
    if (reader->place == UFF_BROKEN)
        return ROTID_ERROR_IO;
    int status = uff_seek(&reader->lines, set->offset, set->line);
    if (status == ROTID_OK)
        status = read_opener(reader);
    if (status == ROTID_OK)
        status = enter_set(reader, &again);
    if (status == UFF_END || (status == ROTID_OK && again.number != set->number)) /* changed under our hands */
        status = uff_fail(&reader->lines, 0, "set %d is not there any more", set->number);
    if (status == ROTID_ERROR_SYNTAX)
        status = ROTID_ERROR_IO;
    return uff_end(reader, status, UFF_AT_BODY);
}
