/* The built-in beam as a client of rotid_model: the door that a host's own model comes through as well. */
#ifndef ROTID_RUN_CLIENT_H
#define ROTID_RUN_CLIENT_H

#include "base/pool.h"
#include "beam/beam.h"
#include "rotid.h"

struct client {
    struct beam beam;
    int *master;
    rotid_model model; /* user points to this struct: do not copy it */
};

/* The model of a rotor with the given parameters at their values in the rotor; masters are the lateral degrees of freedom at the
 * sensors, without sensors all of the axis. Statuses of beam_build and beam_count_rigid, ROTID_ERROR_ARGUMENT where two sensors
 * fall on one node; *failed as for beam_build. */
int client_open(struct pool *pool, const struct rotor *rotor, int nparameter, const struct parameter *parameter, int refine,
                struct client *client, int *failed);

#endif
