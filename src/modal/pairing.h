/* Which mode of the model each measured mode is. */
#ifndef ROTID_MODAL_PAIRING_H
#define ROTID_MODAL_PAIRING_H

#include "base/pool.h"

/* Measured shapes tell modes apart where the best correlation is at least this, and the next best at most half of it. */
#define PAIRING_LEAST 0.5

enum pairing_basis {
    PAIRED_BY_NUMBER, /* the shapes do not tell, or there are none: the number stands */
    PAIRED_BY_SHAPE
};

/* "number" or "shape". */
const char *pairing_basis_name(enum pairing_basis basis);

/* Pairs measured modes [nmode] with model modes [ncandidate] by their correlation [nmode * ncandidate] (NCO or MAC, column a
 * candidate; NULL: no shapes). number [nmode], counted from 1: in, as the data has it; out, as the shapes say where they say it.
 * Modes that the shapes place take their partner first, strongest correlation first; the others keep their number if it is still
 * free. basis [nmode]. Returns 0, or 1 + the index of a mode whose number was taken by another. used [ncandidate] is workspace.
 */
int pair_modes(int nmode, int ncandidate, const double *correlation, int *number, enum pairing_basis *basis, int *used);

#endif
