/* True values of what the deck identifies. */
#ifndef HIDE_PARAMETER_H
#define HIDE_PARAMETER_H

#include "hide_random.h"
#include "hide_rotor.h"

/* Sets parameter[].truth and puts it into the rotor: as given ("core.E=1.1e11"), else drawn within 15 % of the value of the deck
 * and inside the bounds. */
int hide_parameters_set(int truths, const char *const *truth, struct hide_random *random, struct hide_rotor *rotor,
                        const struct hide_message *message);

#endif
