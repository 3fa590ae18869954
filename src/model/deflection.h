/* How a rotor deflects in a motion of all degrees of freedom: along its axis, at its sensors, and the members beside it. Values
 * of parameters are those of the last evaluation. */
#ifndef ROTID_MODEL_DEFLECTION_H
#define ROTID_MODEL_DEFLECTION_H

#include "model/model.h"

/* Lateral deflection at place i of model->z, and at a sensor, in the motion u [n]. */
double model_deflection(const struct rotor_model *model, int i, const double *u);
double model_sensor_deflection(const struct rotor_model *model, int sensor, const double *u);

struct model_member { /* tie rods or bars */
    const char *name;
    int is_bars, elements; /* elements: over its length */
};

/* How many members there are, and the i-th of them: tie rods first. */
int model_members(const struct rotor_model *model);
struct model_member model_member(const struct rotor_model *model, int i);

/* Deflection v [npoint] of member i at npoint >= 2 even places z [npoint] from its left end to the right one. */
void model_member_deflection(const struct rotor_model *model, int i, const double *u, int npoint, double *z, double *v);

#endif
