/* What a cause below its detection limit does to the parameters that are identified. */
#ifndef ROTID_DIAGNOSE_HIDDEN_H
#define ROTID_DIAGNOSE_HIDDEN_H

#include "diagnose/engine.h"
#include "diagnose/round.h"

/* result.hidden of *engine->out. With the scan of the last round, c the whitened column of a cause, J those of what is fitted,
 * both free of the scales of the shapes, and s the smallest size that shows at a place (detectable.h), or the largest that is
 * physical, the fit without the cause is off by
 *   dx = (J'J)^-1 J'c s.
 * Of all places and widths of a cause the one counts that moves a parameter most; of all causes those that move it most, three at
 * most. A cause in one state alone, a suspect, and one whose column lies within those of J (its size is not bounded by the data)
 * are left out, as is a parameter at its bound. ROTID_OK or ROTID_ERROR_MEMORY. */
int hidden_shifts(struct engine *engine, const struct round_result *last);

/* The same of a fit that no diagnosis made: of the states, whose noise is stated, at the values of their unknowns in `fit`, the
 * full model by the likelihood; number of all modes as paired by that fit. The threshold of the scan is extrapolated from few
 * replicates.
 * list [*n] on the pool; none where there is nothing to judge by. Statuses of scan_run and bootstrap_run. */
int hidden_of_fit(struct pool *pool, const struct states *states, const int *number, const rotid_fit_result *fit,
                  const rotid_environment *environment, int *n, rotid_hidden **list);

#endif
