#ifndef ROTID_SIGNAL_SIGNAL_H
#define ROTID_SIGNAL_SIGNAL_H

/* signal: from hammer and response records to transfer functions H(f) with their variance; windows; spectra.
 *
 * Comes in: time records of force f and response x, sampled together (struct time_record), options in SI. Goes out: struct
 * frf_set (H, variance, coherence on common lines), the impacts found, the spectra of each impact. Entrance: transfer_compute.
 *
 *   impacts      impact_find: |f| above a share of its largest value; impact_merge: double hits           transfer.c
 *   blocks       block_plan: one length 2^a 3^b 5^c for all; cut, overloaded, double impacts left out      transfer.c
 *   windows      force: kept, then faded by a cosine; exponential exp(-d t) on f and x, which shifts each  transfer.c
 *                pole to lambda - d and leaves its residue
 *   spectra      fft_real, kissfft; S_ff = |F|^2, S_xx = |X|^2, S_xf = X conj(F) for each impact           transfer.c
 *   estimators   estimator_transfer: H1 = S_xf/S_ff, H2 = S_xx/S_fx, Hv by total least squares;            transfer.c
 *                estimator_coherence: |S_xf|^2/(S_ff S_xx)
 *   variance     estimator_jackknife: 1/K sum (1 - w_i)/w_i |H - H_(i)|^2, w_i = S_ff,i/sum S_ff; then     transfer.c
 *                estimator_smooth: mean over 31 lines
 *
 * src/import calls transfer_compute for the records of a file; src/ema takes the set and, for the scatter of the force, the
 * spectra of single impacts; src/run compares the set with synthesised functions. The room knows nothing of files and modes. */

#include "base/base.h"

/* ------------------------------------------------------------------------------------------------------------------- frf */

/* Transfer functions of one test on common lines: what the signal processing makes, what the modal extraction and the synthesis
 * use. SI units. */

enum frf_quantity { FRF_DISPLACEMENT, FRF_VELOCITY, FRF_ACCELERATION }; /* of the response: powers of i omega */

struct frf {
    int line;                                /* of the file that it comes from, for messages; 0 where there is none */
    int response_node, response_direction;   /* as in set 58: +-1 x, +-2 y, +-3 z, 0 scalar */
    int reference_node, reference_direction; /* of the force */
    double complex *h;                       /* [nline] response over force [m/N, m/(s N), m/(s2 N)] */
    double *variance;                        /* [nline] E|h - E h|^2 of the mean, or NULL; INFINITY where the line says nothing */
    double *coherence;                       /* [nline] in [0, 1], or NULL */
    const double complex *single; /* [nline * averages] cross spectrum with the force of each impact, NULL where not known */
    const double *single_force;   /* [nline * averages] its spectrum of the force */
    int averages;                 /* impacts that were averaged, 0 where not known */
};

struct frf_set {
    int nline;
    double *frequency_hz; /* [nline] rising, > 0 but perhaps the first */
    enum frf_quantity quantity;
    double window_decay; /* 1/s: the exponential window multiplied force and response by exp(-decay t), so that h is the transfer
                            function at s = i omega + decay: each pole seen has to get the decay back, and the powers of i omega
                            between the quantities are powers of s */
    int nfrf;
    struct frf *frf;
};

/* -------------------------------------------------------------------------------------------------------------- transfer */

/* From time records of a hammer test to transfer functions. One channel is the force, the others respond; a record may hold one
 * impact or several. */

enum transfer_estimator { TRANSFER_H1, TRANSFER_H2, TRANSFER_HV };

/* Zero takes the default in brackets. */
struct transfer_options {
    int estimator;     /* H1 = S_xf/S_ff (noise on the response), H2 = S_xx/S_fx (noise on the force), Hv (both, the vector of
                          least total error of [S_ff S_fx; S_xf S_xx], the response in the unit that gives both channels the same
                          energy over the lines: so it is meant for noise of the same share in both, and free of units) */
    double threshold;  /* [0.1] an impact is where the force exceeds this share of its largest value, < 1 */
    double pretrigger; /* [0.01] s before the impact that belong to the block, fewer where the record has fewer. Their mean is
                          taken off both channels, without the rise of the pulse */
    double block;      /* s, length of a block, rounded down to 2^a 3^b 5^c samples, even, as is the default: [to the next impact
                          or the end of the record, the shortest of all but those shorter than half of what is usual in their
                          record, which are cut]. By default a pulse within a tenth of the usual spacing, and within 0.25 s, is a
                          second hit */
    double force_window; /* s after the impact that the force is kept, then it fades to its mean before the impact within a
                            quarter of that; [ten times the width of the pulse at the threshold, at least the 128 samples in which
                            an anti-alias filter rings down]; < 0: none. Double hits that are kept have none */
    double exponential;  /* end value of the exponential window of the response and of the force, relative: 0.01 damps to 1 % at
                            the end of the block; [0: none]. It belongs on both, so that H keeps its form with every pole shifted
                            by the decay (window_decay) */
    double low_hz, high_hz; /* lines kept, never 0 Hz; [first line above 0 ... 0.45 of the sampling rate] */
    int double_hits;        /* nonzero: keep impacts that hit twice; else they are left out, with a count */
};

struct impact { /* one found in a record */
    int record;
    long long onset;  /* index of its first sample above the threshold */
    long long sample; /* of the largest force */
    double peak;      /* N, from the base line of the force; negative where the hammer's cable has that sign */
    double width;     /* s at the threshold */
    double tail; /* rms of the response over the last tenth of the block, windowed, over that of all of it: above some 0.1 the
                    block ends too early and lines leak (longer block, or exponential window); 0 where it is not used */
    double lost; /* rms of the force that a given window takes away within what is kept by default, over the rms of that; without
                    the noise before the impact, and 0 where less than 5 samples tell it */
    int is_double;  /* a second pulse above the threshold inside the block */
    int is_cut;     /* the block does not fit into the record or before the next impact */
    int is_clipped; /* force or response stays at its largest value: overload */
    int used;       /* not cut, not clipped, not double, the response not constant */
};

struct time_record { /* one measurement: force and one response, sampled together */
    int line;        /* of the file, for messages */
    int response_node, response_direction, reference_node, reference_direction;
    long long count;
    const double *force, *response; /* [count] N; m, m/s or m/s2 */
};

struct transfer {
    struct frf_set set; /* a response and reference each; variance and coherence of each line; on the pool. `line` is that of the
                           first record */
    int nimpact;
    struct impact *impact; /* [nimpact] all that were found, record by record */
    /* Every impact by itself, for uncertainties by deleting one at a time: */
    int *first;              /* [set.nfrf + 1] into single, per transfer function */
    double complex *single;  /* [nline * first[nfrf]] S_xf of each used impact, column by column */
    double *single_force;    /* same shape: its S_ff */
    double *single_response; /* same: its S_xx */
};

/* Transfer functions of nrecord records at sampling rate `rate` [Hz], 1e-12 ... 1e12. Records with the same response and
 * reference are averaged together, in the order in which the records name them first. Impacts that are cut, overloaded, double or
 * dead are left out. Variance of a line, where there are two impacts or more: from their spread (delete-one jackknife of the
 * chosen estimator, weighted by S_ff; for two that is their difference), then averaged over 31 lines (estimator_jackknife,
 * estimator_smooth): under noise of the response |h - E h|^2 over it is 1 in the mean, within 3 %; under
 * noise of the force, which follows |h|^2, within 20 %. It knows nothing of the bias of an estimator that trusts a noisy channel.
 * Coherence |S_xf|^2/(S_ff S_xx) where there are two or more; without noise it is 1, with noise alone 1/averages. A line without
 * force has h = 0, variance INFINITY, coherence 0. For one impact variance and coherence are NULL. What estimator_sum and
 * estimator_transfer make of the single spectra is h again, with weights any other choice of impacts. ROTID_OK,
 * ROTID_ERROR_ARGUMENT (*bad_record: the record without an impact, or with samples that are not finite or above 1e50, or shorter
 * than a block; the first of a transfer function that has no impact to use; -1 where the options are at fault, also where no line
 * lies between their limits), ROTID_ERROR_MEMORY. threads >= 1; the results are the same for any number. */
int transfer_compute(struct pool *pool, int nrecord, const struct time_record *record, double rate, enum frf_quantity quantity,
                     const struct transfer_options *options, int threads, struct transfer *out, int *bad_record);

/* ----------------------------------------------------------------------------------------------------------------- block */

/* Which part of which record belongs to which impact. All blocks have the same length, so that all lines are the same. */

#define BLOCK_LARGEST 1e50 /* of a sample in SI units: beyond it the squares of spectra overflow */

struct block_plan {
    int n;                 /* samples of a block, of fft_length */
    int *first;            /* [nrecord + 1] into impact */
    int *begin;            /* [first[nrecord]] samples of each block before the onset, >= 1 unless the impact is cut */
    struct impact *impact; /* record by record, with everything but `tail` */
};

/* ------------------------------------------------------------------------------------------------------------- estimator */

/* Transfer functions and their variance from spectra of single impacts. With force F and response X of an impact, a column holds
 * S_ff = |F|^2, S_xx = |X|^2, S_xf = X conj(F) on nline lines; columns follow each other. */

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

/* ------------------------------------------------------------------------------------------------------------------- fft */

/* Discrete Fourier transform of real samples, by kissfft in single precision.
 *
 * The data are scaled by a power of two to at most 1 in magnitude before they are rounded to single precision, so neither
 * overflow nor underflow depends on units. What single precision leaves: no line is off by more than FFT_ACCURACY sqrt(n sum
 * x^2), the largest that a line can be, and for the lengths of fft_length the mean square error over the lines is below (2e-7)^2
 * of their mean square. So what lies 130 dB below the root mean square of a spectrum drowns; converters of 24 bits resolve 110
 * dB. */

#define FFT_LONGEST  (1 << 26) /* samples: an hour at 18 kHz; keeps every size an int with room to spare */
#define FFT_ACCURACY 1e-7      /* two roundings of 2^-24 */

struct fft { /* plan and workspace of one thread */
    int n;
    void *plan, *line;
    float *time;
};

/* The largest 2^a 3^b 5^c with a >= 1 that is not above n nor FFT_LONGEST: lengths that kissfft transforms in O(n log n) and
 * without allocating. It is never below 0.8 n for n >= 8. 0 where n < 2. */
int fft_length(long long n);

/* Room for transforms of n samples, on the pool. n even, 2 <= n <= FFT_LONGEST; a prime factor p above 5 costs O(n p).
 * ROTID_OK, ROTID_ERROR_ARGUMENT, ROTID_ERROR_MEMORY. */
int fft_open(struct pool *pool, int n, struct fft *fft);

/* X_k = sum_j x_j exp(-2 pi i jk/n), k = 0 ... n/2. x [n] finite, X [n/2 + 1]. */
void fft_real(struct fft *fft, const double *x, double complex *X);

/* ---------------------------------------------------------------------------------------------------------------- impact */

/* Where a hammer hit, from the force alone. */

#define IMPACT_LEAST_FORCE 1e-50 /* N: below it the squares of spectra underflow */

struct impact_list {
    struct impact *item;
    size_t count, capacity;
};

/* Upper quartile of the samples from each of npulse >= 1 pulses to the next one or to the end of the record: the usual spacing,
 * also where each impact has a second hit. work [npulse]. */
long long impact_spacing(int npulse, const struct impact *pulse, long long count, double *work);

/* A pulse that begins to rise no more than `reach` samples after the onset of an impact is its second hit: the impact is_double
 * and the pulse leaves the array. Returns how many impacts remain. */
int impact_merge(int npulse, struct impact *pulse, double rate, long long reach);

/* Samples from `start` to where impact k of n rises next, or to the end of the record: room for its block. */
long long impact_room(int n, const struct impact *impact, int k, double rate, long long start, long long count);

/* ---------------------------------------------------------------------------------------------------------------- window */

/* Windows of a hammer test. Both leave the form of a transfer function as it is. */

/* Decay [1/s] of the exponential window that falls to `end` over n samples at `rate` [Hz]: ln(1/end) rate/n; 0 < end <= 1.
 *
 * On force and response alike it changes nothing but the poles. Where x(t) is the integral of h(t - s) f(s) ds,
 *     exp(-d t) x(t) = integral of [exp(-d (t - s)) h(t - s)] [exp(-d s) f(s)] ds,
 * so the windowed signals obey exp(-d t) h(t), whose poles are lambda - d with the same residues, exactly and for any force. On
 * the response alone it would do so only for a pulse of no length. */
double window_decay(int n, double end, double rate);

#endif
