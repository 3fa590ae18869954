/* Decks from jobs: one self-contained text that deck_read turns into the same job. */
#ifndef ROTID_DECK_DECK_WRITE_H
#define ROTID_DECK_DECK_WRITE_H

#include "base/pool.h"
#include "run/states.h"

struct deck_write_options {
    int nextra;
    const char *const *extra; /* [nextra] lines of text for the heading, behind those of the job; long ones are cut */
    const double *x;          /* [nparameter] the model and the starts of *IDENTIFY at these values; NULL: as in the job */
};

/* The deck of a job. Measured data stand in it as they were read, in *SENSORS, *MODES and *SHAPE, with the faults found in them
 * as *CAUSE cards behind. Reading it gives the numbers of the job to the last bit, but a standard deviation of a frequency within
 * one unit of the last place and, where x lies on a bound or is zero, a start beside it; names of materials become those of their
 * owners.
 * options may be NULL. ROTID_OK and *text on the pool; ROTID_ERROR_MEMORY; ROTID_ERROR_ARGUMENT where a deck cannot say it: a
 * name with a comma or too long for a line, a cause without a name, a sensor id or mode number beyond those of a deck, too many
 * cards. */
int deck_write(struct pool *pool, const struct job *job, const struct deck_write_options *options, char **text);

/* The deck of all states; x of the options: of the unknowns of all [states->nparameter]. Common are the cards that all states
 * begin with, and the unknowns that are common or of a cause that is in all; moduli, densities and lengths of groups that differ
 * stand in *SET. Reading it gives each state as deck_write would, but for lengths that *SET states, and positions on them, within
 * 1e-12. Statuses as of deck_write. */
int deck_write_states(struct pool *pool, const struct states *states, const struct deck_write_options *options, char **text);

#endif
