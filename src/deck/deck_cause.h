/* The reader of CAUSE cards, by file: the card and its values, its target, what corrections do to the data. */
#ifndef ROTID_DECK_DECK_CAUSE_H
#define ROTID_DECK_DECK_CAUSE_H

#include "deck/deck_cards.h"
#include "diagnose/causes/catalogue.h"

struct cause_card {
    struct deck_reader *reader;
    const struct card *card;
    const char *name;
    const struct cause_kind *kind;
    int suspect;
    struct effect effect;
    struct correction correction;
};

/* What a target is called by on the card: its option, NULL where it has none, and what that expects. */
const char *cause_target_option(enum cause_target target);
const char *cause_target_expected(enum cause_target target);

/* Reads the target into effect.target or the sensors and the block of the correction; the variant is known. 0, or 1 after an
 * error. */
int cause_read_target(struct cause_card *c);

#endif
