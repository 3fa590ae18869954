/* Reading over a set, or over what is left of it. */

#include "uff/uff_reader.h"

/* Data of a set may be -1 in a line of its own, so the end must look like the beginning did. The first `texts` lines may be
 * anything. */
static int skip_lines(struct uff_lines *lines, int texts)
{
    for (int i = 0;; i += i < texts) {
        int status = uff_take_line(lines);
        if (status == UFF_END)
            return uff_fail(lines, 0, "the file ends after this line; expected the '-1' that ends the set");
        if (status != ROTID_OK || (i >= texts && uff_is_delimiter(lines, lines->strict)))
            return status;
    }
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

/* The bytes of binary data may hold anything, also what looks like the end. */
static int skip_binary(struct uff_reader *reader)
{
    struct uff_lines *lines = &reader->lines;
    struct uff_function function = {0};
    long long bytes;
    int x_size;
    for (long long i = 0; i < reader->binary.text_lines; ++i) {
        int status = uff_take_line(lines);
        if (status == UFF_END)
            return uff_fail(lines, 0, "the file ends after this line; expected %lld lines of text in all",
                            reader->binary.text_lines);
        if (status != ROTID_OK)
            return status;
        struct uff_cell cell[6];
        if (i == 6 && reader->set.number == 58 && uff_cut_data_form(lines, cell, &function) >= 0)
            function = (struct uff_function){0};
    }
    int status = uff_measure_binary(lines, &reader->binary, &function, &bytes, &x_size);
    return status == ROTID_OK ? uff_close_values(lines, bytes) : status;
}

int uff_skip_set(struct uff_reader *reader)
{
    struct uff_values *values = &reader->values;
    int status, has_texts = reader->place == UFF_AT_BODY && (reader->set.number == 55 || reader->set.number == 58);
    if (!reader->set.is_binary)
        status = skip_lines(&reader->lines, has_texts ? UFF_ID_LINES : 0);
    else if (reader->place == UFF_AT_BODY)
        status = skip_binary(reader);
    else
        status = uff_close_values(&reader->lines, values->left_over + (values->function.count - values->done) *
                                                                          (values->x_size + (long long)values->y_size));
    return uff_end(reader, status, UFF_BETWEEN);
}

/* Whether an end stands behind so many bytes, which the file must have. */
static int try_length(struct uff_lines *lines, long long length, long long *bytes, int *found)
{
    int status = uff_look_for_end(lines, length, found);
    if (status == ROTID_OK && *found)
        *bytes = length;
    return status;
}

int uff_measure_binary(struct uff_lines *lines, const struct uff_binary *binary, const struct uff_function *function,
                       long long *bytes, int *x_size)
{
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
        uff_warn(lines, "%lld bytes announced, but %lld values make %lld, behind which the set ends", binary->bytes,
                 function->count, *bytes);
    if (!found && status == ROTID_OK)
        status = try_length(lines, binary->bytes, bytes, &found);
    if (found || status != ROTID_OK)
        return status;
    if (binary->bytes > lines->size - lines->base - (long long)lines->at)
        return uff_skip_bytes(lines, binary->bytes); /* which says how many are missing */
    return uff_fail(lines, 0, "expected a line '    -1' behind %lld bytes of binary data", binary->bytes);
}
