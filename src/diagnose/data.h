/* The job that is judged: copies of the data, and the faults found in them. */
#ifndef ROTID_DIAGNOSE_DATA_H
#define ROTID_DIAGNOSE_DATA_H

#include "diagnose/engine.h"

/* Copies the data of all states, states the noise, refuses what cannot be judged. ROTID_ERROR_ARGUMENT with a reason in the
 * notes. */
int data_prepare(struct engine *engine, const struct states *states);
/* Gives a job its own copies of the data that the steps change. */
int data_copy(struct pool *pool, struct job *job);
void data_remove_mode(struct job *job, int k);
/* The unit of its value follows from its id. */
int data_add_finding(struct engine *engine, const rotid_data_finding *finding);
/* A finding about measured modes; second 0: about the first alone. */
int data_add_pairing(struct engine *engine, int first, int second, const char *text);

#endif
