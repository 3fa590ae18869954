/* Measured shapes beside those of the full model, as a picture of them needs it: on one scale, the model's along the whole axis
 * and along the members beside it, and which measured shape looks like which mode. */
#ifndef ROTID_RUN_MODE_SHAPES_H
#define ROTID_RUN_MODE_SHAPES_H

#include "run/compare.h"

struct member_shape { /* of tie rods or of bars, from their left end to the right one */
    const char *name;
    int is_bars, npoint;
    double *z, *shape; /* [npoint] m, [npoint * nmode] */
};

/* Arrays [.. * nmode] go by measured modes. */
struct mode_shapes {
    int nmode, nsensor, naxis, nmember, ncolumn;
    int *has_shape;              /* [nmode] measured, with a component that is not zero */
    double *measured;            /* [nsensor * nmode] largest component 1, NaN where not measured */
    double *predicted;           /* [nsensor * nmode] of the partner, times its best scale to the measured one:
                                    a = sum p m/s^2/sum p^2/s^2 with the stated noise s, 1 where it is not known of all. Without
                                    a measured shape the largest deflection of the axis is 1; NaN without a partner */
    double *axis_z, *axis;       /* [naxis] m, [naxis * nmode]: nodes of the axis, evenly thinned, both ends among them */
    struct member_shape *member; /* [nmember] tie rods, then bars, at the scale of predicted */
    double *mac, *nco;           /* [nmode * ncolumn] with modes 1 ... ncolumn of the model, NaN without a shape; NULL: none has
                                    one, or, of nco, there is no mass matrix of the masters */
};

/* ROTID_OK or ROTID_ERROR_MEMORY. The spectrum is that of spectrum_compute, at the model that `compared` paired. */
int mode_shapes_make(struct pool *pool, const struct job *job, const struct spectrum *spectrum, const struct comparison *compared,
                     struct mode_shapes *shapes);

#endif
