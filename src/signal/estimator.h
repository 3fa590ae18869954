/* Transfer functions and their variance from spectra of single impacts. With force F and response X of an impact, a column holds
 * S_ff = |F|^2, S_xx = |X|^2, S_xf = X conj(F) on nline lines; columns follow each other. */
#ifndef ROTID_SIGNAL_ESTIMATOR_H
#define ROTID_SIGNAL_ESTIMATOR_H

#include "base/complex.h"

struct spectra { /* of nline lines each; sums, or `count` columns */
    double *ff, *xx;
    double complex *xf;
};

/* sum := weighted sum of the columns; weight [count] >= 0: one leaves an impact in, zero leaves it out, and numbers of draws make
 * a bootstrap. NULL: all ones. */
void estimator_sum(int nline, int count, const struct spectra *column, const double *weight, struct spectra *sum);

/* Sum of S_xx over that of S_ff over the lines: the square of the unit of X in units of F that Hv takes, so that its error is the
 * least where noise is the same share of the energy in both channels, and does not depend on the units. 0 where there is no
 * force. */
double estimator_balance(int nline, const struct spectra *sum);

/* h [nline]: H1 = S_xf/S_ff, H2 = S_xx/S_fx, or Hv = [D + sqrt(D^2 + 4 b |S_xf|^2)]/(2 S_fx), D = S_xx - b S_ff, with b the
 * balance: h/sqrt(b) is the ratio of the components of the eigenvector of the larger eigenvalue of [S_ff, S_fx/sqrt(b);
 * S_xf/sqrt(b), S_xx/b], to which that of the smaller, the error, is orthogonal. 0 where the denominator vanishes. */
void estimator_transfer(int estimator, double balance, int nline, const struct spectra *sum, double complex *h);

/* |S_xf|^2/(S_ff S_xx) in [0, 1]; 0 where a channel is silent. */
void estimator_coherence(int nline, const struct spectra *sum, double *coherence);

/* Variance E|h - E h|^2 of the estimate h from count >= 2 impacts, each line by itself, by leaving out one impact at a time:
 *     variance = 1/count sum_i (1 - w_i)/w_i |h - h_(i)|^2,  w_i = S_ff,i/sum S_ff,
 * the jackknife for parts of unequal weight (Busing, Meijer, van der Leeden 1999); equal impacts make it the usual
 * (count - 1)/count sum |h - h_(i)|^2. For H1 under noise on the response, h_i = X_i/F_i, it is 1/count sum w_i/(1 - w_i)
 * |h_i - h|^2, whose expectation is S_nn/sum S_ff exactly, for any forces. It has count - 1 complex degrees of freedom. INFINITY
 * on lines without force. work: sum of one column, and complex [nline]; weight [count] is overwritten. */
void estimator_jackknife(int estimator, int nline, int count, const struct spectra *column, const double complex *h,
                         double *variance, struct spectra *sum, double complex *part, double *weight);

#define ESTIMATOR_SMOOTH  15   /* lines to each side: some 31 (count - 1) degrees of freedom in place of count - 1 */
#define ESTIMATOR_OUTLIER 10.0 /* times the median; one degree of freedom exceeds it by chance in 1 of 1000 lines */

/* Replaces the variance of a line by that of its neighbourhood. Noise is smooth over frequency where the variance of h is not, so
 * the mean is taken of variance * S_ff (noise of the response), over ESTIMATOR_SMOOTH lines to each side, fewer at the ends. Near
 * a resonance force noise and scatter of the impacts stand out: lines above ESTIMATOR_OUTLIER times the median of their
 * neighbourhood are averaged among themselves, and no line is averaged with them. The expectation stays; weights 1/variance of
 * few degrees of freedom would be dominated by lines that look good by chance (with one or two their expectation does not exist).
 * force [nline]: sum S_ff. Lines of infinite variance are left alone. work [nline + 2 ESTIMATOR_SMOOTH + 2]. */
void estimator_smooth(int nline, const double *force, double *variance, double *work);

#endif
