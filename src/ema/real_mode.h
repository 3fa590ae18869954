/* Real normal modes from complex ones, and how far they are from real. */
#ifndef ROTID_EMA_REAL_MODE_H
#define ROTID_EMA_REAL_MODE_H

#include "base/complex.h"

/* Modal phase collinearity (Pappa, Elliott, Schenk 1993): 1 where all components lie on one line through the origin, 0 without a
 * preferred direction: ((S_xx - S_yy)^2 + 4 S_xy^2)/(S_xx + S_yy)^2. NaN components are left out; 0 where all vanish. */
double mode_phase_collinearity(int n, const double complex *shape);

/* Mean deviation [degrees] of the phases from the line of best fit, weighted by the magnitude of the components. */
double mode_phase_deviation(int n, const double complex *shape);

/* exp(i a) along that line: the sum of Re(shape exp(-i a))^2 is largest. 1 where all vanish. */
double complex mode_axis(int n, const double complex *shape);

#endif
