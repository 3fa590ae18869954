/* Decks that a test reads: from a text, by way of a file in the folder (folder.h) of the test program, or from a file. */
#ifndef ROTID_TESTS_READING_H
#define ROTID_TESTS_READING_H

#include "deck/deck.h"
#include "one_state.h"

struct reading {
    struct pool pool; /* to be closed by the test */
    struct message_list messages;
    struct job job;
    int status;
};

/* set: one --set, or NULL. try_path takes what comes; the others fail the test, with the messages, where the deck has an error.
 */
void try_path(struct reading *r, const char *path, const char *set);
void read_path(struct reading *r, const char *path, const char *set);
void read_text(struct reading *r, const char *text, const char *set);

/* A job, or all states, of a right deck into test_pool. */
void read_job(const char *text, struct message_list *messages, struct job *job);
struct states read_states(const char *text);
struct states read_states_at(const char *path, const struct override *override);

/* A right deck as a host reads it, from its text alone; set [nset] as above. */
rotid_deck *read_handle(const char *text, int nset, const char *const *set);

/* Frequencies [Hz] of the first modes of a type (ROTID_BENDING ...) of a right deck that are no rigid motion: hz [count] */
void read_frequencies(const char *text, int type, int count, double *hz);

/* The first message that holds these words; of that severity. NULL: there is none. */
const rotid_message *find_message(const struct message_list *messages, const char *words);
int warns(const struct message_list *messages, const char *words);

#endif
