/* The bijection (30) between an unbounded y and x in (lower, upper):
 *   x = alpha + (beta - alpha)/(1 + exp(chi y)) */
#ifndef ROTID_FIT_BOUNDS_H
#define ROTID_FIT_BOUNDS_H

#include "rotid.h"

double bounds_to_x(const rotid_parameter *parameter, double chi, double y);
double bounds_to_y(const rotid_parameter *parameter, double chi, double x);
/* dx/dy */
double bounds_slope(const rotid_parameter *parameter, double chi, double y);
/* dr/dy [m * n] := dr/dx dx/dy; a column that is nothing but rounding beside the others becomes zero. A parameter that does
 * nothing keeps its value then: all of r seems to be gained by a leap of it, and where the fit refuses that, it refuses with it
 * what the step does to the others. */
void bounds_jacobian(int m, int n, const rotid_parameter *parameter, double chi, const double *y, const double *dr_dx,
                     double *dr_dy);
/* The sigmoid saturates where x is this near to a bound, as part of the interval: -1 lower, 1 upper, 0 neither. */
int bounds_pressed(const rotid_parameter *parameter, double x);

#endif
