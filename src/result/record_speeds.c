#include "record/rows.h"
#include "result/result.h"
#include "running/running.h"

static const struct record_field margin_fields[] = {
    NUMBER(struct margin, value, MAY_BE_NULL),
    RECORD_ROW(struct margin, ci95, FIELD_NUMBER, SHAPE_FIXED, ELEMENTS_MAY_BE_NULL, .fixed = 2),
    NUMBER(struct margin, required, MAY_BE_NULL),
    NUMBER(struct margin, probability, MAY_BE_NULL | PROBABILITY),
    {0},
};
static const struct record margin_record = RECORD(struct margin, margin_fields);

static const struct record_field peak_fields[] = {
    TEXT(struct peak, probe, 0),
    NUMBER(struct peak, speed_rpm, ABOVE_0),
    NUMBER(struct peak, amplitude_m, FROM_0),
    NUMBER(struct peak, amplification, MAY_BE_NULL | FROM_0),
    {0},
};
static const struct record peak_record = RECORD(struct peak, peak_fields);

static const struct record_field share_fields[] = {
    TEXT(struct variance_share, source, 0),
    NUMBER(struct variance_share, share, FROM_0),
    {0},
};
static const struct record share_record = RECORD(struct variance_share, share_fields);

static const struct record_field critical_fields[] = {
    INTEGER(struct critical_speed, number, FROM_1),
    INTEGER(struct critical_speed, mode, FROM_1),
    NUMBER(struct critical_speed, speed_rpm, ABOVE_0),
    NUMBER(struct critical_speed, std, MAY_BE_NULL | FROM_0),
    RECORD_ROW(struct critical_speed, ci95, FIELD_NUMBER, SHAPE_FIXED, ELEMENTS_MAY_BE_NULL, .fixed = 2),
    TEXT_OF(struct critical_speed, whirl, 0, whirl_words),
    NUMBER(struct critical_speed, log_decrement, 0),
    NUMBER(struct critical_speed, damping_ratio, 0),
    NUMBER(struct critical_speed, amplification, MAY_BE_NULL | FROM_0),
    STRUCT(struct critical_speed, margin, 0, margin_record),
    STRUCTS(struct critical_speed, peaks, 0, peak_record),
    STRUCTS(struct critical_speed, variance_shares, 0, share_record),
    NUMBERS(struct critical_speed, z, ROUNDED),
    NUMBERS_BY(struct critical_speed, x_re, ROUNDED, nz, "z"),
    NUMBERS_BY(struct critical_speed, x_im, ROUNDED, nz, "z"),
    NUMBERS_BY(struct critical_speed, y_re, ROUNDED, nz, "z"),
    NUMBERS_BY(struct critical_speed, y_im, ROUNDED, nz, "z"),
    {0},
};
static const struct record critical_record = RECORD(struct critical_speed, critical_fields);

static const struct record_field mode_fields[] = {
    INTEGER(struct campbell_mode, mode, FROM_1),
    NUMBER(struct campbell_mode, frequency_hz, ABOVE_0),
    RECORD_ROW(struct campbell_mode, ci95, FIELD_NUMBER, SHAPE_FIXED, ELEMENTS_MAY_BE_NULL, .fixed = 2),
    NUMBER(struct campbell_mode, damping_ratio, 0),
    NUMBER(struct campbell_mode, log_decrement, 0),
    TEXT_OF(struct campbell_mode, whirl, 0, whirl_words),
    {0},
};
static const struct record mode_record = RECORD(struct campbell_mode, mode_fields);

static const struct record_field campbell_fields[] = {
    NUMBER(struct campbell_speed, speed_rpm, FROM_0),
    STRUCTS(struct campbell_speed, modes, 0, mode_record),
    {0},
};
static const struct record campbell_record = RECORD(struct campbell_speed, campbell_fields);

static const struct record_field stability_fields[] = {
    NUMBER(struct stability, onset_rpm, MAY_BE_NULL | FROM_0),
    INTEGER(struct stability, mode, MAY_BE_NULL | FROM_1),
    NUMBER(struct stability, probability_stable, MAY_BE_NULL | PROBABILITY),
    {0},
};
static const struct record stability_record = RECORD(struct stability, stability_fields);

static const struct record_field response_fields[] = {
    TEXT(struct probe_response, probe, 0),
    NUMBERS(struct probe_response, speed_rpm, FROM_0),
    NUMBERS_BY(struct probe_response, amplitude_m, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    NUMBERS_BY(struct probe_response, phase_deg, ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, nspeed_rpm, "speed_rpm"),
    {0},
};
static const struct record response_record = RECORD(struct probe_response, response_fields);

static const struct record_field load_fields[] = {
    TEXT(struct bearing_load, bearing, MAY_BE_NULL),
    NUMBER(struct bearing_load, position_m, FROM_0),
    NUMBER(struct bearing_load, load_x_n, 0),
    NUMBER(struct bearing_load, load_y_n, 0),
    {0},
};
static const struct record load_record = RECORD(struct bearing_load, load_fields);

static const struct record_field map_fields[] = {
    NUMBER(struct map_row, stiffness_factor, ABOVE_0),
    NUMBERS(struct map_row, speed_rpm, ABOVE_0),
    {0},
};
static const struct record map_record = RECORD(struct map_row, map_fields);

static const struct record_field speeds_fields[] = {
    NUMBER(struct speeds, low_rpm, MAY_BE_NULL | ABOVE_0),
    NUMBER(struct speeds, high_rpm, MAY_BE_NULL | ABOVE_0),
    NUMBER(struct speeds, harmonic, ABOVE_0),
    INTEGER(struct speeds, draws, FROM_0),
    NUMBER(struct speeds, basis_error, MAY_BE_NULL | FROM_0),
    STRUCTS(struct speeds, critical_speeds, 0, critical_record),
    STRUCT(struct speeds, stability, 0, stability_record),
    STRUCTS(struct speeds, campbell, 0, campbell_record),
    STRUCTS(struct speeds, unbalance, 0, response_record),
    NUMBER(struct speeds, weight_n, FROM_0),
    NUMBER(struct speeds, sag_m, FROM_0),
    STRUCTS(struct speeds, bearing_loads, 0, load_record),
    STRUCTS(struct speeds, map, 0, map_record),
    {0},
};
const struct record speeds_record = RECORD(struct speeds, speeds_fields);
