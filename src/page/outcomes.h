/* What `rotid modes`, `rotid sensitivity` and `rotid frf` write with --json. Each reader gives NULL where something is wrong:
 * reader->status tells. */
#ifndef ROTID_PAGE_OUTCOMES_H
#define ROTID_PAGE_OUTCOMES_H

#include "result/place.h"

struct modes_entry {
    int mode;
    double full_hz, reduced_hz, reduction_percent, mesh_percent;
    double measured_hz, error_percent, mac, nco; /* NaN where no measured mode is paired with it */
    double *shape;                               /* [nsensor] */
};

struct modes_outcome {
    const char *reduction;
    int nrigid, nsensor, nmode;
    double *rigid_hz, *sensor_z;
    struct modes_entry *mode;
};

struct sensitivity_parameter {
    const char *name, *unit;
    double reference;
    double *difference, *derivative; /* [nmode] */
    double *curve;                   /* [nmode * npoint] E_k^2/2, NaN where the model has no modes */
};

struct growth_outcome { /* Figure 3: f(E) and f(F) over eps^2 */
    int points;
    double *epsilon2, *objective[2], *shapes_alone; /* [points]; shapes_alone NULL: not known */
    double slope[2], intercept[2];
};

struct sensitivity_outcome {
    const char *reduction;
    double step;
    int nmode, npoint, nparameter;
    double *hz, *relative;
    struct sensitivity_parameter *parameter;
    struct growth_outcome *growth; /* NULL: the result has none */
};

struct transfer_function {
    int response, reference, nline;
    double response_z, reference_z, frac, frac_moved, level_db;
    double *hz, *re, *im, *measured_re, *measured_im; /* [nline]; NULL where the result has no curves, or no measured ones */
};

struct transfer_mode {
    int mode; /* 0: rigid */
    double model_hz, measured_hz, damping, frac, level_db, phase_deg;
    const char *damping_from;
};

struct transfer_outcome {
    const char *quantity, *unit, *measured_file; /* the file NULL: nothing measured */
    double low_hz, high_hz, up_to_hz, frac, frac_moved;
    int complete, with_curves, nmode, nfunction, nparameter;
    struct transfer_mode *mode;
    struct transfer_function *function;
    struct fitted_value {
        const char *name, *unit;
        double value;
    } * parameter; /* identified ones the model is taken at */
};

struct modes_outcome *modes_read(const struct json_place *root);
struct sensitivity_outcome *sensitivity_read(const struct json_place *root);
struct transfer_outcome *transfer_read(const struct json_place *root);

#endif
