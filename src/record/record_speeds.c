#include "record/rows.h"

const char *const whirl_words[] = {"backward", "mixed", "forward", NULL};

static const struct record_field margin_fields[] = {
    NUMBER(rotid_speed_margin, value, MAY_BE_NULL),
    RECORD_ROW(rotid_speed_margin, ci95, FIELD_NUMBER, SHAPE_FIXED, ELEMENTS_MAY_BE_NULL, .fixed = 2),
    NUMBER(rotid_speed_margin, required, MAY_BE_NULL),
    NUMBER(rotid_speed_margin, probability, MAY_BE_NULL | PROBABILITY),
    {0},
};
const struct record speed_margin_record = RECORD(rotid_speed_margin, margin_fields);

static const struct record_field peak_fields[] = {
    TEXT(rotid_response_peak, probe, 0),
    NUMBER(rotid_response_peak, speed_rpm, ABOVE_0),
    NUMBER(rotid_response_peak, amplitude_m, FROM_0),
    NUMBER(rotid_response_peak, amplification, MAY_BE_NULL | FROM_0),
    {0},
};
static const struct record peak_record = RECORD(rotid_response_peak, peak_fields);

static const struct record_field share_fields[] = {
    TEXT(rotid_variance_share, source, 0),
    NUMBER(rotid_variance_share, share, FROM_0),
    {0},
};
static const struct record share_record = RECORD(rotid_variance_share, share_fields);

static const struct record_field sensitivity_fields[] = {
    TEXT(rotid_speed_sensitivity, parameter, 0),
    NUMBER(rotid_speed_sensitivity, speed, 0),
    NUMBER(rotid_speed_sensitivity, log_decrement, 0),
    NUMBER(rotid_speed_sensitivity, amplitude, MAY_BE_NULL),
    {0},
};
static const struct record sensitivity_record = RECORD(rotid_speed_sensitivity, sensitivity_fields);

static const struct record_field critical_fields[] = {
    INTEGER(rotid_critical_speed, number, FROM_1),
    INTEGER(rotid_critical_speed, mode, FROM_1),
    NUMBER(rotid_critical_speed, speed_rpm, ABOVE_0),
    NUMBER(rotid_critical_speed, std, MAY_BE_NULL | FROM_0),
    RECORD_ROW(rotid_critical_speed, ci95, FIELD_NUMBER, SHAPE_FIXED, ELEMENTS_MAY_BE_NULL, .fixed = 2),
    TEXT_OF(rotid_critical_speed, whirl, 0, whirl_words),
    NUMBER(rotid_critical_speed, log_decrement, 0),
    INTERVAL(rotid_critical_speed, log_decrement_ci95, ELEMENTS_MAY_BE_NULL),
    NUMBER(rotid_critical_speed, damping_ratio, 0),
    NUMBER(rotid_critical_speed, amplification, MAY_BE_NULL | FROM_0),
    STRUCT(rotid_critical_speed, margin, 0, speed_margin_record),
    STRUCTS(rotid_critical_speed, peaks, 0, peak_record),
    STRUCTS(rotid_critical_speed, variance_shares, 0, share_record),
    STRUCTS(rotid_critical_speed, sensitivities, 0, sensitivity_record),
    NUMBERS(rotid_critical_speed, z, ROUNDED),
    NUMBERS_BY(rotid_critical_speed, x_re, ROUNDED, nz, "z"),
    NUMBERS_BY(rotid_critical_speed, x_im, ROUNDED, nz, "z"),
    NUMBERS_BY(rotid_critical_speed, y_re, ROUNDED, nz, "z"),
    NUMBERS_BY(rotid_critical_speed, y_im, ROUNDED, nz, "z"),
    {0},
};
static const struct record critical_record = RECORD(rotid_critical_speed, critical_fields);

static const struct record_field mode_fields[] = {
    INTEGER(rotid_campbell_mode, mode, FROM_1),
    NUMBER(rotid_campbell_mode, frequency_hz, ABOVE_0),
    RECORD_ROW(rotid_campbell_mode, ci95, FIELD_NUMBER, SHAPE_FIXED, ELEMENTS_MAY_BE_NULL, .fixed = 2),
    NUMBER(rotid_campbell_mode, damping_ratio, 0),
    NUMBER(rotid_campbell_mode, log_decrement, 0),
    INTERVAL(rotid_campbell_mode, log_decrement_ci95, ELEMENTS_MAY_BE_NULL),
    TEXT_OF(rotid_campbell_mode, whirl, 0, whirl_words),
    {0},
};
static const struct record mode_record = RECORD(rotid_campbell_mode, mode_fields);

static const struct record_field campbell_fields[] = {
    NUMBER(rotid_campbell_speed, speed_rpm, FROM_0),
    STRUCTS(rotid_campbell_speed, modes, 0, mode_record),
    {0},
};
static const struct record campbell_record = RECORD(rotid_campbell_speed, campbell_fields);

static const struct record_field stability_fields[] = {
    NUMBER(rotid_stability, onset_rpm, MAY_BE_NULL | FROM_0),
    INTEGER(rotid_stability, mode, MAY_BE_NULL | FROM_1),
    NUMBER(rotid_stability, probability_stable, MAY_BE_NULL | PROBABILITY),
    {0},
};
const struct record stability_record = RECORD(rotid_stability, stability_fields);

static const struct record_field response_fields[] = {
    TEXT(rotid_probe_response, probe, 0),
    NUMBERS(rotid_probe_response, speed_rpm, FROM_0),
    NUMBERS_BY(rotid_probe_response, amplitude_m, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    NUMBERS_BY(rotid_probe_response, phase_deg, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    NUMBERS_BY(rotid_probe_response, from_m, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    NUMBERS_BY(rotid_probe_response, to_m, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    {0},
};
static const struct record response_record = RECORD(rotid_probe_response, response_fields);

static const struct record_field load_fields[] = {
    TEXT(rotid_bearing_load, bearing, MAY_BE_NULL),
    NUMBER(rotid_bearing_load, position_m, FROM_0),
    NUMBER(rotid_bearing_load, load_x_n, 0),
    NUMBER(rotid_bearing_load, load_y_n, 0),
    {0},
};
static const struct record load_record = RECORD(rotid_bearing_load, load_fields);

static const struct record_field map_fields[] = {
    NUMBER(rotid_map_row, stiffness_factor, ABOVE_0),
    NUMBERS(rotid_map_row, speed_rpm, ABOVE_0),
    NUMBERS_BY(rotid_map_row, from_rpm, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    NUMBERS_BY(rotid_map_row, to_rpm, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    {0},
};
static const struct record map_record = RECORD(rotid_map_row, map_fields);

static const struct record_field excitation_fields[] = {
    TEXT(rotid_excitation, name, 0),
    NUMBER(rotid_excitation, per_revolution, FROM_0),
    NUMBER(rotid_excitation, hz, FROM_0),
    {0},
};
static const struct record excitation_record = RECORD(rotid_excitation, excitation_fields);

static const struct record_field runup_fields[] = {
    INTEGER(rotid_runup_speed, number, FROM_1),
    TEXT_OF(rotid_runup_speed, whirl, 0, whirl_words),
    NUMBER(rotid_runup_speed, measured_rpm, ABOVE_0),
    NUMBER(rotid_runup_speed, measured_std, ABOVE_0),
    NUMBER(rotid_runup_speed, predicted_rpm, MAY_BE_NULL | ABOVE_0),
    NUMBER(rotid_runup_speed, predicted_std, MAY_BE_NULL | FROM_0),
    NUMBER(rotid_runup_speed, z, MAY_BE_NULL),
    FLAG(rotid_runup_speed, holdout, 0),
    {0},
};
const struct record runup_record = RECORD(rotid_runup_speed, runup_fields);

static const struct record_field torsion_fields[] = {
    INTEGER(rotid_torsional_frequency, number, FROM_1),
    NUMBER(rotid_torsional_frequency, frequency_hz, ABOVE_0),
    NUMBER(rotid_torsional_frequency, std_hz, FROM_0),
    {0},
};
static const struct record torsion_record = RECORD(rotid_torsional_frequency, torsion_fields);

static const struct record_field speeds_fields[] = {
    NUMBER(rotid_speeds, low_rpm, MAY_BE_NULL | ABOVE_0),
    NUMBER(rotid_speeds, high_rpm, MAY_BE_NULL | ABOVE_0),
    NUMBER(rotid_speeds, harmonic, ABOVE_0),
    INTEGER(rotid_speeds, draws, FROM_0),
    NUMBER(rotid_speeds, basis_error, MAY_BE_NULL | FROM_0),
    STRUCTS(rotid_speeds, critical_speeds, 0, critical_record),
    STRUCT(rotid_speeds, stability, 0, stability_record),
    STRUCTS(rotid_speeds, campbell, 0, campbell_record),
    STRUCTS(rotid_speeds, excitation, 0, excitation_record),
    STRUCTS(rotid_speeds, unbalance, 0, response_record),
    NUMBER(rotid_speeds, weight_n, FROM_0),
    NUMBER(rotid_speeds, sag_m, FROM_0),
    STRUCTS(rotid_speeds, bearing_loads, 0, load_record),
    STRUCTS(rotid_speeds, map, 0, map_record),
    STRUCTS(rotid_speeds, runup, SINCE_LATER, runup_record),
    STRUCTS(rotid_speeds, torsion, SINCE_LATER, torsion_record),
    {0},
};
const struct record speeds_record = RECORD(rotid_speeds, speeds_fields);

static const struct record_field speeds_whole_fields[] = {
    ROWS(0, speeds_record),
    STRUCTS(rotid_speeds, message, 0, message_record),
    {0},
};
const struct record speeds_whole_record = RECORD(rotid_speeds, speeds_whole_fields);
