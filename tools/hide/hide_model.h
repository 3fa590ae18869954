/* From a rotor with effects to a system of the oracle. */
#ifndef HIDE_MODEL_H
#define HIDE_MODEL_H

#include "hide_kind.h"
#include "oracle/oracle.h"

/* A rotor with what is hidden in it. */
struct hide_physics {
    const struct hide_rotor *rotor;
    int effects, refine;
    const struct hide_effect *effect;
    const struct hide_disk *moving; /* a mass that is there besides, or NULL */
    double ground;                  /* factor on springs to the ground and on axial forces; 1 */
};

/* Properties of the rotor at one place. */
struct hide_section {
    double bending, shear, mass, inertia; /* EI, kGS, rhoS, rhoI */
};
void hide_section_at(const struct hide_physics *physics, int segment, double z, struct hide_section *section);

/* Ends of uniform stretches, ascending, from 0 to the length; to be freed. NULL without memory. */
double *hide_cuts(const struct hide_physics *physics, int *count);

struct hide_model {
    struct oracle_system system; /* points to what follows */
    struct oracle_segment *segment;
    struct oracle_point *point;
    struct oracle_parallel parallel[HIDE_MOST_TIES];
};

/* Whatever it returns, hide_model_close. */
int hide_model_open(const struct hide_physics *physics, struct hide_model *model, const struct hide_message *message);
void hide_model_close(struct hide_model *model);

#endif
