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
        struct uff_cell cell[UFF_CELL_LIMIT];
        if (i == 6 && reader->set.number == 58 && uff_cut_data_form(lines, cell, &function) >= 0)
            function = (struct uff_function){0};
    }
    int status = uff_measure_binary(reader, &function, &bytes, &x_size);
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
