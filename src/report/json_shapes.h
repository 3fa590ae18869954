/* Measured and predicted shapes, and how far they are alike. */
#ifndef ROTID_REPORT_JSON_SHAPES_H
#define ROTID_REPORT_JSON_SHAPES_H

#include "result/json_tree.h"

/* "shapes", "mac_matrix", "nco_matrix", "matrix_rows" and "matrix_columns" of an identification. */
void json_shapes(struct json_tree *tree, cJSON *object, const struct job *job, const struct identification *result);

#endif
