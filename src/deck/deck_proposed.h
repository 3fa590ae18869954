/* A test that is proposed, as the state of a deck. */
#ifndef ROTID_DECK_DECK_PROPOSED_H
#define ROTID_DECK_DECK_PROPOSED_H

#include "base/message.h"
#include "suggest/suggest.h"

/* The *STATE of a test: what changes in the rotor, its sensors, its noise, and as comments where its measurements go, beside the
 * frequencies that the best rival expects, all in the units of the deck. job: the model that is tested. ROTID_OK and *text on the
 * pool, ROTID_ERROR_MEMORY, or ROTID_ERROR_ARGUMENT where a deck cannot say it: a support without a name. */
int deck_write_test(struct pool *pool, const struct job *job, const struct test *test, char **text);

/* The text `deck` of the file `path` (NULL: it is read) with that state behind it: as it is where it has states, of which the new
 * one takes the cards of `home` (may be NULL) that say how the structure is; else its measured data become a state of their own,
 * `measured`, so that the other cards are common to both. Comments and *INCLUDE stay, but for a file that holds what is common
 * beside what was measured: its cards stand in its place. Where the deck has a state of the name of the new one, that gets a
 * number. Relative paths become absolute where `to`, the file that is written (NULL: paths stay), lies in another folder.
 * ROTID_OK, ROTID_ERROR_MEMORY or, of a file or folder that cannot be read, ROTID_ERROR_IO. */
int deck_add_state(struct pool *pool, const char *path, const char *deck, const char *to, const char *home, const char *state,
                   char **text);

/* The same of a test that was suggested, read back: with the expected frequencies in it the text reads as the states of the file
 * `from`, to the last digit, and one more, which is `home` with what the test changes. Else *text is NULL, the list has an error
 * and the status is ROTID_ERROR_SYNTAX, or ROTID_ERROR_IO or ROTID_ERROR_MEMORY. */
int deck_propose(struct pool *pool, const char *from, const char *to, const char *home, const rotid_suggested_test *test,
                 struct message_list *notes, char **text);

#endif
