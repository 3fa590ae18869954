#include "record/rows.h"
#include "result/result.h"
#include "run/run.h"

#define CURVE (ELEMENTS_MAY_BE_NULL | FROM_0)

static const struct record_field parameter_fields[] = {
    COUNT_OF(struct sensitivity_parameter, nfrequency_hz, struct sensitivity, nfrequency_hz),
    COUNT_OF(struct sensitivity_parameter, nrelative_value, struct sensitivity, nrelative_value),
    TEXT(struct sensitivity_parameter, name, 0),
    TEXT(struct sensitivity_parameter, unit, 0),
    NUMBER(struct sensitivity_parameter, reference, 0),
    NUMBERS_BY(struct sensitivity_parameter, sensitivity, 0, nfrequency_hz, "frequency_hz"),
    NUMBERS_BY(struct sensitivity_parameter, derivative, 0, nfrequency_hz, "frequency_hz"),
    NUMBERS_BY(struct sensitivity_parameter, frequency_change, SINCE_LATER, nfrequency_hz, "frequency_hz"),
    MATRIX(struct sensitivity_parameter, curves, CURVE, nfrequency_hz, nrelative_value),
    {0},
};
static const struct record parameter_record = RECORD(struct sensitivity_parameter, parameter_fields);

static const struct record_field line_fields[] = {
    COUNT_OF(struct growth_line, nepsilon_squared, struct growth, nepsilon_squared),
    NUMBERS_BY(struct growth_line, objective, CURVE, nepsilon_squared, "epsilon_squared"),
    NUMBER(struct growth_line, slope, MAY_BE_NULL),
    NUMBER(struct growth_line, intercept, MAY_BE_NULL),
    {0},
};
static const struct record line_record = RECORD(struct growth_line, line_fields);

static const struct record_field growth_fields[] = {
    NUMBERS(struct growth, epsilon_squared, ABOVE_0),
    STRUCT(struct growth, hybrid, 0, line_record),
    STRUCT(struct growth, hybrid_f, 0, line_record),
    NUMBERS_BY(struct growth, shapes_alone, CURVE | SINCE_LATER, nepsilon_squared, "epsilon_squared"),
    {0},
};
static const struct record growth_record = RECORD(struct growth, growth_fields);

static const struct record_field sensitivity_fields[] = {
    TEXT_OF(struct sensitivity, reduction, 0, reduction_words),
    NUMBER(struct sensitivity, step, ABOVE_0),
    NUMBERS(struct sensitivity, frequency_hz, FROM_0),
    NUMBERS(struct sensitivity, relative_value, 0),
    STRUCTS(struct sensitivity, parameters, 0, parameter_record),
    STRUCT(struct sensitivity, functional_growth, MAY_BE_NULL | SINCE_LATER | BEHIND_POINTER, growth_record),
    {0},
};
const struct record sensitivity_record = RECORD(struct sensitivity, sensitivity_fields);
