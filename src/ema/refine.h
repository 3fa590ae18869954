/* All poles of a modal fit together: weighted nonlinear least squares with the residues eliminated (variable projection, Golub,
 * Pereyra 1973, in the form of Kaufman 1975: the information of the poles is the Schur complement of the Gauss-Newton matrix). */
#ifndef ROTID_EMA_REFINE_H
#define ROTID_EMA_REFINE_H

#include "ema/modal_fit.h"

struct refinement {
    double *covariance; /* [(2 nmode)^2] of (Re, Im lambda/scale a mode) */
    double *widened;    /* [2 nmode] factor on each standard deviation that came from the scatter over channels, >= 1 */
    int *moved;         /* [nmode] nonzero: the pole ran away (further than three half-power bandwidths) or grows */
    int iterations, converged;
    double chi2;
    double *work; /* internal */
};

/* modal_fit_new and refinement_new for the channels from, ... of the band, which starts at pole [nmode] in rad/s. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int refinement_open(struct pool *pool, const struct ema_band *band, int nline, const int *line, int from, int nchannel, int nmode,
                    const double complex *pole, int threads, struct modal_fit *fit, struct refinement *refinement);

/* Levenberg-Marquardt from fit->pole, which is overwritten by the best poles; most = 0 evaluates only. Where weights are flat the
 * noise of each channel is taken from its residual three times on the way. A step moves no pole by more than its half bandwidth.
 *
 * Covariance: A^-1, A the information, from the noise stated or left over. Where the scores g_c of the channels scatter more
 * than that allows (poles that differ from point to point), A^-1 sum g_c g_c' A^-1 n/(n - 1) stands instead, parameter by
 * parameter, n = (sum I_c)^2/sum I_c^2 the number of channels that have a say in it: each channel carries a whole score, so n
 * loses one, as a mean does. It is taken past two of its own standard deviations only, 1 + 2 sqrt(2/(n - 1)): taking the larger
 * of the two always would overstate by a tenth where nothing is wrong.
 * On exit the fit is evaluated with spread. ROTID_OK or ROTID_STOP_CANCELLED. */
int refine_poles(struct modal_fit *fit, int most, const rotid_environment *environment, struct refinement *refinement);

#endif
