/* Of a file of results of a study: its first line and its summary. */
#include "record/rows.h"
#include "result/result.h"

const char *const score_words[] = {"quiet",  "false_alarm", "right", "in_set", "other_set",
                                   "silent", "unexplained", "wrong", NULL};
static const char *const studies[] = {"identify", "diagnose", "speeds", NULL};

static const struct record_field digests_fields[] = {
    TEXT(struct study_digests, plan, 0),
    TEXT(struct study_digests, decks, 0),
    TEXT(struct study_digests, data, 0),
    TEXT(struct study_digests, options, 0),
    {0},
};
static const struct record digests_record = RECORD(struct study_digests, digests_fields);

static const struct record_field header_fields[] = {
    INTEGER(struct study_header, schema, FROM_1),
    TEXT(struct study_header, rotid, 0),
    TEXT(struct study_header, commit, 0),
    TEXT(struct study_header, command, 0),
    TEXT(struct study_header, plan, MAY_BE_NULL),
    TEXT_OF(struct study_header, studies, 0, studies),
    STRUCT(struct study_header, digest, 0, digests_record),
    NUMBER(struct study_header, seed, FROM_0 | WHOLE),
    INTEGER(struct study_header, runs, FROM_1),
    TEXT(struct study_header, shard, MAY_BE_NULL),
    {0},
};
const struct record study_header_record = RECORD(struct study_header, header_fields);

static const struct record_field axes_fields[] = {
    TEXT(struct study_axes, deck, 0),
    TEXT(struct study_axes, variant, MAY_BE_NULL),
    TEXT(struct study_axes, modes, MAY_BE_NULL),
    TEXT(struct study_axes, sensors, MAY_BE_NULL),
    NUMBER(struct study_axes, noise_frequency, MAY_BE_NULL | FROM_0),
    NUMBER(struct study_axes, noise_shape, MAY_BE_NULL | FROM_0),
    TEXT(struct study_axes, hide, MAY_BE_NULL),
    {0},
};
const struct record study_axes_record = RECORD(struct study_axes, axes_fields);

static const struct record_field parameter_fields[] = {
    TEXT(struct cell_parameter, name, 0),
    TEXT(struct cell_parameter, unit, 0),
    INTEGER(struct cell_parameter, count, FROM_0),
    NUMBER(struct cell_parameter, mean, MAY_BE_NULL),
    NUMBER(struct cell_parameter, std, MAY_BE_NULL | FROM_0),
    NUMBER(struct cell_parameter, min, MAY_BE_NULL),
    NUMBER(struct cell_parameter, max, MAY_BE_NULL),
    NUMBER(struct cell_parameter, mean_stated_std, MAY_BE_NULL | FROM_0),
    NUMBER(struct cell_parameter, bias, MAY_BE_NULL),
    NUMBER(struct cell_parameter, std_error, MAY_BE_NULL | FROM_0),
    NUMBER(struct cell_parameter, rms_error, MAY_BE_NULL | FROM_0),
    INTEGER(struct cell_parameter, intervals, FROM_0),
    NUMBER(struct cell_parameter, coverage95, MAY_BE_NULL | PROBABILITY),
    {0},
};
static const struct record parameter_record = RECORD(struct cell_parameter, parameter_fields);

static const struct record_field diagnoses_fields[] = {
    INTEGER(struct cell_diagnoses, count, FROM_0),
    COUNTS(struct cell_diagnoses, verdicts, 0, verdict_words),
    MAP(struct cell_diagnoses, named, 0),
    COUNTS(struct cell_diagnoses, scores, MAY_BE_NULL, score_words),
    INTEGER(struct cell_diagnoses, false_findings, MAY_BE_NULL | FROM_0),
    {0},
};
static const struct record diagnoses_record = RECORD(struct cell_diagnoses, diagnoses_fields);

static const struct record_field cell_fields[] = {
    STRUCT(struct study_cell_result, cell, 0, study_axes_record),
    INTEGER(struct study_cell_result, first_run, FROM_0),
    INTEGER(struct study_cell_result, runs, FROM_0),
    INTEGER(struct study_cell_result, converged, FROM_0),
    INTEGER(struct study_cell_result, at_bound, FROM_0),
    INTEGER(struct study_cell_result, not_converged, FROM_0),
    INTEGER(struct study_cell_result, not_adequate, FROM_0 | SINCE_LATER),
    INTEGER(struct study_cell_result, failed, FROM_0),
    INTEGER(struct study_cell_result, reached_best, MAY_BE_NULL | FROM_0),
    STRUCTS(struct study_cell_result, parameters, 0, parameter_record),
    NUMBER(struct study_cell_result, frequency_rms_percent, MAY_BE_NULL | FROM_0),
    NUMBER(struct study_cell_result, holdout_frequency_rms_percent, MAY_BE_NULL | FROM_0),
    NUMBER(struct study_cell_result, chi2_per_dof, MAY_BE_NULL | FROM_0),
    NUMBER(struct study_cell_result, evaluations, MAY_BE_NULL | FROM_0),
    STRUCT(struct study_cell_result, diagnoses, MAY_BE_NULL | BEHIND_POINTER, diagnoses_record),
    NUMBER(struct study_cell_result, seconds, FROM_0),
    {0},
};
static const struct record cell_record = RECORD(struct study_cell_result, cell_fields);

static const struct record_field error_fields[] = {
    TEXT(struct study_error, error, 0),
    INTEGER(struct study_error, runs, FROM_1),
    INTEGER(struct study_error, first_run, FROM_0),
    {0},
};
static const struct record error_record = RECORD(struct study_error, error_fields);

static const struct record_field study_fields[] = {
    TEXT(struct study_result, results, 0),
    TEXT(struct study_result, plan, MAY_BE_NULL),
    TEXT_OF(struct study_result, studies, 0, studies),
    INTEGER(struct study_result, shard, FROM_1),
    INTEGER(struct study_result, shards, FROM_1),
    INTEGER(struct study_result, runs, FROM_0),
    INTEGER(struct study_result, done, FROM_0),
    INTEGER(struct study_result, missing, FROM_0),
    INTEGER(struct study_result, failed, FROM_0),
    STRUCTS(struct study_result, cells, 0, cell_record),
    STRUCTS(struct study_result, errors, 0, error_record),
    NUMBER(struct study_result, seconds, FROM_0),
    {0},
};
const struct record study_record = RECORD(struct study_result, study_fields);
