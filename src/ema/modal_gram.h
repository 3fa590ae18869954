/* Weighted inner products of the columns of a modal fit, for many channels at a time. */
#ifndef ROTID_EMA_MODAL_GRAM_H
#define ROTID_EMA_MODAL_GRAM_H

#include <stddef.h>

#include "base/complex.h"

/* Every product of two of the functions g = 1/(i nu - lambda), g^2, g' = 1/(i nu - conj(lambda)), g'^2, one of them conjugate, is
 * a sum of single ones: conj(g_r) g_s = -(conj(g_r) + g_s)/(lambda_s + conj(lambda_r)), and the others follow from that. So a
 * channel needs the sums of a dozen functions a mode over its lines, which is one matrix product for all channels, in place of a
 * Gram matrix of 4 n + 4 columns of its own. The denominators are not small as long as all poles are damped. */
struct modal_gram {
    int nline, nmode;
    double *table;         /* [nline * modal_gram_functions(nmode)] */
    double complex *a, *b; /* [nmode^2] -1/(lambda_s + conj(lambda_r)), -1/(conj(lambda_s) + conj(lambda_r)) */
};

/* Number of functions in the table. */
int modal_gram_functions(int nmode);

/* Whether the poles [nmode] are far enough from the axis and from each other, for lines `spacing` apart: sums of partial
 * fractions lose (what the lines see of them over the distance)^2 digits, four at most here. */
int modal_gram_is_good(int nmode, const double complex *pole, double spacing);

/* Fills the table and the denominators for the lines nu [nline]. */
void modal_gram_fill(struct modal_gram *gram, const double *nu, const double complex *pole);

/* From sums [functions] of one channel over w^2 of its lines: matrix [(4 nmode + 5)^2], both triangles, but for the last row and
 * column: columns in the order of modal_fit.h. */
void modal_gram_assemble(const struct modal_gram *gram, const double *sum, double *matrix);

#endif
