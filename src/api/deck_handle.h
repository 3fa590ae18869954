/* What stands behind the `memory` of a rotid_deck. */
#ifndef ROTID_API_DECK_HANDLE_H
#define ROTID_API_DECK_HANDLE_H

#include "api/call.h"
#include "run/states.h"

/* The states of a deck, for reading alone; NULL where there is none to compute with (deck NULL, or with errors): the notes of the
 * call say why then. */
const struct states *deck_states(const rotid_deck *deck, struct call *call);

/* The job of a deck of one state; NULL also where it has several. */
const struct job *deck_job(const rotid_deck *deck, struct call *call);

/* All states, and the job of the first one, without a call that has to be explained; NULL of a deck with errors. */
const struct states *deck_states_of(const rotid_deck *deck);
const struct job *deck_job_of(const rotid_deck *deck);

#endif
