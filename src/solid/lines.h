/* Places of mesh lines along one coordinate, graded towards some of them. */
#ifndef ROTID_SOLID_LINES_H
#define ROTID_SOLID_LINES_H

#include "base/pool.h"

struct stop {
    double at;   /* m, where a line has to be */
    double fine; /* m: the size of the elements beside it; 0: not graded towards it */
    double upto; /* m: the largest element between this stop and the next */
};

/* Lines x [*count] through `nstop` >= 2 stops, increasing: from a graded stop the elements double until they reach the largest,
 * and there is a multiple of `multiple` of even ones.
 * ROTID_OK or ROTID_ERROR_MEMORY. */
int lines_graded(struct pool *pool, int nstop, const struct stop *stop, int multiple, int *count, double **x);

/* Sorts stops, and makes one of those nearer than `tolerance`: the finest of their sizes. Returns how many are left. */
int stops_merge(int nstop, struct stop *stop, double tolerance);

#endif
