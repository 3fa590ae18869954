/* What physics can do to a shape at one place: a joint or a soft zone bends it (its slope changes) and shears it (it jumps). That
 * is nearly a spike where sensors are far apart, so a fault has to explain the data better. */
#ifndef ROTID_DIAGNOSE_SENSOR_LOCAL_H
#define ROTID_DIAGNOSE_SENSOR_LOCAL_H

#include <stddef.h>

#include "diagnose/sensor_field.h"

/* Length of the workspace in doubles. */
size_t local_workspace(const struct sensor_field *field);

/* Log likelihood of all sensors that are in, with a change of slope and a jump of free size in every mode at the best place
 * within two gaps of sensor s. */
double local_physics(const struct sensor_field *field, int s, double *work);

#endif
