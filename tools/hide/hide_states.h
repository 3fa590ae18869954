/* One rotor in the states of a deck. */
#ifndef HIDE_STATES_H
#define HIDE_STATES_H

#include "hide_cards.h"
#include "hide_kind.h"

/* What one state has, or a deck without *STATE: its measured data, its truth as JSON, and the SPECs of its effects, drawn ones
 * with them. */
struct hide_part {
    struct hide_text data, truth;
    int effects;
    char spec[HIDE_MOST_EFFECTS][HIDE_SPEC];
};

/* Of a deck without *STATE. To be freed whatever it returns. */
int hide_one(const struct hide_request *request, struct hide_part *part, const struct hide_message *message);
void hide_part_free(struct hide_part *part);

/* The deck of the state of this name, to be freed: the text with blanks for what is not of it, so that lines keep their numbers.
 * The *STATE card of it and the card behind it go to *first and *end; cards: of the text, some of them *STATE or none. NULL with
 * *status and a message. */
char *hide_state_text(const char *deck, const char *name, const char *state, const struct hide_cards *cards, int *first, int *end,
                      int *status, const struct hide_message *message);

/* The deck and the truth of all states; cards: of request->deck, some of them *STATE. */
int hide_states(const struct hide_request *request, const struct hide_cards *cards, struct hide_text *deck,
                struct hide_text *truth, const struct hide_message *message);

#endif
