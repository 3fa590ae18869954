/* Numbers in order. */
#ifndef ROTID_BASE_ORDER_H
#define ROTID_BASE_ORDER_H

#include <stddef.h>

/* value [count], increasing; none is NaN. */
void sort_doubles(size_t count, double *value);

#endif
