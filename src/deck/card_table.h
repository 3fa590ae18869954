/* All cards of a deck. */
#ifndef ROTID_DECK_CARD_TABLE_H
#define ROTID_DECK_CARD_TABLE_H

#include "deck/deck_row.h"

/* The cards there are, ended by one without a name. */
extern const struct deck_card deck_card_table[];

/* NULL where there is none of this name. */
const struct deck_card *deck_card_find(const char *name);

#endif
