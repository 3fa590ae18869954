/* All cards of a deck: deck_card_table and deck_card_find of deck_row.h, by the name that readers of new cards include. */
#ifndef ROTID_DECK_CARD_TABLE_H
#define ROTID_DECK_CARD_TABLE_H

#include "deck/deck_row.h"

#endif
