#include "record/rows.h"
#include "result/result.h"

static const char *const states[] = {"read", "read_over", "not_known", "malformed", NULL};
static const char *const doubts[] = {
    "malformed", "unknown_set", "no_units",  "node_twice", "no_coordinates", "abscissa_order", "uneven",          "unit",
    "dead",      "clipped",     "coherence", "identical",  "length",         "resolution",     "frequency_order", NULL};

#define NUMBER_3(S, M) RECORD_ROW(S, M, FIELD_NUMBER, SHAPE_FIXED, 0, .fixed = 3)
#define ID(S)          RECORD_ROW(S, id, FIELD_TEXT, SHAPE_FIXED, ELEMENTS_MAY_BE_NULL, .fixed = LISTED_ID_LINES)

static const struct record_field header_fields[] = {
    TEXT(struct listed_header, model, MAY_BE_NULL),   TEXT(struct listed_header, description, MAY_BE_NULL),
    TEXT(struct listed_header, program, MAY_BE_NULL), TEXT(struct listed_header, created, MAY_BE_NULL),
    TEXT(struct listed_header, saved, MAY_BE_NULL),   TEXT(struct listed_header, written_by, MAY_BE_NULL),
    TEXT(struct listed_header, written, MAY_BE_NULL), {0},
};
static const struct record header_record = RECORD(struct listed_header, header_fields);

static const struct record_field units_fields[] = {
    INTEGER(struct listed_units, code, 0),
    TEXT(struct listed_units, name, 0),
    TEXT(struct listed_units, description, MAY_BE_NULL),
    NUMBER(struct listed_units, length, 0),
    NUMBER(struct listed_units, force, 0),
    NUMBER(struct listed_units, temperature, 0),
    NUMBER(struct listed_units, temperature_offset, 0),
    {0},
};
static const struct record units_record = RECORD(struct listed_units, units_fields);

static const struct record_field set_fields[] = {
    INTEGER(struct listed_set, line, FROM_1),
    INTEGER(struct listed_set, set, FROM_0),
    FLAG(struct listed_set, binary, 0),
    TEXT(struct listed_set, name, MAY_BE_NULL),
    TEXT_OF(struct listed_set, state, 0, states),
    NUMBER(struct listed_set, count, FROM_0 | WHOLE),
    {0},
};
static const struct record set_record = RECORD(struct listed_set, set_fields);

static const struct record_field every_node_fields[] = {
    INTEGERS(struct listed_nodes, ids, 0),
    MATRIX(struct listed_nodes, x, 0, nids, nx),
    {0},
};
static const struct record every_node_record = RECORD(struct listed_nodes, every_node_fields);

static const struct record_field nodes_fields[] = {
    INTEGER(struct listed_nodes, count, FROM_0),
    NUMBER_3(struct listed_nodes, min),
    NUMBER_3(struct listed_nodes, max),
    ROWS(IF_KNOWN, every_node_record),
    {0},
};
static const struct record nodes_record = RECORD(struct listed_nodes, nodes_fields);

static const struct record_field axis_fields[] = {
    INTEGER(struct listed_axis, data_type, 0),
    TEXT(struct listed_axis, label, MAY_BE_NULL),
    TEXT(struct listed_axis, unit, MAY_BE_NULL),
    {0},
};
static const struct record axis_record = RECORD(struct listed_axis, axis_fields);

static const struct record_field function_fields[] = {
    INTEGER(struct listed_function, line, FROM_1),
    INTEGER(struct listed_function, type, FROM_0),
    TEXT(struct listed_function, kind, 0),
    ID(struct listed_function),
    TEXT(struct listed_function, response, 0),
    TEXT(struct listed_function, reference, 0),
    INTEGER(struct listed_function, response_node, 0),
    INTEGER(struct listed_function, response_direction, 0),
    INTEGER(struct listed_function, reference_node, 0),
    INTEGER(struct listed_function, reference_direction, 0),
    INTEGER(struct listed_function, ordinate, FROM_1),
    TEXT(struct listed_function, ordinate_name, 0),
    FLAG(struct listed_function, binary, 0),
    NUMBER(struct listed_function, count, FROM_0 | WHOLE),
    FLAG(struct listed_function, even, 0),
    NUMBER(struct listed_function, start, 0),
    NUMBER(struct listed_function, step, MAY_BE_NULL),
    NUMBER(struct listed_function, end, 0),
    FLAG(struct listed_function, time, 0),
    NUMBER(struct listed_function, sampling_rate_hz, MAY_BE_NULL),
    STRUCT(struct listed_function, abscissa, 0, axis_record),
    STRUCT(struct listed_function, numerator, 0, axis_record),
    STRUCT(struct listed_function, denominator, 0, axis_record),
    NUMBER(struct listed_function, si_factor, 0),
    NUMBER(struct listed_function, abscissa_si_factor, 0),
    NUMBER(struct listed_function, min, MAY_BE_NULL),
    NUMBER(struct listed_function, max, MAY_BE_NULL),
    NUMBER(struct listed_function, rms, MAY_BE_NULL),
    NUMBERS(struct listed_function, first, 0),
    NUMBERS(struct listed_function, last, 0),
    INTERVAL(struct listed_function, sum, 0),
    {0},
};
static const struct record function_record = RECORD(struct listed_function, function_fields);

static const struct record_field every_value_fields[] = {
    INTEGERS(struct listed_shape, nodes, 0),
    NUMBERS(struct listed_shape, real, 0),
    NUMBERS(struct listed_shape, imag, 0),
    {0},
};
static const struct record every_value_record = RECORD(struct listed_shape, every_value_fields);

static const struct record_field shape_fields[] = {
    INTEGER(struct listed_shape, line, FROM_1),
    ID(struct listed_shape),
    INTEGER(struct listed_shape, analysis_type, 0),
    TEXT(struct listed_shape, analysis, 0),
    INTEGER(struct listed_shape, mode, 0),
    NUMBER(struct listed_shape, frequency_hz, 0),
    NUMBER(struct listed_shape, damping, 0),
    FLAG_IS(struct listed_shape, complex, 0),
    INTEGER(struct listed_shape, components, FROM_0),
    INTEGER(struct listed_shape, node_count, FROM_0),
    INTERVAL(struct listed_shape, sum, 0),
    NUMBER(struct listed_shape, rms, 0),
    ROWS(IF_KNOWN, every_value_record),
    {0},
};
static const struct record shape_record = RECORD(struct listed_shape, shape_fields);

static const struct record_field doubt_fields[] = {
    TEXT_OF(struct listed_doubt, kind, 0, doubts),
    INTEGER(struct listed_doubt, line, MAY_BE_NULL | FROM_1),
    TEXT(struct listed_doubt, text, 0),
    {0},
};
static const struct record doubt_record = RECORD(struct listed_doubt, doubt_fields);

static const struct record_field error_fields[] = {
    INTEGER(struct listed_error, line, FROM_0),
    INTEGER(struct listed_error, column, FROM_0),
    TEXT(struct listed_error, text, 0),
    {0},
};
static const struct record error_record = RECORD(struct listed_error, error_fields);

static const struct record_field uff_fields[] = {
    TEXT(struct uff_result, file, 0),
    TEXTS(struct uff_result, summary, 0),
    STRUCT(struct uff_result, header, MAY_BE_NULL | BEHIND_POINTER, header_record),
    STRUCT(struct uff_result, units, MAY_BE_NULL | BEHIND_POINTER, units_record),
    STRUCTS(struct uff_result, sets, 0, set_record),
    STRUCT(struct uff_result, nodes, 0, nodes_record),
    STRUCTS(struct uff_result, functions, 0, function_record),
    STRUCTS(struct uff_result, shapes, 0, shape_record),
    STRUCTS(struct uff_result, doubtful, 0, doubt_record),
    STRUCTS(struct uff_result, errors, 0, error_record),
    {0},
};
const struct record uff_record = RECORD(struct uff_result, uff_fields);
