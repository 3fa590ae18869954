/* Records: numbers over several lines, lists of integers, and lines of mixed contents in columns. */
#include <limits.h>
#include <string.h>

#include "uff/uff_fields.h"

/* How many of the numbers still missing the current line should hold. */
static int on_this_line(const struct uff_lines *lines, int left, int columns)
{
    struct uff_field field[UFF_VALUE_LIMIT + 3];
    return left <= columns || uff_split_blanks(lines, field, left + 1) == left ? left : columns;
}

int uff_read_reals(struct uff_lines *lines, int count, int columns, int width, const char *what, double *real)
{
    for (int done = 0; done < count;) {
        int status = uff_expect_line(lines, what);
        if (status != ROTID_OK)
            return status;
        struct uff_form form = {.reals = on_this_line(lines, count - done, columns), .real_width = width};
        status = uff_parse_line(lines, &form, what, NULL, real + done);
        if (status != ROTID_OK)
            return status;
        done += form.reals;
    }
    return ROTID_OK;
}

int uff_read_integers(struct uff_lines *lines, int count, const char *what, int *integer)
{
    for (int done = 0; done < count;) {
        int status = done ? uff_expect_line(lines, what) : ROTID_OK;
        if (status != ROTID_OK)
            return status;
        struct uff_form form = {.integers = on_this_line(lines, count - done, 8), .integer_width = 10};
        status = uff_parse_line(lines, &form, what, integer + done, NULL);
        if (status != ROTID_OK)
            return status;
        done += form.integers;
    }
    return ROTID_OK;
}

int uff_find_integers(const struct uff_lines *lines, int count, const int *start, const int *width, const int *field,
                      long long *value)
{
    int found = 0;
    for (int i = 0; i < count; ++i) {
        struct uff_field column = uff_cut_column(lines, (size_t)start[i], (size_t)width[i]);
        found += column.length && uff_parse_integer(lines->text + column.start, column.length, &value[i]) == UFF_FAULT_NONE;
    }
    if (found == count)
        return 1;

    struct uff_field token[UFF_VALUE_LIMIT];
    int tokens = uff_split_blanks(lines, token, UFF_VALUE_LIMIT);
    for (int i = 0; i < count; ++i) {
        if (field[i] >= tokens)
            return 0;
        struct uff_field one = token[field[i]];
        if (uff_parse_integer(lines->text + one.start, one.length, &value[i]) != UFF_FAULT_NONE)
            return 0;
    }
    return 1;
}

static enum uff_fault read_cell(const struct uff_lines *lines, enum uff_kind kind, struct uff_field field, struct uff_cell *cell)
{
    const char *text = lines->text + field.start;
    *cell = (struct uff_cell){.start = field.start, .length = field.length};
    if (kind == UFF_WORDS)
        return UFF_FAULT_NONE;
    if (!field.length)
        return kind == UFF_REQUIRED_INTEGER || kind == UFF_LONG ? UFF_FAULT_MALFORMED : UFF_FAULT_NONE;
    return kind == UFF_REAL ? uff_parse_real(text, field.length, &cell->real)
                            : uff_parse_integer(text, field.length, &cell->integer);
}

int uff_cut_line(const struct uff_lines *lines, int count, const struct uff_column *column, struct uff_cell *cell)
{
    int bad = -1;
    for (int i = count - 1; i >= 0; --i) {
        struct uff_field field = uff_cut_column(lines, (size_t)column[i].start, (size_t)column[i].width);
        if (read_cell(lines, column[i].kind, field, &cell[i]) != UFF_FAULT_NONE)
            bad = i;
    }
    struct uff_field token[UFF_CELL_LIMIT + 1];
    if (bad < 0 || uff_split_blanks(lines, token, count + 1) != count)
        return bad;
    struct uff_cell other[UFF_CELL_LIMIT];
    for (int i = 0; i < count; ++i)
        if (read_cell(lines, column[i].kind, token[i], &other[i]) != UFF_FAULT_NONE)
            return bad;
    memcpy(cell, other, (size_t)count * sizeof *cell);
    return -1;
}

int uff_cut_record(struct uff_lines *lines, int count, const struct uff_column *column, const char *what, struct uff_cell *cell)
{
    int bad = uff_cut_line(lines, count, column, cell);
    if (bad < 0) {
        for (int i = 0; i < count; ++i)
            if ((cell[i].integer < INT_MIN || cell[i].integer > INT_MAX) && column[i].kind == UFF_INTEGER)
                return uff_fail_field(lines, what, UFF_FAULT_RANGE, (struct uff_field){cell[i].start, cell[i].length}, 1,
                                      "32 bits");
        return ROTID_OK;
    }
    char expected[80];
    (void)snprintf(expected, sizeof expected, "it in columns %d to %d", column[bad].start + 1,
                   column[bad].start + column[bad].width);
    struct uff_field field = uff_cut_column(lines, (size_t)column[bad].start, (size_t)column[bad].width);
    if (!field.length)
        field.start = (size_t)column[bad].start;
    if (field.start > lines->length)
        field.start = lines->length;
    return uff_fail_field(lines, what, UFF_FAULT_MALFORMED, field, column[bad].kind != UFF_REAL, expected);
}

void uff_copy_text(const char *text, size_t length, size_t room, char *out)
{
    length = length < room ? length : room - 1;
    while (length && (text[length - 1] == ' ' || text[length - 1] == '\t'))
        --length;
    if (length == 4 && memcmp(text, "NONE", 4) == 0)
        length = 0;
    memcpy(out, text, length);
    out[length] = '\0';
}

int uff_read_text(struct uff_lines *lines, const char *expected, char out[UFF_TEXT + 1])
{
    int status = uff_expect_line(lines, expected);
    if (status == ROTID_OK)
        uff_copy_text(lines->text, lines->length, UFF_TEXT + 1, out);
    return status;
}
