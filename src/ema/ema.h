#ifndef ROTID_EMA_EMA_H
#define ROTID_EMA_EMA_H

/* ema: experimental modal analysis, from transfer functions to poles, shapes and their standard deviations.
 *
 *     H_c(w) = (i w)^q { sum_r [A_cr/(i w - lambda_r) + conj(A_cr)/(i w - conj(lambda_r))] - L_c/w^2 + U_c }
 *
 * Comes in: struct frf_set of src/signal, struct ema_options. Goes out: struct ema. Entrance: ema_compute (ema.c), which calls
 *   band.c           ema_band_new: usable channels (channels.c: channels_check) as accelerance on the lines of the band
 *   stabilisation.c  stabilisation_compute: LSCF, B_c(z)/A(z), z = exp(i theta), common A; roots of A for each even order;
 *                    stabilisation_candidates: poles that come back from order to order
 *   selection.c      selection_screen, selection_earn: a candidate stays where sum |A|^2/var(A) exceeds chance
 *   ema.c            zoom_compute: a long band in parts; guard_poles: poles beyond the band; picking_compute: EMA_QUADRATURE
 *   modal_fit.c      modal_fit_evaluate: residues, L, U for given poles, linear least squares with weights 1/variance
 *   refine.c         refine_poles: all poles by variable projection, Levenberg-Marquardt; covariance C of the poles = inverse of
 *                    the information, wider where the scores of the channels scatter more
 *   modes.c          modes_of_pole: std of frequency and damping from C; modes_judge: quality flags, MAC
 *   tests.c          ema_average: modes of several tests, and the scatter between them
 *   modes.c          residue_of_mode: std of A from spread + mix C mix'; impacts.c: impacts_spread adds the noise of the force
 *   per_point.c      per_point_frequencies: a pole for each channel (local_fit) where the channels disagree
 *   modes.c          shapes_of_mode: A_cr to a real shape (mode_axis), its std, MPC, MPD, modal mass
 *   tests.c          ema_average: modes of several tests, and the scatter between them
 *   modes.c          ema_synthesise: H_c from the modes; channels.c: channels_compare, FRAC of measured and synthesised
 *
 * src/cli calls it for rotid ema; src/import writes its modes to a file, src/report shows them. It knows no rotor and no file. */

#include "signal/signal.h"

/* ------------------------------------------------------------------------------------------------------------------ band */

/* What the estimators work on: the usable channels of a set as accelerance, on the lines of a band. Accelerance because its peaks
 * are of one size for modes of one damping and mass, whatever their frequency; and off its peaks it is real, which the basis of
 * LSCF needs. */

struct ema_band {
    int nline;
    double low, high; /* rad/s, of the first and last line */
    double *omega;    /* [nline] rising, > 0 */
    int nchannel;
    int *channel;      /* [nchannel] index of the transfer function in the set */
    double complex *h; /* [nline * nchannel] accelerance, channel by channel */
    double *variance;  /* [nline * nchannel] of it, smoothed and > 0; NULL unless most channels have one */
};

/* What brings a line of the set to accelerance of i omega: (i omega)^2/(i omega + window_decay)^q, since behind an exponential
 * window the set is the transfer function at i omega + window_decay. */
double complex ema_band_factor(const struct frf_set *set, double omega);

/* Takes the lines first ... last - 1 of the set, all above 0 Hz, of the transfer functions with usable [nfrf] nonzero, times
 * ema_band_factor. A variance estimated from n averages scatters by sqrt(2/(2 n - 2)); as weight it would prefer lines that came
 * out too small. So one that is not from records, where that has been done, is averaged over neighbouring lines up to 20 degrees
 * of freedom, and kept above 1e-10 of its mean over the band, where the running sum rounds. ROTID_OK or ROTID_ERROR_MEMORY. */
int ema_band_new(struct pool *pool, const struct frf_set *set, int first, int last, const int *usable, struct ema_band *band);

/* Its lines first ... first + nline - 1, copied. ROTID_OK or ROTID_ERROR_MEMORY. */
int ema_band_part(struct pool *pool, const struct ema_band *band, int first, int nline, struct ema_band *part);

/* First line with omega >= value; nline where there is none. */
int ema_band_line(const struct ema_band *band, double value);

/* ------------------------------------------------------------------------------------------------------------------- ema */

/* The model above, for channel c (a response over a reference): q = 0, 1, 2 for displacement, velocity, acceleration; L_c and U_c
 * stand for what lies below and above the band. lambda = -zeta w0 + i w0 sqrt(1 - zeta^2), the frequency is w0/(2 pi). */

enum ema_method { EMA_LSCF, EMA_QUADRATURE };

/* Zero takes the default in brackets. */
struct ema_options {
    int method;
    double low_hz, high_hz; /* band; [the lines of the set] */
    int order; /* largest order of the denominator, of which half are poles of positive frequency; [120], and two thirds of the
                  number of lines at most. Parts of a long band take 60 of it at most */
    int npick; /* frequencies that the user wants, instead of those that the stabilisation table proposes */
    const double *pick_hz;
    double frequency_tolerance, damping_tolerance; /* of a stable pole from order to order; [0.002], [0.05] */
    int per_point;                                 /* nonzero: also the frequency of each mode in each transfer function alone */
    int no_refinement;                             /* nonzero: poles as LSCF gives them */
    int threads;                                   /* [1] */
};

struct ema_pole { /* of the stabilisation table */
    int order;
    double frequency_hz, damping;
    int stable_frequency, stable_damping; /* against the order before */
    int mode;                             /* number of the mode that it was taken for, from 1, or ROTID_NONE */
    int part; /* 0: of the whole band; of very many lines also parts of it have a table each, counted from 1 */
};

/* What is doubtful about a mode: a set of flags, each with the number that it rests on below. */
enum ema_quality_flag {
    EMA_CLOSE = 1,       /* another mode within three half-power bandwidths */
    EMA_COMPLEX = 2,     /* MPC below 0.8 or MPD above 20 degrees */
    EMA_UNSTABLE = 4,    /* picked by the user where the table has no stable pole */
    EMA_DOUBLE_PEAK = 8, /* the channels disagree about the pole by more than noise: with one width from point to point (moving
                            mass: local_pole is set), else two peaks in place of one (loose sensor, support): the pole is then
                            that of the channels that respond most, its std the scatter */
    EMA_WEAK = 16,       /* its residues are not above their own standard deviation */
    EMA_NEGATIVE_DAMPING = 32,
    EMA_EDGE = 64,           /* within two half-power bandwidths of an end of the band */
    EMA_NEGATIVE_MASS = 256, /* the drive point turns the wrong way: a sign, or another point than stated */
    EMA_NOT_REFINED = 128    /* the refinement did not converge for it: LSCF's pole stands */
};

struct ema_mode {
    double frequency_hz, damping;      /* the decay of the exponential window taken off */
    double frequency_std, damping_std; /* Hz, ratio; NaN where they cannot be stated */
    double complex pole;               /* 1/s, the decay of the window taken off */
    double complex *residue;           /* [nfrf] A_cr of displacement */
    double *residue_std;               /* [nfrf] of |A_cr| along its phase */
    double *shape, *shape_std; /* [npoint] real, largest component 1; NaN where not measured. The std is that of a component by
                                  itself, the common scale left out: also the largest component has one */
    double complex *complex_shape; /* [npoint] same scale */
    double complex *local_pole;    /* [nfrf] each channel's own pole (decay taken off) where the frequency differs from channel to
                                      channel, and the residues are those of these poles; NULL where one pole serves all */
    double mpc;                    /* modal phase collinearity in [0, 1] */
    double mpd;                    /* mean phase deviation [degrees] */
    double modal_mass;             /* kg, of the shape whose largest component is 1; NaN without a drive point */
    double *point_frequency_hz, *point_frequency_std; /* [npoint] where per_point, else NULL; NaN where it cannot be told */
    double peak_signal_to_noise;                      /* |H|/std at the peak, median of the channels; without a variance from
                                                         what the modes leave over */
    int quality_flags;                                /* of enum ema_quality_flag */
    double nearest_hz;                                /* nearest other mode, NaN where there is one mode */
};

enum ema_channel_quality_flag {
    EMA_DEAD = 1,        /* no more than noise: its largest |H| is below 1e-3 of the median channel, or constant */
    EMA_DUPLICATE = 2,   /* the same as an earlier channel to 1e-6, or correlated above 0.99999 with equal noise */
    EMA_NOISY = 4,       /* noise over signal five times that of the median channel, at least over a fifth of the band */
    EMA_MISFIT = 8,      /* what the modes leave of it is more than three times that of the median channel, relative */
    EMA_NOT_FINITE = 16, /* it has values that are not finite: left out */
    EMA_LOW_COHERENCE = 32
};

struct ema_channel {
    int response_node, response_direction, reference_node, reference_direction, averages; /* as of the transfer function */
    int quality_flags, duplicate_of;                                                      /* another channel, or -1 */
    double fit;   /* |sum conj(H) H^|^2/(sum |H|^2 sum |H^|^2) over the band (FRAC of measured and synthesised) */
    double noise; /* rms of sqrt(variance) over rms of |H|; NaN without variance */
};

struct ema { /* everything on the pool */
    int nfrf, npoint;
    int *point_node,
        *point_direction; /* [npoint] distinct pairs, in the order of the transfer functions: where the shapes live */
    int roving_force;     /* nonzero: more references than responses: shapes live at the references (reciprocity) */
    int *channel_point;   /* [nfrf] index of the point */
    int order;            /* used */
    int npole;
    struct ema_pole *pole; /* stabilisation table: order by order, rising frequency */
    int nmode;
    struct ema_mode *mode; /* rising frequency; behind them nguard that stand for what is beyond the band */
    int nguard;
    double *mac;                   /* [nmode * nmode] of the complex shapes with themselves */
    double complex *lower, *upper; /* [nfrf] L_c, U_c */
    struct ema_channel *channel;   /* [nfrf] */
    int refined;                   /* iterations of the last refinement */
    int std_from_impacts;          /* 1: from the variance of the lines; 0: from what the modes leave over */
    int impacts;                   /* behind each function, the fewest; 0: not known */
    int tests;                     /* ema_average: means over so many tests; else 0 */
};

/* What several tests of one structure say of their repeatability. */
struct ema_scatter {
    int tests, missing;               /* modes of the test with the most that are not in every test */
    int lacking;                      /* points, each along its axis, that some test does not have: the shapes are without them */
    double *std_hz, *std_damping;     /* [mean.nmode] of one test, by each mode's own few */
    double frequency, damping, shape; /* of one test, over all modes: relative; of the rms damping of the tests; of the largest
                                         component. NaN without a mode, of the shape also with one point */
};

/* Modes of count >= 2 tests as one. The test that is most like the others is assigned to each of them, mode to mode, so that the
 * sum of the distances in MAC and frequency is least (MAC above 0.8 over the points of all, frequency within 5 %); a mode counts
 * that every test has. mean: the points of all; frequency, damping, shapes (real and complex, each test at the scale that is
 * nearest to the mean, largest component 1), modal mass in that scale averaged, MPC and MPD of the mean shape, flags of any test;
 * nothing of residues, channels and poles. Standard deviations are s/sqrt(count) of the scatter s of one test, which is pooled
 * over all modes and points since few tests tell little of a single one: (count - 1)(points - 1) degrees of freedom for a shape.
 * Nothing depends on the order of the tests but numbers of modes and points. ROTID_OK, ROTID_ERROR_MEMORY. */
int ema_average(struct pool *pool, int count, const struct ema test[], struct ema *mean, struct ema_scatter *scatter);

/* Modes of a set of transfer functions: stabilisation table by least-squares complex frequency domain (Guillaume, Verboven,
 * Vanlanduit 1998; Peeters, Van der Auweraer, Guillaume, Leuridan 2004), shapes by least squares with residuals, then all poles
 * refined together by weighted nonlinear least squares (variable projection, weights 1/variance), from whose Jacobian the
 * standard deviations come, with the scatter from channel to channel where that is larger than chance. Modes that were not picked
 * are fitted along and not reported. EMA_QUADRATURE instead picks peaks of
 * the imaginary part (accelerance, receptance) or real part (mobility) as the paper does, damping from the half-power points.
 * ROTID_OK; ROTID_ERROR_ARGUMENT (fewer than 16 lines in the band, no channel, every channel dead), ROTID_ERROR_MEMORY,
 * ROTID_ERROR_EIGEN, ROTID_STOP_CANCELLED. No mode found is ROTID_OK with nmode = 0. */
int ema_compute(struct pool *pool, const struct frf_set *set, const struct ema_options *options,
                const rotid_environment *environment, struct ema *out);

/* The transfer function of channel c on n lines, from the modes, L_c and U_c. */
void ema_synthesise(const struct ema *ema, const struct frf_set *set, int c, int n, const double *frequency_hz,
                    double complex *h);

/* ------------------------------------------------------------------------------------------------------ channels, guards */

/* What is wrong with a transfer function, before and after the modes are known. */

/* Flags of channel [nfrf] from the lines first ... last - 1: NOT_FINITE, DEAD, DUPLICATE (the same to 1e-6 of the largest, or
 * FRAC above 0.99999 where the stated noise of both, above half a percent, forbids that of separate measurements), NOISY,
 * LOW_COHERENCE (mean weighted by |H|^2 below 0.8); duplicate_of, noise. usable [nfrf] := neither of the first two. Duplicates
 * stay in: what they add is a point of the shape. ROTID_OK or ROTID_ERROR_MEMORY. */
int channels_check(struct pool *pool, const struct frf_set *set, int first, int last, struct ema_channel *channel, int *usable);

/* fit and MISFIT of the usable channels over the same lines, from the modes in out. ROTID_OK or ROTID_ERROR_MEMORY. */
int channels_compare(struct pool *pool, const struct frf_set *set, int first, int last, const int *usable, struct ema *out);

/* Modes beyond the ends of the band, as far as the band feels them. */

#define GUARD_MOST 6 /* poles */

/* ------------------------------------------------------------------------------------------------------------ modal gram */

/* Weighted inner products of the columns of a modal fit, for many channels at a time. */

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

/* Fills the table and the denominators for the lines nu [nline], rising, and the columns basis [2 nline * (4 nmode + 4)] of
 * modal_fit_columns at these poles; where psi is not filled, neither are the products with it. Returns 0, or 1 where a pole is
 * not damped or too many are close. */
int modal_gram_fill(struct modal_gram *gram, const double *nu, const double complex *pole, const double *basis);

/* ---------------------------------------------------------------------------------------------------- modal fit, impacts */

/* The modal model on a choice of lines, linear in its residues, nonlinear in its poles: the kernel of the residues, of their
 * refinement and of fits to single channels. As accelerance, s = i omega,
 *
 *     H_c = s^2 sum_r [A_cr/(s - lambda_r) + conj(A_cr)/(s - conj(lambda_r))] + L_c - omega^2 U_c .
 *
 * Columns, real: of A_cr its real and imaginary part, phi = s^2 (g + g'), i s^2 (g - g') with g = 1/(s - lambda); of L_c and U_c
 * likewise; and psi = s^2 (g^2 + g'^2), i s^2 (g^2 - g'^2), from which each channel mixes its derivatives by lambda. Rows: real
 * and imaginary parts, each over its own standard deviation. */

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

/* For the channels from, ... of the band, on the lines line [nline] of it. Flat sigma (1 until refine_poles) where the band
 * has no variance. ROTID_OK or ROTID_ERROR_MEMORY. */
int modal_fit_new(struct pool *pool, const struct ema_band *band, int nline, const int *line, int from, int nchannel, int nmode,
                  int threads, struct modal_fit *fit);

/* That part for each channel at fit->pole. Normal equations with scaled columns: their rounding does not move where the score
 * vanishes by more than eps of a bandwidth. Returns sum chi2. Allocates nothing. */
double modal_fit_evaluate(struct modal_fit *fit, enum modal_fit_part part);

/* Columns of residues and rests, phi [2 nline * (2 nmode + 4)], on the lines nu of omega/scale for poles in that unit. */
void modal_fit_columns(int nline, const double *nu, int nmode, const double complex *pole, double *phi);

/* Mean square of the residual over its standard deviation in each channel within `widths` half-power bandwidths of each of the
 * modes 0 ... count - 1, to noise [nchannel * count]: 1 where the noise is what it was taken for; 1 too where fewer than four
 * lines tell. At fit->pole as it was evaluated last. */
void modal_fit_local_noise(const struct modal_fit *fit, int count, double widths, double *noise);

/* The lines of the band within `widths` half-power bandwidths 2 |Re lambda| of a pole, at least ten on each side; every second,
 * third ... of those further than three bandwidths from all poles where there would be more than `most`. Returns their number,
 * line [band->nline]. */
int modal_fit_lines(const struct ema_band *band, int nmode, const double complex *pole, double widths, int most, int *line);

/* The covariance `spread` of the residues takes the noise of neighbouring lines for independent. That of the force is not: behind
 * the window of the force its spectrum is smooth, and moves a whole peak up or down, as a gain would. So the residues are fitted
 * again without each impact in turn, the poles known; the jackknife of impacts of unequal weight (Busing, Meijer, van der Leeden
 * 1999) gives the variance of each, and stated + g |A|^2 = variance over the channels of a mode the relative variance g of that
 * gain, which is added to `spread`. fit: refined, with spread, on the lines line [fit->nline] of the band, which begins at line
 * `first` of the set. gain [fit->nmode] out: g, 0 where fewer than two impacts are known. ROTID_OK or ROTID_ERROR_MEMORY. */
int impacts_spread(const struct pool *pool, const struct frf_set *set, int first, const struct ema_band *band, const int *line,
                   struct modal_fit *fit, double *gain);

/* ----------------------------------------------------------------------------------------------------------------- local */

/* Modes that differ from channel to channel: a roving accelerometer, a support that slips, temperature. */

struct local_pole {
    int known;                    /* 0: the channel sits on a node, or no pole was found; the rest is NaN then */
    double complex pole, residue; /* as measured */
    double covariance[4];         /* of (Re, Im pole) */
    double residue_std;
    double chi2;  /* sum of squared residuals over the stated variance; without one as they are */
    double noise; /* that over the degrees of freedom */
};

/* Replaces modes that lie within 2 % of each other by one wherever each channel shows one peak only: one pole a channel against
 * common poles leaves less (log-likelihood of the residuals; both have as many unknowns where two become one). The pole that
 * stays is the median of the channels' own; none stays where their residues have no phase in common (MPC below 0.4). pole
 * [*count] in and out; ROTID_OK or ROTID_ERROR_MEMORY. */
int local_merge(const struct pool *pool, const struct ema_band *band, int *count, double complex *pole);

/* ---------------------------------------------------------------------------------------------------------------- refine */

/* All poles of a modal fit together: weighted nonlinear least squares with the residues eliminated (variable projection, Golub,
 * Pereyra 1973, in the form of Kaufman 1975: the information of the poles is the Schur complement of the Gauss-Newton matrix). */

struct refinement {
    double *covariance;        /* [(2 nmode)^2] of (Re, Im lambda/scale a mode) */
    double *widened;           /* [2 nmode] factor on each standard deviation that came from the scatter over channels, >= 1 */
    int *moved;                /* [nmode] nonzero: the pole ran away (further than three half-power bandwidths) or grows */
    int iterations, converged; /* converged: no pole but loose ones is further from its best place than 0.3 standard deviations */
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

/* Of refine_poles that evaluated only: adds the step s = A^-1 sum g_c to the minimum, by which the poles are off, as s s' to the
 * covariance. */
void refinement_add_step(int nmode, struct refinement *refinement);

/* ----------------------------------------------------------------------------------------------------------------- modes */

/* The modes of the result from a fit: frequencies, residues, quality flags. */

/* out->mode [nmode] with arrays to be filled, out->lower, upper, channel: everything NaN or 0. out->nfrf, npoint and the number
 * of modes are known. ROTID_OK or ROTID_ERROR_MEMORY. */
int modes_new(struct pool *pool, int nmode, int per_point, struct ema *out);

/* Frequency and damping of a pole, lambda = -zeta w + i w sqrt(1 - zeta^2), w = |lambda|, with their standard deviations from the
 * covariance [2 * 2] of (Re, Im lambda): dw = (Re dRe + Im dIm)/w, dzeta = (-dRe - zeta dw)/w. */
void modes_of_pole(double complex pole, const double *covariance, struct ema_mode *mode);

/* From a fit evaluated with spread and the covariance of its poles: poles (decay taken off), residues, lower and upper. Channels
 * without a fit stay NaN. */
void modes_from_fit(const struct ema_band *band, const struct modal_fit *fit, const struct refinement *refinement, double decay,
                    struct ema *out);

/* nearest_hz, peak_signal_to_noise, mac, and the quality flags CLOSE, COMPLEX, WEAK, NEGATIVE_DAMPING, EDGE from what the modes
 * hold. */
int modes_judge(struct pool *pool, const struct ema_band *band, double decay, struct ema *out);

/* ----------------------------------------------------------------------------------------------------------------- poles */

/* Roots of the polynomial of an order from those of the order before: root [n] of x^n + c[0] x^(n-1) + ... + c[n-1] by Ehrlich's
 * and Aberth's iteration (Aberth 1973), which takes n^2 operations a step where the eigenvalues of the companion matrix take n^3.
 * It begins with `before` [n - 2], roots of the polynomial of the order before, and a pair in the largest gap. Real roots come
 * out real, others as conjugate pairs. Returns 0, or 1 where that was not reached: the roots are then to be had as eigenvalues.
 * done [n] and angle [n] are workspace. */
int next_roots(int n, const double *c, const double complex *before, double complex *root, int *done, double *angle);

/* For each mode with suspect [nmode] nonzero (all with point_frequency_hz asked for): the pole of every channel alone. Where they
 * scatter beyond three times their standard deviations and a fiftieth of the half bandwidth, and leave less than two thirds of
 * the variance common [nmode * nchannel] (mode by mode) that the common poles leave near the mode, and no other mode lies within
 * three half-power bandwidths, the mode is EMA_DOUBLE_PEAK; where the widths agree local_pole is set, residues of the channels
 * that know their pole come from their own fits, frequency and damping are the means of the channels with the standard deviation
 * of a mean, and gain [nmode] (impacts_spread) in the standard deviations of the residues; where they do not, the pole is
 * local_common's. point_frequency: mean of the channels of the point. out holds the
 * modes of the common fit. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_STOP_CANCELLED. */
int per_point_frequencies(struct pool *pool, const struct ema_band *band, double decay, const int *suspect, const double *common,
                          const double *gain, const rotid_environment *environment, struct ema *out);

/* Sorts poles lambda [1/s] by rising Im lambda. pole [count] in and out. */
void sort_poles(size_t count, double complex *pole);

/* -------------------------------------------------------------------------------------------------- real modes, residues */

/* Real normal modes from complex ones, and how far they are from real. */

/* Modal phase collinearity (Pappa, Elliott, Schenk 1993): 1 where all components lie on one line through the origin, 0 without a
 * preferred direction: ((S_xx - S_yy)^2 + 4 S_xy^2)/(S_xx + S_yy)^2. NaN components are left out; 0 where all vanish. */
double mode_phase_collinearity(int n, const double complex *shape);

/* Mean deviation [degrees] of the phases from the line of best fit, weighted by the magnitude of the components. */
double mode_phase_deviation(int n, const double complex *shape);

/* exp(i a) along that line: the sum of Re(shape exp(-i a))^2 is largest. 1 where all vanish. */
double complex mode_axis(int n, const double complex *shape);

/* Residue of mode r in channel c of a modal fit (least-squares frequency domain), evaluated with spread: A of displacement, and
 * the standard deviation of its part along its own phase, V = spread + mix C mix' with the covariance C [(2 nmode)^2] of the
 * poles, NULL for poles that are known. NaN where the columns of the channel depend on each other. */
void residue_of_mode(const struct modal_fit *fit, int c, int r, const double *covariance, double complex *residue,
                     double *residue_std);

/* ------------------------------------------------------------------------------------------------------------- selection */

/* Which candidates are modes. */

/* Lines that a fit uses: within 50 half-power bandwidths of a mode. Further away a mode is no more than a residual term, and
 * modes that were not picked bias less what does not try to explain them. Those more than three bandwidths away carry little of
 * what is known of a pole: they are thinned so that an evaluation takes no more than the given number of products, of a tenth of
 * a second. */
#define FIT_WIDTHS    50
#define FIT_PRODUCTS  3e8
#define EARN_PRODUCTS 5e7

/* That number of lines, at least 16 a mode and 400. */
int selection_lines(const struct ema_band *band, int nmode, double products);

/* Leaves out what is weaker than a fifth of what selection_earn asks for, with the poles as they are. Arguments and statuses of
 * selection_earn. */
int selection_screen(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                     int *count, double complex *pole, int *candidate);

/* Fits all candidates together and leaves out, worst first and fitting again, those that do not earn their place:
 *   - the pole grows, runs away, is damped above 0.2, leaves the band, or it is not known to a fifth of its half bandwidth;
 *   - sum over channels |A|^2/var(A) <= 2 n + 12 sqrt(n) + 30 for n channels: what the best of very many places in the noise
 *     reaches by chance; var from what is left around the mode where that is more than the noise;
 *   - of three channels or more, two at least show it, and with a phase in common (MPC 0.4 where it can be told);
 *   - not a peak below 5 % of the median mode's together with an MPC below 0.9: something attached to the rotor;
 *   - it is not the weaker of two within half a half-power bandwidth that have one shape (MAC above 0.9),
 *     or within a fifth;
 *   - at its frequency it is less than `least share` (0.05) of |H| in every channel: it corrects what others leave;
 *   - its half-power bandwidth is under a fifth of the line spacing: a single line (mains hum).
 * pole [*count] in, the refined ones out; candidate [*count] tells which of those that came in each was. ROTID_OK,
 * ROTID_ERROR_MEMORY or
 * ROTID_STOP_CANCELLED. */
int selection_earn(const struct pool *pool, const struct ema_band *band, int threads, const rotid_environment *environment,
                   int *count, double complex *pole, int *candidate);

/* ---------------------------------------------------------------------------------------------------------------- shapes */

/* From residues to mode shapes. */

struct ema_points {
    int nreference;
    int *reference; /* [nfrf] index of the reference of each channel (of the response, where the force roves) */
    double *sign;   /* [nfrf] of response times reference direction */
    int *is_drive;  /* [nfrf] response and reference are the same point */
};

/* Points where the shapes live, channel_point and roving_force of out: the responses, or the references where these are more
 * (reciprocity: H_ij = H_ji). A direction counts without its sign, which goes into the shape: a transducer
 * mounted in -x measures -x. ROTID_OK or ROTID_ERROR_MEMORY. */
int shapes_points(struct pool *pool, const struct frf_set *set, struct ema_points *points, struct ema *out);

/* shape, complex_shape, shape_std, mpc, mpd, modal_mass of a mode from residue and residue_std of the usable channels.
 * With one reference the shape is the residues; with several the rank-one matrix phi_p v_j nearest to them, weighted by
 * 1/residue_std^2 of each channel (alternating least squares from the strongest reference; points that one reference lacks are no
 * obstacle). shape_std is that of a component by itself in units of the largest one, which has its own: the common factor is left
 * out, because shapes are compared up to their scale. Modal mass m = phi_d^2/(2 i omega_d A_d) of the drive points' mean.
 * The arrays of the mode exist; work [nreference]. */
void shapes_of_mode(const struct frf_set *set, const struct ema_points *points, const int *usable, const struct ema *out,
                    struct ema_mode *mode, double complex *work);

/* --------------------------------------------------------------------------------------------------------- stabilisation */

/* The stabilisation table and what it proposes. */

struct stabilisation {
    int norder, step, order;                       /* orders step, 2 step, ..., order */
    double frequency_tolerance, damping_tolerance; /* relative, of poles that are one */
    int *first;                                    /* [norder + 1] into pole and table */
    int npole;
    double complex *pole;   /* [npole] as measured, the window's decay still in */
    struct ema_pole *table; /* [npole] the decay taken off */
};

/* LSCF of every even order up to `order`, and for each pole whether the order before has one within the tolerances of the
 * options. ROTID_OK, ROTID_ERROR_MEMORY or ROTID_ERROR_EIGEN. */
int stabilisation_compute(struct pool *pool, const struct ema_band *band, int order, double decay,
                          const struct ema_options *options, struct stabilisation *out);

/* Candidates for modes. A physical pole comes back at order after order, so poles are followed: a track takes the nearest
 * decaying pole of damping below 0.2 that lies within frequency_tolerance, and four times damping_tolerance, which a weak mode
 * needs; it may miss one order. Tracks over at least an eighth of the orders and four of them are candidates, and so is what
 * several tracks one after the other make of one pole. Its value is the mean over the later half of the track.
 * pole [*count], on the pool, rising. ROTID_OK or ROTID_ERROR_MEMORY. */
int stabilisation_candidates(struct pool *pool, const struct stabilisation *table, int *count, double complex **pole);

/* For each frequency that a user picked the stable pole nearest to it within 2 %, of the highest order that has one; else any
 * decaying pole, else the frequency itself with damping 0.01; unstable [npick] tells where there was no stable one. */
void stabilisation_picks(const struct stabilisation *table, int npick, const double *pick_hz, double complex *pole,
                         int *unstable);

/* Marks each pole of the table that stands for one of the modes: nearest, within both tolerances (damping fourfold). */
void stabilisation_assign(const struct stabilisation *table, int nmode, const double complex *pole);

#endif
