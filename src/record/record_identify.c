#include "record/rows.h"

const char *const functional_words[] = {"LIKELIHOOD", "HYBRID", "HYBRID_F", NULL};
const char *const reduction_words[] = {"NONE", "GUYAN", "IRS", NULL};
const char *const derivative_words[] = {"NELSON", "MODAL", NULL};
const char *const fit_status_words[] = {"converged", "not_converged", "at_bound", NULL};
const char *const mode_type_words[] = {"BENDING", "TORSION", "AXIAL", NULL}; /* ROTID_BENDING ... */
const char *const pairing_words[] = {"shape", "number", NULL};
static const char *const algorithms[] = {"LN_BOBYQA", "LN_SBPLX", "LD_SLSQP", NULL};
static const char *const grounds[] = {"noise", "residuals", NULL};

TABLE(fitted_parameter_record, rotid_fitted_parameter) = {
    KEYS(rotid_fitted_parameter, 0, name, unit, value, start, lower, upper),
    NUMBER(rotid_fitted_parameter, std, MAY_BE_NULL | FROM_0),
    INTERVAL(rotid_fitted_parameter, ci95, 0),
    FLAGS(rotid_fitted_parameter, 0, at_bound, identifiable),
    {0},
};

TABLE(compared_mode_record, rotid_compared_mode) = {
    INTEGER(rotid_compared_mode, mode, FROM_1),
    INTEGER(rotid_compared_mode, measured_mode, FROM_1 | SINCE_LATER),
    NUMBER(rotid_compared_mode, measured_hz, ABOVE_0),
    NUMBER(rotid_compared_mode, frequency_std, MAY_BE_NULL | ABOVE_0 | SINCE_LATER),
    NUMBER(rotid_compared_mode, predicted_hz, FROM_0),
    NUMBER(rotid_compared_mode, error_percent, 0),
    KEYS(rotid_compared_mode, MAY_BE_NULL | CORRELATION, mac, nco),
    TEXT_OF(rotid_compared_mode, paired_by, 0, pairing_words),
    FLAG(rotid_compared_mode, holdout, 0),
    NUMBER(rotid_compared_mode, residual, 0),
    TEXT_OF(rotid_compared_mode, type, SINCE_LATER, mode_type_words),
    {0},
};

PART_TABLE(member_record, rotid_member_shape) = {
    TEXT(rotid_member_shape, name, MAY_BE_NULL),
    NUMBERS(rotid_member_shape, z_m, ROUNDED),
    NUMBERS_BY(rotid_member_shape, shape, ELEMENTS_MAY_BE_NULL | ROUNDED, nz_m, "z_m"),
    {0},
};

PART_TABLE(mode_shapes_record, rotid_mode_shapes) = {
    INTEGER(rotid_mode_shapes, mode, FROM_1),
    INTEGER(rotid_mode_shapes, measured_mode, FROM_1 | SINCE_LATER),
    NUMBERS_AS(rotid_mode_shapes, measured, MAY_BE_NULL | ELEMENTS_MAY_BE_NULL | ROUNDED, rotid_shapes, sensor_id),
    NUMBERS_AS(rotid_mode_shapes, measured_std, MAY_BE_NULL | ELEMENTS_MAY_BE_NULL | FROM_0 | ROUNDED, rotid_shapes, sensor_id),
    NUMBERS_AS(rotid_mode_shapes, predicted, ELEMENTS_MAY_BE_NULL | ROUNDED, rotid_shapes, sensor_id),
    NUMBERS_AS(rotid_mode_shapes, predicted_axis, ELEMENTS_MAY_BE_NULL | ROUNDED, rotid_shapes, axis_z_m),
    STRUCTS(rotid_mode_shapes, tierods, 0, member_record),
    STRUCTS(rotid_mode_shapes, bars, 0, member_record),
    {0},
};

PART_TABLE(shapes_record, rotid_shapes) = {
    INTEGERS(rotid_shapes, sensor_id, 0),
    NUMBERS_BY(rotid_shapes, z_m, FROM_0 | ROUNDED, nsensor_id, "sensor_id"),
    NUMBERS(rotid_shapes, axis_z_m, FROM_0 | ROUNDED),
    STRUCTS(rotid_shapes, modes, 0, mode_shapes_record),
    {0},
};

PART_TABLE(history_record, rotid_history_entry) = {
    KEYS(rotid_history_entry, FROM_0, iteration, objective, gradient, mu),
    NUMBER(rotid_history_entry, gain_ratio, MAY_BE_NULL),
    NUMBER(rotid_history_entry, step, FROM_0),
    NUMBER(rotid_history_entry, seconds, FROM_0 | SINCE_LATER),
    NUMBERS_AS(rotid_history_entry, x, 0, rotid_identification, parameters),
    {0},
};

PART_TABLE(minimiser_record, rotid_minimiser) = {
    TEXT_OF(rotid_minimiser, algorithm, 0, algorithms),
    TEXT(rotid_minimiser, result, 0),
    FLAG(rotid_minimiser, usable, 0),
    KEYS(rotid_minimiser, MAY_BE_NULL | FROM_0, objective, gradient),
    KEYS(rotid_minimiser, FROM_0, evaluations, seconds),
    NUMBERS_AS(rotid_minimiser, x, 0, rotid_identification, parameters),
    NUMBERS_AS(rotid_minimiser, predicted_hz, ELEMENTS_MAY_BE_NULL | FROM_0 | SINCE_LATER, rotid_identification, modes),
    {0},
};

TABLE(noise_record, rotid_noise) = {
    KEYS(rotid_noise, MAY_BE_NULL | FROM_0, frequency, shape),
    FLAGS(rotid_noise, 0, frequency_assumed, shape_assumed),
    TEXT_OF(rotid_noise, intervals_from, IF_KNOWN, grounds),
    {0},
};

static const char *const weighed_words[] = {"mass", "centre", NULL};
TABLE(weighed_record, rotid_weighed) = {
    TEXT_OF(rotid_weighed, quantity, 0, weighed_words),
    TEXT(rotid_weighed, unit, 0),
    TEXT(rotid_weighed, state, IF_KNOWN),
    NUMBER(rotid_weighed, measured, 0),
    NUMBER(rotid_weighed, std, ABOVE_0),
    KEYS(rotid_weighed, 0, predicted, z),
    {0},
};

/* Rows of a model beside measured modes: of all states, and of each. SINCE: bits of what older results lack. */
#define COMPARED_ROWS(S, SINCE)                                                                                                  \
    STRUCTS(S, modes, NOT_EMPTY, compared_mode_record),                                                                          \
        NUMBERS_BY(S, reduction_error_percent, ELEMENTS_MAY_BE_NULL, nmodes, "modes"),                                           \
        NUMBERS_BY(S, mesh_error_percent, ELEMENTS_MAY_BE_NULL, nmodes, "modes"), NUMBER(S, mass_kg, ABOVE_0),                   \
        NUMBER(S, center_of_mass_m, 0), STRUCT(S, shapes, MAY_BE_NULL | BEHIND_POINTER | (SINCE), shapes_record),                \
        MATRIX(S, nco_matrix, MAY_BE_NULL | ELEMENTS_MAY_BE_NULL | CORRELATION | ROUNDED | (SINCE), nmatrix_rows,                \
               nmatrix_columns),                                                                                                 \
        MATRIX(S, mac_matrix, MAY_BE_NULL | ELEMENTS_MAY_BE_NULL | CORRELATION | ROUNDED | (SINCE), nmatrix_rows,                \
               nmatrix_columns),                                                                                                 \
        INTEGERS_BY(S, matrix_rows, FROM_1 | (SINCE), nmatrix_rows, "rows of mac_matrix"),                                       \
        INTEGERS_BY(S, matrix_columns, FROM_1 | (SINCE), nmatrix_columns, "columns of mac_matrix")

PART_TABLE(state_record, rotid_identified_state) = {
    TEXT(rotid_identified_state, name, 0),
    INTEGER(rotid_identified_state, fitted_residuals, FROM_0),
    FLAG(rotid_identified_state, shapes_fitted, 0),
    NUMBER(rotid_identified_state, objective, FROM_0),
    NUMBER(rotid_identified_state, chi2, MAY_BE_NULL | FROM_0),
    COMPARED_ROWS(rotid_identified_state, 0),
    STRUCT(rotid_identified_state, noise, BEHIND_POINTER, noise_record),
    STRUCT(rotid_identified_state, geometry, BEHIND_POINTER, geometry_record),
    {0},
};

TABLE(identification_record, rotid_identification) = {
    TEXT_OF(rotid_identification, status, 0, fit_status_words),
    TEXT_OF(rotid_identification, functional, 0, functional_words),
    TEXT_OF(rotid_identification, reduction, 0, reduction_words),
    TEXT_OF(rotid_identification, derivative, 0, derivative_words),
    FLAG(rotid_identification, shapes_fitted, SINCE_LATER),
    NUMBER(rotid_identification, bijection_chi, ABOVE_0 | SINCE_LATER),
    KEYS(rotid_identification, FROM_0, objective, gradient),
    KEYS(rotid_identification, MAY_BE_NULL | FROM_0, chi2, chi2_per_dof),
    INTEGER(rotid_identification, dof, 0),
    INTEGER(rotid_identification, iterations, FROM_0),
    INTEGER(rotid_identification, evaluations, FROM_1),
    INTEGER(rotid_identification, jacobians, FROM_0),
    TEXT(rotid_identification, stop_reason, 0),
    STRUCTS(rotid_identification, parameters, 0, fitted_parameter_record),
    MATRIX(rotid_identification, correlation, ELEMENTS_MAY_BE_NULL, nparameters, nparameters),
    NUMBER(rotid_identification, condition_number, MAY_BE_NULL | FROM_0),
    MAPS(rotid_identification, undetermined_directions, 0, nparameters),
    NUMBER(rotid_identification, intervals_widened_by, FROM_1),
    COMPARED_ROWS(rotid_identification, SINCE_LATER),
    STRUCTS(rotid_identification, history, NOT_EMPTY, history_record),
    FLAG(rotid_identification, nlopt, SINCE_LATER),
    STRUCTS(rotid_identification, baseline, 0, minimiser_record),
    NUMBER(rotid_identification, seconds, FROM_0),
    STRUCTS(rotid_identification, runup, SINCE_LATER, runup_record),
    STRUCTS(rotid_identification, weighed, SINCE_LATER, weighed_record),
    STRUCTS(rotid_identification, states, IF_KNOWN, state_record),
    {0},
};

TABLE(hidden_cause_record, rotid_hidden) = {
    KEYS(rotid_hidden, 0, parameter, shift, unit, id, target, component, size, size_unit),
    KEYS(rotid_hidden, MAY_BE_NULL, z_m, width_m),
    FLAG(rotid_hidden, beyond, 0),
    {0},
};

TABLE(identification_alone_record, rotid_identification) = {
    STRUCT(rotid_identification, noise, SINCE_LATER | BEHIND_POINTER, noise_record),
    STRUCT(rotid_identification, geometry, SINCE_LATER | BEHIND_POINTER, geometry_record),
    STRUCTS(rotid_identification, hidden, SINCE_LATER, hidden_cause_record),
    {0},
};

TABLE(identification_whole_record, rotid_identification) = {
    ROWS(0, identification_record),
    ROWS(0, identification_alone_record),
    {0},
};
