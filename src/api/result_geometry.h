/* A model as it is drawn and meshed, for results. */
#ifndef ROTID_API_RESULT_GEOMETRY_H
#define ROTID_API_RESULT_GEOMETRY_H

#include "model/model.h"

/* Of the beam, with the values of the parameters and the end springs that it has; of the rotor as it stands, without nodes, where
 * beam is NULL. It leans on
 * both. NULL where memory is out. */
rotid_geometry *result_geometry(struct pool *pool, const struct rotor *rotor, const struct rotor_model *model);

#endif
