/* The paper's rotor on a coarse mesh with effects in it, for the tests of effects and causes. */
#ifndef ROTID_TESTS_EFFECT_BENCH_H
#define ROTID_TESTS_EFFECT_BENCH_H

#include "beam/beam.h"
#include "diagnose/causes/causes.h"
#include "support.h"

#define BENCH_EFFECTS 3

extern const struct cause_kind cause_step_stiffness, cause_stiffness_gradient, cause_stiffness_profile, cause_stiffness_local,
    cause_joint, cause_support, cause_added_mass, cause_density, cause_diameter, cause_stiffness, cause_tie_stiffness,
    cause_tie_tension, cause_tie_shear, cause_shear_coefficient, cause_accelerometer_mass, cause_support_position,
    cause_support_extra, cause_support_rotation, cause_clamp, cause_hub_stiffness, cause_added_inertia, cause_layer_slip;

/* Overwrites the static rotor of paper_rotor: bored left shaft, perforated core, a fan, springs that are felt, `elements` in
 * every segment (0: the paper's own), no effects yet. */
struct rotor *bench_rotor(enum bundle_model model, int rods, int elements);

/* Puts another effect into it, called "a", "b", "c" in turn. */
struct effect *bench_add(struct rotor *rotor, const struct effect_kind *kind, int target, int variant, const double *value);

/* A beam of it in the pool of the test, and its matrices. */
void bench_build(const struct rotor *rotor, int nparameter, const struct parameter *parameter, struct beam *beam);
void bench_matrices(struct beam *beam, const double *x, rotid_matrix *k, rotid_matrix *m);
rotid_matrix bench_zero(const struct beam *beam);

/* Largest entries of a - b, or of a where b is NULL, rotations divided by an element's length, so that every entry has the unit
 * of a translational stiffness and none hides behind another. */
double bench_largest(const rotid_matrix *a, const rotid_matrix *b);

/* dK/dx_p and dM/dx_p of beam_differentiate beside differences of fourth order over x_p (1 +- 2 step), or of x_p +- 2 step where
 * x_p is 0; side 1 or -1: over points on that side alone. The larger error of the two, relative to the largest entry. */
double bench_derivative_error(struct beam *beam, int p, double step, int side);

/* The cones of step_stiffness from their definition, all steps and no shortcuts: the stiffness diameter at z, and what carries
 * stiffness inside a diameter of a segment; holes lie inside the section, and those across the diameter count in part. */
double bench_cone_diameter(const struct rotor *rotor, int segment, double z, double angle);
void bench_section(const struct rotor *rotor, int segment, double diameter, double *area, double *inertia);

#endif
