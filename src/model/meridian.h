/* The mesh of a solid of revolution and the motion on it, as results carry them. NULL of a beam, and where memory is out. */
#ifndef ROTID_MODEL_MERIDIAN_H
#define ROTID_MODEL_MERIDIAN_H

#include "model/model.h"

rotid_solid_mesh *meridian_size(struct pool *pool, const struct rotor_model *model);
/* Nodes and elements of its mesh; untouched of a beam. */
void meridian_count(const struct rotor_model *model, int *nodes, int *elements);

rotid_meridian *meridian_mesh(struct pool *pool, const struct rotor_model *model);

/* Of the motion u [n], at the values of the last evaluation. */
rotid_meridian_mode *meridian_mode(struct pool *pool, const struct rotor_model *model, const double *u);

#endif
