/* The rival of a beam's causes: the same rotor as a solid (causes/beam_theory.c). */
#ifndef ROTID_DIAGNOSE_AS_SOLID_H
#define ROTID_DIAGNOSE_AS_SOLID_H

#include "diagnose/scan.h"

/* *to := the job with its rotor as a solid, without the suspects that a solid cannot have. In a run alone (models_solids). `to`
 * may be the job itself. ROTID_OK or ROTID_ERROR_MEMORY. */
int job_as_solid(struct pool *pool, const struct job *from, struct job *to);

/* What the rotor as a solid in all states promises, by its residual at x, from which the beam's columns take what is fitted
 * anyway: to the first order in a change of the moduli. 0 where the rotor can be no solid, or one that is too large, as is noted
 * where notes is not NULL. Statuses of memory only. */
int scan_solid(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
               struct scan *scan, struct message_list *notes);

#endif
