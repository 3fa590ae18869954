/* Effects drawn from a seed: kind, place, and a size from too small to be seen to large.
 *
 * A draw is a SPEC, so that what is drawn can be written, and typed again. Sizes are uniform in their logarithm; those of masses,
 * springs and joints are in proportion to the rotor. */
#ifndef HIDE_DRAW_H
#define HIDE_DRAW_H

#include "hide_kind.h"
#include "hide_random.h"

/* random: "none"; an id of the table, or the name of a kind outside; "physical", "data", "outside": one of that class; "pair":
 * two physical ones, of one id only where each has a place; "any": none, physical, data, outside or pair. Only what applies to
 * the rotor is drawn, and with no_shapes nothing that takes shapes. Adds *count texts of HIDE_SPEC characters at most. */
int hide_draw(const struct hide_rotor *rotor, int modes, int no_shapes, const char *random, struct hide_random *stream,
              char spec[2][HIDE_SPEC], int *count, const struct hide_message *message);

#endif
