/* Shared by what writes decks of several states. */
#ifndef ROTID_DECK_DECK_WRITE_STATES_H
#define ROTID_DECK_DECK_WRITE_STATES_H

#include "deck/deck_writer.h"

struct deck_card;

/* A card with its data lines; of a group or a bundle with the material in front of it. */
struct block {
    const char *text;
    size_t length;
    const struct deck_card *kind;
    int part, common; /* part: faults of the data and causes are lists of their own */
};

struct written {
    const struct state *state;
    int *common; /* [job.unknowns.nparameter] which of its unknowns are common to all */
    struct deck_writer w;
    struct deck_writer set; /* the lines of *SET */
    int nblock;
    struct block *block;
};

/* Gives the groups of all states [nstate] one material and one length each where *SET can say how they differ, and writes the
 * lines of *SET. ROTID_OK, ROTID_ERROR_MEMORY or, of a name that no deck can say, ROTID_ERROR_ARGUMENT. */
int deck_put_sets(struct pool *pool, int nstate, struct written *state);

#endif
