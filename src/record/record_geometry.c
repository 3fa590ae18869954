#include "record/rows.h"

static const char *const bundles[] = {"RODS", "TUBE", NULL};

PART_TABLE(material_record, rotid_material) = {
    TEXT(rotid_material, name, MAY_BE_NULL),
    NUMBER(rotid_material, e_pa, FROM_0),
    NUMBER(rotid_material, g_pa, FROM_0),
    NUMBER(rotid_material, nu, 0),
    NUMBER(rotid_material, rho_kg_m3, FROM_0),
    NUMBER(rotid_material, sheet_e_pa, IF_KNOWN | ABOVE_0),
    NUMBER(rotid_material, stacking, IF_KNOWN | ABOVE_0),
    {0},
};

PART_TABLE(segment_record, rotid_segment) = {
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

PART_TABLE(perforation_record, rotid_perforation) = {
    INTEGER(rotid_perforation, number, FROM_1),
    NUMBER(rotid_perforation, hole_diameter_m, ABOVE_0 | ROUNDED),
    NUMBER(rotid_perforation, pitch_radius_m, ABOVE_0 | ROUNDED),
    {0},
};

PART_TABLE(group_record, rotid_group) = {
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

PART_TABLE(tierods_record, rotid_tierods) = {
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

PART_TABLE(bars_record, rotid_bars) = {
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

PART_TABLE(disk_record, rotid_disk) = {
    TEXT(rotid_disk, name, MAY_BE_NULL),         NUMBER(rotid_disk, z_m, FROM_0 | ROUNDED), NUMBER(rotid_disk, mass_kg, FROM_0),
    NUMBER(rotid_disk, diametral_kg_m2, FROM_0), NUMBER(rotid_disk, polar_kg_m2, FROM_0),   {0},
};

PART_TABLE(spring_record, rotid_spring) = {
    TEXT(rotid_spring, name, MAY_BE_NULL),
    NUMBER(rotid_spring, z_m, FROM_0 | ROUNDED),
    NUMBER(rotid_spring, lateral_n_m, FROM_0),
    NUMBER(rotid_spring, rotational_nm_rad, FROM_0),
    {0},
};

TABLE(sensor_record, rotid_sensor) = {
    INTEGER(rotid_sensor, id, 0),
    NUMBER(rotid_sensor, z_m, FROM_0 | ROUNDED),
    {0},
};

PART_TABLE(cause_parameter_record, rotid_cause_parameter) = {
    TEXT(rotid_cause_parameter, name, 0),
    TEXT(rotid_cause_parameter, unit, 0),
    NUMBER(rotid_cause_parameter, value, 0),
    {0},
};

PART_TABLE(model_cause_record, rotid_model_cause) = {
    TEXT(rotid_model_cause, name, MAY_BE_NULL),
    TEXT(rotid_model_cause, id, 0),
    TEXT(rotid_model_cause, target, 0),
    INTEGER(rotid_model_cause, sensor, MAY_BE_NULL),
    TEXT(rotid_model_cause, variant, MAY_BE_NULL),
    STRUCTS(rotid_model_cause, parameters, 0, cause_parameter_record),
    {0},
};

TABLE(geometry_record, rotid_geometry) = {
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
