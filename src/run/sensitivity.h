/* Sensitivity of the modes to parameters: the paper's Table 1 and Figure 5, for any parameter. */
#ifndef ROTID_RUN_SENSITIVITY_H
#define ROTID_RUN_SENSITIVITY_H

#include "rotid.h"
#include "run/growth.h"

struct sensitivity_options {
    double step;  /* relative, for (29) */
    double range; /* relative, of the curves: x/x0 from 1 - range to 1 + range */
    int points;   /* of each curve */
    int modes;
    int with_growth;
    unsigned long seed; /* of its shapes */
};

/* how the modes depend on one parameter */
struct sensitivity_parameter {
    const char *name;                   /* such as core.E */
    const char *unit;                   /* of the reference; 1 for a pure number */
    double reference;                   /* value x0 that the relative changes refer to [unit] */
    int nfrequency_hz, nrelative_value; /* as in struct sensitivity */
    double *sensitivity;      /* per mode: E_k after one step, divided by the step [1]; E_k = 1 - R*_k/w_k(x0)^2: (29) */
    double *derivative;       /* per mode: its limit for a step that vanishes, from the analytic derivatives [1] */
    double *frequency_change; /* per mode: relative change of the frequency for that of the parameter, d ln f/d ln x [1], per cent
                                 for a per cent; -derivative/2, since E_k = 1 - (f/f0)^2 */
    double *curves; /* per mode, Figure 5 of the paper: component E_k^2/2 of the objective of HYBRID at each relative_value [1];
                       NaN where the model has no modes */
};

struct sensitivity {
    const char *reduction;  /* of the model that is varied */
    double step;            /* relative step of the differences [1] */
    int nfrequency_hz;      /* modes */
    double *frequency_hz;   /* of each mode at the reference values [Hz] */
    int nrelative_value;    /* points of the curves */
    double *relative_value; /* abscissa of the curves: value over reference [1] */
    int nparameters;
    struct sensitivity_parameter *parameters; /* in the order of *IDENTIFY or --at */
    struct growth *functional_growth; /* how the hybrid functionals grow away from the optimum, Figure 3 of the paper; NULL where
                                         that was not asked for */
};

/* Around the values x0 [n] of the parameters, whose names are `named`, with the reduction of the job's FIT. Statuses of the
 * prediction; at points of a curve where the model has no modes the curve is NaN. */
int sensitivity_run(struct pool *pool, const struct job *job, int n, const struct parameter *parameter,
                    const rotid_parameter *named, const double *x0, const struct sensitivity_options *options,
                    struct sensitivity *out);

#endif
