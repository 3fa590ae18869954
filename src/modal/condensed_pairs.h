/* Pairs of a condensed model of which the frequencies are wanted and not the shapes' derivatives: by bands where that is possible
 * (linalg/eigen_guyan.h), else by the dense matrices. The inner part of prediction. */
#ifndef ROTID_MODAL_CONDENSED_PAIRS_H
#define ROTID_MODAL_CONDENSED_PAIRS_H

#include "modal/prediction.h"

/* ROTID_OK or ROTID_ERROR_MEMORY. */
int condensed_new(struct pool *pool, struct prediction *p);

/* As prediction_compute, with K and M in place. p->by_bands tells which way it went. */
int condensed_compute(struct prediction *p, const double *x);

/* As prediction_differentiate, of eigenvalues that came by bands. */
int condensed_differentiate(struct prediction *p, const double *x, const int *wanted);

#endif
