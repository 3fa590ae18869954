/* Frequencies of a rotor twice over, for the tests that hold the finite elements against the truth: from the oracle, and from
 * meshes of librotid. The oracle's system is worked out here from the meaning of the deck's cards, with no help of librotid. */
#ifndef ROTID_TESTS_EXACT_H
#define ROTID_TESTS_EXACT_H

#include "oracle/oracle.h"
#include "rotor/rotor.h"
#include "support.h"

#define EXACT_MODES 6

struct exact {
    struct oracle_system system; /* points into this struct: do not copy it */
    struct oracle_segment segment[32];
    struct oracle_point point[32];
    struct oracle_parallel parallel[4];
};

/* Tie rods of one element of isotropic material; bars are left out, since the oracle has no branches. */
void exact_open(const struct rotor *rotor, struct exact *exact);
void exact_hz(const struct exact *exact, int first, int count, double *hz);

/* How many natural frequencies of a rotor with one bundle of tie rods in infinitely many elements lie below hz. */
int exact_count(const struct rotor *rotor, double hz);

/* A bundle as a uniform beam; `pitch_inertia` gets S e^2/2, which for RODS is not part of its bending. */
struct oracle_segment exact_bundle(enum bundle_model model, const struct material *material, int number, double diameter,
                                   double pitch, double length, double *pitch_inertia);

/* Modes skip + 1 ... skip + count of the full model, every element cut into `refine`. */
void mesh_hz(const struct rotor *rotor, int refine, int skip, int count, double *hz);
/* Extrapolated from `refine` and 2 `refine` for errors of h^2. */
void limit_hz(const struct rotor *rotor, int refine, int skip, int count, double *hz);

/* Every one of `count` within rtol; a failure names the mode. */
#define assert_hz(count, value, expected, rtol) assert_hz_at((count), (value), (expected), (rtol), #value, __FILE__, __LINE__)
void assert_hz_at(int count, const double *value, const double *expected, double rtol, const char *text, const char *file,
                  int line);

/* Largest |a_k/b_k - 1|. */
double worst_ratio(int count, const double *a, const double *b);

/* The factor that brings a nearest to b by least squares; *mac of the two. */
double best_scale(int count, const double *a, const double *b, double *mac);

#endif
