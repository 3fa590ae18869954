/* The paper's rotor as plain structs, for tests that do not go through a deck. Measured frequencies: the paper's Table 3.
 * Geometry: a stated surrogate (the paper prints none), fitted to its Tables 1 and 3, its mass of 998 kg and its centre of mass
 * at 1.0594 m; provenance in input/paper_rotor.inp. */
#ifndef ROTID_TESTS_PAPER_ROTOR_H
#define ROTID_TESTS_PAPER_ROTOR_H

#include "beam/beam.h"

#define PAPER_SENSORS 68
#define PAPER_MODES   6

extern const double paper_measured_hz[PAPER_MODES];
extern const double paper_start[2];                /* E, G where the paper starts */
extern const struct parameter paper_parameters[2]; /* core.E, core.G */

/* Overwrites a static rotor: one at a time. */
struct rotor *paper_rotor(enum bundle_model model, int self_equilibrated);

#endif
