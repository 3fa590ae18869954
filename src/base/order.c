#include "base/order.h"

#include <math.h>
#include <stdlib.h>

static int compare(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

void sort_doubles(size_t count, double *value)
{
    qsort(value, count, sizeof *value, compare);
}

double median_of(size_t count, double *x)
{
    sort_doubles(count, x);
    return count ? (x[(count - 1) / 2] + x[count / 2]) / 2 : NAN;
}
