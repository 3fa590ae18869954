/* The values of sets 58 and 58b, a piece at a time. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "uff/uff_reader.h"

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
