/* The model as it is drawn and meshed, so that a picture of it needs no deck. */
#ifndef ROTID_REPORT_JSON_GEOMETRY_H
#define ROTID_REPORT_JSON_GEOMETRY_H

#include "result/json_tree.h"

/* "geometry" of the root: of the model of the spectrum, with the values of the parameters and the end springs that it has; of the
 * job as it stands, without nodes, where there is no spectrum (spectrum->model NULL). */
void json_geometry(struct json_tree *tree, const struct job *job, const struct spectrum *spectrum);

#endif
