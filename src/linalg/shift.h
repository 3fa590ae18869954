/* The shift s of an iteration with (K - s M)^-1 M. */
#ifndef ROTID_LINALG_SHIFT_H
#define ROTID_LINALG_SHIFT_H

#define FIRST_SHIFT 1e-10 /* of the highest eigenvalue: the first shift, far below the first mode and far above its rounding */
#define ZERO        1e-14 /* of the highest eigenvalue: below this, rounding of a rigid motion */

/* A shift < 0 of the size of the third of the eigenvalues value [known], ascending (the first two may be rigid-body modes at
 * zero), or of the first above it that is not zero: the iteration then converges about as fast as with none. largest: the size of
 * the highest eigenvalue. Returns 0 where none of these is known (not finite, or zero). */
double shift_of(int known, const double *value, double largest);

#endif
