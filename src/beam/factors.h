/* What the effects of a rotor do to the elements of the axis. */
#ifndef ROTID_BEAM_FACTORS_H
#define ROTID_BEAM_FACTORS_H

#include "beam/beam.h"

/* Room for the factors of a beam whose mesh is built, and their first values. ROTID_OK or ROTID_ERROR_MEMORY. */
int factors_open(struct pool *pool, struct beam *beam);

/* Computes beam->factor anew, where there is one. */
void factors_refresh(struct beam *beam);

/* The parts of the section of element e, how many there are, and the factors of each, NULL without effects. */
int factors_parts(const struct beam *beam, int e, const struct section_part **part, struct effect_field **factor);

/* A part of element e as the hooks of effects see it. */
struct effect_span factors_span(const struct beam *beam, int e, const struct section_part *part);

#endif
