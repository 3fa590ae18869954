/* K and M as Matrix Market files (Boisvert, Pozo, Remington 1996), which SciPy, MATLAB and Julia read: coordinate format with the
 * lower triangle for the full model, array format for the condensed one, 17 digits; and a table of the nodes. */
#ifndef ROTID_EXPORT_MATRIX_MARKET_H
#define ROTID_EXPORT_MATRIX_MARKET_H

#include <stdio.h>

#include "export/model.h"

/* Each writes to a stream whose errors the caller asks for at its end. */
int matrix_market_stiffness(FILE *stream, const struct export_model *model);
int matrix_market_mass(FILE *stream, const struct export_model *model);
int matrix_market_condensed_stiffness(FILE *stream, const struct export_model *model);
int matrix_market_condensed_mass(FILE *stream, const struct export_model *model);
/* node, z_m, row_v, row_theta (from 1), member, sensor; of a solid node, r_m, z_m, row_u, row_v, row_w, row_theta, member, sensor
 */
int matrix_market_nodes(FILE *stream, const struct export_model *model);

#endif
