/* The extended deck in the words of the user's own. */
#ifndef ROTID_DECK_DECK_KEEP_H
#define ROTID_DECK_DECK_KEEP_H

#include "deck/deck_write.h"
#include "diagnose/diagnose.h"

/* *text, in: the deck that deck_write_states makes of the states with the options; out: the deck `from` of the diagnosis with
 * what has to change in it, where that reads as the same states: its comments, names of materials, tables and mesh stay. Changed
 * are the heading (lines of the options behind its own), starts of *IDENTIFY, *FIT, elements where the mesh of the states is
 * another one; measured data stand in it as in *text where they are those of a file, or were corrected; causes, faults of the
 * data and their unknowns come last. *text stays where the deck has several states, names files for anything else, cannot be read
 * again, or where what came of it is read as something else. ROTID_OK, ROTID_ERROR_MEMORY or, where *text itself does not read as
 * the states, ROTID_ERROR_ARGUMENT with *text NULL. */
int deck_keep(struct pool *pool, const struct diagnosis *d, const struct states *states, const struct deck_write_options *options,
              const char *from, char **text);

#endif
