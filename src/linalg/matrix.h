/* Symmetric matrices that are banded but for a small block (rotid_matrix of rotid.h). */
#ifndef ROTID_LINALG_MATRIX_H
#define ROTID_LINALG_MATRIX_H

#include <stdint.h>
#include <string.h>

#include "base/pool.h"
#include "rotid.h"

/* Storage for a zero matrix of the given structure; `far` is kept, not copied. ROTID_OK or ROTID_ERROR_MEMORY. */
int matrix_new(struct pool *pool, int n, int kd, int nfar, const int *far, rotid_matrix *a);

void matrix_zero(rotid_matrix *a);

/* Adds value to A(i, j) and A(j, i): into the band where it reaches, else into the block, where i and j must both be far. */
void matrix_add(rotid_matrix *a, int i, int j, double value);

/* Adds the element matrix e [nd * nd] on the degrees of freedom dof [nd]. */
void matrix_add_element(rotid_matrix *a, int nd, const int *dof, const double *e);

/* c := alpha a + beta b, same structure; c may be a or b. */
void matrix_combine(double alpha, const rotid_matrix *a, double beta, const rotid_matrix *b, rotid_matrix *c);

/* Y [n * columns] := A X [n * columns]. */
void matrix_multiply(const rotid_matrix *a, int columns, const double *x, double *y);

/* x' A y; work [n]. */
double matrix_product(const rotid_matrix *a, const double *x, const double *y, double *work);

/* Rows and columns *from ... *end - 1 hold all that is not zero; all of them where the block holds anything, *from = *end where
 * there is nothing. */
void matrix_occupied(const rotid_matrix *a, int *from, int *end);

/* *part := rows and columns from ... from + length - 1 of a, in the same storage, with the block where those are all. */
void matrix_rows(const rotid_matrix *a, int from, int length, rotid_matrix *part);

int matrix_is_finite(const rotid_matrix *a);
/* Nothing but zeros in all of the storage? Soon known where there is anything. */
int matrix_is_zero(const rotid_matrix *a);

#define MATRIX_STRETCH 8 /* entries of a wide band that are looked at together */

/* Are MATRIX_STRETCH entries all zero? Bits tell faster than comparisons; a negative zero counts as an entry. */
static inline int matrix_stretch_is_zero(const double *a)
{
    uint64_t bits[MATRIX_STRETCH], any = 0;
    memcpy(bits, a, sizeof bits);
    for (int i = 0; i < MATRIX_STRETCH; i++)
        any |= bits[i];
    return !any;
}

/* full [n, n], leading dimension ld, := A, both triangles. */
void matrix_to_dense(const rotid_matrix *a, int ld, double *full);

#endif
