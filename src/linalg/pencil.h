/* The entries of two matrices of one wide structure that are not zero, K and M: made in one pass over the bands, which cost more
 * to read than the products and factors that follow. */
#ifndef ROTID_LINALG_PENCIL_H
#define ROTID_LINALG_PENCIL_H

#include <stdint.h>

#include "base/pool.h"
#include "rotid.h"

struct pencil {
    int n;
    const rotid_matrix *stiffness, *mass; /* as they were taken: their blocks are read from them */
    int *start;                           /* [n + 1] where a column of the lower triangle begins */
    int *row;                             /* [(kd + 1) n], increasing within a column, the diagonal element first */
    double *k, *m;                        /* the entries of K and M there */
    double *block;                        /* [nfar^2] that of M */
    uint64_t digest;                      /* of the entries of M and their places */
    double *x, *y;                        /* [8 n] columns interleaved */
};

/* ROTID_OK or ROTID_ERROR_MEMORY. What is never written costs address space alone where the memory comes from calloc. */
int pencil_new(struct pool *pool, const rotid_matrix *structure, struct pencil *p);

/* Takes the entries of k and m, which must outlive it unchanged. Returns whether M is that of the call before,
 * by a digest of 64 bits of its entries. */
int pencil_take(struct pencil *p, const rotid_matrix *k, const rotid_matrix *m);

/* Y [n * columns] := K X or M X */
void pencil_multiply_stiffness(struct pencil *p, int columns, const double *x, double *y);
void pencil_multiply_mass(struct pencil *p, int columns, const double *x, double *y);

#endif
