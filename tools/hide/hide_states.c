#include "hide_states.h"

#include <stdlib.h>
#include <string.h>

#include "hide_write.h"

#define MOST_STATES 100

struct reader {
    const struct hide_request *request;
    const struct hide_cards *cards;
    const struct hide_message *message;
    int common, states;         /* cards before the first *STATE */
    int first[MOST_STATES + 1]; /* the *STATE card of each, and the end */
};

static const char *name_of(const struct reader *r, int state)
{
    const char *name = hide_card_option(&r->cards->card[r->first[state]], "NAME");
    return name ? name : "";
}

static int find_states(struct reader *r)
{
    for (int i = 0; i < r->cards->cards; i++) {
        if (!hide_same(r->cards->card[i].name, "STATE"))
            continue;
        if (r->states == MOST_STATES)
            return hide_fail(r->message, HIDE_INPUT, "%s: expected at most %d states", r->request->name, MOST_STATES);
        r->first[r->states++] = i;
        if (!*name_of(r, r->states - 1) || strpbrk(name_of(r, r->states - 1), "\"\\"))
            return hide_fail(r->message, HIDE_INPUT, "%s:%d: *STATE: expected NAME=name, without quotes", r->request->name,
                             r->cards->card[i].number);
    }
    r->common = r->first[0];
    r->first[r->states] = r->cards->cards;
    return HIDE_OK;
}

/* Whether the state has a card in place of this common one. */
static int is_replaced(const struct reader *r, int state, const struct hide_card *common)
{
    if (!hide_same(common->name, "SENSORS") && !hide_same(common->name, "SLING"))
        return 0;
    for (int i = r->first[state] + 1; i < r->first[state + 1]; i++)
        if (hide_same(r->cards->card[i].name, common->name))
            return 1;
    return 0;
}

/* The deck of one state: the text with blanks for what is not of it, so that lines keep their numbers. NULL without memory. */
static char *deck_of(const struct reader *r, int state)
{
    char *text = malloc(strlen(r->request->deck) + 1);
    if (!text)
        return NULL;
    strcpy(text, r->request->deck);
    for (int i = 0; i < r->cards->cards; i++) {
        const struct hide_card *card = &r->cards->card[i];
        if (i < r->common ? !is_replaced(r, state, card) : i > r->first[state] && i < r->first[state + 1])
            continue;
        for (size_t k = card->begin; k < card->end; k++)
            text[k] = text[k] == '\n' ? '\n' : ' ';
    }
    return text;
}

static int is_in(const struct reader *r, int state, const char *effect_in)
{
    const char *name = name_of(r, state), *equals = strchr(effect_in, '=');
    size_t length = equals ? (size_t)(equals - effect_in) : 0;
    return equals && strlen(name) == length && !strncmp(effect_in, name, length);
}

/* The SPECs of a state into spec: those of all, its own, and those that were drawn for the first state. How many. */
static int effects_of(const struct reader *r, int state, const struct hide_part *first, const char **spec)
{
    const struct hide_request *request = r->request;
    int count = 0, own_of_first = 0;
    for (int i = 0; i < request->effects; i++)
        spec[count++] = request->effect[i];
    for (int i = 0; i < request->effects_in && count < HIDE_MOST_EFFECTS; i++) {
        own_of_first += is_in(r, 0, request->effect_in[i]);
        if (is_in(r, state, request->effect_in[i]))
            spec[count++] = strchr(request->effect_in[i], '=') + 1;
    }
    for (int i = request->effects + own_of_first; i < first->effects && state; i++)
        spec[count++] = first->spec[i];
    return count;
}

static int check_effects(const struct reader *r)
{
    for (int i = 0; i < r->request->effects_in; i++) {
        const char *text = r->request->effect_in[i];
        int found = 0;
        for (int s = 0; s < r->states; s++)
            found |= is_in(r, s, text);
        if (!found)
            return hide_fail(r->message, HIDE_INPUT, "--effect-in %s: expected NAME=SPEC with a state of the deck", text);
    }
    return HIDE_OK;
}

static int make_state(const struct reader *r, int state, const struct hide_part *first, struct hide_part *part)
{
    const char *spec[2 * HIDE_MOST_EFFECTS];
    struct hide_request own = *r->request;
    char *deck = deck_of(r, state);
    own.effects = effects_of(r, state, first, spec);
    own.effect = spec;
    own.effects_in = 0;
    own.random = state ? NULL : own.random;
    own.state = state;
    own.deck = deck;
    int status = deck ? hide_one(&own, part, r->message) : hide_fail(r->message, HIDE_FAILURE, "no memory for a state");
    free(deck);
    return status;
}

char *hide_state_text(const char *deck, const char *name, const char *state, const struct hide_cards *cards, int *first, int *end,
                      int *status, const struct hide_message *message)
{
    const struct hide_request request = {.deck = deck, .name = name};
    struct reader r = {.request = &request, .cards = cards, .message = message};
    char *text = NULL;
    *status = find_states(&r);
    int s = 0;
    while (s < r.states && !hide_same(name_of(&r, s), state))
        s++;
    if (!*status && s == r.states) {
        *status = hide_fail(message, HIDE_INPUT, "--state %s: expected a *STATE of %s", state, name);
    } else if (!*status) {
        *first = r.first[s];
        *end = r.first[s + 1];
        text = deck_of(&r, s);
        *status = text ? HIDE_OK : hide_fail(message, HIDE_FAILURE, "no memory for a state");
    }
    return text;
}

int hide_states(const struct hide_request *request, const struct hide_cards *cards, struct hide_text *deck,
                struct hide_text *truth, const struct hide_message *message)
{
    struct reader r = {.request = request, .cards = cards, .message = message};
    struct hide_part *part = calloc(MOST_STATES, sizeof *part);
    int status = part ? find_states(&r) : hide_fail(message, HIDE_FAILURE, "no memory for states"),
        new_sensors = request->sensors || request->half_sensors;
    if (!status)
        status = check_effects(&r);
    for (int s = 0; s < r.states && !status; s++)
        status = make_state(&r, s, &part[0], &part[s]);
    if (!status) {
        hide_write_cards(request->deck, cards, 0, r.common, new_sensors, deck);
        hide_add(truth, "{\n\"states\": [\n");
    }
    for (int s = 0; s < r.states && !status; s++) {
        hide_write_cards(request->deck, cards, r.first[s], r.first[s + 1], new_sensors, deck);
        hide_add_bytes(deck, part[s].data.data, part[s].data.length);
        hide_add(truth, "%s{\"name\": \"%s\", \"truth\": ", s ? ",\n" : "", name_of(&r, s));
        hide_add_bytes(truth, part[s].truth.data, part[s].truth.length);
        hide_add(truth, "}");
    }
    hide_add(truth, "]\n}\n");
    for (int s = 0; s < r.states && part; s++)
        hide_part_free(&part[s]);
    free(part);
    return status;
}
