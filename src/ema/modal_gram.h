/* Weighted inner products of the columns of a modal fit, for many channels at a time. */
#ifndef ROTID_EMA_MODAL_GRAM_H
#define ROTID_EMA_MODAL_GRAM_H

#include <stddef.h>

#include "base/complex.h"
#include "base/pool.h"

/* Every product of two of the functions g = 1/(i nu - lambda), g^2, g' = 1/(i nu - conj(lambda)), g'^2, one of them conjugate, is
 * a sum of single ones: conj(g_r) g_s = -(conj(g_r) + g_s)/(lambda_s + conj(lambda_r)), and the others follow from that. So a
 * channel needs the sums of a dozen functions a mode over its lines, which is one matrix product for all channels, in place of a
 * Gram matrix of 4 n + 4 columns of its own. Where two poles are closer than the lines can tell, as guards outside of the band
 * are, the products of their columns are functions of their own: the difference of two sums would lose the digits that tell such
 * columns from each other. */
struct modal_gram {
    int nline, nmode, most; /* most: functions at most */
    int nclose, *close;     /* [2 nclose] pairs of modes r <= s */
    double *table;          /* [nline * most] */
    double complex *a, *b;  /* [nmode^2] -1/(lambda_s + conj(lambda_r)), -1/(conj(lambda_s) + conj(lambda_r)) */
};

/* ROTID_OK or ROTID_ERROR_MEMORY. */
int modal_gram_new(struct pool *pool, int nline, int nmode, struct modal_gram *gram);

/* Number of functions in the table, for the poles that it was filled for. */
int modal_gram_functions(const struct modal_gram *gram);

/* Fills the table and the denominators for the lines nu [nline], rising, and the columns basis [2 nline * (4 nmode + 4)] of
 * modal_fit.h at these poles; where psi is not filled, neither are the products with it. Returns 0, or 1 where a pole is not
 * damped or too many are close. */
int modal_gram_fill(struct modal_gram *gram, const double *nu, const double complex *pole, const double *basis);

/* From sums [functions] of one channel over w^2 of its lines: matrix [(4 nmode + 5)^2], both triangles, but for the last row and
 * column: columns in the order of modal_fit.h. */
void modal_gram_assemble(const struct modal_gram *gram, const double *sum, double *matrix);

#endif
