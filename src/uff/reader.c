#include "uff/uff.h"

#include <limits.h>

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

int uff_same_units(const struct uff_units *a, const struct uff_units *b)
{
    return a->length == b->length && a->force == b->force;
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

int uff_is_complex(const struct uff_function *function)
{
    return function->ordinate == UFF_COMPLEX_SINGLE || function->ordinate == UFF_COMPLEX_DOUBLE;
}

int uff_is_double(const struct uff_function *function)
{
    return function->ordinate == UFF_REAL_DOUBLE || function->ordinate == UFF_COMPLEX_DOUBLE;
}

/* Bytes of an ordinate in a binary set. */
static int ordinate_size(const struct uff_function *function)
{
    return (uff_is_double(function) ? 8 : 4) * (uff_is_complex(function) ? 2 : 1);
}

/* ---- how long the values of a binary function are, and what has to stand behind them */

/* Record 7 of sets 58: the description of the values. Returns the cell that is wrong, or -1. */
static int uff_cut_data_form(const struct uff_lines *lines, struct uff_cell cell[UFF_CELL_LIMIT], struct uff_function *function)
{
    struct uff_function form = *function;
    int bad = uff_cut_members(lines, &uff_form_58, cell, &form);
    if (bad >= 0)
        return bad;
    if (cell[0].integer != form.ordinate || (form.ordinate != UFF_REAL_SINGLE && !uff_is_double(&form) && !uff_is_complex(&form)))
        return 0;
    if (form.count < 0 || form.count > LLONG_MAX / 32) /* a value has up to 24 bytes */
        return 1;
    if (cell[2].integer != 0 && cell[2].integer != 1)
        return 2;
    *function = form;
    return -1;
}

/* From the last value to behind the closing '-1'; blank lines may stand before it. */
static int uff_close_values(struct uff_lines *lines, long long left_over)
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
    int status = uff_find_end(lines, length, found);
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

/* From the end of the records of a 58b: how many bytes its data have. The number in the first line is wrong with some writers,
 * so the '-1' behind the data decides. `function` holds record 7, or has ordinate 0 when that is not known. Sets *bytes, and in
 * *x_size the size of an abscissa of double precision data, which is 4 by the format and 8 with some writers. */
static int uff_measure_binary(struct uff_reader *reader, const struct uff_function *function, long long *bytes, int *x_size)
{
    struct uff_lines *lines = &reader->lines;
    const struct uff_binary *binary = &reader->binary;
    int y_size = ordinate_size(function), size[2] = {0, 0}, count = 0;
    if (function->ordinate) {
        size[count++] = function->is_even ? 0 : 4;
        if (!function->is_even && uff_is_double(function))
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
    int status = uff_read_id(lines, function->id);
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
    int is_double = uff_is_double(function), is_complex = uff_is_complex(function);
    values->per_value = (is_complex ? 2 : 1) + !function->is_even;
    values->y_size = ordinate_size(function);
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
    int status = uff_take_bytes(&reader->lines, (long long)limit * size, bytes);
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
        x[i] = function->is_even ? function->start + (double)(values->done + i) * function->step : number[(ptrdiff_t)i * per];
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

/* ---- where in the file a reader is */

int uff_begin(struct uff_reader *reader, int number)
{
    return reader->place == UFF_AT_BODY && reader->set.number == number ? ROTID_OK : ROTID_ERROR_ARGUMENT;
}

int uff_end(struct uff_reader *reader, int status, enum uff_place place)
{
    reader->place = status == ROTID_OK ? place : status == ROTID_ERROR_IO ? UFF_BROKEN : UFF_LOST;
    return status;
}

int uff_next_record(struct uff_reader *reader, const char *expected, int *is_end)
{
    int status = uff_expect_line(&reader->lines, expected);
    *is_end = status == ROTID_OK && uff_is_delimiter(&reader->lines, 0);
    return status;
}

/* ---- ids that must not occur twice */

ORDER_BY(by_id, struct uff_label, it->id, it->order)

struct uff_label *uff_sort_labels(struct pool *pool, int count, const int *id, size_t stride)
{
    struct uff_label *label = POOL_ARRAY(pool, struct uff_label, count);
    for (int i = 0; i < count && label; ++i)
        label[i] = (struct uff_label){*(const int *)((const char *)id + (size_t)i * stride), i};
    if (label)
        qsort(label, (size_t)count, sizeof *label, by_id);
    return label;
}

/* ---- reading over a set, or over what is left of it */

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

/* Reads over the rest of the set at hand. */
static int uff_skip_set(struct uff_reader *reader)
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

/* ---- header, set 151, and units, set 164 */

/* Record 4: date and time, then numbers, which no one needs: writers put other things there, or nothing. */
static void cut_versions(const struct uff_lines *lines, struct uff_header *header)
{
    struct uff_cell cell[UFF_CELL_LIMIT];
    int bad = uff_cut_members(lines, &uff_versions_151, cell, header);
    uff_copy_text(lines->text, lines->length < 20 || bad >= 0 ? lines->length : 20, sizeof header->created, header->created);
    for (int i = 0; i < 3 && bad < 0; ++i)
        if (cell[i].integer < INT_MIN || cell[i].integer > INT_MAX)
            header->version[0] = header->version[1] = header->file_type = 0;
}

int uff_read_header(struct uff_reader *reader, struct uff_header *header)
{
    struct uff_lines *lines = &reader->lines;
    *header = (struct uff_header){0};
    char *text[] = {header->model, header->description, header->program, NULL,
                    header->saved, header->written_by,  header->written};
    int status = uff_begin(reader, 151);
    if (status != ROTID_OK)
        return status;
    /* some write fewer records or more: as the lines come, to the end of the set */
    for (size_t i = 0;; ++i) {
        status = uff_take_line(lines);
        if (status == UFF_END)
            status = uff_fail(lines, 0, "the file ends after this line; expected the '-1' that ends the set");
        if (status != ROTID_OK || uff_is_delimiter(lines, lines->strict))
            return uff_end(reader, status, UFF_BETWEEN);
        if (i == 3)
            cut_versions(lines, header);
        else if (i < sizeof text / sizeof *text)
            uff_copy_text(lines->text, lines->length, UFF_TEXT + 1, text[i]);
    }
}

static int read_units(struct uff_reader *reader, struct uff_units *units)
{
    struct uff_lines *lines = &reader->lines;
    double factor[4];
    int is_end, status = uff_read_record(lines, &uff_units_164, units);
    if (status != ROTID_OK)
        return status;
    if (units->code < 1 || units->code > 9)
        return uff_fail(lines, 1, "%s: code %d; expected 1 to 9", uff_units_164.what, units->code);
    status = uff_read_reals(lines, 4, 3, 25, "record 2 (factors of length, force, temperature; offset)", factor);
    if (status == ROTID_OK)
        status = uff_next_record(reader, "the '-1' that ends the set", &is_end);
    if (status != ROTID_OK)
        return status;
    if (!is_end)
        return uff_fail(lines, 0, "expected the '-1' that ends the set behind four factors");
    units->length = factor[0];
    units->force = factor[1];
    units->temperature = factor[2];
    units->temperature_offset = factor[3];
    return ROTID_OK;
}

int uff_read_units(struct uff_reader *reader, struct uff_units *units)
{
    *units = (struct uff_units){0};
    int status = uff_begin(reader, 164);
    return status == ROTID_OK ? uff_end(reader, read_units(reader, units), UFF_BETWEEN) : status;
}

/* ---- Nodes: set 15 in single precision, one line a node; sets 2411 and 781 in double precision, two lines a node. */

static int add_node(struct uff_reader *reader, struct pool *pool, struct uff_node_list *list, int line,
                    const struct uff_node *node)
{
    const struct uff_placed_node placed = {.node = *node, .line = line, .set = reader->set.number, .set_line = reader->set.line};
    if (list->count == INT_MAX)
        return uff_fail(&reader->lines, 0, "more than %d nodes", INT_MAX);
    return POOL_ADD(pool, list->item, list->count, &placed) ? ROTID_ERROR_MEMORY : ROTID_OK;
}

/* One node, of which the first line is at hand. */
static int read_node(struct uff_lines *lines, int number, struct uff_node *node)
{
    if (number == 15)
        return uff_take_record(lines, &uff_node_15, node);
    int status = uff_take_record(lines, &uff_node_2411, node);
    return status == ROTID_OK ? uff_read_record(lines, &uff_place_2411, node) : status;
}

int uff_append_nodes(struct uff_reader *reader, struct pool *pool, struct uff_node_list *list)
{
    int number = reader->set.number;
    int status = number == 15 || number == 781 || number == 2411 ? uff_begin(reader, number) : ROTID_ERROR_ARGUMENT;
    if (status != ROTID_OK)
        return status;
    for (;;) {
        struct uff_node node;
        int is_end;
        status = uff_next_record(reader, "a node or '-1'", &is_end);
        if (status != ROTID_OK || is_end)
            return uff_end(reader, status, UFF_BETWEEN);
        int line = reader->lines.line;
        status = read_node(&reader->lines, number, &node);
        if (status == ROTID_OK)
            status = add_node(reader, pool, list, line, &node);
        if (status != ROTID_OK)
            return uff_end(reader, status, UFF_BETWEEN);
    }
}

int uff_read_nodes(struct uff_reader *reader, struct pool *pool, int *count, struct uff_node **node)
{
    struct pool scratch; /* what grows grows there and is copied to its length */
    struct uff_node_list list = {0};
    *count = 0;
    *node = NULL;
    pool_open(&scratch, reader->allocator);
    int status = uff_append_nodes(reader, &scratch, &list);
    if (status == ROTID_OK) {
        *node = POOL_ARRAY(pool, struct uff_node, list.count);
        status = *node ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    for (int i = 0; i < list.count && status == ROTID_OK; ++i)
        (*node)[i] = list.item[i].node;
    *count = status == ROTID_OK ? list.count : 0;
    pool_close(&scratch);
    return status;
}

/* The sets of a universal file in turn: between two lines '-1', a line with the number of the set and its records. */

int uff_open(struct pool *pool, const char *path, struct message_list *messages, struct uff_reader **out)
{
    struct uff_reader *reader = POOL_NEW(pool, struct uff_reader);
    *out = NULL;
    if (!reader)
        return ROTID_ERROR_MEMORY;
    reader->allocator = pool->allocator;
    reader->lines.path = path;
    reader->lines.messages = messages;
    int status = uff_open_lines(&reader->lines);
    if (status == ROTID_OK)
        *out = reader;
    else
        uff_close(reader);
    return status;
}

void uff_close(struct uff_reader *reader)
{
    if (reader && reader->lines.stream)
        (void)fclose(reader->lines.stream); /* nothing was written that could fail to arrive */
    if (reader)
        reader->lines.stream = NULL;
}

/* The number of a set in the current line, 0 when it is none. */
static int parse_number(const struct uff_lines *lines, int *is_binary, size_t *end)
{
    size_t i = 0;
    int number = 0;
    while (lines->text[i] == ' ' || lines->text[i] == '\t')
        ++i;
    for (; lines->text[i] >= '0' && lines->text[i] <= '9' && number < 1000000; ++i)
        number = 10 * number + (lines->text[i] - '0');
    *end = i;
    *is_binary = lines->text[i] == 'b' || lines->text[i] == 'B';
    i += (size_t)*is_binary;
    return lines->text[i] && lines->text[i] != ' ' && lines->text[i] != '\t' ? 0 : number;
}

/* Behind an error: the next line that looks like the number of a set behind a '-1', in the columns where the set that failed
 * had its own. The set that failed is not taken again. ROTID_OK with that line at hand, UFF_END or ROTID_ERROR_IO. */
static int find_opener(struct uff_reader *reader)
{
    struct uff_lines *lines = &reader->lines;
    for (;;) {
        size_t end;
        int is_binary;
        if (lines->before.is_delimiter && lines->before.line != reader->set.line && parse_number(lines, &is_binary, &end) &&
            (!lines->strict || (lines->before.is_strict && end <= 6)))
            return ROTID_OK;
        int status = uff_take_line(lines);
        if (status != ROTID_OK)
            return status;
    }
}

/* The '-1' that opens a set, and the line behind it. */
static int read_opener(struct uff_reader *reader)
{
    struct uff_lines *lines = &reader->lines;
    int status, is_first = !reader->opened_sets;
    lines->set = 0;
    do
        status = uff_take_line(lines);
    while (status == ROTID_OK && !lines->length); /* blank lines between sets, and at the end */
    int is_opener = status == ROTID_OK && uff_is_delimiter(lines, 0);
    if (is_first && (status == UFF_END || (status == ROTID_OK && !is_opener))) {
        reader->opened_sets = 1; /* say so once */
        if (status == ROTID_OK && memchr(lines->text, '\r', lines->length))
            return uff_fail(lines, 0, "lines end with a carriage return alone; expected line feeds");
        return uff_fail(lines, 0, "no universal file: expected a line '    -1'");
    }
    if (status != ROTID_OK)
        return status;
    if (!is_opener) {
        char excerpt[UFF_EXCERPT];
        return uff_fail(lines, 1, "expected a line '    -1' that opens a set, found '%s'",
                        uff_excerpt(lines->text, lines->length, excerpt));
    }
    return uff_expect_line(lines, "the number of a set");
}

/* 58b: its first line says how many lines and then how many bytes follow. */
static int read_binary_line(struct uff_reader *reader)
{
    static const struct uff_record behind_number = {.count = 4,
                                                    .member = {{.column = {UFF_LONG, 7, 6}},
                                                               {.column = {UFF_LONG, 13, 6}},
                                                               {.column = {UFF_LONG, 19, 12}},
                                                               {.column = {UFF_LONG, 31, 12}}}};
    struct uff_binary *binary = &reader->binary;
    struct uff_cell cell[UFF_CELL_LIMIT];
    if (uff_cut_line(&reader->lines, &behind_number, 1, cell) >= 0 || cell[2].integer < 0 || cell[3].integer < 0)
        return uff_fail(&reader->lines, 0, "binary; expected byte order, number format, number of lines and number of bytes");
    binary->is_binary = 1;
    /* anything but 1 to 3 is refused when the values are read */
    binary->order = cell[0].integer == 1 || cell[0].integer == 2 ? (int)cell[0].integer : 0;
    binary->format = cell[1].integer >= 1 && cell[1].integer <= 3 ? (int)cell[1].integer : 0;
    /* the format fixes 11 for set 58, and some writers leave 0 there */
    binary->text_lines = reader->set.number == 58 && cell[2].integer < 11 ? 11 : cell[2].integer;
    binary->bytes = cell[3].integer;
    return ROTID_OK;
}

/* From the line with the number, which is at hand. */
static int enter_set(struct uff_reader *reader, struct uff_set *set)
{
    struct uff_lines *lines = &reader->lines;
    size_t end;
    int is_binary;
    int number = parse_number(lines, &is_binary, &end);
    reader->opened_sets = 1;
    reader->binary = (struct uff_binary){0};
    reader->values.is_finished = 0;
    lines->strict = lines->before.is_strict;
    lines->set = number;
    reader->set =
        (struct uff_set){.number = number, .is_binary = is_binary, .line = lines->before.line, .offset = lines->before.offset};
    if (!number) {
        char excerpt[UFF_EXCERPT];
        return uff_fail(lines, 1, "expected the number of a set behind '    -1', found '%s'",
                        uff_excerpt(lines->text, lines->length, excerpt));
    }
    if (is_binary) {
        int status = read_binary_line(reader);
        if (status != ROTID_OK)
            return status;
    }
    *set = reader->set;
    return ROTID_OK;
}

int uff_next(struct uff_reader *reader, struct uff_set *set)
{
    int status = ROTID_OK;
    *set = (struct uff_set){0};
    if (reader->place == UFF_BROKEN)
        return ROTID_ERROR_IO;
    if (reader->place == UFF_AT_BODY || reader->place == UFF_AT_DATA)
        status = uff_skip_set(reader);
    if (status == ROTID_OK && reader->place == UFF_LOST)
        status = find_opener(reader);
    else if (status == ROTID_OK)
        status = read_opener(reader);
    if (status == UFF_END) {
        reader->place = UFF_BETWEEN;
        return status;
    }
    if (status == ROTID_OK)
        status = enter_set(reader, set);
    return uff_end(reader, status, UFF_AT_BODY);
}

int uff_can_return(const struct uff_reader *reader)
{
    return reader->lines.size >= 0;
}

int uff_return_to(struct uff_reader *reader, const struct uff_set *set)
{
    struct uff_set again = {0};
    if (reader->place == UFF_BROKEN)
        return ROTID_ERROR_IO;
    int status = uff_seek(&reader->lines, set->offset, set->line);
    if (status == ROTID_OK)
        status = read_opener(reader);
    if (status == ROTID_OK)
        status = enter_set(reader, &again);
    if (status == UFF_END || (status == ROTID_OK && again.number != set->number)) /* changed under our hands */
        status = uff_fail(&reader->lines, 0, "set %d is not there any more", set->number);
    if (status == ROTID_ERROR_SYNTAX)
        status = ROTID_ERROR_IO;
    return uff_end(reader, status, UFF_AT_BODY);
}
