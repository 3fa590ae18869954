#include "record/rows.h"

const char *const verdict_words[] = {"adequate", "named", "ambiguous", "unexplained", NULL}; /* ROTID_ADEQUATE ... */
static const char *const blocks[] = {"SHAPE", "FREQUENCY", NULL};

PART_TABLE(cause_value_record, rotid_cause_value) = {
    TEXT(rotid_cause_value, name, 0),
    TEXT(rotid_cause_value, unit, MAY_BE_NULL),
    NUMBER(rotid_cause_value, value, 0),
    NUMBER(rotid_cause_value, std, MAY_BE_NULL | FROM_0),
    INTERVAL(rotid_cause_value, ci95, 0),
    FLAG(rotid_cause_value, fixed, 0),
    {0},
};

TABLE(cause_record, rotid_cause) = {
    KEYS(rotid_cause, 0, id, target),
    TEXT(rotid_cause, name, MAY_BE_NULL),
    TEXT(rotid_cause, variant, MAY_BE_NULL | SINCE_LATER),
    STRUCTS(rotid_cause, parameters, 0, cause_value_record),
    TEXT(rotid_cause, state, MAY_BE_NULL | SINCE_LATER),
    {0},
};

PART_TABLE(explanation_record, rotid_explanation) = {
    STRUCTS(rotid_explanation, causes, 0, cause_record),
    FLAG(rotid_explanation, something_else, 0),
    NUMBER(rotid_explanation, probability, PROBABILITY),
    NUMBER(rotid_explanation, at_rest, SINCE_LATER | MAY_BE_NULL | PROBABILITY),
    STRUCTS(rotid_explanation, identified, 0, cause_value_record),
    {0},
};

PART_TABLE(marginal_record, rotid_marginal) = {
    KEYS(rotid_marginal, 0, id, target),
    KEYS(rotid_marginal, MAY_BE_NULL, state, z_m),
    NUMBER(rotid_marginal, probability, PROBABILITY),
    {0},
};

PART_TABLE(averaged_record, rotid_averaged_parameter) = {
    KEYS(rotid_averaged_parameter, 0, name, unit, value),
    NUMBER(rotid_averaged_parameter, std, FROM_0),
    INTERVAL(rotid_averaged_parameter, ci95, 0),
    {0},
};
TABLE(verdict_record, rotid_verdict) = {
    WORD(rotid_verdict, kind, MAY_BE_NULL, verdict_words),
    FLAG(rotid_verdict, adequate_after, 0),
    NUMBER(rotid_verdict, p_value, MAY_BE_NULL | PROBABILITY),
    STRUCTS(rotid_verdict, causes, 0, cause_record),
    STRUCTS(rotid_verdict, likely_causes, SINCE_LATER, cause_record),
    TEXTS(rotid_verdict, alternatives, 0),
    STRUCTS(rotid_verdict, alternative_causes, 0, cause_record),
    INTEGERS(rotid_verdict, alternative_sets, SINCE_LATER),
    KEYS(rotid_verdict, MAY_BE_NULL, next_measurement, sentence),
    INTEGER(rotid_verdict, undetermined_parameters, FROM_0),
    FLAG(rotid_verdict, confident, SINCE_LATER),
    STRUCTS(rotid_verdict, explanations, SINCE_LATER, explanation_record),
    STRUCTS(rotid_verdict, marginals, SINCE_LATER, marginal_record),
    KEYS(rotid_verdict, SINCE_LATER | MAY_BE_NULL | PROBABILITY, nothing, nothing_prior, something_else, runup_p),
    {0},
};

TABLE(data_finding_record, rotid_data_finding) = {
    TEXT(rotid_data_finding, id, 0),
    INTEGERS(rotid_data_finding, sensors, 0),
    INTEGERS(rotid_data_finding, modes, 0),
    TEXT_OF(rotid_data_finding, block, MAY_BE_NULL, blocks),
    KEYS(rotid_data_finding, MAY_BE_NULL, value, unit, std, chi2_drop, text),
    TEXT(rotid_data_finding, state, MAY_BE_NULL | SINCE_LATER),
    STRUCTS(rotid_data_finding, parameters, SINCE_LATER, cause_value_record),
    {0},
};

PART_TABLE(numerical_finding_record, rotid_numerical_finding) = {
    TEXT(rotid_numerical_finding, id, 0),
    INTEGERS(rotid_numerical_finding, modes, 0),
    NUMBERS_BY(rotid_numerical_finding, error_percent, ELEMENTS_MAY_BE_NULL, nmodes, "modes"),
    TEXT(rotid_numerical_finding, text, MAY_BE_NULL),
    TEXT(rotid_numerical_finding, state, MAY_BE_NULL | SINCE_LATER),
    {0},
};

PART_TABLE(round_record, rotid_round) = {
    INTEGER(rotid_round, round, FROM_1),
    KEYS(rotid_round, MAY_BE_NULL, chi2, chi2_frequency),
    INTEGER(rotid_round, dof, 0),
    INTEGER(rotid_round, frequencies, FROM_0),
    KEYS(rotid_round, MAY_BE_NULL, largest),
    KEYS(rotid_round, MAY_BE_NULL | PROBABILITY, p_frequency, p_total),
    {0},
};

PART_TABLE(candidate_record, rotid_candidate) = {
    INTEGER(rotid_candidate, round, FROM_1),
    INLINE(rotid_candidate, cause, 0, cause_record),
    FLAGS(rotid_candidate, 0, suspect, refitted),
    KEYS(rotid_candidate, MAY_BE_NULL, predicted_drop, chi2, chi2_frequency, chi2_drop),
    KEYS(rotid_candidate, MAY_BE_NULL | FROM_0, holdout_rms, sensor_out_rms),
    FLAG(rotid_candidate, at_bound, 0),
    NUMBER(rotid_candidate, probability, PROBABILITY),
    {0},
};

PART_TABLE(pair_record, rotid_pair) = {
    KEYS(rotid_pair, MAY_BE_NULL, before, after),
    {0},
};

PART_TABLE(changed_parameter_record, rotid_changed_parameter) = {
    KEYS(rotid_changed_parameter, 0, name, unit),
    KEYS(rotid_changed_parameter, MAY_BE_NULL, before, after),
    INTERVAL(rotid_changed_parameter, before_ci95, 0),
    INTERVAL(rotid_changed_parameter, after_ci95, 0),
    {0},
};

PART_TABLE(gain_record, rotid_gain) = {
    RECORDS(rotid_gain, pair_record, frequency_rms_percent, frequency_max_percent, shape_rms, chi2_per_dof, nco_min,
            holdout_frequency_rms_percent, holdout_shape_rms, mode_out_frequency_rms_percent, mode_out_shape_rms,
            sensor_out_shape_rms),
    STRUCTS(rotid_gain, parameters, 0, changed_parameter_record),
    {0},
};

PART_TABLE(sensor_residual_record, rotid_sensor_residual) = {
    KEYS(rotid_sensor_residual, 0, id, z_m),
    NUMBER(rotid_sensor_residual, rms, MAY_BE_NULL | FROM_0),
    TEXT(rotid_sensor_residual, state, MAY_BE_NULL | SINCE_LATER),
    {0},
};

TABLE(detectable_record, rotid_detectable) = {
    KEYS(rotid_detectable, 0, id, target, parameter),
    KEYS(rotid_detectable, MAY_BE_NULL, smallest, unit, z_m, worst),
    FLAG(rotid_detectable, beyond, 0),
    {0},
};

TABLE(diagnosis_record, rotid_diagnosis) = {
    FLAG(rotid_diagnosis, interrupted, 0),
    KEYS(rotid_diagnosis, MAY_BE_NULL | SINCE_LATER, before, after),
    STRUCT(rotid_diagnosis, verdict, 0, verdict_record),
    STRUCTS(rotid_diagnosis, data_findings, 0, data_finding_record),
    STRUCTS(rotid_diagnosis, numerical_findings, 0, numerical_finding_record),
    STRUCTS(rotid_diagnosis, rounds, 0, round_record),
    STRUCTS(rotid_diagnosis, candidates, 0, candidate_record),
    STRUCT(rotid_diagnosis, gain, 0, gain_record),
    NUMBERS(rotid_diagnosis, modes_standardised, ELEMENTS_MAY_BE_NULL),
    STRUCTS(rotid_diagnosis, sensors, 0, sensor_residual_record),
    STRUCTS(rotid_diagnosis, localisation, 0,
            RECORD_OF(rotid_localisation, NUMBER(rotid_localisation, z_m, 0),
                      NUMBER(rotid_localisation, indicator, MAY_BE_NULL))),
    STRUCTS(rotid_diagnosis, detectable, 0, detectable_record),
    STRUCTS(rotid_diagnosis, hidden, SINCE_LATER, hidden_cause_record),
    STRUCTS(rotid_diagnosis, parameters, SINCE_LATER, averaged_record),
    STRUCT(rotid_diagnosis, noise, SINCE_LATER, noise_record),
    STRUCT(rotid_diagnosis, geometry, SINCE_LATER | BEHIND_POINTER, geometry_record),
    STRUCT(rotid_diagnosis, today, MAY_BE_NULL | BEHIND_POINTER, identification_record),
    STRUCT(rotid_diagnosis, base, MAY_BE_NULL | BEHIND_POINTER, identification_record),
    STRUCT(rotid_diagnosis, extended, MAY_BE_NULL | BEHIND_POINTER, identification_record),
    STRUCTS(rotid_diagnosis, steps, SINCE_LATER,
            RECORD_OF(rotid_step, TEXT(rotid_step, name, 0), NUMBER(rotid_step, seconds, FROM_0))),
    {0},
};

TABLE(diagnosis_whole_record, rotid_diagnosis) = {
    ROWS(0, diagnosis_record),
    TEXT(rotid_diagnosis, extended_deck, 0),
    {0},
};
