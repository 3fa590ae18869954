#include "hide_cards.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "hide.h"

const char *hide_card_option(const struct hide_card *card, const char *name)
{
    for (int i = 0; i < card->options; i++)
        if (hide_same(card->option[i].name, name))
            return card->option[i].value;
    return NULL;
}

void hide_cards_free(struct hide_cards *cards)
{
    free(cards->copy);
    free(cards->card);
    free(cards->line);
}

/* Options of a keyword line; pieces without = are a list going on (MODES=1,2) or words, and their value is "". */
static int add_options(struct hide_card *card, char *text)
{
    char *field[HIDE_MOST_OPTIONS + 1];
    int count = hide_fields(text, HIDE_MOST_OPTIONS + 1, field);
    for (int i = 0; i < count; i++) {
        char *equals = strchr(field[i], '=');
        if (isdigit((unsigned char)field[i][0]) || !*field[i])
            continue;
        if (card->options == HIDE_MOST_OPTIONS)
            return 1;
        struct hide_option *option = &card->option[card->options++];
        option->value = equals ? hide_trim(equals + 1) : field[i] + strlen(field[i]);
        if (equals)
            *equals = 0;
        option->name = hide_trim(field[i]);
    }
    return count < 0;
}

static int goes_on(const char *text)
{
    size_t length = strlen(text);
    return length > 0 && text[length - 1] == ',';
}

int hide_cards_read(const char *deck, const char *name, struct hide_cards *cards, const struct hide_message *message)
{
    size_t length = strlen(deck), lines = 1;
    int number = 0, data = 0, continues = 0;
    *cards = (struct hide_cards){.copy = malloc(length + 1)};
    for (size_t i = 0; i < length; i++)
        lines += deck[i] == '\n';
    cards->card = calloc(lines, sizeof *cards->card);
    cards->line = calloc(lines, sizeof *cards->line);
    if (!cards->copy || !cards->card || !cards->line)
        return hide_fail(message, HIDE_FAILURE, "no memory for the deck");
    memcpy(cards->copy, deck, length + 1);
    if (!memcmp(cards->copy, "\xEF\xBB\xBF", length < 3 ? length + 1 : 3))
        memset(cards->copy, ' ', 3);
    for (char *next = cards->copy, *text; next;) {
        size_t begin = (size_t)(next - cards->copy);
        text = next;
        next = strchr(text, '\n');
        if (next)
            *next++ = 0;
        number++;
        char *comment = strstr(text, "**");
        if (comment)
            *comment = 0;
        text = hide_trim(text);
        struct hide_card *card = cards->cards ? &cards->card[cards->cards - 1] : NULL;
        int wrong = 0, keyword = *text == '*', follows = continues && !keyword && *text;
        if (keyword) {
            if (card)
                card->end = begin;
            card = &cards->card[cards->cards++];
            *card = (struct hide_card){.name = text + 1, .number = number, .first = data, .begin = begin};
            char *comma = strchr(text, ',');
            continues = goes_on(text);
            if (comma) {
                *comma = 0;
                wrong = add_options(card, comma + 1);
            }
            card->name = hide_trim(card->name);
        } else if (follows) {
            continues = goes_on(text);
            wrong = add_options(card, text);
        } else if (*text && !card) {
            return hide_fail(message, HIDE_INPUT, "%s:%d: data before the first card, expected a line that begins with *", name,
                             number);
        } else if (*text) {
            cards->line[data++] = (struct hide_line){text, number};
            card->lines++;
        }
        if (wrong)
            return hide_fail(message, HIDE_INPUT, "%s:%d: expected at most %d options", name, number, HIDE_MOST_OPTIONS);
    }
    if (cards->cards)
        cards->card[cards->cards - 1].end = length;
    return HIDE_OK;
}
