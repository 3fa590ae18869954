/* Numbers in order. */
#ifndef ROTID_BASE_ORDER_H
#define ROTID_BASE_ORDER_H

#include <stddef.h>

/* value [count], increasing; none is NaN. */
void sort_doubles(size_t count, double *value);

/* Their median, behind which x is sorted; NaN of none. */
double median_of(size_t count, double *x);

#endif
