#include "record/rows.h"

const char *const whirl_words[] = {"backward", "mixed", "forward", NULL};

TABLE(speed_margin_record, rotid_speed_margin) = {
    NUMBER(rotid_speed_margin, value, MAY_BE_NULL),
    RECORD_ROW(rotid_speed_margin, ci95, FIELD_NUMBER, SHAPE_FIXED, ELEMENTS_MAY_BE_NULL, .fixed = 2),
    NUMBER(rotid_speed_margin, required, MAY_BE_NULL),
    NUMBER(rotid_speed_margin, probability, MAY_BE_NULL | PROBABILITY),
    {0},
};

PART_TABLE(peak_record, rotid_response_peak) = {
    TEXT(rotid_response_peak, probe, 0),
    NUMBER(rotid_response_peak, speed_rpm, ABOVE_0),
    NUMBER(rotid_response_peak, amplitude_m, FROM_0),
    NUMBER(rotid_response_peak, amplification, MAY_BE_NULL | FROM_0),
    {0},
};

PART_TABLE(speed_sensitivity_record, rotid_speed_sensitivity) = {
    KEYS(rotid_speed_sensitivity, 0, parameter, speed, log_decrement),
    NUMBER(rotid_speed_sensitivity, amplitude, MAY_BE_NULL),
    {0},
};

PART_TABLE(critical_record, rotid_critical_speed) = {
    KEYS(rotid_critical_speed, FROM_1, number, mode),
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
    STRUCTS(rotid_critical_speed, variance_shares, 0,
            RECORD_OF(rotid_variance_share, TEXT(rotid_variance_share, source, 0), NUMBER(rotid_variance_share, share, FROM_0))),
    STRUCTS(rotid_critical_speed, sensitivities, 0, speed_sensitivity_record),
    NUMBERS(rotid_critical_speed, z, ROUNDED),
    NUMBERS_BY(rotid_critical_speed, x_re, ROUNDED, nz, "z"),
    NUMBERS_BY(rotid_critical_speed, x_im, ROUNDED, nz, "z"),
    NUMBERS_BY(rotid_critical_speed, y_re, ROUNDED, nz, "z"),
    NUMBERS_BY(rotid_critical_speed, y_im, ROUNDED, nz, "z"),
    {0},
};

PART_TABLE(campbell_mode_record, rotid_campbell_mode) = {
    INTEGER(rotid_campbell_mode, mode, FROM_1),
    NUMBER(rotid_campbell_mode, frequency_hz, ABOVE_0),
    RECORD_ROW(rotid_campbell_mode, ci95, FIELD_NUMBER, SHAPE_FIXED, ELEMENTS_MAY_BE_NULL, .fixed = 2),
    KEYS(rotid_campbell_mode, 0, damping_ratio, log_decrement),
    INTERVAL(rotid_campbell_mode, log_decrement_ci95, ELEMENTS_MAY_BE_NULL),
    TEXT_OF(rotid_campbell_mode, whirl, 0, whirl_words),
    {0},
};

PART_TABLE(campbell_record, rotid_campbell_speed) = {
    NUMBER(rotid_campbell_speed, speed_rpm, FROM_0),
    STRUCTS(rotid_campbell_speed, modes, 0, campbell_mode_record),
    {0},
};

TABLE(stability_record, rotid_stability) = {
    NUMBER(rotid_stability, onset_rpm, MAY_BE_NULL | FROM_0),
    INTEGER(rotid_stability, mode, MAY_BE_NULL | FROM_1),
    NUMBER(rotid_stability, probability_stable, MAY_BE_NULL | PROBABILITY),
    {0},
};

PART_TABLE(response_record, rotid_probe_response) = {
    TEXT(rotid_probe_response, probe, 0),
    NUMBERS(rotid_probe_response, speed_rpm, FROM_0),
    NUMBERS_BY(rotid_probe_response, amplitude_m, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    NUMBERS_BY(rotid_probe_response, phase_deg, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    NUMBERS_BY(rotid_probe_response, from_m, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    NUMBERS_BY(rotid_probe_response, to_m, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    {0},
};

PART_TABLE(load_record, rotid_bearing_load) = {
    TEXT(rotid_bearing_load, bearing, MAY_BE_NULL),
    NUMBER(rotid_bearing_load, position_m, FROM_0),
    KEYS(rotid_bearing_load, 0, load_x_n, load_y_n),
    {0},
};

PART_TABLE(map_record, rotid_map_row) = {
    NUMBER(rotid_map_row, stiffness_factor, ABOVE_0),
    NUMBERS(rotid_map_row, speed_rpm, ABOVE_0),
    NUMBERS_BY(rotid_map_row, from_rpm, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    NUMBERS_BY(rotid_map_row, to_rpm, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    {0},
};

TABLE(runup_record, rotid_runup_speed) = {
    INTEGER(rotid_runup_speed, number, FROM_1),
    TEXT_OF(rotid_runup_speed, whirl, 0, whirl_words),
    KEYS(rotid_runup_speed, ABOVE_0, measured_rpm, measured_std),
    NUMBER(rotid_runup_speed, predicted_rpm, MAY_BE_NULL | ABOVE_0),
    NUMBER(rotid_runup_speed, predicted_std, MAY_BE_NULL | FROM_0),
    NUMBER(rotid_runup_speed, z, MAY_BE_NULL),
    FLAG(rotid_runup_speed, holdout, 0),
    {0},
};

PART_TABLE(torsion_record, rotid_torsional_frequency) = {
    INTEGER(rotid_torsional_frequency, number, FROM_1),
    NUMBER(rotid_torsional_frequency, frequency_hz, ABOVE_0),
    NUMBER(rotid_torsional_frequency, std_hz, FROM_0),
    {0},
};

TABLE(speeds_record, rotid_speeds) = {
    KEYS(rotid_speeds, MAY_BE_NULL | ABOVE_0, low_rpm, high_rpm),
    NUMBER(rotid_speeds, harmonic, ABOVE_0),
    INTEGER(rotid_speeds, draws, FROM_0),
    NUMBER(rotid_speeds, basis_error, MAY_BE_NULL | FROM_0),
    STRUCTS(rotid_speeds, critical_speeds, 0, critical_record),
    STRUCT(rotid_speeds, stability, 0, stability_record),
    STRUCTS(rotid_speeds, campbell, 0, campbell_record),
    STRUCTS(rotid_speeds, excitation, 0,
            RECORD_OF(rotid_excitation, TEXT(rotid_excitation, name, 0), KEYS(rotid_excitation, FROM_0, per_revolution, hz))),
    STRUCTS(rotid_speeds, unbalance, 0, response_record),
    KEYS(rotid_speeds, FROM_0, weight_n, sag_m),
    STRUCTS(rotid_speeds, bearing_loads, 0, load_record),
    STRUCTS(rotid_speeds, map, 0, map_record),
    STRUCTS(rotid_speeds, runup, SINCE_LATER, runup_record),
    STRUCTS(rotid_speeds, torsion, SINCE_LATER, torsion_record),
    {0},
};
