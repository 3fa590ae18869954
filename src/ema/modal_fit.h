/* The modal model on a choice of lines, linear in its residues, nonlinear in its poles: the kernel of the residues, of their
 * refinement and of fits to single channels. As accelerance, s = i omega,
 *
 *     H_c = s^2 sum_r [A_cr/(s - lambda_r) + conj(A_cr)/(s - conj(lambda_r))] + L_c - omega^2 U_c .
 *
 * Columns, real: of A_cr its real and imaginary part, phi = s^2 (g + g'), i s^2 (g - g') with g = 1/(s - lambda); of L_c and U_c
 * likewise; and psi = s^2 (g^2 + g'^2), i s^2 (g^2 - g'^2), from which each channel mixes its derivatives by lambda. Rows: real
 * and imaginary parts, each over its own standard deviation. */
#ifndef ROTID_EMA_MODAL_FIT_H
#define ROTID_EMA_MODAL_FIT_H

#include "base/complex.h"
#include "base/pool.h"
#include "ema/band.h"
#include "ema/modal_gram.h"

/* what modal_fit_evaluate leaves: chi2, linear, singular; score and schur as well; mix and spread as well */
enum modal_fit_part { MODAL_FIT_LINEAR, MODAL_FIT_POLES, MODAL_FIT_SPREAD };

struct modal_fit {
    int nline, nchannel, nmode, nlinear, ncolumn; /* nlinear = 2 nmode + 4 of phi, L, U; ncolumn = nlinear + 2 nmode */
    double scale;                                 /* rad/s, the unit of frequency inside */
    double *nu;                                   /* [nline] omega/scale */
    double *y;                                    /* [2 nline * nchannel] real parts, then imaginary parts */
    double *yy;                                   /* [nchannel] sum y^2, flat weights */
    double *weight;                               /* [nline * nchannel] 1/sigma of a part; NULL: flat, sigma below */
    double *sigma;                                /* [nchannel] */
    int equal;                                    /* set by the caller: sigma stays 1, all channels count alike */
    double complex *pole;                         /* [nmode] lambda/scale */
    int *loose;                                   /* [nmode] nonzero: a guard, which convergence need not wait for */
    int *held;                                    /* [nmode] nonzero: refine_poles leaves the pole where it is */
    double *basis;                                /* [2 nline * ncolumn] */
    double *gram, *right;                         /* flat weights: [ncolumn^2] and [ncolumn * nchannel] */
    struct modal_gram summed;                     /* weights of each channel */
    int threads;
    double **work;
    /* of each channel, after modal_fit_evaluate: */
    double *linear; /* [nlinear * nchannel] residues (Re, Im a mode), L, U in units of scale */
    double *chi2;   /* [nchannel] */
    double *schur;  /* [(2 nmode)^2 * nchannel] information of (Re, Im lambda/scale a mode), the linear part eliminated */
    double *score;  /* [2 nmode * nchannel] its right-hand side: minus half the gradient of chi2 */
    double *mix;    /* [nlinear * 2 nmode * nchannel] -d(linear)/d(pole) */
    double *spread; /* [nlinear^2 * nchannel] covariance of the linear part for known poles */
    int *singular;  /* [nchannel] nonzero: its columns depend on each other; chi2 is that of no model then */
};

/* For the channels from, ... of the band, on the lines line [nline] of it. Flat sigma (1 until modal_fit_noise) where the band
 * has no variance. ROTID_OK or ROTID_ERROR_MEMORY. */
int modal_fit_new(struct pool *pool, const struct ema_band *band, int nline, const int *line, int from, int nchannel, int nmode,
                  int threads, struct modal_fit *fit);

/* That part for each channel at fit->pole. Normal equations with scaled columns: their rounding does not move where the score
 * vanishes by more than eps of a bandwidth. Returns sum chi2. Allocates nothing. */
double modal_fit_evaluate(struct modal_fit *fit, enum modal_fit_part part);

/* Columns of residues and rests, phi [2 nline * (2 nmode + 4)], on the lines nu of omega/scale for poles in that unit. */
void modal_fit_columns(int nline, const double *nu, int nmode, const double complex *pole, double *phi);

/* Flat weights: sigma of each channel from its chi2; score, schur, chi2 and spread are brought to it. */
void modal_fit_noise(struct modal_fit *fit);

/* Mean square of the residual over its standard deviation in each channel within `widths` half-power bandwidths of each of the
 * modes 0 ... count - 1, to noise [nchannel * count]: 1 where the noise is what it was taken for; 1 too where fewer than four
 * lines tell. At fit->pole as it was evaluated last. */
void modal_fit_local_noise(const struct modal_fit *fit, int count, double widths, double *noise);

/* The lines of the band within `widths` half-power bandwidths 2 |Re lambda| of a pole, at least ten on each side; every second,
 * third ... of those further than three bandwidths from all poles where there would be more than `most`. Returns their number,
 * line [band->nline]. */
int modal_fit_lines(const struct ema_band *band, int nmode, const double complex *pole, double widths, int most, int *line);

#endif
