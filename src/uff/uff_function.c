/* The records 1 to 11 of sets 58 and 58b. */
#include <string.h>

#include "uff/uff_reader.h"
#include "uff/uff_record.h"

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
