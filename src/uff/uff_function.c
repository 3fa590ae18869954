/* The records 1 to 11 of sets 58 and 58b. */
#include <limits.h>
#include <string.h>

#include "uff/uff_reader.h"

int uff_cut_data_form(const struct uff_lines *lines, struct uff_cell cell[6], struct uff_function *function)
{
    static const struct uff_column column[] = {{UFF_REQUIRED_INTEGER, 0, 10},
                                               {UFF_REQUIRED_INTEGER, 10, 10},
                                               {UFF_INTEGER, 20, 10},
                                               {UFF_REAL, 30, 13},
                                               {UFF_REAL, 43, 13},
                                               {UFF_REAL, 56, 13}};
    int bad = uff_cut_line(lines, 6, column, cell);
    if (bad >= 0)
        return bad;
    long long ordinate = cell[0].integer;
    if (ordinate != UFF_REAL_SINGLE && ordinate != UFF_REAL_DOUBLE && ordinate != UFF_COMPLEX_SINGLE &&
        ordinate != UFF_COMPLEX_DOUBLE)
        return 0;
    if (cell[1].integer < 0 || cell[1].integer > LLONG_MAX / 32) /* a value has up to 24 bytes */
        return 1;
    if (cell[2].integer != 0 && cell[2].integer != 1)
        return 2;
    function->ordinate = (int)ordinate;
    function->count = cell[1].integer;
    function->is_even = cell[2].integer == 1;
    function->start = cell[3].real;
    function->step = cell[4].real;
    function->z = cell[5].real;
    return -1;
}

static int read_data_form(struct uff_lines *lines, struct uff_function *function)
{
    static const char what[] = "record 7 (ordinate data type, number of values, spacing, minimum, increment, z)";
    static const char *const expected[] = {"an ordinate data type 2, 4, 5 or 6",
                                           "a number of values",
                                           "abscissa spacing 0 (uneven) or 1 (even)",
                                           "an abscissa minimum",
                                           "an abscissa increment",
                                           "a z-axis value"};
    struct uff_cell cell[6];
    int status = uff_expect_line(lines, what);
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

static int read_location(struct uff_lines *lines, struct uff_function *function)
{
    static const char what[] = "record 6 (function type, number, version, load case, response, reference)";
    static const struct uff_column column[] = {
        {UFF_INTEGER, 0, 5},   {UFF_INTEGER, 5, 10}, {UFF_INTEGER, 15, 5}, {UFF_INTEGER, 20, 10}, {UFF_WORDS, 31, 10},
        {UFF_INTEGER, 41, 10}, {UFF_INTEGER, 51, 4}, {UFF_WORDS, 56, 10},  {UFF_INTEGER, 66, 10}, {UFF_INTEGER, 76, 4}};
    struct uff_cell cell[10];
    int status = uff_expect_line(lines, what);
    if (status == ROTID_OK)
        status = uff_cut_record(lines, 10, column, what, cell);
    if (status != ROTID_OK)
        return status;
    function->type = (int)cell[0].integer;
    function->number = (int)cell[1].integer;
    function->version = (int)cell[2].integer;
    function->load_case = (int)cell[3].integer;
    uff_copy_text(lines->text + cell[4].start, cell[4].length, sizeof function->response_name, function->response_name);
    function->response_node = (int)cell[5].integer;
    function->response_direction = (int)cell[6].integer;
    uff_copy_text(lines->text + cell[7].start, cell[7].length, sizeof function->reference_name, function->reference_name);
    function->reference_node = (int)cell[8].integer;
    function->reference_direction = (int)cell[9].integer;
    return ROTID_OK;
}

static int read_axis(struct uff_lines *lines, const char *what, struct uff_axis *axis)
{
    static const struct uff_column column[] = {{UFF_INTEGER, 0, 10}, {UFF_INTEGER, 10, 5}, {UFF_INTEGER, 15, 5},
                                               {UFF_INTEGER, 20, 5}, {UFF_WORDS, 26, 20},  {UFF_WORDS, 47, 20}};
    struct uff_cell cell[6];
    int status = uff_expect_line(lines, what);
    if (status == ROTID_OK)
        status = uff_cut_record(lines, 6, column, what, cell);
    if (status != ROTID_OK)
        return status;
    axis->specific_type = (int)cell[0].integer;
    axis->length = (int)cell[1].integer;
    axis->force = (int)cell[2].integer;
    axis->temperature = (int)cell[3].integer;
    uff_copy_text(lines->text + cell[4].start, cell[4].length, sizeof axis->label, axis->label);
    uff_copy_text(lines->text + cell[5].start, cell[5].length, sizeof axis->unit, axis->unit);
    return ROTID_OK;
}

static int read_records(struct uff_lines *lines, struct uff_function *function)
{
    int status = ROTID_OK;
    for (int i = 0; i < UFF_ID_LINES && status == ROTID_OK; ++i)
        status = uff_read_text(lines, "five lines of text", function->id[i]);
    if (status == ROTID_OK)
        status = read_location(lines, function);
    if (status == ROTID_OK)
        status = read_data_form(lines, function);
    if (status == ROTID_OK)
        status = read_axis(lines, "record 8 (abscissa)", &function->abscissa);
    if (status == ROTID_OK)
        status = read_axis(lines, "record 9 (ordinate)", &function->numerator);
    if (status == ROTID_OK)
        status = read_axis(lines, "record 10 (ordinate denominator)", &function->denominator);
    if (status == ROTID_OK)
        status = read_axis(lines, "record 11 (z axis)", &function->z_axis);
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
