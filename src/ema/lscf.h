/* Least-squares complex frequency-domain estimator with a common denominator (Guillaume, Verboven, Vanlanduit 1998; Verboven
 * 2002; Cauberghe 2004): for channel c on line k
 *
 *     e_ck = sum_j b_cj z_k^j - H_ck sum_j a_j z_k^j,    z = exp(i theta),  theta = pi (omega - low)/(high - low),
 *
 * minimises sum w_ck |e_ck|^2 with real coefficients. The band covers the half circle, and its mirror image that real
 * coefficients imply covers the other: powers of z are then orthogonal on even lines and the normal equations well conditioned.
 * The mirrored accelerance is continuous at the ends of the band because it is real off its peaks. All products of powers are
 * Toeplitz: one sum a lag. A channel's numerator is eliminated, M = sum_c T_c - X_c' R_c^-1 X_c, [order + 1] squared. With right
 * matrix fractions the same sums would carry one more pair of indices, the references. */
#ifndef ROTID_EMA_LSCF_H
#define ROTID_EMA_LSCF_H

#include "base/pool.h"
#include "ema/band.h"

/* normal [(order + 1)^2] := M. Weights: line spacing (so that uneven lines stand for the band that they cover), times 1/variance
 * where known, kept within a factor 100 of its median, else 1/mean |H|^2 of the channel. 1 <= order < nline. threads share the
 * channels; the result does not depend on their number. ROTID_OK, ROTID_ERROR_MEMORY. */
int lscf_normal_matrix(struct pool *pool, const struct ema_band *band, int order, int threads, double *normal);

/* Poles of all orders step, 2 step, ... <= order from the leading blocks of M, with a_0 = 1: the coefficient of lowest power is
 * held because the roots that only fit noise then lie outside the unit circle (the reversed polynomial is that of a linear
 * prediction, whose roots lie inside), which is negative damping, while physical ones decay. count [order/step] of each order,
 * pole [(order/step) * order] column by column: those of positive theta only, lambda = log(z)/T + i low, T = pi/(high - low),
 * rising in imaginary part. M is overwritten. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_ERROR_EIGEN. */
int lscf_poles(struct pool *pool, const struct ema_band *band, int order, int step, double *normal, int *count,
               double complex *pole);

#endif
