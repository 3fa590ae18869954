/* The readers of the cards of a plan, by file. */
#ifndef ROTID_STUDY_PLAN_CARDS_H
#define ROTID_STUDY_PLAN_CARDS_H

#include "deck/deck_cards.h"
#include "study/plan.h"

struct plan_reader {
    struct deck_reader fields; /* pool, messages and end of memory, for the readers of single fields */
    struct plan *plan;
    size_t deck_room, variant_room, modes_room, sensors_room, noise_room, hide_room, truth_room;
    const struct card *study_card, *data_card, *starts_card, *truth_card, *hide_card;
};

void plan_study(struct plan_reader *reader, const struct card *card);
void plan_decks(struct plan_reader *reader, const struct card *card);
void plan_variant(struct plan_reader *reader, const struct card *card);
void plan_modes(struct plan_reader *reader, const struct card *card);
void plan_sensors(struct plan_reader *reader, const struct card *card);
void plan_data(struct plan_reader *reader, const struct card *card);
void plan_truth(struct plan_reader *reader, const struct card *card);
void plan_noise(struct plan_reader *reader, const struct card *card);
void plan_starts(struct plan_reader *reader, const struct card *card);
void plan_hide(struct plan_reader *reader, const struct card *card);

#endif
