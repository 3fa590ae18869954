/* The rotor as a beam beside the same rotor as a solid of revolution: their modes, and what a beam that is fitted to the solid
 * would take its moduli for. */
#ifndef ROTID_RUN_BESIDE_H
#define ROTID_RUN_BESIDE_H

#include "base/message.h"
#include "run/job.h"

/* At the values x [nparameter] of the parameters of the job; nmode modes as far as both have them. Without sensors the shapes are
 * compared at nodes of the beam. ROTID_OK; ROTID_ERROR_SECTION with an error in the list where a part of the rotor has no meaning
 * in one of the two; statuses of spectrum_compute, comparison_make and rotid_fit. */
int beside_make(struct pool *pool, const struct job *job, const double *x, int nmode, const rotid_environment *environment,
                struct message_list *notes, rotid_beam_beside_solid **beside);

#endif
