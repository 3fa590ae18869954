/* The fields of a line: written by Fortran in columns, where neighbours may touch, or by others separated by blanks. */
#include <limits.h>
#include <string.h>

#include "uff/uff_lines.h"
#include "uff/uff_numbers.h"

struct field {
    size_t start, length;
};

static int is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Blank-separated fields, at most `limit` of them. */
static int split_blanks(const struct uff_lines *lines, struct field *field, int limit)
{
    int count = 0;
    for (size_t i = 0; i < lines->length && count < limit;) {
        if (is_blank(lines->text[i])) {
            ++i;
            continue;
        }
        size_t start = i;
        while (i < lines->length && !is_blank(lines->text[i]))
            ++i;
        field[count++] = (struct field){start, i - start};
    }
    return count;
}

/* The same, but a field also ends where a sign cannot belong to it any more, as in -1.00000e+00-2.00000e+00: behind an
 * exponent, or where the number has no point (a sign behind digits with a point is an exponent without its letter). */
static int split_signs(const struct uff_lines *lines, struct field *field, int limit)
{
    int count = 0;
    for (size_t i = 0; i < lines->length && count < limit;) {
        if (is_blank(lines->text[i])) {
            ++i;
            continue;
        }
        size_t start = i;
        int point = 0, exponent = 0;
        for (; i < lines->length && !is_blank(lines->text[i]); ++i) {
            char c = lines->text[i];
            int letter_before = i > start && memchr("eEdDqQ", lines->text[i - 1], 6) != NULL;
            if ((c == '-' || c == '+') && i > start && !letter_before) {
                if (exponent || !point)
                    break;
                exponent = 1;
            }
            point |= c == '.';
            exponent |= memchr("eEdDqQ", c, 6) != NULL;
        }
        field[count++] = (struct field){start, i - start};
    }
    return count;
}

/* What the columns start to start + width - 1 hold, without the blanks around it. */
static struct field cut_column(const struct uff_lines *lines, size_t start, size_t width)
{
    size_t end = start + width < lines->length ? start + width : lines->length;
    while (start < end && is_blank(lines->text[start]))
        ++start;
    while (end > start && is_blank(lines->text[end - 1]))
        --end;
    return (struct field){start, end > start ? end - start : 0};
}

/* A real that touches its neighbour must show its point: else a long number would be cut in two valid ones, and a Fortran
 * reader would scale it. */
static int is_cut_off(const struct uff_lines *lines, struct field field)
{
    size_t end = field.start + field.length;
    int touches_left = field.start > 0 && !is_blank(lines->text[field.start - 1]);
    int touches_right = end < lines->length && !is_blank(lines->text[end]);
    return (touches_left || touches_right) && !memchr(lines->text + field.start, '.', field.length);
}

static enum uff_fault parse_fields(const struct uff_lines *lines, const struct uff_form *form, const struct field *field,
                                   int may_touch, int *bad, int *integer, double *real)
{
    int total = form->integers + form->reals;
    for (*bad = 0; *bad < total; ++*bad) {
        const char *text = lines->text + field[*bad].start;
        size_t length = field[*bad].length;
        enum uff_fault fault;
        if (*bad < form->integers) {
            long long value = 0;
            fault = uff_parse_integer(text, length, &value);
            if (fault == UFF_FAULT_NONE && (value < INT_MIN || value > INT_MAX))
                fault = UFF_FAULT_RANGE;
            if (fault == UFF_FAULT_NONE)
                integer[*bad] = (int)value;
        } else {
            fault = uff_parse_real(text, length, &real[*bad - form->integers]);
            if (fault == UFF_FAULT_NONE && may_touch && is_cut_off(lines, field[*bad]))
                fault = UFF_FAULT_MALFORMED;
        }
        if (fault != UFF_FAULT_NONE)
            return fault;
    }
    return UFF_FAULT_NONE;
}

/* "4 integers and 3 reals" */
static const char *count_numbers(const struct uff_form *form, char buffer[64])
{
    const char *s_integers = form->integers == 1 ? "" : "s", *s_reals = form->reals == 1 ? "" : "s";
    if (form->integers && form->reals)
        (void)snprintf(buffer, 64, "%d integer%s and %d real%s", form->integers, s_integers, form->reals, s_reals);
    else if (form->integers)
        (void)snprintf(buffer, 64, "%d integer%s", form->integers, s_integers);
    else
        (void)snprintf(buffer, 64, "%d real%s", form->reals, s_reals);
    return buffer;
}

static int report(struct uff_lines *lines, const struct uff_form *form, const char *what, enum uff_fault fault,
                  struct field field, int is_integer)
{
    char excerpt[UFF_EXCERPT], numbers[64];
    int column = (int)field.start + 1;
    uff_excerpt(lines->text + field.start, field.length, excerpt);
    if (fault == UFF_FAULT_RANGE)
        return uff_fail(lines, column, "%s: %s is too large for a 32-bit integer; expected %s", what, excerpt,
                        count_numbers(form, numbers));
    if (fault == UFF_FAULT_NOT_FINITE)
        return uff_fail(lines, column, "%s: %s is not a finite number; expected %s", what, excerpt, count_numbers(form, numbers));
    return uff_fail(lines, column, "%s: '%s' is not %s; expected %s", what, excerpt, is_integer ? "an integer" : "a real",
                    count_numbers(form, numbers));
}

int uff_parse_line(struct uff_lines *lines, const struct uff_form *form, const char *what, int *integer, double *real)
{
    struct field blank[UFF_VALUE_LIMIT + 3], column[UFF_VALUE_LIMIT + 2], sign[UFF_VALUE_LIMIT + 3];
    int total = form->integers + form->reals;

    int bad = 0;
    int found = split_blanks(lines, blank, total + 1);
    enum uff_fault fault = UFF_FAULT_COUNT;
    if (found == total)
        fault = parse_fields(lines, form, blank, 0, &bad, integer, real);
    if (fault == UFF_FAULT_NONE)
        return ROTID_OK;
    if (fault == UFF_FAULT_RANGE || fault == UFF_FAULT_NOT_FINITE) /* a number for certain, do not cut it in two */
        return report(lines, form, what, fault, blank[bad], bad < form->integers);

    size_t start = 0;
    int complete = 1, bad_column = 0;
    for (int i = 0; i < total; ++i) {
        size_t width = (size_t)(i < form->integers ? form->integer_width : form->real_width);
        column[i] = cut_column(lines, start, width);
        complete = complete && column[i].length > 0;
        start += width;
    }
    complete = complete && start >= lines->length; /* text has no trailing blanks */
    enum uff_fault column_fault = UFF_FAULT_COUNT;
    if (complete)
        column_fault = parse_fields(lines, form, column, 1, &bad_column, integer, real);
    if (column_fault == UFF_FAULT_NONE)
        return ROTID_OK;

    int bad_sign = 0;
    if (split_signs(lines, sign, total + 1) == total &&
        parse_fields(lines, form, sign, 1, &bad_sign, integer, real) == UFF_FAULT_NONE)
        return ROTID_OK;

    if (found == total)
        return report(lines, form, what, fault, blank[bad], bad < form->integers);
    if (complete)
        return report(lines, form, what, column_fault, column[bad_column], bad_column < form->integers);
    char numbers[64];
    return uff_fail(lines, 0, "%s: expected %s, found %s%d field%s", what, count_numbers(form, numbers),
                    found > total ? "at least " : "", found, found == 1 ? "" : "s");
}

/* How many of the numbers still missing the current line should hold. */
static int on_this_line(const struct uff_lines *lines, int left, int columns)
{
    struct field field[UFF_VALUE_LIMIT + 3];
    return left <= columns || split_blanks(lines, field, left + 1) == left ? left : columns;
}

int uff_read_reals(struct uff_lines *lines, int count, const char *what, double *real)
{
    for (int done = 0; done < count;) {
        int status = uff_expect_line(lines, what);
        if (status != ROTID_OK)
            return status;
        struct uff_form form = {.reals = on_this_line(lines, count - done, 6), .real_width = 13};
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
        struct field column = cut_column(lines, (size_t)start[i], (size_t)width[i]);
        found += column.length && uff_parse_integer(lines->text + column.start, column.length, &value[i]) == UFF_FAULT_NONE;
    }
    if (found == count)
        return 1;

    struct field token[UFF_VALUE_LIMIT];
    int tokens = split_blanks(lines, token, UFF_VALUE_LIMIT);
    for (int i = 0; i < count; ++i) {
        if (field[i] >= tokens)
            return 0;
        struct field one = token[field[i]];
        if (uff_parse_integer(lines->text + one.start, one.length, &value[i]) != UFF_FAULT_NONE)
            return 0;
    }
    return 1;
}
