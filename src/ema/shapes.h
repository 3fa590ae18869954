/* From residues to mode shapes. */
#ifndef ROTID_EMA_SHAPES_H
#define ROTID_EMA_SHAPES_H

#include "ema/ema.h"

struct ema_points {
    int nreference;
    int *reference; /* [nfrf] index of the reference of each channel (of the response, where the force roves) */
    double *sign;   /* [nfrf] of response times reference direction */
    int *is_drive;  /* [nfrf] response and reference are the same point */
};

/* Points where the shapes live, channel_point and roving_force of out: the responses, or the references where these are many and
 * the response is one (reciprocity: H_ij = H_ji). A direction counts without its sign, which goes into the shape: a transducer
 * mounted in -x measures -x. ROTID_OK or ROTID_ERROR_MEMORY. */
int shapes_points(struct pool *pool, const struct frf_set *set, struct ema_points *points, struct ema *out);

/* shape, complex_shape, shape_std, mpc, mpd, modal_mass of a mode from residue and residue_std of the usable channels.
 * With one reference the shape is the residues; with several the rank-one matrix phi_p v_j nearest to them, weighted by
 * 1/residue_std^2 of each channel (alternating least squares from the strongest reference; points that one reference lacks are no
 * obstacle). shape_std is that of a component by itself in units of the largest one, which has its own: the common factor is left
 * out, because shapes are compared up to their scale. Modal mass m = phi_d^2/(2 i omega_d A_d) of the drive points' mean.
 * The arrays of the mode exist; work [nreference]. */
void shapes_of_mode(const struct frf_set *set, const struct ema_points *points, const int *usable, const struct ema *out,
                    struct ema_mode *mode, double complex *work);

#endif
