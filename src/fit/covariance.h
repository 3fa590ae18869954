/* What the data say about the parameters: covariance, correlation, intervals, undetermined directions. */
#ifndef ROTID_FIT_COVARIANCE_H
#define ROTID_FIT_COVARIANCE_H

#include "rotid.h"

struct covariance_input {
    int m, n;
    const double *jacobian;  /* [m * n] with respect to x_p/|x_p|: relative parameters */
    const double *r;         /* [m] */
    const double *noise_std; /* [m] of the residuals where the noise is known (1 for a likelihood), else NULL */
    int nscale;              /* degrees of freedom spent on the scales of the shapes */
    const double *x;         /* [n] */
    const int *fixed;        /* [n] nonzero: pressed against a bound, taken as known */
};

size_t covariance_workspace(int m, int n);

/* Fills covariance ... widened_by, chi2 and dof of the result, with Student's t where the variance comes from the residuals and
 * the sandwich (J'J)^-1 J' S J (J'J)^-1 where the functional does not weigh by the noise S it is given. Directions that the data
 * determine to no better than half of the parameters' own size are called undetermined, and parameters whose 95 % interval holds
 * zero not identifiable. ROTID_OK or ROTID_ERROR_LIBRARY. */
int covariance_compute(const struct covariance_input *input, rotid_fit_result *result, double *work);

#endif
