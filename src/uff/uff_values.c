/* The values of sets 58 and 58b, a piece at a time. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "uff/uff_reader.h"

/* An IEEE number whose bytes stand in that order, on any machine. */
static double decode(const unsigned char *byte, int size, int order)
{
    uint64_t bits = 0;
    for (int i = 0; i < size; ++i)
        bits = bits << 8 | byte[order == 1 ? size - 1 - i : i];
    double value;
    if (size == 8) {
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    float single;
    uint32_t half = (uint32_t)bits;
    memcpy(&single, &half, sizeof single);
    return single;
}

/* Up to `limit` values from binary data, their numbers in turn to number. */
static int take_binary(struct uff_reader *reader, int limit, double *number)
{
    unsigned char bytes[UFF_VALUE_LIMIT * 24] = {0};
    struct uff_values *values = &reader->values;
    int parts = values->per_value - !values->function.is_even, order = reader->binary.order;
    int size = values->x_size + values->y_size;
    int status = uff_take_bytes(&reader->lines, (size_t)limit * (size_t)size, bytes);
    for (int i = 0; i < limit && status == ROTID_OK; ++i) {
        const unsigned char *at = bytes + (ptrdiff_t)i * size;
        double *to = number + (ptrdiff_t)i * values->per_value;
        if (values->x_size)
            *to++ = decode(at, values->x_size, order);
        for (int k = 0; k < parts; ++k)
            to[k] = decode(at + values->x_size + (ptrdiff_t)k * (values->y_size / parts), values->y_size / parts, order);
        for (int k = 0; k < values->per_value; ++k)
            if (!isfinite(number[i * values->per_value + k]))
                return uff_fail(&reader->lines, 0, "value %lld of %lld is %g; expected a finite number", values->done + i + 1,
                                values->function.count, number[i * values->per_value + k]);
    }
    return status;
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

/* One set of numbers to the places the caller wants them at. */
static void hand_out(const struct uff_values *values, const double *number, double *x, double *real, double *imag)
{
    const struct uff_function *function = &values->function;
    int y = !function->is_even;
    if (x)
        *x = function->is_even ? function->start + (double)values->done * function->step : number[0];
    if (real)
        *real = number[y];
    if (imag)
        *imag = values->per_value - y == 2 ? number[y + 1] : 0;
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
        for (int i = 0; i < count && status == ROTID_OK; ++i, ++*got, ++values->done)
            hand_out(values, number + (ptrdiff_t)i * values->per_value, x ? x + *got : NULL, real ? real + *got : NULL,
                     imag ? imag + *got : NULL);
    }
    if (status != ROTID_OK)
        *got = 0;
    return uff_end(reader, status, UFF_AT_DATA);
}
