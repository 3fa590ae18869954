/* Of a file of results of a study: the line of a run, rows of the result of its command. */
#include "record/rows.h"
#include "result/result.h"
#include "run/run.h"

const char *const study_status_words[] = {"converged", "at_bound", "not_converged", "failed", NULL};

static const struct record_field value_fields[] = {
    TEXT(struct run_value, name, 0),
    TEXT(struct run_value, unit, 0),
    NUMBER(struct run_value, value, 0),
    {0},
};
static const struct record value_record = RECORD(struct run_value, value_fields);

static const struct record_field hidden_fields[] = {
    TEXT(struct run_hidden, id, 0),
    STRUCTS(struct run_hidden, parameters, 0, value_record),
    {0},
};
static const struct record hidden_record = RECORD(struct run_hidden, hidden_fields);

/* Lines differ in nothing but their last seconds: no times of steps and of other minimisers. */
static const struct record_field step_fields[] = {
    INTEGER(rotid_history_entry, iteration, FROM_0),
    NUMBER(rotid_history_entry, objective, FROM_0),
    NUMBERS(rotid_history_entry, x, 0),
    {0},
};
static const struct record step_record = RECORD(rotid_history_entry, step_fields);

static const struct record_field minimiser_fields[] = {
    TEXT(rotid_minimiser, algorithm, 0),
    TEXT(rotid_minimiser, result, SINCE_LATER),
    FLAG(rotid_minimiser, usable, 0),
    NUMBER(rotid_minimiser, objective, MAY_BE_NULL | FROM_0),
    INTEGER(rotid_minimiser, evaluations, FROM_0),
    NUMBERS(rotid_minimiser, x, 0),
    {0},
};
static const struct record run_minimiser_record = RECORD(rotid_minimiser, minimiser_fields);

static const struct record_field state_fields[] = {
    TEXT(rotid_identified_state, name, 0),
    STRUCTS(rotid_identified_state, modes, NOT_EMPTY, compared_mode_record),
    {0},
};
static const struct record state_record = RECORD(rotid_identified_state, state_fields);

static const struct record_field fit_fields[] = {
    TEXT_OF(rotid_identification, functional, 0, functional_words),
    TEXT_OF(rotid_identification, reduction, 0, reduction_words),
    NUMBER(rotid_identification, objective, MAY_BE_NULL | FROM_0),
    NUMBER(rotid_identification, chi2, MAY_BE_NULL | FROM_0),
    NUMBER(rotid_identification, chi2_per_dof, MAY_BE_NULL | FROM_0),
    INTEGER(rotid_identification, dof, 0),
    INTEGER(rotid_identification, iterations, FROM_0),
    INTEGER(rotid_identification, evaluations, FROM_1),
    TEXT(rotid_identification, stop_reason, 0),
    STRUCTS(rotid_identification, parameters, 0, fitted_parameter_record),
    STRUCTS(rotid_identification, modes, 0, compared_mode_record),
    STRUCTS(rotid_identification, states, IF_KNOWN, state_record),
    STRUCTS(rotid_identification, history, IF_KNOWN, step_record),
    STRUCTS(rotid_identification, baseline, IF_KNOWN, run_minimiser_record),
    {0},
};
static const struct record fit_record = RECORD(rotid_identification, fit_fields);

static const struct record_field diagnosis_fields[] = {
    STRUCT(rotid_diagnosis, verdict, 0, verdict_record),
    STRUCTS(rotid_diagnosis, data_findings, 0, data_finding_record),
    {0},
};
static const struct record diagnosis_record_of_run = RECORD(rotid_diagnosis, diagnosis_fields);

static const struct record_field critical_fields[] = {
    INTEGER(rotid_critical_speed, number, FROM_1),
    NUMBER(rotid_critical_speed, speed_rpm, ABOVE_0),
    NUMBER(rotid_critical_speed, std, MAY_BE_NULL | FROM_0),
    INTERVAL(rotid_critical_speed, ci95, ELEMENTS_MAY_BE_NULL),
    TEXT_OF(rotid_critical_speed, whirl, 0, whirl_words),
    NUMBER(rotid_critical_speed, log_decrement, 0),
    STRUCT(rotid_critical_speed, margin, 0, speed_margin_record),
    {0},
};
static const struct record critical_record = RECORD(rotid_critical_speed, critical_fields);

static const struct record_field speeds_fields[] = {
    STRUCTS(rotid_speeds, critical_speeds, 0, critical_record),
    STRUCT(rotid_speeds, stability, 0, stability_record),
    STRUCTS(rotid_speeds, runup, 0, runup_record),
    {0},
};
static const struct record speeds_record_of_run = RECORD(rotid_speeds, speeds_fields);

static const struct record_field stamp_fields[] = {
    TEXT(struct study_run, study, 0),
    TEXT(struct study_run, digest, 0),
    {0},
};
static const struct record stamp_record = RECORD(struct study_run, stamp_fields);

static const struct record_field run_fields[] = {
    INTEGER(struct study_run, run, FROM_0),
    STRUCT(struct study_run, cell, 0, study_axes_record),
    INTEGER(struct study_run, replicate, FROM_0),
    INTEGER(struct study_run, start, FROM_0),
    WORD(struct study_run, status, 0, study_status_words),
    TEXT(struct study_run, error, MAY_BE_NULL),
    INTEGER(struct study_run, sensors, IF_KNOWN | FROM_0),
    MAP(struct study_run, truth, IF_KNOWN),
    STRUCT(struct study_run, hidden, MAY_BE_NULL | SINCE_LATER | BEHIND_POINTER, hidden_record),
    INLINE(struct study_run, fit, IF_KNOWN | BEHIND_POINTER, fit_record),
    INLINE(struct study_run, diagnosis, IF_KNOWN | BEHIND_POINTER, diagnosis_record_of_run),
    INLINE(struct study_run, speeds, IF_KNOWN | BEHIND_POINTER, speeds_record_of_run),
    WORD(struct study_run, score, IF_KNOWN, score_words),
    INTEGER(struct study_run, false_findings, IF_KNOWN | FROM_0),
    TEXTS(struct study_run, warnings, IF_KNOWN),
    TEXT(struct study_run, input, IF_KNOWN),
    NUMBER(struct study_run, seconds, FROM_0),
    ROWS(IF_KNOWN, stamp_record),
    {0},
};
const struct record study_run_record = RECORD(struct study_run, run_fields);
