#include "linalg/linalg.h"

#include <math.h>

#define ROUNDING 2e-15 /* of the highest eigenvalue: what the entries of K leave of the lowest ones */

double shift_of(int known, const double *value, double largest)
{
    int j = known < 3 ? known - 1 : 2;
    while (j + 1 < known && value[j] < ZERO * largest)
        j++;
    return isfinite(value[j]) && value[j] >= ZERO * largest ? -0.1 * value[j] : 0;
}

double shift_above(double last, double below, double largest)
{
    return last + 1e-6 * (fabs(last) - below) + ROUNDING * largest;
}
