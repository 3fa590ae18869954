#include "linalg/linalg.h"

#include <math.h>

double shift_of(int known, const double *value, double largest)
{
    int j = known < 3 ? known - 1 : 2;
    while (j + 1 < known && value[j] < ZERO * largest)
        j++;
    return isfinite(value[j]) && value[j] >= ZERO * largest ? -0.1 * value[j] : 0;
}
