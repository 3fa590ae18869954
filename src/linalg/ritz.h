/* Rayleigh-Ritz: the best pairs of K phi = lambda M phi in the span of given vectors. */
#ifndef ROTID_LINALG_RITZ_H
#define ROTID_LINALG_RITZ_H

#include "rotid.h"

#define RITZ_WORK 34 /* times count: workspace of ritz_pairs */

/* value [count] ascending and vector [n * count] with vector' M vector = 1 in the span of y [n * count], which is scaled; M
 * positive definite. Workspace: product [n * count], squares [2 count^2], work [RITZ_WORK count]. Returns 0, or 1 where the
 * columns of y are not independent or not finite. */
int ritz_pairs(int n, int count, const rotid_matrix *k, const rotid_matrix *m, double *y, double *value, double *vector,
               double *product, double *squares, double *work);

#endif
