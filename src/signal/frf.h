/* Transfer functions of one test on common lines: what the signal processing makes, what the modal extraction and the synthesis
 * use. SI units. */
#ifndef ROTID_SIGNAL_FRF_H
#define ROTID_SIGNAL_FRF_H

#include "base/complex.h"

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

#endif
