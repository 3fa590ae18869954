/* The entries of a matrix one by one. */
#ifndef ROTID_EXPORT_TRIPLETS_H
#define ROTID_EXPORT_TRIPLETS_H

#include "rotid.h"

struct triplet {
    int row, column; /* from 0, row >= column; start with row -1, column 0 */
    double value;
};

/* The next entry of the lower triangle that is not zero, column by column, rows increasing; 0 where there is none. As the beam
 * assembles its matrices, the block of far degrees of freedom holds only the entries outside the band. */
int triplet_next(const rotid_matrix *a, struct triplet *t);

/* How many there are. */
long triplet_count(const rotid_matrix *a);

#endif
