/* From a matrix to the storage of its factor: which rows and columns are kept, which of them are far. */
#ifndef ROTID_LINALG_FACTOR_GATHER_H
#define ROTID_LINALG_FACTOR_GATHER_H

#include "linalg/factor.h"

/* A, or of a pencil K - shift M (wide bands alone) */
struct factor_source {
    const rotid_matrix *a;
    const struct pencil *pencil;
    double shift;
};

/* band or wide, coupling and schur := the parts of A */
void factor_gather(struct factor *f, const struct factor_source *source);

#endif
