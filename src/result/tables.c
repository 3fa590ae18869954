/* The tables of the results that only the program has: those of results.def, those of src/run, the line of a run of a study. */
#include "import/import.h"
#include "record/rows.h"
#include "result/result.h"
#include "run/run.h"

/* ---- words */

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
const char *const export_format_words[] = {"matrix-market", "dmig", NULL};
static const char *const models[] = {"identified", "stated", NULL};
static const char *const condensations[] = {"GUYAN", "IRS", NULL};
const char *const score_words[] = {"quiet",  "false_alarm", "right", "in_set", "other_set",
                                   "silent", "unexplained", "wrong", NULL};
static const char *const studies[] = {"identify", "diagnose", "speeds", NULL};
const char *const study_status_words[] = {"converged", "at_bound", "not_converged", "failed", NULL};
const char *const transfer_quantity_words[] = {"displacement", "velocity", "acceleration", NULL};
const char *const transfer_unit_words[] = {"m/N", "m/(s N)", "m/(s2 N)", NULL};
const char *const transfer_damping_words[] = {"measured", "stated", "smallest_measured", "mean_measured", NULL};
static const char *const states[] = {"read", "read_over", "not_known", "malformed", NULL};
static const char *const doubts[] = {
    "malformed", "unknown_set", "no_units",  "node_twice", "no_coordinates", "abscissa_order", "uneven",          "unit", "dead",
    "clipped",   "coarse",      "coherence", "identical",  "length",         "resolution",     "frequency_order", NULL};

/* ---- keys that stand together or not at all */

#define CURVE(M) NUMBERS_BY(struct transfer_function, M, ELEMENTS_MAY_BE_NULL, nfrequency_hz, "frequency_hz")
PART_TABLE(transfer_function_curve_record, struct transfer_function) = {
    NUMBERS(struct transfer_function, frequency_hz, ABOVE_0),
    CURVE(synthesised_re),
    CURVE(synthesised_im),
    {0},
};

PART_TABLE(transfer_function_measured_curve_record, struct transfer_function) = {
    CURVE(measured_re),
    CURVE(measured_im),
    {0},
};

PART_TABLE(listed_nodes_every_node_record, struct listed_nodes) = {
    INTEGERS(struct listed_nodes, ids, 0),
    MATRIX(struct listed_nodes, x, 0, nids, nx),
    {0},
};

/* ---- results.def */

#define BEGIN(S) TABLE(S##_record, struct S) = {
#define END(S)                                                                                                                   \
    {                                                                                                                            \
        0                                                                                                                        \
    }                                                                                                                            \
    }                                                                                                                            \
    ;
#define OF(S, T)                                                                                                                 \
    extern const struct record_field S##_rows[];                                                                                 \
    const struct record S##_record = {.name = "struct " #S, .size = sizeof(T), .field = S##_rows};                               \
    const struct record_field S##_rows[] = {
#define DONE                      END()
#define ON(KIND, T, ...)          KIND(struct T, __VA_ARGS__),
#define IS(KIND, T, ...)          AT(KIND, struct T, __VA_ARGS__),
#define IS_LIST(KIND, T, ...)     AT_LIST(KIND, struct T, __VA_ARGS__),
#define IS_FIXED(KIND, T, ...)    AT_FIXED(KIND, struct T, __VA_ARGS__),
#define KEY(KIND, S, ...)         KIND(struct S, __VA_ARGS__),
#define PART(KIND, S, M, BITS, T) KIND(struct S, M, BITS, T##_record),
#define TOGETHER(BITS, R)         ROWS(BITS, R),
#define MEMBER(TYPE, M)
#define ROW(...)                 __VA_ARGS__,
#define NUMBER_3(S, M)           RECORD_ROW(S, M, FIELD_NUMBER, SHAPE_FIXED, 0, .fixed = 3)
#define STRUCT_IN(S, M, BITS, R) STRUCT(S, M, BITS, R)
#define STRUCT_AT(S, M, BITS, R) STRUCT(S, M, (BITS) | BEHIND_POINTER, R)
#define INLINE_IN(S, M, BITS, R) INLINE(S, M, BITS, R)
#define INLINE_AT(S, M, BITS, R) INLINE(S, M, (BITS) | BEHIND_POINTER, R)
#undef complex /* a key */
#include "result/results.def"

/* ---- the change of frequencies with parameters, of src/run */

#define GROWING (ELEMENTS_MAY_BE_NULL | FROM_0)

PART_TABLE(parameter_record, struct sensitivity_parameter) = {
    COUNT_OF(struct sensitivity_parameter, nfrequency_hz, struct sensitivity, nfrequency_hz),
    COUNT_OF(struct sensitivity_parameter, nrelative_value, struct sensitivity, nrelative_value),
    KEYS(struct sensitivity_parameter, 0, name, unit, reference),
    NUMBERS_BY(struct sensitivity_parameter, sensitivity, 0, nfrequency_hz, "frequency_hz"),
    NUMBERS_BY(struct sensitivity_parameter, derivative, 0, nfrequency_hz, "frequency_hz"),
    NUMBERS_BY(struct sensitivity_parameter, frequency_change, SINCE_LATER, nfrequency_hz, "frequency_hz"),
    MATRIX(struct sensitivity_parameter, curves, GROWING, nfrequency_hz, nrelative_value),
    {0},
};

PART_TABLE(line_record, struct growth_line) = {
    COUNT_OF(struct growth_line, nepsilon_squared, struct growth, nepsilon_squared),
    NUMBERS_BY(struct growth_line, objective, GROWING, nepsilon_squared, "epsilon_squared"),
    KEYS(struct growth_line, MAY_BE_NULL, slope, intercept),
    {0},
};

PART_TABLE(growth_record, struct growth) = {
    NUMBERS(struct growth, epsilon_squared, ABOVE_0),
    STRUCT(struct growth, hybrid, 0, line_record),
    STRUCT(struct growth, hybrid_f, 0, line_record),
    NUMBERS_BY(struct growth, shapes_alone, GROWING | SINCE_LATER, nepsilon_squared, "epsilon_squared"),
    {0},
};

TABLE(sensitivity_record, struct sensitivity) = {
    TEXT_OF(struct sensitivity, reduction, 0, reduction_words),
    NUMBER(struct sensitivity, step, ABOVE_0),
    NUMBERS(struct sensitivity, frequency_hz, FROM_0),
    NUMBERS(struct sensitivity, relative_value, 0),
    STRUCTS(struct sensitivity, parameters, 0, parameter_record),
    STRUCT(struct sensitivity, functional_growth, MAY_BE_NULL | SINCE_LATER | BEHIND_POINTER, growth_record),
    {0},
};

/* ---- the line of a run of a study: rows of the result of its command */

PART_TABLE(hidden_record, struct run_hidden) = {
    TEXT(struct run_hidden, id, 0),
    STRUCTS(struct run_hidden, parameters, 0, RECORD_OF(struct run_value, KEYS(struct run_value, 0, name, unit, value))),
    {0},
};

/* Lines differ in nothing but their last seconds: no times of steps and of other minimisers. */
PART_TABLE(run_minimiser_record, rotid_minimiser) = {
    TEXT(rotid_minimiser, algorithm, 0),
    TEXT(rotid_minimiser, result, SINCE_LATER),
    FLAG(rotid_minimiser, usable, 0),
    NUMBER(rotid_minimiser, objective, MAY_BE_NULL | FROM_0),
    INTEGER(rotid_minimiser, evaluations, FROM_0),
    NUMBERS(rotid_minimiser, x, 0),
    {0},
};

PART_TABLE(run_state_record, rotid_identified_state) = {
    TEXT(rotid_identified_state, name, 0),
    STRUCTS(rotid_identified_state, modes, NOT_EMPTY, compared_mode_record),
    {0},
};

PART_TABLE(fit_record, rotid_identification) = {
    TEXT_OF(rotid_identification, functional, 0, functional_words),
    TEXT_OF(rotid_identification, reduction, 0, reduction_words),
    KEYS(rotid_identification, MAY_BE_NULL | FROM_0, objective, chi2, chi2_per_dof),
    INTEGER(rotid_identification, dof, 0),
    INTEGER(rotid_identification, iterations, FROM_0),
    INTEGER(rotid_identification, evaluations, FROM_1),
    TEXT(rotid_identification, stop_reason, 0),
    STRUCTS(rotid_identification, parameters, 0, fitted_parameter_record),
    STRUCTS(rotid_identification, modes, 0, compared_mode_record),
    STRUCTS(rotid_identification, states, IF_KNOWN, run_state_record),
    STRUCTS(rotid_identification, history, IF_KNOWN,
            RECORD_OF(rotid_history_entry, KEYS(rotid_history_entry, FROM_0, iteration, objective),
                      NUMBERS(rotid_history_entry, x, 0))),
    STRUCTS(rotid_identification, baseline, IF_KNOWN, run_minimiser_record),
    {0},
};

PART_TABLE(diagnosis_record_of_run, rotid_diagnosis) = {
    STRUCT(rotid_diagnosis, verdict, 0, verdict_record),
    STRUCTS(rotid_diagnosis, data_findings, 0, data_finding_record),
    {0},
};

PART_TABLE(run_critical_record, rotid_critical_speed) = {
    INTEGER(rotid_critical_speed, number, FROM_1),
    NUMBER(rotid_critical_speed, speed_rpm, ABOVE_0),
    NUMBER(rotid_critical_speed, std, MAY_BE_NULL | FROM_0),
    INTERVAL(rotid_critical_speed, ci95, ELEMENTS_MAY_BE_NULL),
    TEXT_OF(rotid_critical_speed, whirl, 0, whirl_words),
    NUMBER(rotid_critical_speed, log_decrement, 0),
    STRUCT(rotid_critical_speed, margin, 0, speed_margin_record),
    {0},
};

PART_TABLE(speeds_record_of_run, rotid_speeds) = {
    STRUCTS(rotid_speeds, critical_speeds, 0, run_critical_record),
    STRUCT(rotid_speeds, stability, 0, stability_record),
    STRUCTS(rotid_speeds, runup, 0, runup_record),
    {0},
};

PART_TABLE(stamp_record, struct study_run) = {
    KEYS(struct study_run, 0, study, digest),
    {0},
};

TABLE(study_run_record, struct study_run) = {
    INTEGER(struct study_run, run, FROM_0),
    STRUCT(struct study_run, cell, 0, study_axes_record),
    KEYS(struct study_run, FROM_0, replicate, start),
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
