/* Residuals between measured and predicted modes, and their Jacobian. */
#ifndef ROTID_MODAL_FUNCTIONAL_H
#define ROTID_MODAL_FUNCTIONAL_H

#include "modal/prediction.h"
#include "rotid.h"

struct functional {
    int kind; /* ROTID_HYBRID, ROTID_HYBRID_F or ROTID_LIKELIHOOD */
    const rotid_measured *measured;
    struct prediction prediction;
    int with_vectors; /* the residual depends on shapes */
    int *wanted;      /* [prediction.count]: pairs that a fitted mode uses */
    int *pair;        /* [nmode] pair of each measured mode */
    double *omega;    /* [nmode] measured, rad/s */
    double *shape;    /* [nmaster * nmode] measured, largest component 1, or NULL */
    int nresidual;    /* of the fitted modes: one a frequency, and one a measured shape component for the likelihood */
    double *quotient; /* [nmode] R*_k of the last evaluation */
    double *work;     /* [2 nmaster] */
};

/* Checks the measured data and makes room; with all modes held out there is no residual. ROTID_OK, MEMORY, ARGUMENT (data out of
 * range), UNPAIRED (a mode number beyond the model). */
int functional_new(struct pool *pool, int kind, int reduction, int derivative, const rotid_model *model,
                   const rotid_measured *measured, struct functional *f);

/* r [nresidual] at x, frequencies of all fitted modes first, then shapes mode by mode. Allocates nothing. Statuses of the
 * prediction, and UNPAIRED where a shape is orthogonal to its partner. */
int functional_residual(struct functional *f, const double *x, double *r);

/* dr/dx [nresidual * nparam] at the x of the last functional_residual. */
int functional_jacobian(struct functional *f, const double *x, double *jacobian);

/* Whether a mode is fitted: it is not held out. */
int functional_fits(const rotid_measured *measured, int mode);

/* Components of the shape that was measured of a mode, 0 where it is NaN or 0 everywhere. */
int functional_count_components(const struct functional *f, int mode);

/* The frequency residual of any mode, fitted or held out, at the last evaluation. */
double functional_frequency_residual(const struct functional *f, int mode);

#endif
