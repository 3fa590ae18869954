/* Numbers in order. */
#ifndef ROTID_BASE_ORDER_H
#define ROTID_BASE_ORDER_H

#include <stddef.h>

/* value [count], increasing; none is NaN. */
void sort_doubles(size_t count, double *value);

/* value[rank] as it would be behind sort_doubles, rank < count; value is left in another order. */
double double_of_rank(size_t count, size_t rank, double *value);

/* Their median, behind which x is sorted; NaN of none. */
double median_of(size_t count, double *x);

#endif
