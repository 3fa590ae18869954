/* The states of a deck: a structure that was measured more than once is a job for each time, complete by itself, over unknowns
 * that they share. What works on one job works on that of one state. */
#ifndef ROTID_RUN_STATES_H
#define ROTID_RUN_STATES_H

#include "run/job.h"

struct state {
    const char *name; /* NULL in a deck without *STATE */
    struct job job;
    int ncommon;  /* the first of its unknowns: those of the common cards */
    int *unknown; /* [job.unknowns.nparameter] which of the unknowns of all states each of its own is */
};

struct states {
    int nstate;
    struct state *state; /* [nstate] at least one; several have the same options but for transfer functions */
    int nparameter;
    rotid_parameter *bounds; /* [nparameter] those of the common cards, then those of each state alone, "bearings:front.k" */
};

/* Says, as an error, that somebody who works on one state has been given several. */
void states_refuse(const struct states *states, const char *deck, struct message_list *notes);

#endif
