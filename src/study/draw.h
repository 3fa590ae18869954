/* Random numbers that have a name instead of a place in a sequence: what a replicate draws for one purpose, mode and sensor is
 * the same in every run of it, whatever the runs leave out or who computes them. Runs that differ in a variant, in the modes
 * fitted or in the sensors kept so see the same noise, and their difference is that of the variant. */
#ifndef ROTID_STUDY_DRAW_H
#define ROTID_STUDY_DRAW_H

#include "base/random.h"

enum draw_purpose { DRAW_TRUTH = 1, DRAW_HIDDEN, DRAW_SENSOR, DRAW_FREQUENCY, DRAW_SHAPE, DRAW_START };

/* a, b: what it is drawn for, such as the number of the mode and the id of the sensor. */
struct random_stream draw_stream(unsigned long seed, enum draw_purpose purpose, long long replicate, uint64_t a, uint64_t b);

#endif
