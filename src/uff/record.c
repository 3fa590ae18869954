#include "uff/uff.h"

static void fail(struct uff_put *put)
{
    if (put->status == ROTID_OK)
        put->status = ROTID_ERROR_ARGUMENT;
}

/* A cell of that length to the left or to the right of `width` columns; ROTID_ERROR_ARGUMENT where it is wider. */
static void add(struct uff_put *put, int width, int to_left, const char *cell, int length)
{
    char *at = put->line + put->length;
    if (put->status != ROTID_OK || length < 0 || length > width || put->length + (size_t)width > UFF_PUT_LIMIT) {
        fail(put);
        return;
    }
    memset(at, ' ', (size_t)width);
    memcpy(at + (to_left ? 0 : width - length), cell, (size_t)length);
    put->length += (size_t)width;
}

static void uff_put_integer(struct uff_put *put, int width, long long value)
{
    char cell[32];
    add(put, width, 0, cell, snprintf(cell, sizeof cell, "%lld", value));
}

/* 1PEw.d: `decimals` behind the point, one digit before it. The exponent letter is E also where the format says D: every reader
 * of Fortran takes it, and those written in C take nothing else. ROTID_ERROR_ARGUMENT for a value that is not finite. */
static void uff_put_real(struct uff_put *put, int width, int decimals, double value)
{
    char cell[64];
    if (isfinite(value))
        add(put, width, 0, cell, snprintf(cell, sizeof cell, "%.*E", decimals, value));
    else
        fail(put);
}

/* To the left of `width` columns; `fallback` where the text is empty. ROTID_ERROR_ARGUMENT where it is longer or has control
 * characters, which would break the line. */
static void uff_put_text(struct uff_put *put, int width, const char *text, const char *fallback)
{
    const char *shown = *text ? text : fallback;
    for (const char *c = shown; *c; ++c)
        if ((unsigned char)*c < ' ')
            fail(put);
    add(put, width, 1, shown, (int)strlen(shown));
}

static void write_line(struct uff_put *put, const char *text, size_t length)
{
    if (put->status == ROTID_OK && (fwrite(text, 1, length, put->stream) != length || putc('\n', put->stream) == EOF))
        put->status = ROTID_ERROR_IO;
}

/* Writes the line without its trailing blanks. A line of '-1' alone, which readers take for the end of the set, is
 * ROTID_ERROR_ARGUMENT. */
static void uff_put_line(struct uff_put *put)
{
    size_t first = 0, length = put->length;
    while (length && put->line[length - 1] == ' ')
        --length;
    while (first < length && put->line[first] == ' ')
        ++first;
    if (length - first == 2 && !memcmp(put->line + first, "-1", 2))
        fail(put);
    write_line(put, put->line, length);
    put->length = 0;
}

static void uff_put_open(struct uff_put *put, FILE *stream, int set)
{
    char number[16];
    *put = (struct uff_put){.stream = stream};
    write_line(put, "    -1", 6);
    write_line(put, number, (size_t)snprintf(number, sizeof number, "%6d", set));
}

/* The line '-1' and the line with the number of the set; the line '-1' that closes it, and the status of all. */
static int uff_put_close(struct uff_put *put)
{
    write_line(put, "    -1", 6);
    return put->status;
}

/* `per_line` reals a line. */
static void uff_put_reals(struct uff_put *put, int width, int decimals, int per_line, int count, const double *value)
{
    for (int i = 0; i < count; ++i) {
        uff_put_real(put, width, decimals, value[i]);
        if ((i + 1) % per_line == 0 || i + 1 == count)
            uff_put_line(put);
    }
}

/* A line with one text of up to 80 characters, NONE where it is empty: the format has no blank lines. */
static void uff_put_text_line(struct uff_put *put, const char *text)
{
    uff_put_text(put, UFF_TEXT, text, "NONE");
    uff_put_line(put);
}

/* ---- layouts: S struct, M member, from column A (from 0), width W, decimals D */

#define COLUMN(KIND, S, M, A, W) .column = {KIND, A, W}, .offset = offsetof(struct S, M)
#define WHOLE(S, M, A, W)                                                                                                        \
    {                                                                                                                            \
        COLUMN(UFF_INTEGER, S, M, A, W)                                                                                          \
    }
#define REQUIRED(S, M, A, W)                                                                                                     \
    {                                                                                                                            \
        COLUMN(UFF_REQUIRED_INTEGER, S, M, A, W)                                                                                 \
    }
#define WORDS(S, M, A, W)                                                                                                        \
    {                                                                                                                            \
        COLUMN(UFF_WORDS, S, M, A, W)                                                                                            \
    }
#define REAL(S, M, A, W, D)                                                                                                      \
    {                                                                                                                            \
        COLUMN(UFF_REAL, S, M, A, W), .decimals = (D)                                                                            \
    }
#define STEP(S, M, A, W, D)                                                                                                      \
    {                                                                                                                            \
        COLUMN(UFF_REAL, S, M, A, W), .decimals = (D), .one_more = 1                                                             \
    }

/* clang-format off */
const struct uff_record uff_versions_151 = {"versions and file type", 0, 3, {
    WHOLE(uff_header, version[0], 20, 10),
    WHOLE(uff_header, version[1], 30, 10),
    WHOLE(uff_header, file_type, 40, 10)}};
const struct uff_record uff_units_164 = {"record 1 (units code, description, temperature mode)", 0, 3, {
    REQUIRED(uff_units, code, 0, 10),
    WORDS(uff_units, description, 10, 20),
    WHOLE(uff_units, temperature_mode, 30, 10)}};

#define NODE_LABEL                                                                                                               \
    WHOLE(uff_node, id, 0, 10), WHOLE(uff_node, definition_system, 10, 10), WHOLE(uff_node, displacement_system, 20, 10),        \
    WHOLE(uff_node, color, 30, 10)
const struct uff_record uff_node_15 = {"a node", 1, 7, {
    NODE_LABEL,
    REAL(uff_node, x[0], 40, 13, 5),
    REAL(uff_node, x[1], 53, 13, 5),
    REAL(uff_node, x[2], 66, 13, 5)}};
const struct uff_record uff_node_2411 = {"a node, record 1", 1, 4, {NODE_LABEL}};
const struct uff_record uff_place_2411 = {"coordinates, record 2 of a node", 1, 3, {
    REAL(uff_node, x[0], 0, 25, 16),
    REAL(uff_node, x[1], 25, 25, 16),
    REAL(uff_node, x[2], 50, 25, 16)}};

const struct uff_record uff_kind_55 = {
    "record 6 (model, analysis, characteristic, quantity, data type, values per node)", 1, 6, {
    WHOLE(uff_shape, model_type, 0, 10),
    WHOLE(uff_shape, analysis_type, 10, 10),
    WHOLE(uff_shape, data_characteristic, 20, 10),
    WHOLE(uff_shape, specific_type, 30, 10),
    WHOLE(uff_shape, data_type, 40, 10),
    WHOLE(uff_shape, component_count, 50, 10)}};

const struct uff_record uff_location_58 = {
    "record 6 (function type, number, version, load case, response, reference)", 0, 10, {
    WHOLE(uff_function, type, 0, 5),
    WHOLE(uff_function, number, 5, 10),
    WHOLE(uff_function, version, 15, 5),
    WHOLE(uff_function, load_case, 20, 10),
    WORDS(uff_function, response_name, 31, 10),
    WHOLE(uff_function, response_node, 41, 10),
    WHOLE(uff_function, response_direction, 51, 4),
    WORDS(uff_function, reference_name, 56, 10),
    WHOLE(uff_function, reference_node, 66, 10),
    WHOLE(uff_function, reference_direction, 76, 4)}};
/* A step of a sixth digit would move the end of 64000 lines by a third of a line. */
const struct uff_record uff_form_58 = {"record 7 (ordinate data type, number of values, spacing, minimum, increment, z)", 0, 6, {
    REQUIRED(uff_function, ordinate, 0, 10),
    {COLUMN(UFF_LONG, uff_function, count, 10, 10)},
    WHOLE(uff_function, is_even, 20, 10),
    STEP(uff_function, start, 30, 13, 5),
    STEP(uff_function, step, 43, 13, 5),
    REAL(uff_function, z, 56, 13, 5)}};
/* NOLINTBEGIN(bugprone-macro-parentheses): M is a member of the struct, whose name no parentheses may enclose */
#define AXIS(NAME, WHAT, M)                                                                                                      \
    const struct uff_record NAME = {WHAT, 0, 6, {                                                                                \
        WHOLE(uff_function, M.specific_type, 0, 10),                                                                             \
        WHOLE(uff_function, M.length, 10, 5),                                                                                    \
        WHOLE(uff_function, M.force, 15, 5),                                                                                     \
        WHOLE(uff_function, M.temperature, 20, 5),                                                                               \
        WORDS(uff_function, M.label, 26, 20),                                                                                    \
        WORDS(uff_function, M.unit, 47, 20)}}
/* NOLINTEND(bugprone-macro-parentheses) */
AXIS(uff_abscissa_58, "record 8 (abscissa)", abscissa);
AXIS(uff_ordinate_58, "record 9 (ordinate)", numerator);
AXIS(uff_denominator_58, "record 10 (ordinate denominator)", denominator);
AXIS(uff_z_axis_58, "record 11 (z axis)", z_axis);
/* clang-format on */

/* ---- reading */

static void store(const struct uff_lines *lines, const struct uff_member *member, const struct uff_cell *cell, void *to)
{
    void *at = (char *)to + member->offset;
    switch (member->column.kind) {
    case UFF_LONG:
        *(long long *)at = cell->integer;
        break;
    case UFF_REAL:
        *(double *)at = cell->real;
        break;
    case UFF_WORDS:
        uff_copy_text(lines->text + cell->start, cell->length, (size_t)member->column.width + 1, at);
        break;
    default:
        *(int *)at = (int)cell->integer;
    }
}

int uff_cut_members(const struct uff_lines *lines, const struct uff_record *record, struct uff_cell cell[UFF_CELL_LIMIT],
                    void *to)
{
    int bad = uff_cut_line(lines, record, UFF_WHOLE, cell);
    for (int i = 0; i < record->count && bad < 0; ++i)
        store(lines, &record->member[i], &cell[i], to);
    return bad;
}

/* Integers, and behind them reals. */
static int take_exact(struct uff_lines *lines, const struct uff_record *record, void *to)
{
    struct uff_form form = {0};
    int integer[UFF_CELL_LIMIT];
    double real[UFF_CELL_LIMIT];
    for (int i = 0; i < record->count; ++i) {
        const struct uff_column *column = &record->member[i].column;
        int is_real = column->kind == UFF_REAL;
        *(is_real ? &form.real_width : &form.integer_width) = column->width;
        ++*(is_real ? &form.reals : &form.integers);
    }
    int status = uff_parse_line(lines, &form, record->what, integer, real);
    for (int i = 0; i < record->count && status == ROTID_OK; ++i) {
        const struct uff_cell cell = {.integer = i < form.integers ? integer[i] : 0,
                                      .real = i < form.integers ? 0 : real[i - form.integers]};
        store(lines, &record->member[i], &cell, to);
    }
    return status;
}

int uff_take_record(struct uff_lines *lines, const struct uff_record *record, void *to)
{
    struct uff_cell cell[UFF_CELL_LIMIT];
    if (record->is_exact)
        return take_exact(lines, record, to);
    int status = uff_cut_record(lines, record, cell);
    for (int i = 0; i < record->count && status == ROTID_OK; ++i) {
        const struct uff_column *column = &record->member[i].column;
        if (column->kind == UFF_REQUIRED_INTEGER && cell[i].integer != (int)cell[i].integer)
            status = uff_fail(lines, column->start + 1, "%s: the number is too large for 32 bits", record->what);
    }
    for (int i = 0; i < record->count && status == ROTID_OK; ++i)
        store(lines, &record->member[i], &cell[i], to);
    return status;
}

int uff_read_record(struct uff_lines *lines, const struct uff_record *record, void *to)
{
    int status = uff_expect_line(lines, record->what);
    return status == ROTID_OK ? uff_take_record(lines, record, to) : status;
}

/* ---- writing */

static int decimals_of(const struct uff_member *member, double value)
{
    char few[32], many[32];
    if (!member->one_more || !isfinite(value))
        return member->decimals;
    (void)snprintf(few, sizeof few, "%.*E", member->decimals, value);
    int length = snprintf(many, sizeof many, "%.*E", member->decimals + 1, value);
    return member->decimals + (length < member->column.width && strtod(many, NULL) != strtod(few, NULL));
}

static void put_members(struct uff_put *put, const struct uff_record *record, const void *from)
{
    for (int i = 0, end = 0; i < record->count; ++i) {
        const struct uff_member *member = &record->member[i];
        const void *at = (const char *)from + member->offset;
        int width = member->column.width;
        for (; end < member->column.start; ++end)
            uff_put_text(put, 1, "", " ");
        end += width;
        if (member->column.kind == UFF_REAL)
            uff_put_real(put, width, decimals_of(member, *(const double *)at), *(const double *)at);
        else if (member->column.kind == UFF_WORDS)
            uff_put_text(put, width, at, "NONE");
        else
            uff_put_integer(put, width, member->column.kind == UFF_LONG ? *(const long long *)at : *(const int *)at);
    }
}

/* The members as a line. */
static void uff_put_record(struct uff_put *put, const struct uff_record *record, const void *from)
{
    put_members(put, record, from);
    uff_put_line(put);
}

/* Sets that are written in one go: header, units, geometry. */

/* A date and a time of ten columns each, kept as one text. */
static void put_date(struct uff_put *put, const char *text)
{
    uff_put_text(put, 20, text, "");
}

int uff_write_header(FILE *stream, const struct uff_header *header)
{
    struct uff_put put;
    uff_put_open(&put, stream, 151);
    uff_put_text_line(&put, header->model);
    uff_put_text_line(&put, header->description);
    uff_put_text_line(&put, header->program);
    put_date(&put, header->created);
    uff_put_integer(&put, 10, header->version[0]);
    uff_put_integer(&put, 10, header->version[1]);
    uff_put_integer(&put, 10, header->file_type);
    uff_put_line(&put);
    put_date(&put, header->saved);
    uff_put_line(&put);
    uff_put_text_line(&put, header->written_by);
    put_date(&put, header->written);
    uff_put_line(&put);
    return uff_put_close(&put);
}

int uff_write_units(FILE *stream, const struct uff_units *units)
{
    const double factor[] = {units->length, units->force, units->temperature, units->temperature_offset};
    struct uff_put put;
    uff_put_open(&put, stream, 164);
    uff_put_record(&put, &uff_units_164, units);
    uff_put_reals(&put, 25, 16, 3, 4, factor);
    return uff_put_close(&put);
}

int uff_write_nodes(FILE *stream, int set, int count, const struct uff_node *node)
{
    struct uff_put put;
    if ((set != 15 && set != 2411) || count < 0)
        return ROTID_ERROR_ARGUMENT;
    uff_put_open(&put, stream, set);
    for (int i = 0; i < count && put.status == ROTID_OK; ++i) {
        uff_put_record(&put, set == 15 ? &uff_node_15 : &uff_node_2411, &node[i]);
        if (set == 2411)
            uff_put_record(&put, &uff_place_2411, &node[i]);
    }
    return uff_put_close(&put);
}

/* Data at nodes: sets 55 and 2414. */

static void put_ids(struct uff_put *put, const char (*id)[UFF_TEXT + 1])
{
    for (int i = 0; i < UFF_ID_LINES; ++i)
        uff_put_text_line(put, id[i]);
}

/* Records 7 and 8. The eigenvalue of a complex mode stands there and not its frequency. */
static void put_mode(struct uff_put *put, const struct uff_shape *shape)
{
    double real[6] = {shape->frequency_hz};
    int count = 1;
    if (shape->analysis_type == NORMAL_MODE) {
        real[1] = shape->modal_mass;
        real[2] = shape->damping;
        real[3] = shape->hysteretic;
        count = 4;
    } else if (uff_has_eigenvalue(shape)) {
        memcpy(real, shape->eigenvalue, sizeof shape->eigenvalue);
        memcpy(real + 2, shape->modal_a, sizeof shape->modal_a);
        memcpy(real + 4, shape->modal_b, sizeof shape->modal_b);
        count = 6;
    }
    const int record[] = {2, count, shape->load_case, shape->number};
    for (int i = 0; i < 4; ++i)
        uff_put_integer(put, 10, record[i]);
    uff_put_line(put);
    uff_put_reals(put, 13, 5, 6, count, real);
}

int uff_write_shape(FILE *stream, const struct uff_shape *shape)
{
    int components = shape->component_count, is_complex = shape->is_complex != 0;
    if (components < 1 || components > 6 || shape->node_count < 0 || (is_complex && shape->node_count && !shape->imag))
        return ROTID_ERROR_ARGUMENT;
    if (uff_has_eigenvalue(shape) && shape->frequency_hz > 0 && shape->eigenvalue[0] == 0 && shape->eigenvalue[1] == 0)
        return ROTID_ERROR_ARGUMENT; /* the frequency would be lost */

    struct uff_shape head = *shape;
    head.data_type = is_complex ? COMPLEX_DATA : REAL_DATA;
    struct uff_put put;
    uff_put_open(&put, stream, 55);
    put_ids(&put, shape->id);
    uff_put_record(&put, &uff_kind_55, &head);
    put_mode(&put, shape);
    for (int i = 0; i < shape->node_count && put.status == ROTID_OK; ++i) {
        double value[12];
        for (int c = 0; c < components; ++c) {
            size_t at = (size_t)components * (size_t)i + (size_t)c;
            value[is_complex ? 2 * c : c] = shape->real[at];
            if (is_complex)
                value[2 * c + 1] = shape->imag[at];
        }
        uff_put_integer(&put, 10, shape->node[i]);
        uff_put_line(&put);
        uff_put_reals(&put, 13, 5, 6, components * (is_complex ? 2 : 1), value);
    }
    return uff_put_close(&put);
}

/* Set 58. */

#define COUNT_MOST 9999999999 /* I10 */

static void put_records(struct uff_put *put, const struct uff_function *function)
{
    put_ids(put, function->id);
    struct uff_function form = *function;
    form.is_even = function->is_even != 0;
    form.start = form.is_even ? form.start : 0;
    form.step = form.is_even ? form.step : 0;
    uff_put_record(put, &uff_location_58, function);
    uff_put_record(put, &uff_form_58, &form);
    uff_put_record(put, &uff_abscissa_58, function);
    uff_put_record(put, &uff_ordinate_58, function);
    uff_put_record(put, &uff_denominator_58, function);
    uff_put_record(put, &uff_z_axis_58, function);
}

int uff_write_function(FILE *stream, const struct uff_function *function, struct uff_function_writer *writer)
{
    *writer = (struct uff_function_writer){.function = function};
    int known = function->ordinate == UFF_REAL_SINGLE || uff_is_complex(function) || uff_is_double(function);
    if (!known || function->binary.is_binary || function->count < 0 || function->count > COUNT_MOST)
        return ROTID_ERROR_ARGUMENT;
    uff_put_open(&writer->put, stream, 58);
    put_records(&writer->put, function);
    return writer->put.status;
}

/* The columns of the format: 6E13.5, 4E20.12, 2(E13.5,E20.12), E13.5,2E20.12. */
static void put_number(struct uff_function_writer *writer, int is_abscissa, double number)
{
    const struct uff_function *function = writer->function;
    int wide = uff_is_double(function), per_line = !wide ? 6 : !function->is_even && uff_is_complex(function) ? 3 : 4;
    uff_put_real(&writer->put, wide && !is_abscissa ? 20 : 13, wide && !is_abscissa ? 12 : 5, number);
    writer->on_line = (writer->on_line + 1) % per_line;
    if (!writer->on_line)
        uff_put_line(&writer->put);
}

int uff_write_values(struct uff_function_writer *writer, long long count, const double *x, const double *real, const double *imag)
{
    const struct uff_function *function = writer->function;
    int uneven = !function->is_even, pair = uff_is_complex(function);
    if (count < 0 || count > function->count - writer->written || (count && (!real || (uneven && !x) || (pair && !imag))))
        return ROTID_ERROR_ARGUMENT;
    for (long long i = 0; i < count && writer->put.status == ROTID_OK; ++i) {
        if (uneven)
            put_number(writer, 1, x[i]);
        put_number(writer, 0, real[i]);
        if (pair)
            put_number(writer, 0, imag[i]);
    }
    if (writer->put.status == ROTID_OK)
        writer->written += count;
    return writer->put.status;
}

int uff_end_function(struct uff_function_writer *writer)
{
    if (writer->written != writer->function->count)
        return ROTID_ERROR_ARGUMENT;
    if (writer->on_line)
        uff_put_line(&writer->put);
    return uff_put_close(&writer->put);
}
