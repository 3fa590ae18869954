#include "linalg/linalg.h"

#include <math.h>

#define AT_REST  1e-13 /* of the energy of its elements were each held alone: a motion that moves none against another */
#define ROUNDING 2e-15 /* of the highest eigenvalue: what the entries of K leave of the lowest ones */

double shift_of(int known, const double *value, double largest)
{
    int j = known < 3 ? known - 1 : 2;
    while (j + 1 < known && value[j] < ZERO * largest)
        j++;
    return isfinite(value[j]) && value[j] >= ZERO * largest ? -0.1 * value[j] : 0;
}

/* A_ii; *f is the first far degree of freedom that is not below i */
static double diagonal_of(const rotid_matrix *a, int i, int *f)
{
    double value = a->band[(ptrdiff_t)i * (a->kd + 1)];
    while (*f < a->nfar && a->far[*f] < i)
        (*f)++;
    return *f < a->nfar && a->far[*f] == i ? value + a->block[(ptrdiff_t)*f * (a->nfar + 1)] : value;
}

double highest_of(const rotid_matrix *k, const rotid_matrix *m)
{
    double largest = 0;
    for (int i = 0, f = 0; i < k->n; i++)
        largest = fmax(largest, diagonal_of(k, i, &f) / diagonal_of(m, i, &f));
    return isfinite(largest) ? largest : 0;
}

int all_at_rest(const rotid_matrix *k, int count, const double *x, const double *kx)
{
    for (int j = 0; j < count; j++, x += k->n, kx += k->n) {
        double energy = 0, held = 0;
        for (int i = 0, f = 0; i < k->n; i++) {
            energy += x[i] * kx[i];
            held += diagonal_of(k, i, &f) * x[i] * x[i];
        }
        if (!(energy <= AT_REST * held))
            return 0;
    }
    return 1;
}

double shift_above(double last, double below, double largest)
{
    return last + 1e-6 * (fabs(last) - below) + ROUNDING * largest;
}

double shift_below(double last, double below, double largest)
{
    return last < ZERO * largest ? -FIRST_SHIFT * largest : last - 1e-6 * (last - below) - ROUNDING * largest;
}
