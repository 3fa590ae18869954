/* Near pairs made exact: inverse iteration with a shift of its own for each, the inner part of eigen_band. */
#ifndef ROTID_LINALG_EIGEN_POLISH_H
#define ROTID_LINALG_EIGEN_POLISH_H

#include "linalg/eigen.h"

/* Residual that rounding leaves at most. */
double eigen_rounding(const struct eigen_band *e);

/* image := (K - s M)^-1 M ritz and mass_basis := M ritz for the first `columns` pairs; residual [watched] :=
 * |ritz - (lambda - s) image|_M. Returns the largest; INFINITY where one is not finite. */
double eigen_residuals(struct eigen_band *e, const rotid_matrix *m, int columns, int watched);

/* Rayleigh-Ritz in the span of the first `count` columns of image: value and ritz get that many pairs. Returns 0, or 1 where the
 * columns are not independent. */
int eigen_ritz_pairs(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m);

/* From `count` pairs that are near (ritz, value; e->factor that of K - s M): one solution with K - lambda_j M each and
 * Rayleigh-Ritz on all together cubes their errors. Returns 0 when every residual is as small as the tolerance, or as rounding
 * lets it be where the iteration has no more to give; 1 where it fails: the pairs may then be anything. Nothing is known about
 * pairs that were missed. */
int eigen_polish(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m);

#endif
