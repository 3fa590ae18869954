/* A size that ends at a bound is tried beyond it before its cause is refused. */
#ifndef ROTID_DIAGNOSE_WIDEN_H
#define ROTID_DIAGNOSE_WIDEN_H

#include "diagnose/refit.h"

/* Whether x lies so near a bound that it is not the size the data want. A bound at which the effect vanishes (neutral) is none: a
 * small size lies near it. Between bounds above zero sizes are factors, and a distance is a ratio. */
int size_at_bound(const rotid_parameter *bounds, double neutral, double x);

/* The fit of a set again with the bounds at which its sizes end farther away, step by step as long as chi2 falls, up to what is
 * physically possible; bounds that the deck states stay. *refit is replaced where that is better. Statuses of memory and
 * cancellation only. */
int refit_widen(struct pool *pool, const struct scan *scan, const struct scan_set *set, const int *number, const int *holdout,
                const rotid_environment *environment, struct refit *refit);

#endif
