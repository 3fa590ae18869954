/* Exact shapes of the paper's rotor, right or with something hidden in it, for the tests that look at shapes along the axis. */
#ifndef ROTID_TESTS_ROTOR_SHAPES_H
#define ROTID_TESTS_ROTOR_SHAPES_H

#include "exact.h"

#define SHAPE_POINTS 204 /* about 10 mm apart */

struct rotor_shapes {
    double length, z[SHAPE_POINTS];
    double value[EXACT_MODES][SHAPE_POINTS]; /* bending modes 1 ... 6; largest component 1 */
};

/* The paper's rotor with rods. */
void rotor_shapes_open(struct exact *exact);

/* EI and kGS of everything between two places times `factor`; may be used twice. */
void exact_soften(struct exact *exact, double from, double to, double factor);
/* Another point: a mass, a hinge. */
void exact_add(struct exact *exact, struct oracle_point point);

void rotor_shapes(const struct exact *exact, struct rotor_shapes *shapes);

/* Mode k (from 0) at z, cubic between the points. */
double rotor_shape_at(const struct rotor_shapes *shapes, int k, double z);

#endif
