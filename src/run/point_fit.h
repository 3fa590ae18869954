/* Frequencies that depend on where the accelerometer sat: weighted regressions with an intercept for each mode. */
#ifndef ROTID_RUN_POINT_FIT_H
#define ROTID_RUN_POINT_FIT_H

#include "base/pool.h"

#define POINT_COLUMNS 2

/* Reading j of mode k stands at [j + k * npoint]; y_kj = c_k + sum over the columns of slope_i column_i,kj + noise of std_kj. */
struct point_readings {
    int nmode, npoint, ncolumn; /* ncolumn from 0 to POINT_COLUMNS */
    const double *y, *std;      /* [npoint * nmode] finite and std > 0 where use is set */
    const double *column[POINT_COLUMNS];
    char *use; /* [npoint * nmode] nonzero: this reading counts */
    double
        *mean; /* [(2 + ncolumn) * nmode] workspace, afterwards for each mode: sum of weights, weighted means of y and columns */
};

struct point_fit {
    int readings, dof; /* dof: readings less modes that have any, less columns */
    double slope[POINT_COLUMNS];
    double variance[POINT_COLUMNS]; /* of the slopes, for the noise as stated */
    double cross;                   /* and their covariance */
    double chi2;
    double scale; /* sqrt(chi2/dof) where that is above one, else 1: factor by which the stated noise grows */
};

/* Least squares over the readings in use. 0, or 1 where a column is constant within every mode or the two cannot be told apart:
 * *fit is then that without columns. */
int point_fit(const struct point_readings *readings, struct point_fit *fit);

/* Takes out of use, one after the other, the reading that the others contradict most: its residual is beyond what noise makes of
 * the largest of all readings once in a hundred times, by Student's distribution and by the scatter of the others or the stated
 * noise, whichever is larger. At most a tenth of the readings, at least one; never so many that fewer than three degrees of
 * freedom are left. Returns the number taken out. */
int point_drop_outliers(const struct point_readings *readings);

/* What one measured mode has for a frequency, from readings that were taken with the accelerometer at one sensor after the
 * other. */
struct point_mean {
    int readings, dropped;
    int regressed;        /* on the squared shape; else the plain weighted mean of the readings */
    double hz, std;       /* Hz; std NaN where nothing says it */
    double std_of_others; /* Hz, of one reading that has none of its own; NaN where nothing says it */
};

/* The mean over all sensors that have a component of the shape: f_j = c + b shape_j^2 by weighted regression, read at the mean of
 * shape_j^2; its standard deviation from the regression, times its scale. Readings whose std is not known (NaN) count with the
 * largest that is known; where none is, all count alike and their scatter gives both deviations. Fewer than five readings, no
 * shape, or readings where the shape is the same everywhere: the plain weighted mean of the readings.
 * hz, std [nsensor] in Hz, NaN where there is none; shape [nsensor], or NULL. ROTID_OK, ROTID_ERROR_MEMORY, or
 * ROTID_ERROR_ARGUMENT where there is no reading. */
int point_mean(struct pool *pool, int nsensor, const double *hz, const double *std, const double *shape, struct point_mean *out);

#endif
