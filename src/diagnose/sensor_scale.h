/* What a field of sensors begins with: the data of each mode on the scale of its model, the grid of what the model may get wrong,
 * and which modes share a covariance. */
#ifndef ROTID_DIAGNOSE_SENSOR_SCALE_H
#define ROTID_DIAGNOSE_SENSOR_SCALE_H

#include "diagnose/sensor_field.h"

/* field_new but for the parts of the covariance. */
int field_scale(struct pool *pool, const struct shape_data *data, struct sensor_field *field);

/* The shape of the model in mode k at z, cubic between the nodes. */
double field_model(const struct sensor_field *field, int k, double z);

#endif
