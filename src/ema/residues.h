/* Residues of an evaluated modal fit (least-squares frequency domain), with standard deviations that carry the uncertainty of the
 * poles. */
#ifndef ROTID_EMA_RESIDUES_H
#define ROTID_EMA_RESIDUES_H

#include "ema/modal_fit.h"

/* Of mode r in channel c of the fit, evaluated with spread: A of displacement, and the standard deviation of its part along its
 * own phase, V = spread + mix C mix' with the covariance C [(2 nmode)^2] of the poles, NULL for poles that are known. NaN where
 * the columns of the channel depend on each other. */
void residue_of_mode(const struct modal_fit *fit, int c, int r, const double *covariance, double complex *residue,
                     double *residue_std);

#endif
