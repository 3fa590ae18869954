/* Experimental modal analysis: poles and shapes from transfer functions.
 *
 *     H_c(omega) = (i omega)^q [ sum_r  A_cr/(i omega - lambda_r) + conj(A_cr)/(i omega - conj(lambda_r))  - L_c/omega^2 + U_c ]
 *
 * for channel c (a response over a reference), q = 0, 1, 2 for displacement, velocity, acceleration; L_c and U_c stand for what
 * lies below and above the band. lambda = -zeta w0 + i w0 sqrt(1 - zeta^2), the frequency of a mode is w0/(2 pi). */
#ifndef ROTID_EMA_EMA_H
#define ROTID_EMA_EMA_H

#include "base/pool.h"
#include "rotid.h"
#include "signal/frf.h"

enum ema_method { EMA_LSCF, EMA_QUADRATURE };

/* Zero takes the default in brackets. */
struct ema_options {
    int method;
    double low_hz, high_hz; /* band; [the lines of the set] */
    int order; /* largest order of the denominator, of which half are poles of positive frequency; [120], and two thirds of the
                  number of lines at most. Parts of a long band take 60 of it at most (zoom.h) */
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
    int mode;                             /* index of the mode that it was taken for, or -1 */
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
    int quality_flags, twin; /* twin: the channel that it duplicates, or -1 */
    double fit;              /* |sum conj(H) H^|^2/(sum |H|^2 sum |H^|^2) over the band (FRAC of measured and synthesised) */
    double noise;            /* rms of sqrt(variance) over rms of |H|; NaN without variance */
};

struct ema { /* everything on the pool */
    int nfrf, npoint;
    int *point_node,
        *point_direction; /* [npoint] distinct pairs, in the order of the transfer functions: where the shapes live */
    int roving_force;     /* nonzero: one response and many references: shapes live at the references (reciprocity) */
    int *channel_point;   /* [nfrf] index of the point */
    int order;            /* used */
    int npole;
    struct ema_pole *pole; /* stabilisation table: order by order, rising frequency */
    int nmode;
    struct ema_mode *mode; /* rising frequency; behind them nguard that stand for what is beyond the band, see guard.h */
    int nguard;
    double *mac;                   /* [nmode * nmode] of the complex shapes with themselves */
    double complex *lower, *upper; /* [nfrf] L_c, U_c */
    struct ema_channel *channel;   /* [nfrf] */
    int refined;                   /* iterations of the last refinement */
    int std_from_impacts;          /* 1: from the variance of the lines; 0: from what the modes leave over */
};

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

/* The transfer function of channel c on n lines, from the modes and (with_residuals) L_c and U_c. */
void ema_synthesise(const struct ema *ema, const struct frf_set *set, int c, int with_residuals, int n,
                    const double *frequency_hz, double complex *h);

#endif
