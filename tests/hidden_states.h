/* Decks of several states with hidden effects: the data of each are made by tools/hide, the rotor and its true parameters are the
 * same in all. */
#ifndef ROTID_TESTS_HIDDEN_STATES_H
#define ROTID_TESTS_HIDDEN_STATES_H

#include "hide/hide.h"

struct hidden_state {
    const char *name, *cards; /* of the state, "" without */
    int effects;              /* hidden in it, in place of those of the request */
    const char *const *effect;
};

/* The deck of nstate states, that of the request, which has no noise, and no sensors where the request has some, in front; the
 * noise of state s is drawn by the seed of the request plus s. truth (may be NULL): what hide says of the last one. To be freed;
 * NULL where hide refuses, message [room] says why. */
char *hidden_states_deck(const struct hide_request *request, int nstate, const struct hidden_state *state, char **truth,
                         char *message, size_t room);

#endif
