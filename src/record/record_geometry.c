#include "record/rows.h"

static const char *const bundles[] = {"RODS", "TUBE", NULL};

static const struct record_field material_fields[] = {
    TEXT(rotid_material, name, MAY_BE_NULL),
    NUMBER(rotid_material, e_pa, FROM_0),
    NUMBER(rotid_material, g_pa, FROM_0),
    NUMBER(rotid_material, nu, 0),
    NUMBER(rotid_material, rho_kg_m3, FROM_0),
    NUMBER(rotid_material, sheet_e_pa, IF_KNOWN | ABOVE_0),
    NUMBER(rotid_material, stacking, IF_KNOWN | ABOVE_0),
    {0},
};
static const struct record material_record = RECORD(rotid_material, material_fields);

static const struct record_field segment_fields[] = {
    NUMBER(rotid_segment, from_m, ROUNDED),
    NUMBER(rotid_segment, to_m, ROUNDED),
    INTEGER(rotid_segment, elements, FROM_1),
    NUMBER(rotid_segment, height_m, IF_KNOWN | ABOVE_0 | ROUNDED),
    NUMBER(rotid_segment, width_m, IF_KNOWN | ABOVE_0 | ROUNDED),
    NUMBER(rotid_segment, outer_m, IF_KNOWN | ABOVE_0 | ROUNDED),
    NUMBER(rotid_segment, inner_m, IF_KNOWN | FROM_0 | ROUNDED),
    NUMBER(rotid_segment, stiff_outer_m, MAY_BE_NULL | SINCE_LATER | ABOVE_0 | ROUNDED),
    {0},
};
static const struct record segment_record = RECORD(rotid_segment, segment_fields);

static const struct record_field perforation_fields[] = {
    INTEGER(rotid_perforation, number, FROM_1),
    NUMBER(rotid_perforation, hole_diameter_m, ABOVE_0 | ROUNDED),
    NUMBER(rotid_perforation, pitch_radius_m, ABOVE_0 | ROUNDED),
    {0},
};
static const struct record perforation_record = RECORD(rotid_perforation, perforation_fields);

static const struct record_field group_fields[] = {
    TEXT(rotid_group, name, 0),
    TEXT(rotid_group, layer_of, IF_KNOWN),
    NUMBER(rotid_group, from_m, ROUNDED),
    NUMBER(rotid_group, to_m, ROUNDED),
    STRUCT(rotid_group, material, 0, material_record),
    STRUCTS(rotid_group, segments, NOT_EMPTY, segment_record),
    STRUCT(rotid_group, perforation, MAY_BE_NULL | BEHIND_POINTER, perforation_record),
    NUMBER(rotid_group, preload_n, 0),
    {0},
};
static const struct record group_record = RECORD(rotid_group, group_fields);

static const struct record_field tierods_fields[] = {
    TEXT(rotid_tierods, name, MAY_BE_NULL),
    NUMBER(rotid_tierods, from_m, ROUNDED),
    NUMBER(rotid_tierods, to_m, ROUNDED),
    STRUCT(rotid_tierods, material, 0, material_record),
    INTEGER(rotid_tierods, number, FROM_1),
    NUMBER(rotid_tierods, diameter_m, ABOVE_0 | ROUNDED),
    NUMBER(rotid_tierods, pitch_radius_m, ABOVE_0 | ROUNDED),
    TEXT_OF(rotid_tierods, model, 0, bundles),
    INTEGER(rotid_tierods, elements, FROM_1),
    NUMBER(rotid_tierods, tension_n, 0),
    FLAG(rotid_tierods, self_equilibrated, 0),
    {0},
};
static const struct record tierods_record = RECORD(rotid_tierods, tierods_fields);

static const struct record_field bars_fields[] = {
    TEXT(rotid_bars, name, MAY_BE_NULL),
    NUMBER(rotid_bars, from_m, ROUNDED),
    NUMBER(rotid_bars, to_m, ROUNDED),
    NUMBER(rotid_bars, center_m, ROUNDED),
    STRUCT(rotid_bars, material, 0, material_record),
    INTEGER(rotid_bars, number, FROM_1),
    NUMBER(rotid_bars, diameter_m, ABOVE_0 | ROUNDED),
    NUMBER(rotid_bars, pitch_radius_m, ABOVE_0 | ROUNDED),
    TEXT_OF(rotid_bars, model, 0, bundles),
    INTEGER(rotid_bars, elements, FROM_1),
    {0},
};
static const struct record bars_record = RECORD(rotid_bars, bars_fields);

static const struct record_field disk_fields[] = {
    TEXT(rotid_disk, name, MAY_BE_NULL),         NUMBER(rotid_disk, z_m, FROM_0 | ROUNDED), NUMBER(rotid_disk, mass_kg, FROM_0),
    NUMBER(rotid_disk, diametral_kg_m2, FROM_0), NUMBER(rotid_disk, polar_kg_m2, FROM_0),   {0},
};
static const struct record disk_record = RECORD(rotid_disk, disk_fields);

static const struct record_field spring_fields[] = {
    TEXT(rotid_spring, name, MAY_BE_NULL),
    NUMBER(rotid_spring, z_m, FROM_0 | ROUNDED),
    NUMBER(rotid_spring, lateral_n_m, FROM_0),
    NUMBER(rotid_spring, rotational_nm_rad, FROM_0),
    {0},
};
static const struct record spring_record = RECORD(rotid_spring, spring_fields);

static const struct record_field sensor_fields[] = {
    INTEGER(rotid_sensor, id, 0),
    NUMBER(rotid_sensor, z_m, FROM_0 | ROUNDED),
    {0},
};
const struct record sensor_record = RECORD(rotid_sensor, sensor_fields);

static const struct record_field cause_parameter_fields[] = {
    TEXT(rotid_cause_parameter, name, 0),
    TEXT(rotid_cause_parameter, unit, 0),
    NUMBER(rotid_cause_parameter, value, 0),
    {0},
};
static const struct record cause_parameter_record = RECORD(rotid_cause_parameter, cause_parameter_fields);

static const struct record_field model_cause_fields[] = {
    TEXT(rotid_model_cause, name, MAY_BE_NULL),
    TEXT(rotid_model_cause, id, 0),
    TEXT(rotid_model_cause, target, 0),
    INTEGER(rotid_model_cause, sensor, MAY_BE_NULL),
    TEXT(rotid_model_cause, variant, MAY_BE_NULL),
    STRUCTS(rotid_model_cause, parameters, 0, cause_parameter_record),
    {0},
};
static const struct record model_cause_record = RECORD(rotid_model_cause, model_cause_fields);

static const struct record_field geometry_fields[] = {
    NUMBER(rotid_geometry, length_m, ABOVE_0 | ROUNDED),
    STRUCTS(rotid_geometry, groups, NOT_EMPTY, group_record),
    STRUCTS(rotid_geometry, tierods, 0, tierods_record),
    STRUCTS(rotid_geometry, bars, 0, bars_record),
    STRUCTS(rotid_geometry, disks, 0, disk_record),
    STRUCTS(rotid_geometry, springs, 0, spring_record),
    NUMBER(rotid_geometry, sling_m, MAY_BE_NULL | ABOVE_0),
    STRUCTS(rotid_geometry, sensors, 0, sensor_record),
    STRUCTS(rotid_geometry, causes, 0, model_cause_record),
    NUMBERS(rotid_geometry, nodes_z_m, FROM_0 | ROUNDED),
    {0},
};
const struct record geometry_record = RECORD(rotid_geometry, geometry_fields);
