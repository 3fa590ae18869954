#include "ema/ema.h"

#include <stdlib.h>

static int by_frequency(const void *a, const void *b)
{
    double x = cimag(*(const double complex *)a), y = cimag(*(const double complex *)b);
    return (x > y) - (x < y);
}

void sort_poles(size_t count, double complex *pole)
{
    if (count)
        qsort(pole, count, sizeof *pole, by_frequency);
}
