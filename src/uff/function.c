#include "uff/uff.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* ---- from the units of a file to SI */

/* Exponents of length, force and temperature of a quantity along an axis, as the format fixes them (addendum A of set 58). */
static void find_exponents(const struct uff_axis *axis, int exponent[3])
{
    static const struct {
        int type, length, force, temperature;
    } table[] = {{8, 1, 0, 0}, {9, 0, 1, 0}, {11, 1, 0, 0}, {12, 1, 0, 0}, {13, 0, 1, 0}, {15, -2, 1, 0}, {16, -1, 1, 0}};
    int is_free = axis->specific_type == 0 || axis->specific_type == 1; /* unknown and general: as the record says */
    exponent[0] = is_free ? axis->length : 0;
    exponent[1] = is_free ? axis->force : 0;
    exponent[2] = is_free ? axis->temperature : 0;
    for (size_t i = 0; i < sizeof table / sizeof *table; ++i)
        if (table[i].type == axis->specific_type) {
            exponent[0] = table[i].length;
            exponent[1] = table[i].force;
            exponent[2] = table[i].temperature;
        }
}

double uff_si_factor(const struct uff_units *units, const struct uff_axis *axis)
{
    static const double standard_gravity = 9.80665; /* m/s2, by definition */
    if (axis->specific_type == 12 && (strcmp(axis->unit, "g") == 0 || strcmp(axis->unit, "gn") == 0))
        return standard_gravity;
    int exponent[3];
    find_exponents(axis, exponent);
    double unit[3] = {units ? units->length : 1, units ? units->force : 1, units ? units->temperature : 1}, factor = 1;
    for (int i = 0; i < 3; ++i)
        if (exponent[i] && unit[i] > 0 && isfinite(unit[i]))
            factor *= pow(unit[i], -exponent[i]);
    return factor;
}

/* ---- how long the values of a binary function are, and what has to stand behind them */

int uff_cut_data_form(const struct uff_lines *lines, struct uff_cell cell[UFF_CELL_LIMIT], struct uff_function *function)
{
    struct uff_function form = *function;
    int bad = uff_cut_members(lines, &uff_form_58, cell, &form), ordinate = form.ordinate;
    if (bad >= 0)
        return bad;
    if (cell[0].integer != ordinate || (ordinate != UFF_REAL_SINGLE && ordinate != UFF_REAL_DOUBLE &&
                                        ordinate != UFF_COMPLEX_SINGLE && ordinate != UFF_COMPLEX_DOUBLE))
        return 0;
    if (form.count < 0 || form.count > LLONG_MAX / 32) /* a value has up to 24 bytes */
        return 1;
    if (cell[2].integer != 0 && cell[2].integer != 1)
        return 2;
    *function = form;
    return -1;
}

int uff_close_values(struct uff_lines *lines, long long left_over)
{
    int status = left_over ? uff_skip_bytes(lines, left_over) : ROTID_OK;
    do {
        if (status == ROTID_OK)
            status = uff_expect_line(lines, "the '-1' that ends the set");
        if (status != ROTID_OK)
            return status;
    } while (!lines->length);
    if (!uff_is_delimiter(lines, 0))
        return uff_fail(lines, 0, "expected a line '    -1' behind the last value");
    return ROTID_OK;
}

/* Whether an end stands behind so many bytes, which the file must have. */
static int try_length(struct uff_lines *lines, long long length, long long *bytes, int *found)
{
    int status = uff_look_for_end(lines, length, found);
    if (status == ROTID_OK && *found)
        *bytes = length;
    return status;
}

/* Says so once, however often the set is come back to: those seen before lie before it. */
static void warn_of_length(struct uff_reader *reader, long long count, long long bytes)
{
    if (reader->set.offset < reader->warned_before)
        return;
    reader->warned_before = reader->set.offset + 1;
    uff_warn(&reader->lines, "%lld bytes announced, but %lld values make %lld, behind which the set ends", reader->binary.bytes,
             count, bytes);
}

int uff_measure_binary(struct uff_reader *reader, const struct uff_function *function, long long *bytes, int *x_size)
{
    struct uff_lines *lines = &reader->lines;
    const struct uff_binary *binary = &reader->binary;
    int is_double = function->ordinate == UFF_REAL_DOUBLE || function->ordinate == UFF_COMPLEX_DOUBLE;
    int is_complex = function->ordinate == UFF_COMPLEX_SINGLE || function->ordinate == UFF_COMPLEX_DOUBLE;
    int y_size = (is_double ? 8 : 4) * (is_complex ? 2 : 1);
    int size[2] = {0, 0}, count = 0;
    if (function->ordinate) {
        size[count++] = function->is_even ? 0 : 4;
        if (!function->is_even && is_double)
            size[count++] = 8;
    }
    *bytes = binary->bytes;
    *x_size = count ? size[0] : 0;
    for (int i = 0; i < count; ++i)
        if (function->count * (size[i] + y_size) == binary->bytes)
            *x_size = size[i];
    if (lines->size < 0) { /* no looking ahead */
        if (!binary->bytes && count)
            *bytes = function->count * (*x_size + y_size);
        return ROTID_OK;
    }

    int found = 0, status = ROTID_OK;
    for (int pass = 0; pass < 2; ++pass) /* first what agrees with the number of bytes announced */
        for (int i = 0; i < count; ++i) {
            long long length = function->count * (size[i] + y_size);
            if (found || status != ROTID_OK || (length == binary->bytes) == pass)
                continue;
            status = try_length(lines, length, bytes, &found);
            if (found)
                *x_size = size[i];
        }
    if (found && *bytes != binary->bytes)
        warn_of_length(reader, function->count, *bytes);
    if (!found && status == ROTID_OK)
        status = try_length(lines, binary->bytes, bytes, &found);
    if (found || status != ROTID_OK)
        return status;
    if (binary->bytes > lines->size - lines->base - (long long)lines->at)
        return uff_skip_bytes(lines, binary->bytes); /* which says how many are missing */
    return uff_fail(lines, 0, "expected a line '    -1' behind %lld bytes of binary data", binary->bytes);
}

/* ---- records 1 to 11 of sets 58 and 58b */

static int read_data_form(struct uff_lines *lines, struct uff_function *function)
{
    static const char *const expected[] = {"an ordinate data type 2, 4, 5 or 6",
                                           "a number of values",
                                           "abscissa spacing 0 (uneven) or 1 (even)",
                                           "an abscissa minimum",
                                           "an abscissa increment",
                                           "a z-axis value"};
    struct uff_cell cell[UFF_CELL_LIMIT];
    int status = uff_expect_line(lines, uff_form_58.what);
    if (status != ROTID_OK)
        return status;
    int bad = uff_cut_data_form(lines, cell, function);
    long long left = lines->size - lines->base - (long long)lines->at;
    if (bad < 0 && lines->size >= 0 && function->count > left) /* whoever takes room for them would take any amount */
        return uff_fail(lines, (int)cell[1].start + 1,
                        "record 7 announces %lld values, expected no more than the %lld bytes that follow", function->count,
                        left);
    if (bad < 0)
        return ROTID_OK;
    char excerpt[UFF_EXCERPT];
    return uff_fail(lines, (int)cell[bad].start + 1, "record 7: found '%s', expected %s",
                    uff_excerpt(lines->text + cell[bad].start, cell[bad].length, excerpt), expected[bad]);
}

static int read_records(struct uff_lines *lines, struct uff_function *function)
{
    static const struct uff_record *const axis[] = {&uff_abscissa_58, &uff_ordinate_58, &uff_denominator_58, &uff_z_axis_58};
    int status = ROTID_OK;
    for (int i = 0; i < UFF_ID_LINES && status == ROTID_OK; ++i)
        status = uff_read_text(lines, "five lines of text", function->id[i]);
    if (status == ROTID_OK)
        status = uff_read_record(lines, &uff_location_58, function);
    if (status == ROTID_OK)
        status = read_data_form(lines, function);
    for (int i = 0; i < 4 && status == ROTID_OK; ++i)
        status = uff_read_record(lines, axis[i], function);
    return status;
}

/* How the numbers of record 12 are laid out in lines: 6E13.5, 4E20.12, 2(E13.5,E20.12) or E13.5,2E20.12. */
static void lay_out(struct uff_values *values)
{
    const struct uff_function *function = &values->function;
    int is_double = function->ordinate == UFF_REAL_DOUBLE || function->ordinate == UFF_COMPLEX_DOUBLE;
    int is_complex = function->ordinate == UFF_COMPLEX_SINGLE || function->ordinate == UFF_COMPLEX_DOUBLE;
    values->per_value = (is_complex ? 2 : 1) + !function->is_even;
    values->y_size = (is_double ? 8 : 4) * (is_complex ? 2 : 1);
    values->columns = !is_double ? 6 : !function->is_even && is_complex ? 3 : 4;
    for (int i = 0; i < values->columns; ++i)
        values->width[i] = is_double ? 20 : 13;
    for (int i = 0; i < values->columns && !function->is_even; i += values->per_value)
        values->width[i] = 13;
}

/* The lines of text that a 58b announces beyond its 11, and the length of the data behind them. */
static int enter_binary(struct uff_reader *reader)
{
    struct uff_lines *lines = &reader->lines;
    struct uff_values *values = &reader->values;
    long long bytes;
    for (long long i = 11; i < reader->binary.text_lines; ++i) {
        int status = uff_expect_line(lines, "as many lines of text as announced");
        if (status != ROTID_OK)
            return status;
    }
    int status = uff_measure_binary(reader, &values->function, &bytes, &values->x_size);
    if (status != ROTID_OK)
        return status;
    long long needed = values->function.count * (values->x_size + values->y_size);
    values->left_over = bytes - needed;
    if (bytes < needed)
        return uff_fail(lines, 0, "%lld bytes of binary data; expected %lld for %lld values", bytes, needed,
                        values->function.count);
    return ROTID_OK;
}

int uff_read_function(struct uff_reader *reader, struct uff_function *function)
{
    struct uff_values *values = &reader->values;
    *function = (struct uff_function){.line = reader->set.line, .binary = reader->binary};
    int status = uff_begin(reader, 58);
    if (status != ROTID_OK)
        return status;
    memset(values, 0, sizeof *values);
    status = read_records(&reader->lines, function);
    values->function = *function;
    lay_out(values);
    if (status == ROTID_OK && reader->set.is_binary)
        status = enter_binary(reader);
    return uff_end(reader, status, UFF_AT_DATA);
}

/* ---- values of sets 58 and 58b, a piece at a time */

static uint32_t four_bytes(const unsigned char *byte, int order)
{
    /* written out, so that compilers see a load in it */
    return order == 1 ? (uint32_t)byte[0] | (uint32_t)byte[1] << 8 | (uint32_t)byte[2] << 16 | (uint32_t)byte[3] << 24
                      : (uint32_t)byte[3] | (uint32_t)byte[2] << 8 | (uint32_t)byte[1] << 16 | (uint32_t)byte[0] << 24;
}

/* IEEE numbers whose bytes stand in that order, on any machine: count of them, `from_step` bytes apart, to every to_step-th
 * place. */
static void decode(int count, const unsigned char *byte, int from_step, int size, int order, double *to, int to_step)
{
    for (int i = 0; i < count; ++i, byte += from_step, to += to_step) {
        float single;
        if (size == 8) {
            uint64_t first = four_bytes(byte, order), second = four_bytes(byte + 4, order);
            uint64_t bits = order == 1 ? second << 32 | first : first << 32 | second;
            memcpy(to, &bits, sizeof *to);
        } else {
            uint32_t bits = four_bytes(byte, order);
            memcpy(&single, &bits, sizeof single);
            *to = single;
        }
    }
}

/* Up to `limit` values from binary data, their numbers in turn to number. */
static int take_binary(struct uff_reader *reader, int limit, double *number)
{
    unsigned char bytes[UFF_VALUE_LIMIT * 24];
    struct uff_values *values = &reader->values;
    int parts = values->per_value - !values->function.is_even, order = reader->binary.order;
    int size = values->x_size + values->y_size;
    int status = uff_take_bytes(&reader->lines, (size_t)limit * (size_t)size, bytes);
    if (status != ROTID_OK)
        return status;
    int first = values->per_value - parts, y_size = values->y_size / parts;
    if (values->x_size)
        decode(limit, bytes, size, values->x_size, order, number, values->per_value);
    for (int k = 0; k < parts; ++k)
        decode(limit, bytes + values->x_size + (ptrdiff_t)k * y_size, size, y_size, order, number + first + k, values->per_value);
    for (int i = 0; i < limit * values->per_value; ++i)
        if (!isfinite(number[i]))
            return uff_fail(&reader->lines, 0, "value %lld of %lld is %g; expected a finite number",
                            values->done + i / values->per_value + 1, values->function.count, number[i]);
    return ROTID_OK;
}

/* One value from the lines of text. A '-1' alone in columns 5 and 6 is no value in any of the formats, but the end. */
static int take_text(struct uff_reader *reader, double *number)
{
    struct uff_lines *lines = &reader->lines;
    struct uff_values *values = &reader->values;
    for (int have = 0; have < values->per_value; ++have) {
        if (values->pending_at == values->pending_count) {
            long long left = (values->function.count - values->done) * values->per_value - have;
            int status = uff_expect_line(lines, "values (record 12)");
            if (status == ROTID_OK && lines->strict && uff_is_delimiter(lines, 1))
                status = uff_fail(lines, 0, "the set ends after %lld of %lld values", values->done, values->function.count);
            if (status == ROTID_OK)
                status = uff_parse_values(lines, values->columns, values->width, left, "record 12", values->pending,
                                          &values->pending_count);
            if (status != ROTID_OK)
                return status;
            values->pending_at = 0;
        }
        number[have] = values->pending[values->pending_at++];
    }
    return ROTID_OK;
}

static int check_binary(struct uff_reader *reader)
{
    static const char *const format[] = {"an unknown format", "DEC VMS", "IEEE 754", "IBM 5/370"};
    const struct uff_binary *binary = &reader->binary;
    if (binary->format != 2)
        return uff_fail(&reader->lines, 0, "binary numbers in %s; expected number format 2 (IEEE 754)", format[binary->format]);
    if (!binary->order)
        return uff_fail(&reader->lines, 0, "unknown byte order; expected 1 (little endian) or 2 (big endian)");
    return ROTID_OK;
}

/* Sets of numbers to the places the caller wants them at. */
static void hand_out(const struct uff_values *values, int count, const double *number, double *x, double *real, double *imag)
{
    const struct uff_function *function = &values->function;
    int y = !function->is_even, per = values->per_value;
    for (int i = 0; x && i < count; ++i)
        x[i] = function->is_even ? function->start + (double)(values->done + i) * function->step : number[i * per];
    for (int i = 0; real && i < count; ++i)
        real[i] = number[i * per + y];
    for (int i = 0; imag && i < count; ++i)
        imag[i] = per - y == 2 ? number[i * per + y + 1] : 0;
}

int uff_read_values(struct uff_reader *reader, long long most, double *x, double *real, double *imag, long long *got)
{
    struct uff_values *values = &reader->values;
    double number[UFF_VALUE_LIMIT * 3] = {0};
    *got = 0;
    if (values->is_finished && reader->place == UFF_BETWEEN)
        return ROTID_OK;
    if (reader->place != UFF_AT_DATA || most < 0)
        return ROTID_ERROR_ARGUMENT;
    long long left = values->function.count - values->done;
    if (!most)
        return ROTID_OK;
    int status = reader->set.is_binary && !values->done ? check_binary(reader) : ROTID_OK;
    if (status == ROTID_OK && !left) {
        status = uff_close_values(&reader->lines, values->left_over);
        values->is_finished = status == ROTID_OK;
        return uff_end(reader, status, UFF_BETWEEN);
    }
    long long wanted = most < left ? most : left;
    while (status == ROTID_OK && *got < wanted) {
        int count = 1;
        if (reader->set.is_binary) {
            count = wanted - *got < UFF_VALUE_LIMIT ? (int)(wanted - *got) : UFF_VALUE_LIMIT;
            status = take_binary(reader, count, number);
        } else {
            status = take_text(reader, number);
        }
        if (status != ROTID_OK)
            break;
        hand_out(values, count, number, x ? x + *got : NULL, real ? real + *got : NULL, imag ? imag + *got : NULL);
        *got += count;
        values->done += count;
    }
    if (status != ROTID_OK)
        *got = 0;
    return uff_end(reader, status, UFF_AT_DATA);
}
