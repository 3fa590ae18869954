/* Two causes at once, for a round in which one alone does not suffice. */
#ifndef ROTID_DIAGNOSE_PAIRS_H
#define ROTID_DIAGNOSE_PAIRS_H

#include "diagnose/refit.h"
#include "diagnose/scan.h"

/* The pairs of a scan that promise most, in score: every two items of different candidates, or of one with a place at two places,
 * drop together -2 b'u - u'Gu with G the products of their columns, b those with the residual, and the steps u within what
 * physics allows. Of the places of two candidates the best ones are taken, and no pair that would leave fewer than
 * LEAST_RESIDUALS. Pairs of causes that act in all states that have them are listed first, then those of which one or both act
 * in one state alone: set [2 * most], each `most` at most and best first, *count of them. ROTID_OK or ROTID_ERROR_MEMORY. */
int pairs_choose(struct pool *pool, const struct states *states, const struct scan *scan, int most, struct scan_set *set,
                 int *count);

/* The same where one of the two causes is known well enough to be in the model: *effect of `candidate`, with the states' own
 * parameters at x [nparameter], both of a fit, since columns at no effect say little of large ones. The scan is made again there,
 * and the `most` partners that promise most, in score, go behind the *count sets. ROTID_OK or ROTID_ERROR_MEMORY. */
int pairs_beside(struct pool *pool, const struct states *states, const int *number, const int *holdout, const double *x,
                 const struct scan *scan, int candidate, const struct effect *effect, int most, struct scan_set *set, int *count);

#endif
