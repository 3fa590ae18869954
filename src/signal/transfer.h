/* From time records of a hammer test to transfer functions. One channel is the force, the others respond; a record may hold one
 * impact or several. */
#ifndef ROTID_SIGNAL_TRANSFER_H
#define ROTID_SIGNAL_TRANSFER_H

#include "base/pool.h"
#include "signal/frf.h"

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
                            by the decay (signal/window.h) */
    double low_hz, high_hz; /* lines kept, never 0 Hz; [first line above 0 ... 0.45 of the sampling rate] */
    int double_hits;        /* nonzero: keep impacts that hit twice; else they are left out, with a count */
};

struct impact { /* one found in a record */
    int record;
    long long onset;  /* index of its first sample above the threshold */
    long long sample; /* of the largest force */
    double peak;      /* N, from the base line of the force; negative where the hammer's cable has that sign */
    double width;     /* s at the threshold */
    double tail;    /* rms of the response over the last tenth of the block, windowed, over that of all of it: above some 0.1 the
                       block ends too early and lines leak (longer block, or exponential window); 0 where it is not used */
    int is_double;  /* a second pulse above the threshold inside the block */
    int is_cut;     /* the block does not fit into the record or before the next impact */
    int is_clipped; /* force or response stays at its largest value: overload */
    int used;
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
 * reference are averaged together, in the order in which the records name them first. Impacts that are cut, overloaded or double
 * are left out. Variance of a line, where there are two impacts or more: from their spread (delete-one jackknife of the chosen
 * estimator, weighted by S_ff; for two that is their difference), then averaged over 31 lines (estimator_jackknife,
 * estimator_smooth of signal/estimator.h): under noise of the response |h - E h|^2 over it is 1 in the mean, within 3 %; under
 * noise of the force, which follows |h|^2, within 20 %. It knows nothing of the bias of an estimator that trusts a noisy channel.
 * Coherence |S_xf|^2/(S_ff S_xx) where there are two or more; without noise it is 1, with noise alone 1/averages. A line without
 * force has h = 0, variance INFINITY, coherence 0. For one impact variance and coherence are NULL. What estimator_sum and
 * estimator_transfer make of the single spectra is h again, with weights any other choice of impacts. ROTID_OK,
 * ROTID_ERROR_ARGUMENT (*bad_record: the record without an impact, or with samples that are not finite or above 1e50, or shorter
 * than a block; the first of a transfer function that has no impact to use; -1 where the options are at fault, also where no line
 * lies between their limits), ROTID_ERROR_MEMORY. threads >= 1; the results are the same for any number. */
int transfer_compute(struct pool *pool, int nrecord, const struct time_record *record, double rate, enum frf_quantity quantity,
                     const struct transfer_options *options, int threads, struct transfer *out, int *bad_record);

#endif
