#include "uff/uff.h"

#include <errno.h>
#include <float.h>
#include <limits.h>
#include <sys/stat.h>

#include "file/file.h"

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* The whole of text [length] must be the number; *value is set when it is. */
static enum uff_fault parse_integer(const char *text, size_t length, long long *value)
{
    size_t i = length && (text[0] == '-' || text[0] == '+');
    if (i == length)
        return UFF_FAULT_MALFORMED;
    long long sum = 0;
    enum uff_fault fault = UFF_FAULT_NONE;
    for (; i < length; ++i) {
        if (!is_digit(text[i]))
            return UFF_FAULT_MALFORMED;
        if (sum > (LLONG_MAX - 9) / 10)
            fault = UFF_FAULT_RANGE;
        else
            sum = 10 * sum + (text[i] - '0');
    }
    *value = text[0] == '-' ? -sum : sum;
    return fault;
}

static int is_word(const char *text, size_t length, const char *word)
{
    size_t i = 0;
    while (i < length && word[i] && (text[i] | 0x20) == word[i])
        ++i;
    return !word[i];
}

/* What the C libraries write for a number that is none, such as "-nan", "Infinity", "1.#QNAN". */
static int is_not_finite(const char *text, size_t length)
{
    size_t i = length && (text[0] == '-' || text[0] == '+');
    return is_word(text + i, length - i, "nan") || is_word(text + i, length - i, "inf") ||
           (length - i > 3 && memcmp(text + i, "1.#", 3) == 0);
}

/* Sign, digits with at most one point, and the exponent that Fortran may write without its letter where a point has been. */
struct decimal {
    uint64_t digits; /* all of them as one number, of which `point` stand behind the point; of no use when is_long */
    int is_negative, is_long, point, exponent;
};

/* Digits past this many may not fit into 64 bits, and an exponent of so many decides by itself. */
enum { DIGIT_LIMIT = 18, EXPONENT_LIMIT = 100000 };

static enum uff_fault scan(const char *text, size_t length, struct decimal *out)
{
    size_t i = 0;
    int digits = 0, points = 0, exponent_digits = 0, significant = 0;
    if (i < length && (text[i] == '-' || text[i] == '+'))
        out->is_negative = text[i++] == '-';
    for (; i < length && (is_digit(text[i]) || (text[i] == '.' && !points)); ++i) {
        if (text[i] == '.') {
            points = 1;
            continue;
        }
        ++digits;
        out->point += points;
        significant += significant || text[i] != '0';
        if (significant <= DIGIT_LIMIT)
            out->digits = 10 * out->digits + (uint64_t)(text[i] - '0');
    }
    out->is_long = significant > DIGIT_LIMIT;
    if (!digits)
        return UFF_FAULT_MALFORMED;
    if (i == length)
        return UFF_FAULT_NONE;
    int letter = memchr("eEdDqQ", text[i], 6) != NULL, negative = 0;
    i += (size_t)letter;
    int sign = i < length && (text[i] == '-' || text[i] == '+');
    if (!letter && (!sign || !points))
        return UFF_FAULT_MALFORMED;
    if (sign)
        negative = text[i++] == '-';
    for (; i < length && is_digit(text[i]); ++i, ++exponent_digits)
        if (out->exponent < EXPONENT_LIMIT)
            out->exponent = 10 * out->exponent + (text[i] - '0');
    if (i < length || !exponent_digits)
        return UFF_FAULT_MALFORMED;
    out->exponent = negative ? -out->exponent : out->exponent;
    return UFF_FAULT_NONE;
}

/* By strtod, for what the short way cannot do: the text with the exponent as C writes it. */
static enum uff_fault convert(const char *text, size_t length, double *value)
{
    char c_text[128];
    size_t n = 0;
    int exponent = 0;
    for (size_t i = 0; i < length; ++i) {
        int letter = memchr("eEdDqQ", text[i], 6) != NULL;
        if (!exponent && (letter || (i && (text[i] == '-' || text[i] == '+')))) {
            c_text[n++] = 'e';
            exponent = 1;
            if (letter)
                continue;
        }
        c_text[n++] = text[i];
    }
    c_text[n] = '\0';
    char *end;
    *value = strtod(c_text, &end);
    if (end != c_text + n) /* a locale with a decimal comma */
        return UFF_FAULT_MALFORMED;
    return isfinite(*value) ? UFF_FAULT_NONE : UFF_FAULT_NOT_FINITE;
}

enum uff_fault uff_parse_real(const char *text, size_t length, double *value)
{
    /* powers of ten that a double holds exactly */
    static const double ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    struct decimal decimal = {0};
    if (length > 120) /* no format writes that; convert has room for it */
        return is_not_finite(text, length) ? UFF_FAULT_NOT_FINITE : UFF_FAULT_MALFORMED;
    if (scan(text, length, &decimal) != UFF_FAULT_NONE)
        return is_not_finite(text, length) ? UFF_FAULT_NOT_FINITE : UFF_FAULT_MALFORMED;
    int power = decimal.exponent - decimal.point;
    /* both factors are exact, so one rounding, which is what correctly rounded means: as strtod, at a fifth of its time */
    if (FLT_EVAL_METHOD == 0 && !decimal.is_long && decimal.digits <= UINT64_C(1) << DBL_MANT_DIG && power >= -22 &&
        power <= 22) {
        double digits = (double)decimal.digits;
        digits = power < 0 ? digits / ten[-power] : digits * ten[power];
        *value = decimal.is_negative ? -digits : digits;
        return UFF_FAULT_NONE;
    }
    return convert(text, length, value);
}

int uff_open_lines(struct uff_lines *lines)
{
    struct stat about;
    char why[HOST_ERROR_TEXT];
    errno = 0;
    lines->stream = file_open(lines->path, 1, &about); /* `buffer` is the only one */
    if (!lines->stream) {
        int status = file_status(errno);
        return message_refuse(lines->messages, status, lines->path, 1, 1, "cannot be %s: %s", errno == EISDIR ? "read" : "opened",
                              file_error_text(errno, why));
    }
    lines->size = S_ISREG(about.st_mode) ? (long long)about.st_size : -1;
    return ROTID_OK;
}

static void say(struct uff_lines *lines, enum severity severity, int column, const char *format, va_list values)
{
    char text[512], set[24] = "";
    (void)vsnprintf(text, sizeof text, format, values);
    if (lines->set)
        (void)snprintf(set, sizeof set, "set %d: ", lines->set);
    message_add(lines->messages, severity, lines->path, lines->line, column, "%s%s", set, text);
}

int uff_fail(struct uff_lines *lines, int column, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    say(lines, SEVERITY_ERROR, column > 0 ? column : 1, format, values); /* 0: the line as a whole */
    va_end(values);
    return ROTID_ERROR_SYNTAX;
}

void uff_warn(struct uff_lines *lines, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    say(lines, SEVERITY_WARNING, 1, format, values);
    va_end(values);
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
    return message_refuse(lines->messages, ROTID_ERROR_IO, lines->path, lines->line, 1, "cannot be read: %s",
                          host_error_text(errno, why));
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

int uff_take_bytes(struct uff_lines *lines, long long count, void *bytes)
{
    for (char *to = bytes; count > 0;) {
        int status = fill(lines);
        if (status != ROTID_OK)
            return status == UFF_END ? fail_short(lines, count) : status;
        size_t there = lines->filled - lines->at, piece = (long long)there < count ? there : (size_t)count;
        if (to)
            memcpy(to, lines->buffer + lines->at, piece);
        lines->at += piece;
        to += to ? piece : 0;
        count -= (long long)piece;
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
    return uff_take_bytes(lines, count, NULL);
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

int uff_find_end(struct uff_lines *lines, long long count, int *found)
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
        status = uff_take_bytes(lines, (long long)length, text);
    if (status == ROTID_OK)
        status = uff_seek(lines, here, line + 1);
    while (i < length && memchr("\r\n \t", text[i], 4))
        ++i;
    *found = status == ROTID_OK && i + 2 <= length && memcmp(text + i, "-1", 2) == 0 &&
             (i + 2 == length || memchr("\r\n \t", text[i + 2], 4));
    return status;
}

/* ---- The fields of a line: written by Fortran in columns, where neighbours may touch, or by others separated by blanks. */

static int is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Blank-separated fields, at most `limit` of them. signs: a field also ends where a sign cannot belong to it any more, as in
 * -1.00000e+00-2.00000e+00: behind an exponent, or where the number has no point (a sign behind digits with a point is an
 * exponent without its letter). */
static int split(const struct uff_lines *lines, int signs, struct uff_field *field, int limit)
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
            if (signs && (c == '-' || c == '+') && i > start && !letter_before) {
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

/* What the columns start to start + width - 1 hold, without the blanks around it. */
static struct uff_field uff_cut_column(const struct uff_lines *lines, size_t start, size_t width)
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

/* Numbers in `count` fields, integers first; the first field that is none to *bad. */
static enum uff_fault parse_fields(const struct uff_lines *lines, int integers, int count, const struct uff_field *field,
                                   int may_touch, int *bad, int *integer, double *real)
{
    for (*bad = 0; *bad < count; ++*bad) {
        const char *text = lines->text + field[*bad].start;
        size_t length = field[*bad].length;
        enum uff_fault fault;
        if (*bad < integers) {
            long long value = 0;
            fault = parse_integer(text, length, &value);
            if (fault == UFF_FAULT_NONE && (value < INT_MIN || value > INT_MAX))
                fault = UFF_FAULT_RANGE;
            if (fault == UFF_FAULT_NONE)
                integer[*bad] = (int)value;
        } else {
            fault = uff_parse_real(text, length, &real[*bad - integers]);
            if (fault == UFF_FAULT_NONE && may_touch && uff_is_cut_off(lines, field[*bad]))
                fault = UFF_FAULT_MALFORMED;
        }
        if (fault != UFF_FAULT_NONE)
            return fault;
    }
    return UFF_FAULT_NONE;
}

/* "4 integers and 3 reals" */
static const char *count_numbers(int integers, int reals, char buffer[64])
{
    const char *s_integers = integers == 1 ? "" : "s", *s_reals = reals == 1 ? "" : "s";
    if (integers && reals)
        (void)snprintf(buffer, 64, "%d integer%s and %d real%s", integers, s_integers, reals, s_reals);
    else if (integers)
        (void)snprintf(buffer, 64, "%d integer%s", integers, s_integers);
    else
        (void)snprintf(buffer, 64, "%d real%s", reals, s_reals);
    return buffer;
}

/* The error that this field is: ROTID_ERROR_SYNTAX. `expected` describes the record. */
static int uff_fail_field(struct uff_lines *lines, const char *what, enum uff_fault fault, struct uff_field field, int is_integer,
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

/* Numbers of a line by blanks, else by columns, else by signs, whichever gives them all: `exact`, one in each column; else as
 * many as there are, up to UFF_VALUE_LIMIT, of which at most `left` are due, *taken. A number that is one for certain, out of
 * range or not finite, is not cut in two. */
static int parse_numbers(struct uff_lines *lines, const char *what, int integers, int columns, const int *width, int exact,
                         long long left, int *integer, double *real, int *taken)
{
    struct uff_field blank[UFF_VALUE_LIMIT + 3], column[UFF_VALUE_LIMIT + 2], sign[UFF_VALUE_LIMIT + 3];
    int bad = 0, bad_column = 0, bad_sign = 0, due = left < columns ? (int)left : columns;
    int most = exact ? columns : UFF_VALUE_LIMIT, found = split(lines, 0, blank, most + 1);
    /* more than are left only as filling of the last line */
    int fits = exact ? found == columns
                     : found > 0 && found <= most && (found <= left || found <= columns) &&
                           (found >= due || !has_hole(columns, width, found, blank));
    enum uff_fault fault = fits ? parse_fields(lines, integers, found, blank, 0, &bad, integer, real) : UFF_FAULT_COUNT;
    *taken = found <= left ? found : (int)left;
    if (fault == UFF_FAULT_NONE)
        return ROTID_OK;
    char expected[64];
    count_numbers(integers, due - integers, expected);
    if (fault == UFF_FAULT_RANGE || fault == UFF_FAULT_NOT_FINITE)
        return uff_fail_field(lines, what, fault, blank[bad], bad < integers, expected);

    int cut = cut_columns(lines, columns, width, column);
    cut = exact && cut < columns ? 0 : cut;
    enum uff_fault column_fault =
        cut ? parse_fields(lines, integers, cut, column, 1, &bad_column, integer, real) : UFF_FAULT_COUNT;
    *taken = cut <= left ? cut : (int)left;
    if (column_fault == UFF_FAULT_NONE)
        return ROTID_OK;
    *taken = due;
    if (split(lines, 1, sign, due + 1) == due &&
        parse_fields(lines, integers, due, sign, 1, &bad_sign, integer, real) == UFF_FAULT_NONE)
        return ROTID_OK;

    if (fits && (exact || column_fault != UFF_FAULT_NOT_FINITE))
        return uff_fail_field(lines, what, fault, blank[bad], bad < integers, expected);
    if (cut && (exact || column_fault == UFF_FAULT_NOT_FINITE))
        return uff_fail_field(lines, what, column_fault, column[bad_column], bad_column < integers, expected);
    return uff_fail(lines, 0, "%s: expected %s, found %s%d field%s", what, expected, exact && found > columns ? "at least " : "",
                    found, found == 1 ? "" : "s");
}

int uff_parse_line(struct uff_lines *lines, const struct uff_form *form, const char *what, int *integer, double *real)
{
    int width[UFF_VALUE_LIMIT + 2], total = form->integers + form->reals, taken;
    for (int i = 0; i < total; ++i)
        width[i] = i < form->integers ? form->integer_width : form->real_width;
    return parse_numbers(lines, what, form->integers, total, width, 1, total, integer, real, &taken);
}

int uff_parse_values(struct uff_lines *lines, int columns, const int *width, long long left, const char *what, double *value,
                     int *taken)
{
    return parse_numbers(lines, what, 0, columns, width, 0, left, NULL, value, taken);
}

/* ---- Records: numbers over several lines, lists of integers, and lines of mixed contents in columns. */

/* How many of the numbers still missing the current line should hold. */
static int on_this_line(const struct uff_lines *lines, int left, int columns)
{
    struct uff_field field[UFF_VALUE_LIMIT + 3];
    return left <= columns || split(lines, 0, field, left + 1) == left ? left : columns;
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

static enum uff_fault read_cell(const struct uff_lines *lines, enum uff_kind kind, struct uff_field field, struct uff_cell *cell)
{
    const char *text = lines->text + field.start;
    *cell = (struct uff_cell){.start = field.start, .length = field.length};
    if (kind == UFF_WORDS)
        return UFF_FAULT_NONE;
    if (!field.length)
        return kind == UFF_REQUIRED_INTEGER || kind == UFF_LONG ? UFF_FAULT_MALFORMED : UFF_FAULT_NONE;
    return kind == UFF_REAL ? uff_parse_real(text, field.length, &cell->real) : parse_integer(text, field.length, &cell->integer);
}

int uff_cut_line(const struct uff_lines *lines, const struct uff_record *record, int before, struct uff_cell cell[UFF_CELL_LIMIT])
{
    int bad = -1, count = record->count, whole = before == UFF_WHOLE, skipped = whole ? 0 : before;
    for (int i = count - 1; i >= 0; --i) {
        const struct uff_column *column = &record->member[i].column;
        struct uff_field field = uff_cut_column(lines, (size_t)column->start, (size_t)column->width);
        if (read_cell(lines, column->kind, field, &cell[i]) != UFF_FAULT_NONE)
            bad = i;
    }
    struct uff_field token[UFF_CELL_LIMIT + 1], *first = token + skipped;
    if (bad < 0 || split(lines, 0, token, skipped + count + whole) != skipped + count)
        return bad;
    struct uff_cell other[UFF_CELL_LIMIT];
    for (int i = 0; i < count; ++i)
        if (read_cell(lines, record->member[i].column.kind, first[i], &other[i]) != UFF_FAULT_NONE)
            return bad;
    memcpy(cell, other, (size_t)count * sizeof *cell);
    return -1;
}

int uff_cut_record(struct uff_lines *lines, const struct uff_record *record, struct uff_cell cell[UFF_CELL_LIMIT])
{
    int bad = uff_cut_line(lines, record, UFF_WHOLE, cell);
    for (int i = 0; i < record->count && bad < 0; ++i)
        if ((cell[i].integer < INT_MIN || cell[i].integer > INT_MAX) && record->member[i].column.kind == UFF_INTEGER)
            return uff_fail_field(lines, record->what, UFF_FAULT_RANGE, (struct uff_field){cell[i].start, cell[i].length}, 1,
                                  "32 bits");
    if (bad < 0)
        return ROTID_OK;
    const struct uff_column *column = &record->member[bad].column;
    char expected[80];
    (void)snprintf(expected, sizeof expected, "it in columns %d to %d", column->start + 1, column->start + column->width);
    struct uff_field field = uff_cut_column(lines, (size_t)column->start, (size_t)column->width);
    if (!field.length)
        field.start = (size_t)column->start;
    if (field.start > lines->length)
        field.start = lines->length;
    return uff_fail_field(lines, record->what, UFF_FAULT_MALFORMED, field, column->kind != UFF_REAL, expected);
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

int uff_read_id(struct uff_lines *lines, char id[UFF_ID_LINES][UFF_TEXT + 1])
{
    int status = ROTID_OK;
    for (int i = 0; i < UFF_ID_LINES && status == ROTID_OK; ++i)
        if (!(status = uff_expect_line(lines, "five lines of text")))
            uff_copy_text(lines->text, lines->length, UFF_TEXT + 1, id[i]);
    return status;
}
