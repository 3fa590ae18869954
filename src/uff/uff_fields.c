/* The fields of a line: written by Fortran in columns, where neighbours may touch, or by others separated by blanks. */
#include <limits.h>
#include <string.h>

#include "uff/uff_fields.h"

static int is_blank(char c)
{
    return c == ' ' || c == '\t';
}

int uff_split_blanks(const struct uff_lines *lines, struct uff_field *field, int limit)
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
        field[count++] = (struct uff_field){start, i - start};
    }
    return count;
}

/* As uff_split_blanks, but a field also ends where a sign cannot belong to it any more, as in -1.00000e+00-2.00000e+00: behind an
 * exponent, or where the number has no point (a sign behind digits with a point is an exponent without its letter). */
static int uff_split_signs(const struct uff_lines *lines, struct uff_field *field, int limit)
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
        field[count++] = (struct uff_field){start, i - start};
    }
    return count;
}

struct uff_field uff_cut_column(const struct uff_lines *lines, size_t start, size_t width)
{
    size_t end = start + width < lines->length ? start + width : lines->length;
    while (start < end && is_blank(lines->text[start]))
        ++start;
    while (end > start && is_blank(lines->text[end - 1]))
        --end;
    return (struct uff_field){start, end > start ? end - start : 0};
}

/* A real that touches its neighbour must show its point: else a long number would be cut in two valid ones, and a Fortran
 * reader would scale it. */
static int uff_is_cut_off(const struct uff_lines *lines, struct uff_field field)
{
    size_t end = field.start + field.length;
    int touches_left = field.start > 0 && !is_blank(lines->text[field.start - 1]);
    int touches_right = end < lines->length && !is_blank(lines->text[end]);
    return (touches_left || touches_right) && !memchr(lines->text + field.start, '.', field.length);
}

static enum uff_fault parse_fields(const struct uff_lines *lines, const struct uff_form *form, const struct uff_field *field,
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
            if (fault == UFF_FAULT_NONE && may_touch && uff_is_cut_off(lines, field[*bad]))
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

int uff_fail_field(struct uff_lines *lines, const char *what, enum uff_fault fault, struct uff_field field, int is_integer,
                   const char *expected)
{
    char excerpt[UFF_EXCERPT];
    int column = (int)field.start + 1;
    uff_excerpt(lines->text + field.start, field.length, excerpt);
    if (fault == UFF_FAULT_RANGE)
        return uff_fail(lines, column, "%s: %s is too large for a 32-bit integer; expected %s", what, excerpt, expected);
    if (fault == UFF_FAULT_NOT_FINITE)
        return uff_fail(lines, column, "%s: %s is not a finite number; expected %s", what, excerpt, expected);
    return uff_fail(lines, column, "%s: '%s' is not %s; expected %s", what, excerpt, is_integer ? "an integer" : "a real",
                    expected);
}

static int report(struct uff_lines *lines, const struct uff_form *form, const char *what, enum uff_fault fault,
                  struct uff_field field, int is_integer)
{
    char numbers[64];
    return uff_fail_field(lines, what, fault, field, is_integer, count_numbers(form, numbers));
}

int uff_parse_line(struct uff_lines *lines, const struct uff_form *form, const char *what, int *integer, double *real)
{
    struct uff_field blank[UFF_VALUE_LIMIT + 3], column[UFF_VALUE_LIMIT + 2], sign[UFF_VALUE_LIMIT + 3];
    int total = form->integers + form->reals;

    int bad = 0;
    int found = uff_split_blanks(lines, blank, total + 1);
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
        column[i] = uff_cut_column(lines, start, width);
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
    if (uff_split_signs(lines, sign, total + 1) == total &&
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

/* Parses `count` fields that are reals; the first that is none to *bad. */
static enum uff_fault parse_reals(const struct uff_lines *lines, int count, const struct uff_field *field, int may_touch,
                                  int *bad, double *value)
{
    const struct uff_form form = {.reals = count};
    return parse_fields(lines, &form, field, may_touch, bad, NULL, value);
}

/* Fields that all end with a column, one of which is left blank before the last: there a Fortran reader sees a zero. Where they
 * do not, the line is in free format. */
static int has_hole(int columns, const int *width, int found, const struct uff_field *field)
{
    int next = 0, passed = 0;
    for (size_t end = 0; passed < columns && next < found; ++passed) {
        end += (size_t)width[passed];
        next += field[next].start + field[next].length == end;
    }
    return next == found && passed > found;
}

/* The columns that the line fills, 0 when one of them is blank or the line is longer. */
static int cut_columns(const struct uff_lines *lines, int columns, const int *width, struct uff_field *column)
{
    int count = 0;
    size_t start = 0;
    for (; count < columns && start < lines->length; start += (size_t)width[count], ++count) {
        column[count] = uff_cut_column(lines, start, (size_t)width[count]);
        if (!column[count].length)
            return 0;
    }
    return lines->length <= start ? count : 0;
}

int uff_parse_values(struct uff_lines *lines, int columns, const int *width, long long left, const char *what, double *value,
                     int *taken)
{
    struct uff_field blank[UFF_VALUE_LIMIT + 1], column[UFF_VALUE_LIMIT], sign[UFF_VALUE_LIMIT + 1];
    int bad = 0, bad_column = 0, bad_sign = 0, due = left < columns ? (int)left : columns;
    int found = uff_split_blanks(lines, blank, UFF_VALUE_LIMIT + 1);
    /* more than are left only as filling of the last line */
    int fits = found > 0 && found <= UFF_VALUE_LIMIT && (found <= left || found <= columns) &&
               (found >= due || !has_hole(columns, width, found, blank));
    enum uff_fault fault = fits ? parse_reals(lines, found, blank, 0, &bad, value) : UFF_FAULT_COUNT;
    *taken = found <= left ? found : (int)left;
    if (fault == UFF_FAULT_NONE)
        return ROTID_OK;

    char expected[48];
    (void)snprintf(expected, sizeof expected, "%d real%s", due, due == 1 ? "" : "s");
    if (fault == UFF_FAULT_NOT_FINITE) /* a number for certain, do not cut it in two */
        return uff_fail_field(lines, what, fault, blank[bad], 0, expected);
    int cut = cut_columns(lines, columns, width, column);
    enum uff_fault column_fault = cut ? parse_reals(lines, cut, column, 1, &bad_column, value) : UFF_FAULT_COUNT;
    *taken = cut <= left ? cut : (int)left;
    if (column_fault == UFF_FAULT_NONE)
        return ROTID_OK;
    *taken = due;
    if (uff_split_signs(lines, sign, due + 1) == due && parse_reals(lines, due, sign, 1, &bad_sign, value) == UFF_FAULT_NONE)
        return ROTID_OK;
    if (column_fault == UFF_FAULT_NOT_FINITE)
        return uff_fail_field(lines, what, column_fault, column[bad_column], 0, expected);
    if (fits)
        return uff_fail_field(lines, what, fault, blank[bad], 0, expected);
    return uff_fail(lines, 0, "%s: expected %s, found %d field%s", what, expected, found, found == 1 ? "" : "s");
}
