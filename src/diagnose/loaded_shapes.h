/* What the mass of an accelerometer that went from sensor to sensor did to the measured shapes. */
#ifndef ROTID_DIAGNOSE_LOADED_SHAPES_H
#define ROTID_DIAGNOSE_LOADED_SHAPES_H

#include "diagnose/columns.h"
#include "run/job.h"

/* The fitted model at the sensors, mode by mode, without the accelerometer. */
struct weighing {
    struct columns columns; /* of the base: its fitted modes */
    int nmode, npoint;
    double *hz, *std, *square, *others, *order, *phi; /* as in struct roving_data; phi [npoint * nmode] */
    double *bend;                                     /* likewise */
    double *across, *across_bend; /* [npoint * nmode] like others and bend, but between the point and the hammer */
    double *spread; /* [npoint * nmode] d phi/dm with the mass spread over all sensors, but for a share of phi itself */
    int hammer;     /* sensor, -1 where not known */
};

/* What the mass does to the shapes: with the accelerometer at j the residue is that of the unloaded rotor times 1 + c,
 * c = -m phi_j^2 + m q_jj + m q_je phi_j/phi_e to first order, where q is what the other modes have between the sensor j and the
 * place e of the hammer. Where that is known, and no node of the mode, the residue is put right exactly (moving_mass_residue),
 * with room for a share of the change. Else q_je is
 * about q_jj; all of it is smooth along the rotor, and the noise is taken as independent: hence twice m (phi^2 + |q|), so that
 * what looks like a cause stays below its threshold. Returns how many modes were put right. */
int loaded_shapes_correct(struct job *job, const struct weighing *w, double mass);

/* A mass that the frequencies cannot tell from none moves the shapes all the same: room for the largest one they do not exclude.
 */
void loaded_shapes_allow(struct job *job, const struct weighing *w, double mass);

#endif
