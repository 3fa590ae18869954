/* Input decks: keyword cards as in docs/deck.md. */
#ifndef ROTID_DECK_DECK_H
#define ROTID_DECK_DECK_H

#include "deck/deck_text.h"
#include "run/states.h"

/* Reads a deck, a file or one from memory (not NULL), applies the overrides, reads the measured data it names and checks
 * everything. All errors of the deck are in the list, each with file, line and column. ROTID_OK, ROTID_ERROR_SYNTAX,
 * ROTID_ERROR_IO, ROTID_ERROR_MEMORY, or ROTID_ERROR_SECTION where all that is wrong is a section that cannot be. */
int deck_read_states(struct pool *pool, const char *path, const struct deck_memory *memory, int noverride,
                     const struct override *override, struct message_list *messages, struct states *states);

/* The same of a deck that has one state, by itself or by FIT, STATE=NAME; of another SYNTAX. */
int deck_read(struct pool *pool, const char *path, int noverride, const struct override *override, struct message_list *messages,
              struct job *job);

/* All states with cards [ncard] of somebody else behind those of the deck, common to all. They keep their own places, which
 * errors name. */
int deck_read_with(struct pool *pool, const char *path, int noverride, const struct override *override, int ncard,
                   const struct card *card, struct message_list *messages, struct states *states);

#endif
