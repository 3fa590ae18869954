/* Rotors for tests of src/solid, built in place: sections end to end, what is attached to them, and their frequencies as a solid.
 */
#ifndef SOLID_RIG_H
#define SOLID_RIG_H

#include "diagnose/causes/causes.h"
#include "solid/solid.h"
#include "support.h"

#define RIG_MOST 64

struct rig {
    struct group group[8];
    struct segment segment[RIG_MOST];
    struct ring ring[8];
    struct spring spring[2];
    struct sensor sensor[600];
    struct disk disk[2];
    struct tierod tierod[2];
    struct bars bars[1];
    struct effect effect[24];
    struct rotor rotor;
};

extern const struct material rig_steel; /* E 2.1e11, nu 0.3, rho 7850 */
extern const struct material rig_stack; /* laminated */

void rig_begin(struct rig *b, int ngroup); /* all of steel */
void rig_section(struct rig *b, int group, double length, double diameter);
void rig_springs(struct rig *b, double left, double right);
void rig_sensors(struct rig *b, int count); /* even, all of them off the ends */
const struct effect_kind *rig_kind(const char *id);

/* Two-step steel shaft 0.3 x 0.10, 0.3 x 0.20, 0.3 x 0.10 m on soft springs; rotor A of seven sections, whose core is laminated
 * or of steel: each has frequencies of an independent program that the tests state. */
void rig_two_steps(struct rig *b);
void rig_rotor_a(struct rig *b, int laminated);

/* Frequencies [Hz] after the first `skip`, which are not looked at; returns the number of unknowns. rule: NULL, the default. */
int rig_solid(const struct rotor *rotor, const struct solid_rule *rule, int refine, int skip, int count, double *hz);

#endif
