/* What options have to be. Internal to hammer. */
#ifndef HAMMER_OPTIONS_H
#define HAMMER_OPTIONS_H

#include "hammer.h"
#include "hide/hide_rotor.h"
#include "hide/hide_text.h"

#define HAMMER_MOST_COUNT 1048576 /* samples of a record */

/* HAMMER_OK, or HAMMER_INPUT with a message of what was expected. */
int hammer_options_check(const struct hammer_options *options, const struct hide_message *message);
int hammer_faults_check(const struct hammer_options *options, const struct hide_rotor *rotor, const struct hide_message *message);

#endif
