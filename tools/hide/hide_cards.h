/* A deck as cards, before anything is known of what they mean. */
#ifndef HIDE_CARDS_H
#define HIDE_CARDS_H

#include <stddef.h>

#include "hide_text.h"

#define HIDE_MOST_OPTIONS 12

struct hide_option {
    char *name, *value; /* value "" where there is none */
};

struct hide_line {
    char *text; /* without comment and blanks around it */
    int number; /* from 1 */
};

struct hide_card {
    char *name;
    int number, options, first, lines; /* number of its line; lines first ... first + lines - 1 are its data */
    struct hide_option option[HIDE_MOST_OPTIONS];
    size_t begin, end; /* of all of it in the text of the deck, comments included */
};

struct hide_cards {
    char *copy; /* of the text; everything points into it */
    int cards;
    struct hide_card *card;
    struct hide_line *line;
};

/* Whatever it returns, hide_cards_free. */
int hide_cards_read(const char *deck, const char *name, struct hide_cards *cards, const struct hide_message *message);
void hide_cards_free(struct hide_cards *cards);

/* The value of an option, or NULL. */
const char *hide_card_option(const struct hide_card *card, const char *name);

#endif
