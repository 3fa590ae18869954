/* The states of a deck: a structure that was measured more than once is a job for each time, complete by itself, over unknowns
 * that they share. What works on one job works on that of one state. */
#ifndef ROTID_RUN_STATES_H
#define ROTID_RUN_STATES_H

#include "run/job.h"

struct state {
    const char *name; /* NULL in a deck without *STATE */
    struct job job;
    int ncommon;  /* the first of its unknowns: those of the common cards */
    int *unknown; /* [job.unknowns.nparameter] which of the unknowns of all states each of its own is;
                     NULL: the first ones */
};

struct states {
    int nstate;
    struct state *state; /* [nstate] at least one; several have the same options but for transfer functions */
    int nparameter;
    rotid_parameter *bounds; /* [nparameter] those of the common cards, then those of each state alone, "bearings:front.k" */
};

/* A job as the only state, at *state, which has no name. Leans on both. */
struct states states_of(const struct job *job, struct state *state);

/* Which of the unknowns of all states unknown q of a state is. */
int state_unknown(const struct state *state, int q);

/* The values of the unknowns of a state [job.unknowns.nparameter] among the values x of those of all. NULL where memory is out.
 */
double *state_values(struct pool *pool, const struct state *state, const double *x);

/* Measured modes of the first `count` states. */
int states_modes(const struct states *states, int count);

/* *to := the same states in an array of its own, whose jobs can be changed. `to` may be the states themselves. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int states_copy(struct pool *pool, const struct states *from, struct states *to);

/* Says, as an error, that somebody who works on one state has been given several. */
void states_refuse(const struct states *states, const char *deck, struct message_list *notes);

#endif
