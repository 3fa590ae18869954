/* Where the nodes of the model are. */
#ifndef ROTID_EXPORT_NODES_H
#define ROTID_EXPORT_NODES_H

#include "export/model.h"

/* Fills model->node, nnode and is_solid. ROTID_OK or ROTID_ERROR_MEMORY. */
int export_nodes(struct pool *pool, struct export_model *model);

#endif
