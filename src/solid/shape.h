/* Shape functions of the eight-node quadrilateral and of its edges. */
#ifndef ROTID_SOLID_SHAPE_H
#define ROTID_SOLID_SHAPE_H

#include "solid/mesh.h"

/* n [8] and its derivatives with respect to x, from the inner to the outer edge, and y, from left to right, both in [-1, 1]. */
void shape_of_element(double x, double y, double *n, double *by_x, double *by_y);

/* Share n [3] of the ends and the node between in the motion at a place of an edge, whose nodes are at `edge` [3], in the order
 * first end, node between, second end; by_place [3]: derivatives with respect to the place, or NULL. */
void shape_of_edge(const double *edge, double place, double *n, double *by_place);

#endif
