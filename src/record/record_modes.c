#include "record/rows.h"

PART_TABLE(measured_record, rotid_compared_mode) = {
    INTEGER(rotid_compared_mode, measured_mode, FROM_1 | SINCE_LATER),
    NUMBER(rotid_compared_mode, measured_hz, ABOVE_0),
    NUMBER(rotid_compared_mode, frequency_std, ABOVE_0 | MAY_BE_NULL | SINCE_LATER),
    NUMBER(rotid_compared_mode, predicted_hz, FROM_0),
    NUMBER(rotid_compared_mode, error_percent, 0),
    KEYS(rotid_compared_mode, CORRELATION | MAY_BE_NULL, mac, nco),
    TEXT_OF(rotid_compared_mode, paired_by, 0, pairing_words),
    FLAG(rotid_compared_mode, holdout, 0),
    TEXT_OF(rotid_compared_mode, type, SINCE_LATER, mode_type_words),
    {0},
};

PART_TABLE(meridian_mode_record, rotid_meridian_mode) = {
    NUMBERS(rotid_meridian_mode, u, ROUNDED),
    NUMBERS(rotid_meridian_mode, w, ROUNDED),
    NUMBERS(rotid_meridian_mode, energy, ROUNDED),
    {0},
};

PART_TABLE(mode_record, rotid_model_mode) = {
    INTEGER(rotid_model_mode, mode, FROM_1),
    NUMBER(rotid_model_mode, full_hz, FROM_0),
    NUMBER(rotid_model_mode, reduced_hz, FROM_0 | MAY_BE_NULL),
    KEYS(rotid_model_mode, MAY_BE_NULL, reduction_error_percent, mesh_error_percent),
    NUMBERS_AS(rotid_model_mode, shape, 0, rotid_spectrum, sensor_z_m),
    INLINE(rotid_model_mode, measured, IF_KNOWN | BEHIND_POINTER, measured_record),
    STRUCT(rotid_model_mode, meridian, IF_KNOWN | BEHIND_POINTER, meridian_mode_record),
    {0},
};

PART_TABLE(meridian_record, rotid_meridian) = {
    NUMBERS(rotid_meridian, r_m, ROUNDED | FROM_0),
    NUMBERS_BY(rotid_meridian, z_m, ROUNDED, nr_m, "r_m"),
    STRUCTS(rotid_meridian, elements, NOT_EMPTY,
            RECORD_OF(rotid_meridian_element, INTEGER(rotid_meridian_element, group, FROM_0),
                      INDICES(rotid_meridian_element, corner, 4))),
    {0},
};

PART_TABLE(beside_mode_record, rotid_beside_mode) = {
    KEYS(rotid_beside_mode, FROM_1, mode, beam_mode),
    KEYS(rotid_beside_mode, ABOVE_0, solid_hz, beam_hz),
    NUMBER(rotid_beside_mode, difference_percent, 0),
    KEYS(rotid_beside_mode, CORRELATION | MAY_BE_NULL, nco, mac),
    KEYS(rotid_beside_mode, MAY_BE_NULL, solid_mesh_error_percent, beam_mesh_error_percent),
    {0},
};

PART_TABLE(beside_modulus_record, rotid_beside_modulus) = {
    TEXT(rotid_beside_modulus, name, 0),
    KEYS(rotid_beside_modulus, ABOVE_0, stated_pa, found_pa),
    NUMBER(rotid_beside_modulus, change_percent, 0),
    {0},
};

PART_TABLE(beside_record, rotid_beam_beside_solid) = {
    STRUCTS(rotid_beam_beside_solid, modes, NOT_EMPTY, beside_mode_record),
    STRUCTS(rotid_beam_beside_solid, moduli, 0, beside_modulus_record),
    INTEGERS(rotid_beam_beside_solid, fitted_modes, FROM_1),
    NUMBER(rotid_beam_beside_solid, fitted_rms_percent, MAY_BE_NULL | FROM_0),
    TEXT(rotid_beam_beside_solid, sentence, MAY_BE_NULL),
    {0},
};

TABLE(spectrum_record, rotid_spectrum) = {
    TEXT_OF(rotid_spectrum, reduction, 0, reduction_words),
    NUMBERS(rotid_spectrum, rigid_hz, FROM_0),
    NUMBERS(rotid_spectrum, sensor_z_m, 0),
    STRUCTS(rotid_spectrum, modes, 0, mode_record),
    STRUCT(rotid_spectrum, geometry, SINCE_LATER | BEHIND_POINTER, geometry_record),
    STRUCT(rotid_spectrum, meridian, IF_KNOWN | BEHIND_POINTER, meridian_record),
    TEXT_OF(rotid_spectrum, type, SINCE_LATER, mode_type_words),
    STRUCT(rotid_spectrum, beside, IF_KNOWN | BEHIND_POINTER, beside_record),
    {0},
};

TABLE(spectrum_whole_record, rotid_spectrum) = {
    ROWS(0, spectrum_record),
    MATRIX(rotid_spectrum, master_mass, 0, nsensor_z_m, nsensor_z_m),
    {0},
};

PART_TABLE(solid_mesh_record, rotid_solid_mesh) = {
    KEYS(rotid_solid_mesh, FROM_1, unknowns, half_band, slices),
    NUMBER(rotid_solid_mesh, corner_m, MAY_BE_NULL | ABOVE_0),
    NUMBER(rotid_solid_mesh, largest_m, ABOVE_0),
    {0},
};
TABLE(check_record, rotid_check) = {
    NUMBER(rotid_check, length_m, ABOVE_0),
    NUMBER(rotid_check, mass_kg, ABOVE_0),
    NUMBER(rotid_check, center_of_mass_m, 0),
    NUMBER(rotid_check, inertia_kg_m2, ABOVE_0),
    KEYS(rotid_check, FROM_1, nodes, elements),
    STRUCT(rotid_check, solid, IF_KNOWN | BEHIND_POINTER, solid_mesh_record),
    INTEGER(rotid_check, rigid_modes, FROM_0),
    NUMBERS(rotid_check, rigid_hz, FROM_0),
    INTEGER(rotid_check, measured_modes, FROM_0),
    TEXT_OF(rotid_check, functional, 0, functional_words),
    TEXT_OF(rotid_check, reduction, 0, reduction_words),
    STRUCTS(rotid_check, sensors, 0, sensor_record),
    TEXTS(rotid_check, parameters, 0),
    STRUCT(rotid_check, geometry, SINCE_LATER | BEHIND_POINTER, geometry_record),
    STRUCTS(rotid_check, weighed, SINCE_LATER, weighed_record),
    {0},
};
