/* Sensitivity of the residuals to anything that changes K and M, at one point of a model: the adjoint way. For every fitted mode
 * the rows of (K - lambda M)^+ at the sensors are solved for once; a change dK, dM then costs products only.
 * Residuals as in modal/functional.h for the likelihood: frequencies of the fitted modes first, then shapes mode by mode, each
 * with its best scale, so a column is already orthogonal to the scales. */
#ifndef ROTID_DIAGNOSE_COLUMNS_H
#define ROTID_DIAGNOSE_COLUMNS_H

#include "modal/functional.h"
#include "model/model.h"
#include "run/job.h"

struct columns_mode {
    int k, pair, sensors; /* measured mode; pair of the prediction; components measured */
    const int *sensor;    /* [sensors] indices */
    double scale;         /* a: predicted shape times a is the best fit to the measured one */
    int first, members;   /* pairs of its cluster (modal/eigenvector_derivative.h) */
    double *adjoint;      /* [sensors * n] */
    double *weighted;     /* [sensors] phi_s/s_s: the direction of the scale */
    double square;        /* its squared length */
};

struct columns {
    struct pool *pool;
    const struct job *job;
    struct rotor_model model;
    struct functional functional;
    rotid_measured measured;
    int nrow, nmode;                 /* residuals, fitted modes */
    struct columns_mode *mode;       /* [nmode] */
    double *x, *r;                   /* [nparam], [nrow]: the point and its residual */
    double *rows, *dk_phi, *dm_phi;  /* [n * nmode] what a change touches of the modes, and what it makes of that */
    double *right;                   /* [n] */
    double *dphi;                    /* [nmaster] */
    rotid_matrix dk, dm;
};

/* At the values x of the job's parameters (those in the rotor, where NULL), with the pairing `number` and the held-out modes
 * `holdout` [nmode]. extra: an effect that can be put in for differentiation, NULL: none; its parameters follow those of the job.
 * Statuses of the fit. */
int columns_open(struct pool *pool, const struct job *job, const int *number, const int *holdout, const struct effect *extra,
                 const double *x, struct columns *c);

/* Solves for what the columns need; before the first of them. Statuses of memory, or ROTID_ERROR_CLOSE. */
int columns_prepare(struct columns *c);

/* column [nrow] for parameter p of the model: the job's first, then those of the extra effect. */
int columns_parameter(struct columns *c, int p, double *column);

/* The effect in the place of the extra one, at its neutral values; the model does not change. ROTID_OK or ROTID_ERROR_MEMORY. */
int columns_probe(struct columns *c, const struct effect *effect);

/* Residual [nrow] at other values x of all parameters, by solving the model anew: for secants. The state that columns_parameter
 * needs is lost with it. */
int columns_residual(struct columns *c, const double *x, double *r);

#endif
