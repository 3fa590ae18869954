#include "record/rows.h"
#include "result/result.h"

const char *const transfer_quantity_words[] = {"displacement", "velocity", "acceleration", NULL};
const char *const transfer_unit_words[] = {"m/N", "m/(s N)", "m/(s2 N)", NULL};
const char *const transfer_damping_words[] = {"measured", "stated", "smallest_measured", "mean_measured", NULL};

#define RATIO (MAY_BE_NULL | CORRELATION)

static const struct record_field parameter_fields[] = {
    TEXT(struct transfer_parameter, name, 0),
    TEXT(struct transfer_parameter, unit, 0),
    NUMBER(struct transfer_parameter, value, 0),
    {0},
};
static const struct record parameter_record = RECORD(struct transfer_parameter, parameter_fields);

static const struct record_field mode_agreement_fields[] = {
    NUMBER(struct transfer_mode_agreement, frac, RATIO),
    NUMBER(struct transfer_mode_agreement, frac_at_measured_frequencies, RATIO),
    NUMBER(struct transfer_mode_agreement, level_db, MAY_BE_NULL),
    NUMBER(struct transfer_mode_agreement, phase_deg, MAY_BE_NULL),
    INTEGER(struct transfer_mode_agreement, worst_function, MAY_BE_NULL | FROM_0),
    {0},
};
static const struct record mode_agreement_record = RECORD(struct transfer_mode_agreement, mode_agreement_fields);

static const struct record_field mode_fields[] = {
    FLAG(struct transfer_mode, rigid, 0),
    INTEGER(struct transfer_mode, mode, MAY_BE_NULL | FROM_1),
    NUMBER(struct transfer_mode, model_hz, FROM_0),
    NUMBER(struct transfer_mode, measured_hz, MAY_BE_NULL | FROM_0),
    NUMBER(struct transfer_mode, damping, ABOVE_0),
    TEXT_OF(struct transfer_mode, damping_from, 0, transfer_damping_words),
    INLINE(struct transfer_mode, agreement, IF_KNOWN | BEHIND_POINTER, mode_agreement_record),
    {0},
};
static const struct record mode_record = RECORD(struct transfer_mode, mode_fields);

static const struct record_field agreement_fields[] = {
    NUMBER(struct transfer_agreement, frac, RATIO),
    NUMBER(struct transfer_agreement, frac_at_measured_frequencies, RATIO),
    NUMBER(struct transfer_agreement, frac_of_conjugate, RATIO),
    NUMBER(struct transfer_agreement, scale, MAY_BE_NULL),
    NUMBER(struct transfer_agreement, level_db, MAY_BE_NULL),
    {0},
};
static const struct record agreement_record = RECORD(struct transfer_agreement, agreement_fields);

static const struct record_field at_mode_fields[] = {
    INTEGER(struct transfer_at_mode, mode, FROM_1),
    NUMBER(struct transfer_at_mode, level_db, MAY_BE_NULL),
    NUMBER(struct transfer_at_mode, phase_deg, MAY_BE_NULL),
    NUMBER(struct transfer_at_mode, deviation, MAY_BE_NULL | FROM_0),
    {0},
};
static const struct record at_mode_record = RECORD(struct transfer_at_mode, at_mode_fields);

static const struct record_field beside_fields[] = {
    INLINE(struct transfer_beside, agreement, 0, agreement_record),
    FLAG(struct transfer_beside, measured_reversed, 0),
    FLAG(struct transfer_beside, measured_reciprocal, 0),
    STRUCTS(struct transfer_beside, at_modes, 0, at_mode_record),
    {0},
};
static const struct record beside_record = RECORD(struct transfer_beside, beside_fields);

#define CURVE(M) NUMBERS_BY(struct transfer_function, M, ELEMENTS_MAY_BE_NULL, nfrequency_hz, "frequency_hz")
static const struct record_field curve_fields[] = {
    NUMBERS(struct transfer_function, frequency_hz, ABOVE_0),
    CURVE(synthesised_re),
    CURVE(synthesised_im),
    {0},
};
static const struct record curve_record = RECORD(struct transfer_function, curve_fields);
static const struct record_field measured_curve_fields[] = {
    CURVE(measured_re),
    CURVE(measured_im),
    {0},
};
static const struct record measured_curve_record = RECORD(struct transfer_function, measured_curve_fields);

static const struct record_field function_fields[] = {
    INTEGER(struct transfer_function, response, 0),
    INTEGER(struct transfer_function, reference, 0),
    NUMBER(struct transfer_function, response_z_m, FROM_0),
    NUMBER(struct transfer_function, reference_z_m, FROM_0),
    INLINE(struct transfer_function, beside, IF_KNOWN | BEHIND_POINTER, beside_record),
    ROWS(IF_KNOWN, curve_record),
    ROWS(IF_KNOWN, measured_curve_record),
    {0},
};
static const struct record function_record = RECORD(struct transfer_function, function_fields);

static const struct record_field frf_fields[] = {
    FLAG(struct transfer_result, complete, 0),
    TEXT_OF(struct transfer_result, quantity, 0, transfer_quantity_words),
    TEXT_OF(struct transfer_result, unit, 0, transfer_unit_words),
    INTEGER(struct transfer_result, lines, FROM_1),
    NUMBER(struct transfer_result, low_hz, ABOVE_0),
    NUMBER(struct transfer_result, high_hz, ABOVE_0),
    NUMBER(struct transfer_result, modes_up_to_hz, ABOVE_0),
    NUMBER(struct transfer_result, window_decay, FROM_0),
    TEXT(struct transfer_result, measured_file, MAY_BE_NULL),
    STRUCTS(struct transfer_result, parameters, 0, parameter_record),
    STRUCTS(struct transfer_result, modes, 0, mode_record),
    STRUCT(struct transfer_result, agreement, IF_KNOWN | BEHIND_POINTER, agreement_record),
    INTEGER(struct transfer_result, left_out, IF_KNOWN | FROM_0),
    STRUCTS(struct transfer_result, functions, 0, function_record),
    FLAG(struct transfer_result, with_curves, 0),
    {0},
};
const struct record transfer_record = RECORD(struct transfer_result, frf_fields);
