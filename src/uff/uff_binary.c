/* How long the values of a function are, and what has to stand behind them. */
#include <limits.h>

#include "uff/uff_reader.h"
#include "uff/uff_record.h"

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
