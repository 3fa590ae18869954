/* A test that is proposed, as the state of a deck. */
#ifndef ROTID_DECK_DECK_PROPOSED_H
#define ROTID_DECK_DECK_PROPOSED_H

#include "suggest/suggest.h"

/* The *STATE of a test: what changes in the rotor, its sensors, its noise, and as comments where its measurements go, beside the
 * frequencies that the best rival expects. job: the model that is tested. ROTID_OK and *text on the pool, ROTID_ERROR_MEMORY, or
 * ROTID_ERROR_ARGUMENT where a deck cannot say it: a support without a name. */
int deck_write_test(struct pool *pool, const struct job *job, const struct test *test, char **text);

/* The text of a deck with that state behind it: as it is where it has states, of which the new one takes the cards of `home` (may
 * be NULL) that say how the structure is; else its measured data become a state of their own, `measured`, so that the other cards
 * are common to both. Comments stay. ROTID_OK or ROTID_ERROR_MEMORY. */
int deck_add_state(struct pool *pool, const char *deck, const char *home, const char *state, char **text);

#endif
