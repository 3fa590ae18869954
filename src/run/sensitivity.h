/* Sensitivity of the modes to parameters: the paper's Table 1 and Figure 5, for any parameter. */
#ifndef ROTID_RUN_SENSITIVITY_H
#define ROTID_RUN_SENSITIVITY_H

#include "run/growth.h"

struct sensitivity_options {
    double step;  /* relative, for (29) */
    double range; /* relative, of the curves: x/x0 from 1 - range to 1 + range */
    int points;   /* of each curve */
    int modes;
    int with_growth;
    unsigned long seed; /* of its shapes */
};

struct sensitivity {
    int n, m, points;
    double *reference;    /* [n] x0 */
    double *hz;           /* [m] at the reference */
    double *difference;   /* [m * n] E_k(x0 (1 + step e_p))/step with E_k = 1 - R*_k/w_k(x0)^2: (29) */
    double *derivative;   /* [m * n] its limit for a small step, from the analytic derivatives */
    double *relative;     /* [points] x/x0 of the curves */
    double *curve;        /* [m * points * n] E_k^2/2 */
    struct growth growth; /* points 0 where it was not asked for */
};

/* Around the values x0 [n] of the parameters, with the reduction of the job's FIT. Statuses of the prediction; at points of a
 * curve where the model has no modes the curve is NaN. */
int sensitivity_run(struct pool *pool, const struct job *job, int n, const struct parameter *parameter, const double *x0,
                    const struct sensitivity_options *options, struct sensitivity *out);

#endif
