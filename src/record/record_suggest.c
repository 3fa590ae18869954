#include "record/rows.h"

static const char *const methods[] = {"deck", "optimal", "effective_independence", NULL};
static const char *const tests[] = {"again", "modes",         "sensors", "shapes",        "noise",
                                    "mass",  "stiff_support", "free",    "moved_support", NULL};

PART_TABLE(modes_record, rotid_expected_modes) = {
    INTEGER(rotid_expected_modes, modes, FROM_1),
    NUMBERS(rotid_expected_modes, frequencies_percent, ELEMENTS_MAY_BE_NULL | FROM_0),
    NUMBERS(rotid_expected_modes, shapes_percent, ELEMENTS_MAY_BE_NULL | FROM_0),
    {0},
};

PART_TABLE(plan_record, rotid_sensor_plan) = {
    TEXT_OF(rotid_sensor_plan, method, 0, methods),
    NUMBERS(rotid_sensor_plan, z_m, 0),
    NUMBERS_BY(rotid_sensor_plan, loss_percent, ELEMENTS_MAY_BE_NULL, nz_m, "z_m"),
    NUMBERS(rotid_sensor_plan, half_width_percent, ELEMENTS_MAY_BE_NULL | FROM_0),
    NUMBER(rotid_sensor_plan, gain_percent, MAY_BE_NULL),
    {0},
};

PART_TABLE(count_record, rotid_sensor_count) = {
    INTEGER(rotid_sensor_count, sensors, FROM_1),
    NUMBER(rotid_sensor_count, half_width_percent, MAY_BE_NULL | FROM_0),
    NUMBER(rotid_sensor_count, gain_percent, MAY_BE_NULL),
    {0},
};

PART_TABLE(rival_record, rotid_rival) = {
    TEXT(rotid_rival, label, 0),
    STRUCTS(rotid_rival, causes, 0, cause_record),
    KEYS(rotid_rival, FROM_0, chi2, score),
    NUMBER(rotid_rival, share, PROBABILITY),
    {0},
};

PART_TABLE(margin_record, rotid_expected_margin) = {
    KEYS(rotid_expected_margin, FROM_0, truth, rival),
    NUMBER(rotid_expected_margin, before, 0),
    NUMBER(rotid_expected_margin, distance, FROM_0),
    NUMBER(rotid_expected_margin, expected, 0),
    NUMBER(rotid_expected_margin, refitted, MAY_BE_NULL),
    NUMBER(rotid_expected_margin, chance, PROBABILITY),
    {0},
};
PART_TABLE(test_record, rotid_suggested_test) = {
    TEXT_OF(rotid_suggested_test, id, 0, tests),
    TEXT(rotid_suggested_test, text, 0),
    KEYS(rotid_suggested_test, FROM_0, cost, setups),
    KEYS(rotid_suggested_test, FROM_1, points, modes),
    NUMBERS(rotid_suggested_test, sensors_m, 0),
    NUMBER(rotid_suggested_test, mass_kg, MAY_BE_NULL | ABOVE_0),
    NUMBER(rotid_suggested_test, z_m, MAY_BE_NULL),
    KEYS(rotid_suggested_test, PROBABILITY, chance, wrong),
    NUMBER(rotid_suggested_test, entropy, FROM_0),
    NUMBERS(rotid_suggested_test, expected_percent, 0),
    STRUCTS(rotid_suggested_test, margins, 0, margin_record),
    TEXT(rotid_suggested_test, cards, MAY_BE_NULL),
    {0},
};

PART_TABLE(speed_test_record, rotid_speed_test) = {
    TEXT(rotid_speed_test, test, 0),
    INTEGER(rotid_speed_test, modes, FROM_1),
    NUMBER(rotid_speed_test, std_rpm, MAY_BE_NULL | FROM_0),
    NUMBER(rotid_speed_test, narrowed_percent, MAY_BE_NULL),
    {0},
};

TABLE(suggestion_record, rotid_suggestion) = {
    STRUCTS(rotid_suggestion, parameters, 0, fitted_parameter_record),
    STRUCT(rotid_suggestion, noise, 0, noise_record),
    NUMBER(rotid_suggestion, wanted_percent, ABOVE_0),
    KEYS(rotid_suggestion, MAY_BE_NULL | FROM_1, modes_needed, sensors_needed),
    INTEGER(rotid_suggestion, plan_modes, FROM_1),
    STRUCTS(rotid_suggestion, modes, 0, modes_record),
    STRUCTS(rotid_suggestion, plans, 0, plan_record),
    STRUCTS(rotid_suggestion, counts, 0, count_record),
    STRUCTS(rotid_suggestion, places, 0,
            RECORD_OF(rotid_sensor_place, NUMBER(rotid_sensor_place, z_m, 0),
                      KEYS(rotid_sensor_place, MAY_BE_NULL, worth_percent, margin_percent))),
    STRUCTS(rotid_suggestion, detectable, 0, detectable_record),
    TEXT(rotid_suggestion, verdict, MAY_BE_NULL),
    STRUCTS(rotid_suggestion, rivals, 0, rival_record),
    NUMBER(rotid_suggestion, among, MAY_BE_NULL | PROBABILITY),
    NUMBER(rotid_suggestion, entropy, MAY_BE_NULL | FROM_0),
    STRUCTS(rotid_suggestion, tests, 0, test_record),
    NUMBER(rotid_suggestion, set_up_cost, FROM_0),
    TEXT(rotid_suggestion, state, MAY_BE_NULL),
    TEXT(rotid_suggestion, sentence, 0),
    STRUCT(rotid_suggestion, geometry, BEHIND_POINTER, geometry_record),
    NUMBER(rotid_suggestion, speed_rpm, MAY_BE_NULL | ABOVE_0 | SINCE_LATER),
    KEYS(rotid_suggestion, MAY_BE_NULL | FROM_0 | SINCE_LATER, speed_std, speed_identified),
    STRUCTS(rotid_suggestion, speed_tests, SINCE_LATER, speed_test_record),
    {0},
};
