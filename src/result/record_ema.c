#include "record/rows.h"
#include "result/result.h"

const char *const ema_mode_doubts[] = {
    "close to another mode",
    "complex: its points do not move in phase",
    "no stable pole in the table",
    "its frequency differs from point to point (a moving mass, drift), or two peaks in place of one",
    "weak: hardly above the noise",
    "negative damping",
    "at an end of the band",
    "not refined",
    "its modal mass is negative: sign or place of the drive point",
    NULL};
const char *const ema_channel_doubts[] = {
    "dead", "duplicate", "noisy", "not explained by the modes", "values not finite, left out", "low coherence", NULL};
const char *const ema_method_words[] = {"lscf", "quadrature", NULL};
static const char *const grounds[] = {"variance", "residual", NULL};

static const struct record_field source_fields[] = {
    TEXT(struct ema_source, file, 0),
    WORD(struct ema_source, quantity, 0, transfer_quantity_words),
    INTEGER(struct ema_source, transfer_functions, FROM_1),
    INTEGER(struct ema_source, lines, FROM_1),
    NUMBER(struct ema_source, low_hz, FROM_0),
    NUMBER(struct ema_source, high_hz, ABOVE_0),
    FLAG(struct ema_source, from_time_records, 0),
    INTEGER(struct ema_source, impacts, FROM_0),
    INTEGER(struct ema_source, impacts_used, FROM_0),
    NUMBER(struct ema_source, window_decay_per_s, FROM_0),
    {0},
};
static const struct record source_record = RECORD(struct ema_source, source_fields);

static const struct record_field alone_fields[] = {
    NUMBER(struct ema_point_frequency, frequency_hz, MAY_BE_NULL | ABOVE_0),
    NUMBER(struct ema_point_frequency, frequency_std_hz, MAY_BE_NULL | FROM_0),
    {0},
};
static const struct record alone_record = RECORD(struct ema_point_frequency, alone_fields);

static const struct record_field point_fields[] = {
    INTEGER(struct ema_shape_point, node, 0),
    INTEGER(struct ema_shape_point, direction, FROM_0),
    NUMBER(struct ema_shape_point, value, MAY_BE_NULL),
    NUMBER(struct ema_shape_point, std, MAY_BE_NULL | FROM_0),
    NUMBER(struct ema_shape_point, complex_re, MAY_BE_NULL),
    NUMBER(struct ema_shape_point, complex_im, MAY_BE_NULL),
    INLINE(struct ema_shape_point, alone, IF_KNOWN | BEHIND_POINTER, alone_record),
    {0},
};
static const struct record point_record = RECORD(struct ema_shape_point, point_fields);

static const struct record_field mode_fields[] = {
    INTEGER(struct ema_mode_result, mode, FROM_1),
    NUMBER(struct ema_mode_result, frequency_hz, ABOVE_0),
    NUMBER(struct ema_mode_result, frequency_std_hz, MAY_BE_NULL | FROM_0),
    NUMBER(struct ema_mode_result, damping, MAY_BE_NULL),
    NUMBER(struct ema_mode_result, damping_std, MAY_BE_NULL | FROM_0),
    NUMBER(struct ema_mode_result, mpc, MAY_BE_NULL | CORRELATION),
    NUMBER(struct ema_mode_result, mpd_degrees, MAY_BE_NULL | FROM_0),
    NUMBER(struct ema_mode_result, modal_mass_kg, MAY_BE_NULL),
    NUMBER(struct ema_mode_result, peak_signal_to_noise, MAY_BE_NULL | FROM_0),
    NUMBER(struct ema_mode_result, nearest_hz, MAY_BE_NULL | ABOVE_0),
    WORDS(struct ema_mode_result, doubts, 0, ema_mode_doubts),
    STRUCTS(struct ema_mode_result, shape, 0, point_record),
    {0},
};
static const struct record mode_record = RECORD(struct ema_mode_result, mode_fields);

static const struct record_field pole_fields[] = {
    INTEGER(struct ema_pole_result, order, FROM_1),
    NUMBER(struct ema_pole_result, frequency_hz, FROM_0),
    NUMBER(struct ema_pole_result, damping, 0),
    FLAG(struct ema_pole_result, stable_frequency, 0),
    FLAG(struct ema_pole_result, stable_damping, 0),
    INTEGER(struct ema_pole_result, part, FROM_0),
    INTEGER(struct ema_pole_result, mode, MAY_BE_NULL | FROM_1),
    {0},
};
static const struct record pole_record = RECORD(struct ema_pole_result, pole_fields);

static const struct record_field channel_fields[] = {
    INTEGER(struct ema_channel_result, response_node, 0),
    INTEGER(struct ema_channel_result, response_direction, 0),
    INTEGER(struct ema_channel_result, reference_node, 0),
    INTEGER(struct ema_channel_result, reference_direction, 0),
    INTEGER(struct ema_channel_result, averages, FROM_0),
    NUMBER(struct ema_channel_result, frac, MAY_BE_NULL | CORRELATION),
    NUMBER(struct ema_channel_result, noise, MAY_BE_NULL | FROM_0),
    WORDS(struct ema_channel_result, doubts, 0, ema_channel_doubts),
    {0},
};
static const struct record channel_record = RECORD(struct ema_channel_result, channel_fields);

#define CURVE(M) NUMBERS_BY(struct ema_curve, M, ELEMENTS_MAY_BE_NULL | ROUNDED, nfrequency_hz, "frequency_hz")
static const struct record_field curve_fields[] = {
    INTEGER(struct ema_curve, channel, FROM_1),
    NUMBERS(struct ema_curve, frequency_hz, FROM_0),
    CURVE(measured_re),
    CURVE(measured_im),
    CURVE(synthesised_re),
    CURVE(synthesised_im),
    {0},
};
static const struct record curve_record = RECORD(struct ema_curve, curve_fields);

#define RMS(M)                                                                                                                   \
    NUMBERS_BY(struct ema_result, M, ELEMENTS_MAY_BE_NULL | ROUNDED | SINCE_LATER, nrms_frequency_hz, "rms_frequency_hz")
static const struct record_field ema_fields[] = {
    STRUCT(struct ema_result, source, 0, source_record),
    WORD(struct ema_result, method, 0, ema_method_words),
    INTEGER(struct ema_result, order, FROM_0),
    FLAG(struct ema_result, refined, 0),
    WORD(struct ema_result, std_from, 0, grounds),
    TEXT(struct ema_result, output, MAY_BE_NULL),
    STRUCTS(struct ema_result, modes, 0, mode_record),
    MATRIX(struct ema_result, mac, ELEMENTS_MAY_BE_NULL | CORRELATION, nmodes, nmodes),
    STRUCTS(struct ema_result, stabilisation, 0, pole_record),
    STRUCTS(struct ema_result, channels, 0, channel_record),
    NUMBERS(struct ema_result, rms_frequency_hz, FROM_0 | SINCE_LATER),
    RMS(rms_measured),
    RMS(rms_synthesised),
    STRUCTS(struct ema_result, curves, SINCE_LATER, curve_record),
    NUMBER(struct ema_result, seconds, FROM_0),
    {0},
};
const struct record ema_record = RECORD(struct ema_result, ema_fields);
