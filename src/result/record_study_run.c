/* Of a file of results of a study: the line of a run. */
#include "record/rows.h"
#include "result/result.h"
#include "run/run.h"

static const char *const run_status_words[] = {"converged", "at_bound", "not_converged", "failed", NULL};
static const char *const blocks[] = {"SHAPE", "FREQUENCY", NULL};

static const struct record_field parameter_fields[] = {
    TEXT(struct run_parameter, name, 0),
    TEXT(struct run_parameter, unit, 0),
    NUMBER(struct run_parameter, value, MAY_BE_NULL),
    NUMBER(struct run_parameter, start, MAY_BE_NULL),
    NUMBER(struct run_parameter, std, MAY_BE_NULL | FROM_0),
    INTERVAL(struct run_parameter, ci95, 0),
    FLAG(struct run_parameter, at_bound, 0),
    FLAG(struct run_parameter, identifiable, 0),
    NUMBER(struct run_parameter, truth, MAY_BE_NULL),
    {0},
};
static const struct record parameter_record = RECORD(struct run_parameter, parameter_fields);

static const struct record_field mode_fields[] = {
    TEXT(struct run_mode, state, IF_KNOWN),
    INTEGER(struct run_mode, mode, FROM_1),
    NUMBER(struct run_mode, measured_hz, ABOVE_0),
    NUMBER(struct run_mode, predicted_hz, MAY_BE_NULL | FROM_0),
    NUMBER(struct run_mode, error_percent, MAY_BE_NULL),
    NUMBER(struct run_mode, nco, MAY_BE_NULL | CORRELATION),
    FLAG(struct run_mode, holdout, 0),
    {0},
};
static const struct record mode_record = RECORD(struct run_mode, mode_fields);

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

static const struct record_field fit_fields[] = {
    TEXT_OF(struct run_fit, functional, 0, functional_words),
    TEXT_OF(struct run_fit, reduction, 0, reduction_words),
    NUMBER(struct run_fit, objective, MAY_BE_NULL | FROM_0),
    NUMBER(struct run_fit, chi2_per_dof, MAY_BE_NULL | FROM_0),
    INTEGER(struct run_fit, dof, 0),
    INTEGER(struct run_fit, iterations, FROM_0),
    INTEGER(struct run_fit, evaluations, FROM_1),
    TEXT(struct run_fit, stop_reason, 0),
    INTEGER(struct run_fit, sensors, FROM_0),
    STRUCTS(struct run_fit, parameters, 0, parameter_record),
    STRUCTS(struct run_fit, modes, 0, mode_record),
    STRUCT(struct run_fit, hidden, MAY_BE_NULL | BEHIND_POINTER, hidden_record),
    {0},
};
static const struct record fit_record = RECORD(struct run_fit, fit_fields);

static const struct record_field minimiser_fields[] = {
    TEXT(struct run_minimiser, algorithm, 0),
    FLAG(struct run_minimiser, usable, 0),
    NUMBER(struct run_minimiser, objective, MAY_BE_NULL | FROM_0),
    INTEGER(struct run_minimiser, evaluations, FROM_0),
    NUMBERS(struct run_minimiser, x, 0),
    {0},
};
static const struct record minimiser_record = RECORD(struct run_minimiser, minimiser_fields);

static const struct record_field cause_parameter_fields[] = {
    TEXT(struct run_cause_parameter, name, 0),
    TEXT(struct run_cause_parameter, unit, 0),
    NUMBER(struct run_cause_parameter, value, MAY_BE_NULL),
    NUMBER(struct run_cause_parameter, std, MAY_BE_NULL | FROM_0),
    {0},
};
static const struct record cause_parameter_record = RECORD(struct run_cause_parameter, cause_parameter_fields);

static const struct record_field cause_fields[] = {
    TEXT(struct run_cause, id, 0),
    TEXT(struct run_cause, target, 0),
    TEXT(struct run_cause, state, IF_KNOWN),
    STRUCTS(struct run_cause, parameters, 0, cause_parameter_record),
    {0},
};
static const struct record run_cause_record = RECORD(struct run_cause, cause_fields);

static const struct record_field verdict_fields[] = {
    WORD(struct run_verdict, kind, 0, verdict_words),
    FLAG(struct run_verdict, adequate_after, 0),
    NUMBER(struct run_verdict, p_value, MAY_BE_NULL | PROBABILITY),
    STRUCTS(struct run_verdict, causes, 0, run_cause_record),
    STRUCTS(struct run_verdict, alternatives, 0, run_cause_record),
    {0},
};
static const struct record verdict_record = RECORD(struct run_verdict, verdict_fields);

static const struct record_field finding_fields[] = {
    TEXT(struct run_finding, id, 0),
    TEXT(struct run_finding, state, IF_KNOWN),
    INTEGERS(struct run_finding, sensors, 0),
    TEXT_OF(struct run_finding, block, MAY_BE_NULL, blocks),
    NUMBER(struct run_finding, value, MAY_BE_NULL),
    {0},
};
static const struct record finding_record = RECORD(struct run_finding, finding_fields);

static const struct record_field diagnosis_fields[] = {
    STRUCT(struct run_diagnosis, verdict, 0, verdict_record),
    STRUCTS(struct run_diagnosis, data_findings, 0, finding_record),
    WORD(struct run_diagnosis, score, MAY_BE_NULL, score_words),
    INTEGER(struct run_diagnosis, false_findings, MAY_BE_NULL | FROM_0),
    {0},
};
static const struct record diagnosis_record_of_run = RECORD(struct run_diagnosis, diagnosis_fields);

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
    WORD(struct study_run, status, 0, run_status_words),
    TEXT(struct study_run, error, MAY_BE_NULL),
    INLINE(struct study_run, fit, IF_KNOWN | BEHIND_POINTER, fit_record),
    NUMBERS(struct study_run, iterates, IF_KNOWN | ROUNDED),
    STRUCTS(struct study_run, baseline, IF_KNOWN, minimiser_record),
    INLINE(struct study_run, diagnosis, IF_KNOWN | BEHIND_POINTER, diagnosis_record_of_run),
    TEXTS(struct study_run, warnings, IF_KNOWN),
    NUMBER(struct study_run, seconds, FROM_0),
    ROWS(IF_KNOWN, stamp_record),
    {0},
};
const struct record study_run_record = RECORD(struct study_run, run_fields);
