/* An identification: what `rotid identify --json` writes, and each of "today", "base" and "extended" of a diagnosis. */
#ifndef ROTID_PAGE_FITTED_H
#define ROTID_PAGE_FITTED_H

#include "result/place.h"

struct fitted_parameter {
    const char *name, *unit;
    double value, start, lower, upper, std, ci[2]; /* NaN where it cannot be stated */
    int at_bound, identifiable;
};

struct fitted_mode {
    int mode, measured_mode; /* of the model; of the test, 0 where the result does not say */
    double measured_hz, predicted_hz, error_percent, residual, mac, nco;
    double frequency_std;                   /* relative, NaN: not stated */
    double reduction_percent, mesh_percent; /* NaN: not known */
    int holdout, by_shape;
};

struct fitted_iteration {
    int iteration;
    double objective, gradient, mu, gain_ratio, step, seconds; /* seconds NaN in results before 0.3 */
    double *x;
};

struct fitted_baseline {
    const char *algorithm, *result;
    int usable, evaluations;
    double objective, gradient, seconds;
    double *x;
    double *predicted_hz; /* [nmode] or NULL */
};

struct fitted_member { /* tie rods or bars in one mode */
    const char *name;
    int is_bars, npoint;
    double *z, *shape;
};

struct fitted_shape { /* of one measured mode */
    int mode, measured_mode;
    double *measured, *measured_std, *predicted; /* [nsensor], the first two NULL where there are none */
    double *axis;                                /* [naxis] */
    int nmember;
    struct fitted_member *member;
};

struct fitted_shapes {
    int nsensor, naxis, nmode;
    double *sensor_id, *sensor_z, *axis_z;
    struct fitted_shape *mode;
};

struct fitted_matrix {
    int rows, columns; /* measured modes, modes of the model */
    double *value;     /* column-major, NaN where there is no shape */
};

struct fitted {
    const char *status, *functional, *reduction, *derivative, *stop_reason;
    int shapes_fitted; /* -1: the result does not say */
    double bijection_chi, objective, gradient, chi2, chi2_per_dof, condition_number, widened_by, mass_kg, center_m, seconds;
    int dof, iterations, evaluations, jacobians;
    int nparameter, nmode, nhistory, nbaseline, ncorrelation;
    struct fitted_parameter *parameter;
    double *correlation; /* [nparameter * nparameter] or NULL */
    struct fitted_mode *mode;
    struct fitted_iteration *history;
    struct fitted_baseline *baseline;
    struct fitted_shapes *shapes; /* NULL where there are none */
    struct fitted_matrix nco, mac;
    double *matrix_row, *matrix_column; /* numbers of their modes, NULL where there are no matrices */
};

/* The identification in the object `at`; NULL where something is wrong: reader->status tells. */
struct fitted *fitted_read(const struct json_place *at);

/* "shapes" of `at`, NULL where it is not there. */
struct fitted_shapes *fitted_read_shapes(const struct json_place *at);

/* rms of error_percent over the modes that were fitted, or held out; NaN of none. */
double fitted_rms_percent(const struct fitted *fit, int holdout);
/* The fitted mode whose frequency is worst, -1 of none. */
int fitted_worst(const struct fitted *fit);

#endif
