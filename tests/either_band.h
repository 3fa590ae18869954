/* The eigen-solvers of narrow and of wide bands behind one pair of routines, so that the tests of one are those of the other. */
#ifndef ROTID_TESTS_EITHER_BAND_H
#define ROTID_TESTS_EITHER_BAND_H

#include "linalg/linalg.h"

/* 0: narrow; 1: wide, the matrices stored with zeros beside them */
extern int either_band_wide;

struct either_band {
    struct eigen_band narrow;
    struct eigen_wide wide;
    rotid_matrix k, m; /* in storage for a wide band */
};

/* Has a matrix of n rows no wide band? */
int either_band_is_too_small(int n);

/* As eigen_band_new and eigen_band_solve. */
int either_band_new(struct pool *pool, const rotid_matrix *structure, int count, struct either_band *e);
int either_band_solve(struct either_band *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi);

/* to, of the same n and far and a band as wide or wider, := from */
void widen(const rotid_matrix *from, rotid_matrix *to);

#endif
