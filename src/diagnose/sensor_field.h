/* The residual of the shapes as a random field along the axis, to predict one sensor from the others.
 *
 * Sensor i reads m_ik = P_k(z_i) + e_k(z_i) + noise in mode k. P_k is the model's shape, e_k what the model gets wrong. Stiffness
 * that is wrong somewhere bends a shape by e'' = d(M/EI), so e is taken as twice integrated white noise of intensity q (a cubic
 * smoothing spline, Wahba 1978), which leaves its slope as rough as a joint makes it, plus what mixes the modes:
 *
 *     cov(e(z), e(z')) = c (1 + x x') + b^2 sum_j P_j(z) P_j(z') + q int (z - u)+ (z' - u)+ du
 *
 * How wrong the model is, (b, q), is not known: every mode has its own mixture over a grid of them, weighted by how well each
 * explains the other sensors. On a bad model the prediction is therefore wide by itself, and sound sensors are not accused.
 * With A = cov^-1 and w = A (m - P), sensor i is predicted from the others as m_i - w_i/A_ii with variance 1/A_ii, noise
 * included, and is left out of everything that follows by A - a_i a_i'/A_ii. Shapes are scaled to a largest deflection of the
 * model of 1. */
#ifndef ROTID_DIAGNOSE_SENSOR_FIELD_H
#define ROTID_DIAGNOSE_SENSOR_FIELD_H

#include "base/pool.h"
#include "diagnose/sensor_check.h"

#define FIELD_MOST_GRID  40
#define FIELD_MOST_MODES 64

struct sensor_field {
    const struct shape_data *data;
    int n, nmode, ngrid, nclass;
    double noise_factor;         /* in variance */
    double origin, middle, half; /* of the axis [m] */
    double q[FIELD_MOST_GRID], b2[FIELD_MOST_GRID];
    double *unit;                       /* [nmode] scale of the measured shape over that used here; 0: mode without data */
    double *scale;                      /* [nmode] axis_shape times this is P */
    double *model, *reading, *variance; /* [n * nmode] P, m and the variance of the noise at the sensors */
    int *present;                       /* [n * nmode] measured */
    int *masked;                        /* [n] left out */
    int *class_of, *leader;             /* [nmode] modes with the same noise at the same sensors share A; the first of each */
    double *inverse;                    /* [n * n * ngrid * nclass] A; rows of sensors that are left out or absent are zero */
    double *weight;                     /* [n * ngrid * nmode] w */
    double *evidence;                   /* [ngrid * nmode] log likelihood of what is not masked, but for constants */
    double *part[3];                    /* [n * n] parts of the covariance, to be added up with c, b^2 and q */
    double *packed;                     /* [n * n] */
    int *row;                           /* [n] */
};

/* Sizes, scales and grid of the data; every mode is scaled afresh by the weighted median of the ratios measured/model, which a
 * few bad sensors do not move. ROTID_OK or ROTID_ERROR_MEMORY. */
int field_new(struct pool *pool, const struct shape_data *data, struct sensor_field *field);

/* All sensors in, noise times `noise_factor`. Returns 0, or 1 where the covariance is singular to working precision. */
int field_start(struct sensor_field *field, double noise_factor);

/* Leaves sensor s out of all that follows. */
void field_mask(struct sensor_field *field, int s);

/* Lets sensors s and t change their readings. Both must have been measured in the same modes. */
void field_exchange(struct sensor_field *field, int s, int t);

/* Log likelihood of the sensors that are in. */
double field_evidence(const struct sensor_field *field);

/* Where sensor s would be at z: mean and variance of the deflection there [ngrid * nmode] predicted by the sensors that are in
 * but s, for the grid points with wanted [ngrid * nmode] nonzero. Workspace: vector [4 n]. */
void field_predict(const struct sensor_field *field, int s, double z, const int *wanted, double *mean, double *variance,
                   double *vector);

/* A [n * n] of a grid point and a class, w [n] of a grid point and a mode. */
double *field_inverse(const struct sensor_field *field, int g, int c);
double *field_weight(const struct sensor_field *field, int g, int k);

#endif
