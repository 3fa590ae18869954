#include "record/rows.h"
#include "result/result.h"

const char *const export_format_words[] = {"matrix-market", "dmig", NULL};
static const char *const models[] = {"identified", "stated", NULL};
static const char *const condensations[] = {"GUYAN", "IRS", NULL};

static const struct record_field parameter_fields[] = {
    TEXT(struct export_parameter_result, name, 0),
    TEXT(struct export_parameter_result, unit, 0),
    NUMBER(struct export_parameter_result, value, 0),
    NUMBER(struct export_parameter_result, std, MAY_BE_NULL | FROM_0),
    {0},
};
static const struct record parameter_record = RECORD(struct export_parameter_result, parameter_fields);

static const struct record_field export_fields[] = {
    TEXT_OF(struct export_result, format, 0, export_format_words),
    TEXTS(struct export_result, files, NOT_EMPTY),
    TEXT_OF(struct export_result, model, 0, models),
    TEXT_OF(struct export_result, status, MAY_BE_NULL, fit_status_words),
    STRUCTS(struct export_result, parameters, 0, parameter_record),
    NUMBER(struct export_result, mass_kg, ABOVE_0),
    NUMBER(struct export_result, center_of_mass_m, 0),
    INTEGER(struct export_result, nodes, FROM_1),
    INTEGER(struct export_result, degrees_of_freedom, FROM_1),
    TEXT_OF(struct export_result, reduction, MAY_BE_NULL, condensations),
    INTEGER(struct export_result, masters, MAY_BE_NULL | FROM_1),
    NUMBERS(struct export_result, rigid_hz, FROM_0),
    NUMBERS(struct export_result, full_hz, FROM_0),
    NUMBERS(struct export_result, exported_hz, ELEMENTS_MAY_BE_NULL | FROM_0),
    {0},
};
const struct record export_record = RECORD(struct export_result, export_fields);
