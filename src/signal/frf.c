#include "signal/frf.h"

#include <math.h>
#include <stddef.h>

/* Without its first `lines` lines. */
static void drop_first(struct frf_set *set, int lines)
{
    set->nline -= lines;
    set->frequency_hz += lines;
    for (int f = 0; f < set->nfrf; f++) {
        set->frf[f].h += lines;
        if (set->frf[f].variance)
            set->frf[f].variance += lines;
        if (set->frf[f].coherence)
            set->frf[f].coherence += lines;
    }
}

/* Their columns have the lines and the quantity of the records. */
static void drop_singles(struct frf_set *set)
{
    for (int f = 0; f < set->nfrf; f++) {
        set->frf[f].single = NULL;
        set->frf[f].single_force = NULL;
    }
}

void frf_convert(struct frf_set *set, enum frf_quantity quantity)
{
    static const double pi = 3.14159265358979323846;
    int power = (int)quantity - (int)set->quantity;
    if (power && set->nline && !(set->frequency_hz[0] > 0) && !(fabs(set->window_decay) > 0))
        drop_first(set, 1);
    set->quantity = quantity;
    drop_singles(set);
    for (int l = 0; l < set->nline; l++) {
        double complex s = CMPLX(set->window_decay, 2 * pi * set->frequency_hz[l]), factor = 1;
        for (int q = 0; q < power; q++)
            factor *= s;
        for (int q = 0; q > power; q--)
            factor /= s;
        double square = creal(factor) * creal(factor) + cimag(factor) * cimag(factor);
        for (int f = 0; f < set->nfrf; f++) {
            set->frf[f].h[l] *= factor;
            if (set->frf[f].variance)
                set->frf[f].variance[l] *= square;
        }
    }
}

void frf_cut(struct frf_set *set, double low_hz, double high_hz)
{
    int below = 0;
    drop_singles(set);
    while (below < set->nline && set->frequency_hz[below] < low_hz)
        below++;
    drop_first(set, below);
    while (set->nline && set->frequency_hz[set->nline - 1] > high_hz)
        set->nline--;
}

double frf_assurance(int n, const double complex *a, const double complex *b)
{
    /* each vector is scaled by its largest component, so that nothing over- or underflows */
    double largest_a = 0, largest_b = 0, aa = 0, bb = 0;
    double complex ab = 0;
    for (int l = 0; l < n; l++) {
        largest_a = fmax(largest_a, cabs(a[l]));
        largest_b = fmax(largest_b, cabs(b[l]));
    }
    if (!(largest_a > 0 && largest_b > 0))
        return 0;
    for (int l = 0; l < n; l++) {
        double complex u = a[l] / largest_a, v = b[l] / largest_b;
        aa += creal(u * conj(u));
        bb += creal(v * conj(v));
        ab += conj(u) * v;
    }
    return fmin(creal(ab * conj(ab)) / (aa * bb), 1);
}
