/* Derivatives of eigenvalues and eigenvectors of any model against differences. */
#ifndef ROTID_TESTS_DERIVATIVE_CHECK_H
#define ROTID_TESTS_DERIVATIVE_CHECK_H

#include "support.h"

/* Every derivative of the modes from `first` to count - 1 at x against central differences of fourth order with the relative
 * steps [nparam], eigenvalues with and without vectors: off by at most `tolerance` of the largest component. Each parameter must
 * act on each mode. */
void check_derivatives(struct pool *pool, const rotid_model *model, int reduction, int derivative, int first, int count,
                       const double *x, const double *steps, double tolerance);

#endif
