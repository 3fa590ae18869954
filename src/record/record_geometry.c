#include "record/rows.h"

static const char *const bundles[] = {"RODS", "TUBE", NULL};

PART_TABLE(material_record, rotid_material) = {
    TEXT(rotid_material, name, MAY_BE_NULL),
    KEYS(rotid_material, FROM_0, e_pa, g_pa),
    NUMBER(rotid_material, nu, 0),
    NUMBER(rotid_material, rho_kg_m3, FROM_0),
    KEYS(rotid_material, IF_KNOWN | ABOVE_0, sheet_e_pa, stacking),
    {0},
};

PART_TABLE(segment_record, rotid_segment) = {
    KEYS(rotid_segment, ROUNDED, from_m, to_m),
    INTEGER(rotid_segment, elements, FROM_1),
    KEYS(rotid_segment, IF_KNOWN | ABOVE_0 | ROUNDED, height_m, width_m, outer_m),
    NUMBER(rotid_segment, inner_m, IF_KNOWN | FROM_0 | ROUNDED),
    NUMBER(rotid_segment, stiff_outer_m, MAY_BE_NULL | SINCE_LATER | ABOVE_0 | ROUNDED),
    {0},
};

PART_TABLE(perforation_record, rotid_perforation) = {
    INTEGER(rotid_perforation, number, FROM_1),
    KEYS(rotid_perforation, ABOVE_0 | ROUNDED, hole_diameter_m, pitch_radius_m),
    {0},
};

PART_TABLE(group_record, rotid_group) = {
    TEXT(rotid_group, name, 0),
    TEXT(rotid_group, layer_of, IF_KNOWN),
    KEYS(rotid_group, ROUNDED, from_m, to_m),
    STRUCT(rotid_group, material, 0, material_record),
    STRUCTS(rotid_group, segments, NOT_EMPTY, segment_record),
    STRUCT(rotid_group, perforation, MAY_BE_NULL | BEHIND_POINTER, perforation_record),
    NUMBER(rotid_group, preload_n, 0),
    {0},
};

PART_TABLE(tierods_record, rotid_tierods) = {
    TEXT(rotid_tierods, name, MAY_BE_NULL),
    KEYS(rotid_tierods, ROUNDED, from_m, to_m),
    STRUCT(rotid_tierods, material, 0, material_record),
    INTEGER(rotid_tierods, number, FROM_1),
    KEYS(rotid_tierods, ABOVE_0 | ROUNDED, diameter_m, pitch_radius_m),
    TEXT_OF(rotid_tierods, model, 0, bundles),
    INTEGER(rotid_tierods, elements, FROM_1),
    NUMBER(rotid_tierods, tension_n, 0),
    FLAG(rotid_tierods, self_equilibrated, 0),
    {0},
};

PART_TABLE(bars_record, rotid_bars) = {
    TEXT(rotid_bars, name, MAY_BE_NULL),
    KEYS(rotid_bars, ROUNDED, from_m, to_m, center_m),
    STRUCT(rotid_bars, material, 0, material_record),
    INTEGER(rotid_bars, number, FROM_1),
    KEYS(rotid_bars, ABOVE_0 | ROUNDED, diameter_m, pitch_radius_m),
    TEXT_OF(rotid_bars, model, 0, bundles),
    INTEGER(rotid_bars, elements, FROM_1),
    {0},
};

PART_TABLE(disk_record, rotid_disk) = {
    TEXT(rotid_disk, name, MAY_BE_NULL),
    NUMBER(rotid_disk, z_m, FROM_0 | ROUNDED),
    KEYS(rotid_disk, FROM_0, mass_kg, diametral_kg_m2, polar_kg_m2),
    {0},
};
PART_TABLE(spring_record, rotid_spring) = {
    TEXT(rotid_spring, name, MAY_BE_NULL),
    NUMBER(rotid_spring, z_m, FROM_0 | ROUNDED),
    KEYS(rotid_spring, FROM_0, lateral_n_m, rotational_nm_rad),
    {0},
};

TABLE(sensor_record, rotid_sensor) = {
    INTEGER(rotid_sensor, id, 0),
    NUMBER(rotid_sensor, z_m, FROM_0 | ROUNDED),
    {0},
};

PART_TABLE(model_cause_record, rotid_model_cause) = {
    TEXT(rotid_model_cause, name, MAY_BE_NULL),
    KEYS(rotid_model_cause, 0, id, target),
    KEYS(rotid_model_cause, MAY_BE_NULL, sensor, variant),
    STRUCTS(rotid_model_cause, parameters, 0,
            RECORD_OF(rotid_cause_parameter, KEYS(rotid_cause_parameter, 0, name, unit, value))),
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
