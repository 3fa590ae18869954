/* The data of several states, settled in each of them alone before they are judged together. */
#ifndef ROTID_DIAGNOSE_SETTLE_STATES_H
#define ROTID_DIAGNOSE_SETTLE_STATES_H

#include "diagnose/engine.h"

/* Pairing, channels, noise, accelerometer and mesh of every state as of a deck that is this state alone; what is found goes with
 * the name of the state to the findings, and the states are judged without. A state whose data do not suffice to judge a model
 * by stays as it is. Statuses of memory and cancellation only. */
int settle_states(struct engine *engine);

#endif
