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

double highest_of(const rotid_matrix *k, const rotid_matrix *m)
{
    double largest = 0;
    for (int i = 0, f = 0; i < k->n; i++) {
        ptrdiff_t diagonal = (ptrdiff_t)i * (k->kd + 1);
        double stiffness = k->band[diagonal], mass = m->band[diagonal];
        if (f < k->nfar && k->far[f] == i) {
            stiffness += k->block[(ptrdiff_t)f * (k->nfar + 1)];
            mass += m->block[(ptrdiff_t)f++ * (k->nfar + 1)];
        }
        largest = fmax(largest, stiffness / mass);
    }
    return isfinite(largest) ? largest : 0;
}

double shift_above(double last, double below, double largest)
{
    return last + 1e-6 * (fabs(last) - below) + ROUNDING * largest;
}

double shift_below(double last, double below, double largest)
{
    return last < ZERO * largest ? -FIRST_SHIFT * largest : last - 1e-6 * (last - below) - ROUNDING * largest;
}
