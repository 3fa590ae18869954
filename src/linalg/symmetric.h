/* Dense symmetric indefinite systems (LAPACK dsytrf, dsytrs). */
#ifndef ROTID_LINALG_SYMMETRIC_H
#define ROTID_LINALG_SYMMETRIC_H

#include "base/pool.h"

struct symmetric {
    int n, lwork;
    double *a, *work; /* a [n * n]: the caller writes the lower triangle into it before each factorisation */
    int *pivot;
};

int symmetric_new(struct pool *pool, int n, struct symmetric *s);

/* Factors the leading size * size matrix in s->a (leading dimension size). Returns 0, or 1 when it is singular. */
int symmetric_factor(struct symmetric *s, int size);

/* Number of negative eigenvalues of the matrix that was factored last. */
int symmetric_negative(const struct symmetric *s, int size);

/* b [size] := A^-1 b */
void symmetric_solve(struct symmetric *s, int size, double *b);

#endif
