/* Decks of several states: the cards before the first *STATE and those of a state are the deck of that state, which is read like
 * any other. */
#ifndef ROTID_DECK_DECK_STATE_H
#define ROTID_DECK_DECK_STATE_H

#include "deck/deck_cards.h"
#include "run/states.h"

/* All states of the text, or the one that FIT, STATE=NAME chooses; of a deck without *STATE the one that it is. Cards from
 * `nread` on are common to all: overrides and others have added them. Memory, messages and text are those of reader, which is
 * otherwise new. Errors go to the list, of the common cards once; no section: as in the reader. */
void deck_read_all_states(struct deck_reader *reader, int nread, struct states *states);

/* Cards: *STATE itself, with the modes of that state; *SET. */
void deck_state(struct deck_reader *reader, const struct card *card);
void deck_set(struct deck_reader *reader, const struct card *card);
/* What *SET says of lengths, before anything refers to positions. */
void deck_set_lengths(struct deck_reader *reader);

#endif
