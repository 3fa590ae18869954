#include "base/order.h"

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
